"""What can go wrong. Each exception has a code, which never changes, and a remedy."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._calibration import Calibration


@dataclass(frozen=True)
class Answer:
    """What the caller may say where an error is a question.

    Attributes
    ----------
    argument
        Name of the argument: ``"rate_hz"``.
    values
        What it may be; empty where that cannot be listed.
    """

    argument: str
    values: tuple[str, ...] = ()


@dataclass(frozen=True)
class UndeterminedGroup:
    """Parameters that the data cannot separate.

    Attributes
    ----------
    parameters
        Their names.
    free_combinations
        How many independent combinations of them the data leave free.
    reason
        Why, in words.
    remedy
        What would fix it.
    """

    parameters: tuple[str, ...]
    free_combinations: int
    reason: str
    remedy: str


class CalibrantError(Exception):
    """The base of all exceptions of this package.

    Attributes
    ----------
    code : str
        Its code, which never changes: ``"unit-unknown"``.
    remedy : str
        What to do.
    answers : tuple of Answer
        The arguments that answer it, where it is a question.
    """

    code: str = "internal-error"
    remedy: str = ""
    answers: tuple[Answer, ...] = ()
    path: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    _json: str | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (type(self), self.args, self.__dict__))


class ExperimentError(CalibrantError, ValueError):
    """The experiment, the motion or an argument makes no sense.

    ``key`` names the key of the experiment: ``"holds.gauge"``. ``path``, ``line`` and ``column`` are there where it came from a file.
    """


class RecordingError(CalibrantError, ValueError):
    """The recording cannot be used. ``path``, ``line`` and ``column`` say where."""


class NotIdentifiable(CalibrantError):
    """The data cannot determine some of the parameters.

    Attributes
    ----------
    groups : tuple of UndeterminedGroup
        One for each set of parameters that cannot be separated.
    """

    groups: tuple[UndeterminedGroup, ...] = ()

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of all parameters that are not determined."""
        return tuple(name for group in self.groups for name in group.parameters)


class Infeasible(CalibrantError):
    """The limits admit no motion, or the time no campaign."""


class OutputError(CalibrantError, OSError):
    """A result cannot be written."""


class BadCalibration(CalibrantError):
    """A calibration is not good enough (:meth:`calibrant.Calibration.raise_for_verdict`).

    Attributes
    ----------
    calibration : calibrant.Calibration
        The calibration.
    """

    code = "bad-calibration"
    calibration: Calibration


class CalibrationWarning(UserWarning):
    """The verdict on a calibration is not ``ok``."""


_CLASSES: dict[str, type[CalibrantError]] = {
    "experiment": ExperimentError,
    "recording": RecordingError,
    "not-identifiable": NotIdentifiable,
    "infeasible": Infeasible,
    "output": OutputError,
}

# commands that have the name of a function
_COMMANDS = re.compile(r"`calibrant (init|records|calibrate|design|inspect|noise|simulate)(?: ([a-z-]+))?[^`]*`")


def in_words_of_python(text: str) -> str:
    """A remedy that names commands, in words of Python."""
    return _COMMANDS.sub(_function, text)


def _function(command: re.Match[str]) -> str:
    name, more = command.groups()
    if name == "init":
        return f'`Experiment.preset("{more}")`'
    return f"`Records.{more}`" if name == "records" else f"`{name}(…)`"


def of_json(text: str) -> CalibrantError:
    """The exception of an error of the native part."""
    data = json.loads(text)
    message, remedy = in_words_of_python(data["message"]), in_words_of_python(data.get("remedy") or "")
    made = _CLASSES.get(data["kind"], CalibrantError)
    path, line, column, key = (data.get(name) for name in ("path", "line", "column", "key"))
    full = "".join(
        (
            place_in_words(path, line, column),
            f"`{key}`: " if key else "",
            message,
            f" ({remedy})" if remedy and made not in (NotIdentifiable, OutputError) else "",
        )
    )
    error = made(full)
    error._json = text
    error.code, error.remedy = data["code"], remedy
    error.path, error.line, error.column, error.key = path, line, column, key
    error.answers = tuple(
        Answer(answer["option"], tuple(answer["values"])) for answer in data.get("answers") or ()
    )
    if isinstance(error, NotIdentifiable):
        error.groups = tuple(
            UndeterminedGroup(
                tuple(group["parameters"]), group["free_combinations"], group["reason"],
                in_words_of_python(group["remedy"]),
            )
            for group in data.get("groups") or ()
        )
    return error


def as_json(error: CalibrantError) -> str:
    """The JSON from which :func:`of_json` makes the same exception."""
    if error._json is not None:
        return error._json
    kinds = [kind for kind, of in _CLASSES.items() if isinstance(error, of)]
    return json.dumps({"kind": kinds[0] if kinds else "other", "code": error.code, "message": str(error)})


def place_in_words(path: str | None, line: int | None, column: int | None) -> str:
    """Where an input is at fault."""
    if path is not None:
        return ":".join(str(part) for part in (path, line, column) if part is not None) + ": "
    if line is not None:
        return f"line {line}" + ("" if column is None else f", column {column}") + ": "
    return ""


def experiment_error(message: str, remedy: str, *, code: str = "value-invalid") -> ExperimentError:
    """An argument that makes no sense."""
    error = ExperimentError(f"{message} ({remedy})" if remedy else message)
    error.code, error.remedy = code, remedy
    return error


def recording_error(message: str, remedy: str, *, code: str = "value-invalid") -> RecordingError:
    """Samples that make no sense."""
    error = RecordingError(f"{message} ({remedy})" if remedy else message)
    error.code, error.remedy = code, remedy
    return error


def _again(of: type[CalibrantError], args: tuple[Any, ...], state: dict[str, Any]) -> CalibrantError:
    error = of(*args)
    error.__dict__.update(state)
    return error
