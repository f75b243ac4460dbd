"""What was noticed: findings of readers, warnings of calibrations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Iterable, Mapping

from ._exceptions import in_words_of_python


@dataclass(frozen=True)
class Diagnostic:
    """Something that a user should know of a recording or a result.

    Attributes
    ----------
    code : str
        Its code, which never changes: ``"hold-moved"``.
    severity : str
        ``"warning"``, ``"note"``, or ``"allowed"`` where the caller allowed it.
    message : str
        What was found and what to do, in a sentence.
    file : str or None
        Name of the file that it is about.
    data : dict
        All of it, as in ``calibration.json``.
    """

    code: str
    severity: str
    message: str
    file: str | None = None
    data: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)

    def __str__(self) -> str:
        place = f"{self.file}: " if self.file else ""
        return f"{self.severity}: {place}{self.message} [{self.code}]"


def diagnostics(found: Iterable[Mapping[str, Any]]) -> tuple[Diagnostic, ...]:
    """Those of a list of a JSON file."""
    return tuple(
        Diagnostic(
            of["code"], of["severity"], in_words_of_python(of["message"]), of.get("file"), dict(of)
        )
        for of in found
    )
