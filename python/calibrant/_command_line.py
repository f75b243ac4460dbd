"""The program ``calibrant``, as the package has it."""

from __future__ import annotations

import sys

from . import _native


def main() -> None:
    """Run the command line with the arguments of the process."""
    sys.exit(_native.command_line(["calibrant", *sys.argv[1:]]))
