"""Recordings: files of any format, bytes, frames and arrays."""

from __future__ import annotations

import json
import os
from typing import Any, Literal, Mapping, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Array, Path, as_json, as_list, as_table, numbers, table
from ._diagnostic import Diagnostic, diagnostics
from ._exceptions import experiment_error
from ._frames import columns_of, first_date_ns, frame, has_dates, is_frame, library_of
from ._page import Page

Columns = Mapping[str, Union[str, Sequence[str]]]


class Samples:
    """The samples of one sensor.

    Attributes
    ----------
    t_s : (n,) array
        Times, s.
    values : (n, 3) array
        Readings, in `unit`.
    unit : str
        ``"m/s²"``, ``"rad/s"`` or ``"counts"``.
    """

    def __init__(self, t_s: Array, values: Array, unit: str) -> None:
        self.t_s, self.values, self.unit = t_s, values, unit

    @classmethod
    def _of(cls, found: tuple[bytearray, bytearray, str] | None) -> Samples | None:
        return None if found is None else cls(numbers(found[0]), table(found[1]), found[2])

    def __repr__(self) -> str:
        return f"Samples({len(self.t_s)} in {self.unit})"


class Inspection(Page):
    """What a recording contains, and what to expect of a calibration from it.

    Attributes
    ----------
    diagnostics : tuple of Diagnostic
        What was noticed in the file, the samples and the holds.
    data : dict
        As ``calibrant inspect --json`` writes it.
    """

    _in_counts = False

    @property
    def holds(self) -> list[dict[str, Any]]:
        """The stationary intervals; empty without an accelerometer."""
        return list((self.data.get("holds") or {}).get("table") or [])

    @property
    def missing_orientations(self) -> tuple[str, ...]:
        """The sides of the sensor that no hold has up: ``"+x"``, ``"-z"``. A hold belongs to the side that is nearest to up."""
        seen = set()
        means = np.array([hold["mean"] for hold in self.holds]).reshape(-1, 3)
        middle, half = np.zeros(3), np.ones(3)
        if len(means) > 1 and self._in_counts:
            # counts have an offset
            least, most = means.min(axis=0), means.max(axis=0)
            middle, half = 0.5 * (least + most), np.maximum(0.5 * (most - least), 1e-9 * np.abs(means).max())
        for hold in self.holds:
            mean = (np.array(hold["mean"]) - middle) / half
            axis = int(np.argmax(np.abs(mean)))
            seen.add(("+" if mean[axis] > 0 else "-") + "xyz"[axis])
        return tuple(side for side in ("+x", "-x", "+y", "-y", "+z", "-z") if side not in seen)

    @property
    def emptiest_direction(self) -> Array | None:
        """The direction that is farthest from all holds, a unit vector in the sensor's axes."""
        found = (self.data.get("holds") or {}).get("emptiest_direction")
        return None if found is None else np.array(found)


