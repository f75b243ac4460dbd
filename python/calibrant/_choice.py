"""What is chosen of a design, as the native part takes it."""

from __future__ import annotations

from typing import Any, Iterable, Mapping, Union

from ._arrays import as_json
from ._calibration import Calibration
from ._exceptions import experiment_error

Reach = Mapping[str, Union[float, str]]
"""Parameters, and the standard deviation that each should have: a number in its unit, or a text such as ``"50ppm"`` or ``"0.2mg"``."""

Known = Union[Calibration, Iterable[Calibration]]


def choice(*, known: Known = (), certificate: bool = True, reach: Reach | None = None, **others: Any) -> str:
    """The choice as JSON. What is ``None`` is as the experiment says."""
    goals = [] if reach is None else [_goal(name, sd) for name, sd in _items(reach)]
    return as_json(
        {
            "known": texts_of(known),
            "without_certificate": not certificate,
            "reach": goals,
            **others,
        }
    )


def texts_of(known: Known) -> list[str]:
    """The texts of earlier calibrations."""
    earlier = [known] if isinstance(known, Calibration) else list(known or ())
    for calibration in earlier:
        if not isinstance(calibration, Calibration):
            raise experiment_error(f"`known` has {type(calibration).__name__}", "give calibrations")
    return [calibration.to_json() for calibration in earlier]


def _items(reach: Reach) -> Iterable[tuple[str, float | str]]:
    if not isinstance(reach, Mapping):
        raise experiment_error(f"`reach` is {type(reach).__name__}", 'give a dict: {"scale.x": "50ppm"}')
    return reach.items()


def _goal(name: object, sd: float | str) -> tuple[str, str]:
    try:
        return str(name), sd if isinstance(sd, str) else repr(float(sd))
    except (TypeError, ValueError):
        raise experiment_error(f"`reach` of {name} is {sd!r}", "give a number, or a text such as '50ppm'") from None
