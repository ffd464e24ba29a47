"""Runs the program: `python -m akap_editor`."""

from .cli import main

if __name__ == "__main__":
    main()
