"""`python -m fpcad` is the command line."""

from fpcad.cli import main

main()
