"""What codes mean."""

from __future__ import annotations

import difflib
from dataclasses import dataclass

from . import _native
from ._exceptions import experiment_error, in_words_of_python


@dataclass(frozen=True)
class Explanation:
    """What a code means.

    Attributes
    ----------
    code, severity : str
        The code; ``"warning"``, ``"note"``, or ``"error"`` where there is no result.
    meaning : str
        What it says.
    decided : str or None
        How it is decided; ``None`` of an error.
    remedy : str
        What to do.
    """

    code: str
    severity: str
    meaning: str
    decided: str | None
    remedy: str

    def __str__(self) -> str:
        decided = "" if self.decided is None else f"\nDecided: {self.decided}"
        return f"{self.code} ({self.severity})\n{self.meaning}{decided}\nWhat to do: {self.remedy}"


def explain(code: str) -> Explanation:
    """What a code of a diagnostic or of an error means, how it is decided, and what to do.

    Examples
    --------
    >>> import calibrant as cb
    >>> cb.explain("unit-unknown").severity
    'error'
    """
    known = {of.code: of for of in codes()}
    if code not in known:
        near = difflib.get_close_matches(str(code), known, 1)
        help = f"did you mean {near[0]!r}?" if near else "see `codes()`"
        raise experiment_error(f"there is no code {code!r}", help)
    return known[code]


def codes() -> tuple[Explanation, ...]:
    """All codes: those of diagnostics, then those of errors."""
    return tuple(
        Explanation(code, severity, *(None if of is None else in_words_of_python(of) for of in texts))  # type: ignore[arg-type]
        for code, severity, *texts in _native.explained()
    )