class Recording:
    """A recording that was read. Make one with :func:`read_recording` or :func:`recording`.

    It remembers where it came from, so that a calibration reads it as the experiment says.
    """

    def __init__(
        self,
        source: _native.Source,
        reading: dict[str, Any],
        name: str,
        rebuild: tuple[Any, ...],
        like: Any = None,
        origin_ns: int | None = None,
    ) -> None:
        self._source, self._reading, self.name = source, reading, name
        # the first time, where it is a date
        self._rebuild, self._like, self._origin_ns = rebuild, like, origin_ns
        self._read = _native.read_recording(source, as_json(reading))
        self._about: dict[str, Any] = json.loads(self._read.about())

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """What the reader noticed and repaired."""
        return diagnostics(self._about["findings"])

    @property
    def format(self) -> str:
        """The format, as it was recognised or given."""
        return str(self._about["format"])

    @property
    def sha256(self) -> tuple[str, ...]:
        """SHA-256 of each file, or of the numbers in memory."""
        return tuple(self._about["sha256"])

    @property
    def accelerometer(self) -> Samples | None:
        """The accelerometer's samples, in m/s² or counts."""
        return Samples._of(self._read.samples("accelerometer"))

    @property
    def gyroscope(self) -> Samples | None:
        """The gyroscope's samples, in rad/s or counts."""
        return Samples._of(self._read.samples("gyroscope"))

    @property
    def temperature_c(self) -> Array | None:
        """Temperature at each sample of the first sensor, °C."""
        found = self._read.temperature_c()
        return None if found is None else numbers(found)

    def inspect(self) -> Inspection:
        """What it contains: columns, sampling, ranges, holds, coverage, and what to expect of a calibration."""
        found = Inspection(self._read.inspect())
        found._in_counts = self.accelerometer is not None and self.accelerometer.unit == "counts"
        return found

    def between(self, start_s: float, end_s: float) -> Recording:
        """The samples from `start_s` to `end_s`, s."""
        accelerometer, gyroscope, temperature = self.accelerometer, self.gyroscope, self.temperature_c
        first = accelerometer or gyroscope
        assert first is not None
        keep = (first.t_s >= start_s) & (first.t_s <= end_s)
        parts = {}
        for sensor, of in (("accelerometer", accelerometer), ("gyroscope", gyroscope)):
            if of is not None:
                kept = (of.t_s >= start_s) & (of.t_s <= end_s)
                parts[sensor] = Samples(of.t_s[kept], of.values[kept], of.unit)
        temperature = None if temperature is None else temperature[keep]
        about = self._about
        return of_samples(
            self.name, parts, temperature, about["axes"], about["rate_sd_ppm"], like=self._like, origin_ns=self._origin_ns
        )

    def to_frame(self) -> Any:
        """The samples as a frame: of the library that came in, or else pandas, polars or pyarrow. Sensors with different times need :attr:`accelerometer` and :attr:`gyroscope`."""
        accelerometer, gyroscope, temperature = self.accelerometer, self.gyroscope, self.temperature_c
        t_s, values = side_by_side(accelerometer, gyroscope)
        columns: dict[str, Any] = {"t_s": t_s}
        for letter, of, table_of in zip("ag", (accelerometer, gyroscope), values):
            if of is not None and table_of is not None:
                unit = {"m/s²": "mps2", "rad/s": "radps"}.get(of.unit, of.unit)
                axes = "xyz" if letter == "g" else "xyz"[: self._about["axes"]]
                columns.update({f"{letter}{axis}_{unit}": table_of[:, k] for k, axis in enumerate(axes)})
        if temperature is not None:
            first = accelerometer or gyroscope
            assert first is not None
            columns["temp_c"] = at_times(t_s, first.t_s, temperature)
        return frame(columns, self._like)

    def save(self, path: Path) -> None:
        """Write it as CSV, in SI units or counts."""
        self._read.write(os.fspath(path))

    def __len__(self) -> int:
        first = self.accelerometer or self.gyroscope
        return 0 if first is None else len(first.t_s)

    def __repr__(self) -> str:
        return f"Recording({self.name!r}: {len(self)} samples, {self.format})"

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuilt, (self._rebuild, self._reading, self._like, self._origin_ns))


def read_recording(
    source: Any,
    *,
    gyroscope: Any = None,
    columns: Columns | None = None,
    accelerometer_unit: str | None = None,
    gyroscope_unit: str | None = None,
    time_unit: str | None = None,
    rate_hz: float | None = None,
    rate_sd_ppm: float | None = None,
    times: Literal["even", "as-logged"] | None = None,
    instance: str | None = None,
    format: str | None = None,
    topic: str | None = None,
    name: str | None = None,
    force: bool = False,
) -> Recording:
    """Read a recording of an accelerometer, a gyroscope or both.

    Parameters
    ----------
    source : path, bytes or frame
        A file of any format that calibrant reads, its bytes, or a frame of pandas, polars or pyarrow.
    gyroscope : path, bytes or frame, optional
        The gyroscope's recording, where each sensor has its own.
    columns : dict, optional
        Names of columns, where their names do not tell: keys ``time``, ``accelerometer``, ``gyroscope`` (three names each) and ``temperature``.
    accelerometer_unit : str, optional
        ``"m/s²"``, ``"mm/s²"``, ``"g"``, ``"mg"`` or ``"counts"``, where the file does not say. A sensitivity, ``"16384 LSB/g"``, makes m/s² of counts.
    gyroscope_unit : str, optional
        ``"rad/s"``, ``"deg/s"``, ``"mdps"`` or ``"counts"``, where the file does not say; or a sensitivity, ``"131 LSB/dps"``.
    time_unit : str, optional
        ``"s"``, ``"ms"``, ``"us"``, ``"ns"``, or ``"samples"`` for a counter.
    rate_hz : float, optional
        Sample rate in Hz, where there are no times.
    rate_sd_ppm : float, optional
        How well that rate is known, ppm; 50 000 by default. Where there are times, and no `rate_hz` is given, how well their clock is; 0 by default.
    times : {"even", "as-logged"}, optional
        Even sample times or the logged ones.
    instance : str, optional
        Which sensor, where the rows are of several.
    format : str, optional
        The format, where it is not recognised.
    topic : str, optional
        The topic of a bag.
    name : str, optional
        What results and errors call bytes or a frame.
    force : bool
        Read it in spite of its size.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        Where it cannot be read, with file, line and column; or where a unit or a rate is not known: `answers` names the argument.

    Examples
    --------
    >>> import calibrant as cb
    >>> text = b"t_s,ax_g,ay_g,az_g\\n0.00,0,0,1\\n0.01,0,0.1,1\\n0.02,0.1,0,1\\n"
    >>> float(cb.read_recording(text).accelerometer.values[0, 2])
    9.80665
    """
    reading = _reading(
        columns=columns,
        accelerometer_unit=accelerometer_unit,
        gyroscope_unit=gyroscope_unit,
        time_unit=time_unit,
        rate_hz=rate_hz,
        rate_sd_ppm=rate_sd_ppm,
        times=times,
        instance=instance,
        format=format,
        topic=topic,
        force=force,
    )
    return _read_recording(source, gyroscope, name, reading)


