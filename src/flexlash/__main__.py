"""`python -m flexlash` is the command `flexlash`, and so is the program that `.ci/flexlash.spec` makes of this file."""

from multiprocessing import freeze_support

if __name__ == "__main__":
    # A process that the program starts begins here as well, and does what it was started for instead of a command.
    freeze_support()
    from flexlash.cli import main

    main()
