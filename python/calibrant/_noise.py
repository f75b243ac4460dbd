"""The noise of a sensor at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Sequence

import numpy as np

from . import _native
from ._arrays import Array, Path, as_json, as_list, number, thread_count
from ._exceptions import experiment_error
from ._frames import frame, library_of
from ._page import Page, write
from ._recording import Recording, as_source

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class SensorNoise:
    """The noise of one sensor, as ``noise.json`` has it. What was not determined is NaN.

    Attributes
    ----------
    sensor, unit : str
        Sensor, and unit of its readings.
    tau_s : (k,) array
        Averaging times, s.
    allan_deviation, allan_low, allan_high : (k, m) array
        Allan deviation of each axis, with the bounds of its confidence interval, in `unit`; (k, m) with an axis in each column.
    random_walk, bias_instability, rate_random_walk : (m,) array
        N, B and K of each axis, in the units of ``noise.json``.
    white : (m,) array
        The same as `random_walk`: the noise density N, as Kalibr takes it.
    axes : tuple of str
        The axes that were examined.
    """

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data
        self.sensor, self.unit = str(data["sensor"]), str(data["reading_unit"])
        rows = data.get("axes") or []
        self.axes = tuple(str(of["axis"]) for of in rows)
        tables = [of.get("allan") or {} for of in rows]
        self.tau_s: Array = np.array(tables[0].get("tau_s") or []) if tables else np.zeros(0)
        self.allan_deviation = _side_by_side(tables, "deviation")
        self.allan_low = _side_by_side(tables, "low")
        self.allan_high = _side_by_side(tables, "high")
        self.random_walk = _coefficients(rows, "random_walk")
        self.bias_instability = _coefficients(rows, "bias_instability")
        self.rate_random_walk = _coefficients(rows, "rate_random_walk")
        self.white = self.random_walk

    def __repr__(self) -> str:
        return f"SensorNoise({self.sensor}, N {self.white})"


class Noise(Page):
    """The noise of the sensors of a recording at rest.

    Attributes
    ----------
    sensors : tuple of SensorNoise
        Each sensor whose noise was determined.
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as in ``noise.json``.
    """

    def __init__(self, page: _native.Page) -> None:
        super().__init__(page)
        listed = self.data.get("sensors") or []
        self.sensors = tuple(SensorNoise(of) for of in listed)

    def __getitem__(self, sensor: str) -> SensorNoise:
        for of in self.sensors:
            if of.sensor == sensor:
                return of
        raise KeyError(sensor)

    @property
    def _first(self) -> SensorNoise:
        return self.sensors[0]

    @property
    def tau_s(self) -> Array:
        """Averaging times of the first sensor, s."""
        return self._first.tau_s

    @property
    def allan_deviation(self) -> Array:
        """Allan deviation of the first sensor, (k, m): an axis in each column."""
        return self._first.allan_deviation

    @property
    def white(self) -> Array:
        """Noise density of each axis of the first sensor."""
        return self._first.white

    @property
    def bias_instability(self) -> Array:
        """Bias instability of each axis of the first sensor."""
        return self._first.bias_instability

    @property
    def random_walk(self) -> Array:
        """Noise density N of each axis of the first sensor: the angle or velocity random walk."""
        return self._first.random_walk

    @property
    def rate_random_walk(self) -> Array:
        """Rate random walk K of each axis of the first sensor."""
        return self._first.rate_random_walk

    def to_frame(self, like: Any = None) -> Any:
        """The coefficients as a frame: sensor, axis, random_walk (N), bias_instability (B), rate_random_walk (K)."""
        columns: dict[str, list[Any]] = {
            name: [] for name in ("sensor", "axis", "random_walk", "bias_instability", "rate_random_walk")
        }
        for of in self.sensors:
            for k, axis in enumerate(of.axes):
                row = (of.sensor, axis, of.random_walk[k], of.bias_instability[k], of.rate_random_walk[k])
                for name, value in zip(columns, row):
                    columns[name].append(value)
        return frame(columns, None if like is None else library_of(like))

    def save(self, path: Path) -> None:
        """Write ``noise.json``."""
        write(path, self._json)

    def plot(self, ax: Axes | None = None, sensor: str | None = None) -> Axes:
        """Draw the Allan deviation of a sensor, of the first by default; returns the axes."""
        from ._plots import allan

        return allan(self._first if sensor is None else self[sensor], ax)

    def __repr__(self) -> str:
        return f"Noise({', '.join(of.sensor for of in self.sensors)})"


def noise(
    recording: Any,
    *,
    sensor: str | None = None,
    hold_s: tuple[float, float] | None = None,
    gain: float | Sequence[float] | None = None,
    gyroscope_gain: float | Sequence[float] | None = None,
    threads: int | None = None,
) -> Noise:
    """Estimate the noise of a sensor at rest: Allan deviation, noise density, bias instability, random walk.

    Parameters
    ----------
    recording : path, bytes, frame or Recording
        A recording with a long hold.
    sensor : {"accelerometer", "gyroscope"}, optional
        One sensor; all that were recorded by default.
    hold_s : (float, float), optional
        Start and end of the interval at rest, s; the longest hold by default.
    gain : float or (3,) array, optional
        Nominal gain of the accelerometer, or of `sensor`: counts per m/s² or rad/s. The noise of counts is then stated in SI, too.
    gyroscope_gain : float or (3,) array, optional
        Nominal gain of the gyroscope, beside that of the accelerometer.
    threads : int, optional
        Number of threads; all cores by default.

    Returns
    -------
    Noise

    Raises
    ------
    RecordingError
        Where there is no hold of a second, or no noise is determined.
    """
    if sensor not in (None, "accelerometer", "gyroscope"):
        raise experiment_error(f"`sensor` is {sensor!r}", "give 'accelerometer' or 'gyroscope'")
    hold = None if hold_s is None else as_list("hold_s", hold_s).tolist()
    if hold is not None and len(hold) != 2:
        raise experiment_error(f"`hold_s` is {hold_s!r}", "give start and end, s")
    source, reading = as_source(recording)
    return Noise(
        _native.noise(
            source,
            as_json(reading),
            read=recording._read if isinstance(recording, Recording) else None,
            sensor=sensor,
            hold_s=None if hold is None else (hold[0], hold[1]),
            gain=_gain("gain", gain),
            gyroscope_gain=_gain("gyroscope_gain", gyroscope_gain),
            threads=thread_count(threads),
        )
    )


def _gain(name: str, given: float | Sequence[float] | None) -> list[float] | None:
    if given is None:
        return None
    gain: list[float] = as_list(name, np.atleast_1d(given)).tolist()
    return gain


def _side_by_side(tables: list[Any], name: str) -> Array:
    columns = [[number(value) for value in table.get(name) or []] for table in tables]
    return np.array(columns).T if columns else np.zeros((0, 0))


def _coefficients(rows: list[Any], name: str) -> Array:
    return np.array([number((of.get(name) or {}).get("value")) for of in rows])
