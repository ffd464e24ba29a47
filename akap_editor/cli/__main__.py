"""Runs the command line: `python -m akap_editor.cli`."""

from . import main

main()
