"""What all results are beside their numbers: JSON, diagnostics, and the sheet of the command line."""

from __future__ import annotations

import json
from functools import cached_property
from typing import Any

from ._arrays import Path
from ._diagnostic import Diagnostic, diagnostics
from ._exceptions import OutputError
from ._sheet import page_html

# the text of the JSON file, diagnostics as JSON, the sheet as text and as a page
Found = tuple[str, str, str, str]


class Page:
    """A result."""

    def __init__(self, found: Found) -> None:
        self._json, notes, self._summary, self._html = found
        self.diagnostics: tuple[Diagnostic, ...] = diagnostics(json.loads(notes))

    @cached_property
    def data(self) -> dict[str, Any]:
        """All of it, with the names of its JSON file."""
        read: dict[str, Any] = json.loads(self._json)
        return read

    def summary(self) -> str:
        """The sheet that the command line prints."""
        return self._summary

    def __str__(self) -> str:
        return self._summary

    def _repr_html_(self) -> str:
        return page_html(self._html)

    def to_json(self) -> str:
        """The text of the JSON file of the command line."""
        return self._json

    def report(self, path: Path) -> None:
        """Write the report as one HTML file."""
        write(path, self._html)


def write(path: Path, text: str) -> None:
    """Write a text."""
    import os

    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        failed = OutputError(f"cannot write {os.fspath(path)}: {error.strerror or error}")
        failed.code, failed.remedy, failed.path = "output-unwritable", "choose another place", os.fspath(path)
        raise failed from error
