"""`python -m flexlash` is the command `flexlash`."""

from flexlash.cli import main

main()