def recording(
    t_s: npt.ArrayLike | None = None,
    accelerometer: npt.ArrayLike | None = None,
    gyroscope: npt.ArrayLike | None = None,
    *,
    rate_hz: float | None = None,
    rate_sd_ppm: float | None = None,
    accelerometer_unit: str = "m/s²",
    gyroscope_unit: str = "rad/s",
    temperature_c: npt.ArrayLike | None = None,
    gyroscope_t_s: npt.ArrayLike | None = None,
    name: str = "recording",
    force: bool = False,
) -> Recording:
    """A recording of arrays.

    Parameters
    ----------
    t_s : (n,) array, optional
        Times, s, increasing; ``None`` with `rate_hz`.
    accelerometer : (n, 3) array, optional
        Specific force, in `accelerometer_unit`. NaN, or a masked value: no reading. Of a sensor with one axis (n,): in m/s² or counts, with `t_s`.
    gyroscope : (n, 3) array, optional
        Angular rate, in `gyroscope_unit`.
    rate_hz : float, optional
        Sample rate in Hz, in place of times.
    rate_sd_ppm : float, optional
        How well that rate, or the clock of the times, is known, ppm; 50 000 by default of a rate, 0 of times.
    accelerometer_unit : str
        ``"m/s²"``, ``"mm/s²"``, ``"g"``, ``"mg"`` or ``"counts"``.
    gyroscope_unit : str
        ``"rad/s"``, ``"deg/s"``, ``"mdps"`` or ``"counts"``.
    temperature_c : (n,) array, optional
        Temperature of the sensor, °C.
    gyroscope_t_s : (m,) array, optional
        Times of the gyroscope, s, where it has its own; it then has shape (m, 3).
    name : str
        What results and errors call it.
    force : bool
        Take it in spite of its size.

    Returns
    -------
    Recording

    Raises
    ------
    RecordingError
        Where shapes differ, times do not increase, or readings make no sense.

    Examples
    --------
    >>> import calibrant as cb, numpy as np
    >>> t = np.arange(100) / 100
    >>> force = np.tile([0.0, 0.0, 1.0], (100, 1)) + 1e-3 * np.sin(np.arange(300)).reshape(-1, 3)
    >>> len(cb.recording(t, force, accelerometer_unit="g"))
    100
    """
    if accelerometer is None and gyroscope is None:
        raise experiment_error("neither `accelerometer` nor `gyroscope` is there", "give at least one of them")
    if accelerometer is not None and np.ndim(accelerometer) == 1 and gyroscope is None:
        readings = as_list("accelerometer", accelerometer)
        return _one_axis(name, t_s, readings, accelerometer_unit, temperature_c, rate_sd_ppm)
    reading = _reading(rate_hz=rate_hz, rate_sd_ppm=rate_sd_ppm, force=force)
    parts: list[list[tuple[str, Array]]] = []
    own_times = gyroscope_t_s is not None and accelerometer is not None
    for letter, given, unit, unit_name in (
        ("a", accelerometer, accelerometer_unit, "accelerometer_unit"),
        ("g", gyroscope, gyroscope_unit, "gyroscope_unit"),
    ):
        if given is None:
            continue
        readings = as_table("accelerometer" if letter == "a" else "gyroscope", given)
        reading[unit_name] = unit
        if not parts or own_times:
            own = gyroscope_t_s if letter == "g" and gyroscope_t_s is not None else t_s
            # a copy: the caller may fill its array again
            parts.append([] if own is None else [("t_s", as_list("t_s", own).copy())])
        parts[-1] += [(f"{letter}{axis}", np.ascontiguousarray(readings[:, k])) for k, axis in enumerate("xyz")]
    if temperature_c is not None:
        parts[0].append(("temp_c", as_list("temperature_c", temperature_c).copy()))
    return _rebuilt((name, [("columns", part) for part in parts]), reading)


