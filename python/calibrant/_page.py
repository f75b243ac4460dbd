"""What all results are beside their numbers: JSON, diagnostics, and the sheet of the command line."""

from __future__ import annotations

import json
import os
from contextlib import contextmanager
from functools import cached_property
from typing import Any, Iterator

from . import _native
from ._arrays import Path
from ._diagnostic import Diagnostic, diagnostics
from ._exceptions import OutputError
from ._sheet import page_html


class Page:
    """A result."""

    def __init__(self, found: _native.Page) -> None:
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

    def __repr__(self) -> str:
        lines = self._summary.strip().splitlines()
        return f"{type(self).__name__}({lines[0].strip() if lines else ''})"

    def _repr_html_(self) -> str:
        return page_html(self._html)

    def to_json(self) -> str:
        """The text of the JSON file of the command line."""
        return self._json

    def report(self, path: Path) -> None:
        """Write the report as one HTML file."""
        write(path, self._html)


def write(path: Path, text: str) -> None:
    """Write a text, with the same bytes on all systems: whole, or not at all."""
    with written_to(path):
        place = os.path.realpath(path)
        is_device = os.path.exists(place) and not os.path.isfile(place)
        beside = place if is_device else f"{place}.{os.getpid()}.tmp"
        try:
            with open(beside, "w", encoding="utf-8", newline="") as file:
                file.write(text)
            # what was there stays until the new one is whole
            os.replace(beside, place)
        finally:
            if beside != place and os.path.exists(beside):
                os.remove(beside)


def make_directory(path: Path) -> None:
    """Make a directory where there is none."""
    with written_to(path):
        os.makedirs(path, exist_ok=True)


@contextmanager
def written_to(path: Path) -> Iterator[None]:
    """Raise :exc:`OutputError` where the system refuses what is written there."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        failed = OutputError(f"cannot write {os.fspath(path)}: {error.strerror or error}")
        failed.code, failed.remedy, failed.path = "output-unwritable", "choose another place", os.fspath(path)
        raise failed from error
