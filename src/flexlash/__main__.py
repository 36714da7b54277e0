"""`python -m flexlash` is the command `flexlash`."""

from flexlash.cli import main

if __name__ == "__main__":
    main()