def _one_axis(
    name: str,
    t_s: npt.ArrayLike | None,
    readings: Array,
    unit: str,
    temperature_c: npt.ArrayLike | None,
    rate_sd_ppm: float | None,
) -> Recording:
    if t_s is None or unit not in ("m/s²", "counts"):
        raise experiment_error("a recording of one axis needs `t_s`, and readings in m/s² or counts", "give them, or a file")
    samples = Samples(as_list("t_s", t_s), np.column_stack([readings, np.zeros((len(readings), 2))]), unit)
    temperatures = None if temperature_c is None else as_list("temperature_c", temperature_c)
    if temperatures is not None and len(temperatures) != len(readings):
        raise experiment_error(f"there are {len(temperatures)} temperatures for {len(readings)} readings", "give one for each")
    return of_samples(name, {"accelerometer": samples}, temperatures, 1, rate_sd_ppm)


def _reading(**options: Any) -> dict[str, Any]:
    columns = options.pop("columns", None)
    reading = {key: value for key, value in options.items() if value is not None and value is not False}
    if columns:
        reading["columns"] = {
            key: value if isinstance(value, str) else list(value) for key, value in columns.items()
        }
    return reading


def _read_recording(source: Any, gyroscope: Any, name: str | None, reading: dict[str, Any]) -> Recording:
    if isinstance(source, Recording):
        if reading:
            raise experiment_error("the recording is read already", f"leave away {', '.join(f'`{key}`' for key in reading)}")
        if gyroscope is None:
            return source
    origin_ns = origin_of(source)
    parts = [_part(source, reading)] + ([] if gyroscope is None else [_part(gyroscope, reading, origin_ns)])
    return _rebuilt((name, parts), reading, like_of(source), origin_ns)


def as_source(
    source: Any, sections: Path | None = None, further: Sequence[Any] = ()
) -> tuple[_native.Source, dict[str, Any]]:
    """Anything that is a recording, as the native part takes it, and what is known of its reading. A path is not read yet."""
    if isinstance(source, Recording):
        if sections is None and not further:
            return source._source, source._reading
        readings, reading = _readings_of(source._rebuild)[0], source._reading
    else:
        readings, reading = [as_readings(source)], {}
    place = None if sections is None else os.fspath(sections)
    added = [_native.Source(as_readings(of)) for of in further]
    return _native.Source(readings[0], readings[1] if len(readings) > 1 else None, added, place), reading


def as_readings(source: Any) -> _native.Readings:
    """A recording beside another one: one that was read keeps its units and its rate."""
    return _readings_of((None, [_part(source)]))[0][0]


def as_soak(source: Any, number: int) -> _native.Source:
    """A recording among others; one without a name gets that of a soak."""
    soak = f"soak {number}"
    if not isinstance(source, Recording):
        part = _part(source)
        return _native.Source(_readings_of((None if part[0] == "path" else soak, [part]))[0][0])
    called = soak if source.name == "recording" else source.name
    if source._reading:
        return _native.Source(source._read.readings(called))
    readings, _ = _readings_of((called if source._rebuild[1][0][0] != "path" else None, source._rebuild[1]))
    return _native.Source(readings[0], readings[1] if len(readings) > 1 else None)


