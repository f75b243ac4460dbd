"""Experiments: what is known of a sensor, and of what was done with it."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping

from . import _native
from ._arrays import Path, plain
from ._exceptions import ExperimentError, experiment_error, place_in_words

Section = Mapping[str, Any]

_BARE = "schema = 1\n"


class Experiment:
    """What is known of a sensor, and of what was done with it.

    It is the text of an experiment file, in TOML. Each section is a dict of keys; ``None`` takes a key or a section away. Start from a preset.

    Parameters
    ----------
    **sections
        ``sensor``, one of ``holds``, ``motion`` and ``machine``, and where needed ``gyroscope``, ``limits``, ``accept``, ``design``, ``known``, ``temperature``, ``campaign``, ``columns``, ``calibrate``, ``study``.

    Raises
    ------
    ExperimentError
        Where a key is unknown or missing, or a value makes no sense. `key` names it.

    Examples
    --------
    >>> import calibrant as cb
    >>> by_hand = cb.Experiment.preset("imu", holds={"gravity_mps2": 9.8132})
    >>> by_hand["holds"]["gravity_mps2"]
    9.8132
    >>> cb.Experiment.preset("imu", holds={"gravitty_mps2": 9.8132})
    Traceback (most recent call last):
        ...
    calibrant.ExperimentError: `holds.gravitty_mps2`: unknown key (did you mean `gravity_mps2`?)
    """

    def __init__(self, **sections: Section | None) -> None:
        self._set(_merged(_BARE, sections), None, written=False)

    @classmethod
    def preset(cls, name: str, **sections: Section | None) -> Experiment:
        """The preset of this name (:func:`presets`), with these keys in place of its own."""
        text = _native.preset_text(name)
        if sections:
            return cls._made(_merged(text, sections), None, written=False)
        return cls._made(text, None)

    @classmethod
    def from_toml(cls, source: Path | bytes) -> Experiment:
        """An experiment file; or its text, as bytes. Paths in a file count from its directory."""
        if isinstance(source, bytes):
            return cls._made(_decoded(source, None), None)
        path = os.fspath(source)
        if "\n" in path:
            raise experiment_error("this is the text of an experiment file, not its path", "give it as bytes: text.encode()")
        try:
            with open(path, "rb") as file:
                content = file.read()
        except OSError as error:
            raise experiment_error(f"{path}: {error.strerror or error}", "check its name", code="file-unreadable") from error
        return cls._made(_decoded(content, path), path)

    def replace(self, **sections: Section | None) -> Experiment:
        """The same experiment with these keys in place of its own."""
        return self._made(_merged(self._text, sections), self._path, written=False)

    def to_toml(self) -> str:
        """The text of the experiment file."""
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """Its sections as dicts."""
        found: dict[str, Any] = json.loads(_native.sections_of(self._text))
        return found

    @property
    def sha256(self) -> str:
        """SHA-256 of the text, as results state it."""
        return str(self._about["sha256"])

    @property
    def kind(self) -> str:
        """How the sensor is moved: ``"holds"``, ``"motion"`` or ``"machine"``."""
        return str(self._about["plan"]).strip("[]")

    @property
    def _is_campaign(self) -> bool:
        return bool(self._about["is_campaign"])

    @property
    def _files(self) -> list[str]:
        return list(self._about["files"])

    def __getitem__(self, section: str) -> Any:
        return self.to_dict()[section]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Experiment) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __repr__(self) -> str:
        what = "IMU" if self._about["is_imu"] else "accelerometer"
        return f"Experiment({what}, [{self.kind}])"

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(self._text)}</pre>"

    def __reduce__(self) -> tuple[Any, ...]:
        # another process may be elsewhere
        path = None if self._path is None else os.path.abspath(self._path)
        return (Experiment._made, (self._text, path, self._written))

    @classmethod
    def _made(cls, text: str, path: str | None, written: bool = True) -> Experiment:
        made = cls.__new__(cls)
        made._set(text, path, written)
        return made

    def _set(self, text: str, path: str | None, written: bool) -> None:
        self._text, self._path, self._written = text, path, written
        try:
            self._native = _native.Experiment(text, path)
        except Exception as error:
            if written:
                raise
            # nobody has seen the text: only the key says where
            raise _without_place(error) from None
        self._about: dict[str, Any] = json.loads(self._native.about())


def presets() -> dict[str, str]:
    """Name and purpose of each preset.

    Examples
    --------
    >>> import calibrant as cb
    >>> cb.presets()["imu"]
    'whole IMU, held and rotated by hand'
    """
    return dict(_native.presets())


def _decoded(content: bytes, path: str | None) -> str:
    try:
        return content.decode("utf-8-sig" if content.startswith(b"\xef\xbb\xbf") else "utf-8")
    except UnicodeDecodeError:
        place = f"{path}: " if path else ""
        raise experiment_error(f"{place}the experiment is not UTF-8", "save it as UTF-8", code="encoding-unknown") from None


def _merged(text: str, sections: Mapping[str, Section | None]) -> str:
    try:
        given = json.dumps(sections, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise experiment_error(f"the sections cannot be written: {error}", "give numbers, texts, lists and dicts") from None
    return _native.merged(text, given)


def _without_place(error: Exception) -> Exception:
    if not isinstance(error, ExperimentError):
        return error
    message = str(error)
    message = message.removeprefix(place_in_words(error.path, error.line, error.column))
    clean = ExperimentError(message)
    clean.__dict__.update(error.__dict__)
    clean.line = clean.column = None
    return clean