def like_of(source: Any) -> Any:
    """The library of a frame, also of one that was read."""
    if isinstance(source, Recording):
        return source._like
    return library_of(source) if not is_path_or_bytes(source) and is_frame(source) else None


def is_path_or_bytes(source: Any) -> bool:
    """Is it a path, or the bytes of a file?"""
    return isinstance(source, (str, os.PathLike, bytes, bytearray, memoryview))


def origin_of(source: Any) -> int | None:
    """The first time of a frame whose times are dates, ns."""
    if isinstance(source, Recording):
        return source._origin_ns
    return first_date_ns(source) if not is_path_or_bytes(source) and is_frame(source) else None


def _part(source: Any, reading: dict[str, Any] | None = None, origin_ns: int | None = None) -> tuple[str, Any]:
    """Path, bytes, columns or a recording: what can be pickled."""
    if isinstance(source, (str, os.PathLike)):
        return ("path", os.fspath(source))
    if isinstance(source, (bytes, bytearray, memoryview)):
        return ("bytes", bytes(source))
    if isinstance(source, Recording):
        return ("recording", source)
    if not is_frame(source):
        message = f"{type(source).__name__} is no recording"
        collected = next((f"`.{how}()` of it" for how in ("collect", "pl") if hasattr(source, how)), "a frame")
        raise experiment_error(message, f"give a path, bytes, {collected}, or arrays by `recording(…)`")
    named = (reading or {}).get("columns") or {}
    time = named.get("time")
    if time is not None and has_dates(source, time):
        named["time"] = "t_s"
    return ("columns", columns_of(source, origin_ns, time))


def _readings_of(rebuild: tuple[Any, ...]) -> tuple[list[_native.Readings], str]:
    name, parts = rebuild
    of, first = parts[0]
    called = name or (os.path.basename(first) if of == "path" else first.name if of == "recording" else "recording")
    made = []
    for number, (of, content) in enumerate(parts):
        other = called if number == 0 else f"{called} (gyroscope)"
        if of == "path":
            made.append(_native.Readings.file(content))
        elif of == "bytes":
            made.append(_native.Readings.bytes(other, content))
        elif of == "recording":
            made.append(content._read.readings(content.name))
        elif of == "samples":
            made.append(_native.Readings.samples(other, *content))
        else:
            columns = [(of_column, values.tobytes()) for of_column, values in content]
            made.append(_native.Readings.columns(other, columns))
    return made, called


def _rebuilt(
    rebuild: tuple[Any, ...], reading: dict[str, Any], like: Any = None, origin_ns: int | None = None
) -> Recording:
    readings, name = _readings_of(rebuild)
    source = _native.Source(readings[0], readings[1] if len(readings) > 1 else None)
    return Recording(source, reading, name, rebuild, like, origin_ns)


def of_samples(
    name: str,
    sensors: Mapping[str, Samples],
    temperature_c: Array | None,
    axes: int,
    rate_sd_ppm: float | None = None,
    *,
    like: Any = None,
    origin_ns: int | None = None,
) -> Recording:
    """A recording of samples as they are: nothing is recognised, and nothing is repaired."""
    listed = [(of, samples.unit, samples.t_s.tobytes(), samples.values.tobytes()) for of, samples in sensors.items()]
    temperatures = None if temperature_c is None else temperature_c.tobytes()
    return _rebuilt((name, [("samples", (listed, axes, temperatures, rate_sd_ppm))]), {}, like, origin_ns)


def at_times(t_s: Array, own_s: Array, values: Array) -> Array:
    """Values of samples at these times, which are theirs and others; NaN at the others."""
    if len(t_s) == len(own_s):
        return values
    found = np.full((len(t_s), *values.shape[1:]), np.nan)
    found[np.searchsorted(t_s, own_s)] = values
    return found


def side_by_side(*sensors: Samples | None) -> tuple[Array, list[Array | None]]:
    """The times of sensors, and the values of each, with NaN where one lacks a sample. Sensors of different rates are refused."""
    given = [of for of in sensors if of is not None]
    t_s = np.unique(np.concatenate([of.t_s for of in given]))
    if len(t_s) > 1.1 * max(len(of.t_s) for of in given):
        raise experiment_error("the sensors have different times", "take `accelerometer` and `gyroscope`, or resample one")
    return t_s, [None if of is None else at_times(t_s, of.t_s, of.values) for of in sensors]

