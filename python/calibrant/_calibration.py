"""The result of a calibration: parameters with their covariance, and what judges them."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Iterator, Literal, Mapping, Sequence, overload

import numpy as np
import numpy.typing as npt

from . import _native, _sheet
from ._arrays import Array, Path, as_json, as_list, as_table, number, numbers, table
from ._diagnostic import Diagnostic, diagnostics
from ._exceptions import BadCalibration, CalibrantError, experiment_error
from ._frames import frame, library_of
from ._page import write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Verdict = Literal["ok", "doubtful", "bad"]
_FROM_BAD: tuple[str, ...] = ("bad", "doubtful", "ok")


@dataclass(frozen=True)
class Parameter:
    """A parameter of a calibration.

    Attributes
    ----------
    name : str
        ``"accelerometer.scale.x"``.
    value, sd : float
        Estimate and standard deviation, in `unit`. NaN where the calibration has none.
    unit : str
        Its unit; ``""`` for a ratio.
    nominal : float or None
        What the datasheet says, where it says something.
    prior_share : float or None
        Which part of the information came from what was known before, where that is reported.
    """

    name: str
    value: float
    sd: float
    unit: str
    nominal: float | None = None
    prior_share: float | None = None

    def __str__(self) -> str:
        unit = "" if self.unit in ("", "1") else f" {self.unit}"
        return f"{self.name} = {_sheet.with_sd(self.value, self.sd)}{unit}"


@dataclass(frozen=True)
class ResidualSeries:
    """Residuals of a sensor, of one axis where they have axes.

    Attributes
    ----------
    kind : str
        Of what each is: ``"sample"``, ``"hold"`` or ``"rotation"``.
    sensor, axis, unit : str
        Sensor, axis (``None`` for a magnitude or an angle), unit.
    t_s, residuals, sd, weights : (n,) array
        Times in s; residuals and their predicted standard deviations in `unit`; weights in the fit, 0 to 1.
    """

    kind: str
    sensor: str
    axis: str | None
    unit: str
    t_s: Array
    residuals: Array
    sd: Array
    weights: Array


@dataclass(frozen=True)
class Converted:
    """Files that :meth:`Calibration.convert` wrote.

    Attributes
    ----------
    paths : tuple of str
        The files.
    diagnostics : tuple of Diagnostic
        What was changed, and what the format cannot hold.
    """

    paths: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]


class Calibration:
    """A calibration, as ``calibration.json`` has it. Its direction is true → raw: ``y = S s + b``.

    It comes from :func:`calibrate` or :meth:`load`. Iteration gives the names of the parameters; ``calibration["accelerometer.scale.x"]`` gives one.

    Attributes
    ----------
    machine : tuple of Parameter
        What was estimated of a machine beside the sensor: lever arm, mounting, clocks, geometry. ``calibration["lever.x"]`` finds them, too.
    data : dict
        All of it, as in ``calibration.json``.
    """

    def __init__(self, text: str, outcome: _native.Outcome | None = None, *, like: Any = None) -> None:
        self._text, self._outcome, self._like = text, outcome, like
        self.data: dict[str, Any] = json.loads(text)
        self._parameters = tuple(
            Parameter(
                of["name"],
                number(of.get("value")),
                number(of.get("sd")),
                of.get("unit") or "",
                of.get("nominal"),
                of.get("prior_share"),
            )
            for of in self.data.get("parameters") or ()
        )
        self._by_name = {parameter.name: parameter for parameter in self._parameters}
        self.machine: tuple[Parameter, ...] = tuple(
            Parameter(of["name"], number(of.get("value")), number(of.get("sd")), of.get("unit") or "")
            for of in (self.data.get("machine") or {}).get("quantities") or ()
        )
        self._of_machine = {quantity.name: quantity for quantity in self.machine}
        self._notes = () if outcome is None else diagnostics(json.loads(outcome.notes()))
        self._correction: _native.Correction | None = None

    # parameters

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters, in the order of `values` and `covariance`."""
        return self._parameters

    @property
    def values(self) -> Array:
        """Estimates, (p,), each in the unit of its parameter."""
        return np.array([parameter.value for parameter in self._parameters])

    @property
    def sd(self) -> Array:
        """Standard deviations, (p,), each in the unit of its parameter."""
        return np.array([parameter.sd for parameter in self._parameters])

    @property
    def covariance(self) -> Array:
        """Covariance, (p, p): entry (i, j) in the unit of parameter i times that of parameter j."""
        return self._matrix("covariance")

    @property
    def correlation(self) -> Array:
        """Correlation, (p, p)."""
        if "correlation" in self.data:
            return self._matrix("correlation")
        covariance = self.covariance
        sd = np.sqrt(np.diag(covariance))
        correlation: Array = covariance / np.outer(sd, sd)
        return correlation

    @property
    def budget(self) -> dict[str, Array]:
        """Shares of the variance of each parameter, 0 to 1, by source: noise, gravity, drift, …. Empty for a commanded motion."""
        found = self.data.get("budget") or (self.data.get("machine") or {}).get("budget") or {}
        shares = np.array(found.get("shares", ()), dtype=np.float64)
        return {source: shares[:, k] for k, source in enumerate(found.get("sources", ()))}

    def _matrix(self, name: str) -> Array:
        rows, count = self.data.get(name), len(self._parameters)
        if rows is None:
            return np.full((count, count), np.nan)
        return np.array(rows, dtype=np.float64).reshape(count, count)

    def __getitem__(self, name: str) -> Parameter:
        found = self._by_name.get(name)
        return self._of_machine[name] if found is None else found

    def __iter__(self) -> Iterator[str]:
        return iter(self._by_name)

    def __len__(self) -> int:
        return len(self._parameters)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name or name in self._of_machine

    # what judges it

    @property
    def verdict(self) -> str:
        """``"ok"``, ``"doubtful"`` or ``"bad"``; ``"none"`` where another program made it."""
        return str((self.data.get("verdict") or {}).get("usability") or "none")

    @property
    def converged(self) -> bool:
        """Did the estimation converge?"""
        return self.data.get("status") in ("converged", None)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Warnings of the calibration, then what was noticed in the recording."""
        return diagnostics(self.data.get("warnings") or ()) + self._notes

    @property
    def holds(self) -> list[dict[str, Any]]:
        """The holds, each with its mean, its direction and its residual; empty where there are none."""
        return list((self.data.get("holds") or {}).get("table") or [])

    @property
    def rotations(self) -> list[dict[str, Any]]:
        """The rotations between holds, each with its error; empty where there are none."""
        found = self.data.get("rotations") or {}
        return list(found.get("table") or []) if isinstance(found, Mapping) else list(found)

    @property
    def sensor(self) -> str | None:
        """The sensor: its serial number, or what else names it."""
        return self.data.get("sensor")

    def raise_for_verdict(self, least: Verdict = "doubtful") -> Calibration:
        """Raise :exc:`BadCalibration` where the verdict is below `least`; otherwise return this."""
        if least not in _FROM_BAD:
            raise experiment_error(f"`least` is {least!r}", "give 'ok', 'doubtful' or 'bad'")
        verdict = self.verdict
        if verdict in _FROM_BAD and _FROM_BAD.index(verdict) < _FROM_BAD.index(least):
            codes = ", ".join((self.data.get("verdict") or {}).get("codes") or ())
            error = BadCalibration(f"the calibration is {verdict}: {codes}")
            error.remedy, error.calibration = "see `diagnostics`", self
            raise error
        return self

    # what people see

    def summary(self) -> str:
        """Verdict, parameters with standard deviations, fit and warnings, as text."""
        return _sheet.calibration_text(self)

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        return f"Calibration({len(self)} parameters, {self.verdict})"

    def _repr_html_(self) -> str:
        return _sheet.calibration_html(self)

    def to_frame(self, like: Any = None) -> Any:
        """The parameters as a frame: name, value, sd, unit, nominal. It is of the library of the frame that was calibrated, of that of `like`, or else pandas, polars or pyarrow."""
        like = self._like if like is None else library_of(like)
        return frame(
            {
                "name": [parameter.name for parameter in self._parameters],
                "value": self.values,
                "sd": self.sd,
                "unit": [parameter.unit for parameter in self._parameters],
                "nominal": np.array([number(parameter.nominal) for parameter in self._parameters]),
            },
            like,
        )

    def report(self, path: Path) -> Calibration:
        """Write the report as one HTML file, the same as the command line's; returns this.

        Raises
        ------
        CalibrantError
            Where the calibration was loaded: a report needs the recording.
        """
        html = self._found("a report").html()
        write(path, html)
        return self

    def text(self, width: int = 100) -> str:
        """The sheet that the command line prints."""
        return self._found("the sheet").text(width)

    def residuals(self) -> tuple[ResidualSeries, ...]:
        """The residuals, one series for each sensor and axis."""
        found = self._found("residuals").residuals()
        return tuple(ResidualSeries(*kind, *(numbers(of) for of in arrays)) for kind, arrays in found)

    def _found(self, what: str) -> _native.Outcome:
        if self._outcome is None:
            error = CalibrantError(f"{what} needs the recording, and this calibration was loaded (calibrate again)")
            error.code, error.remedy = "recording-missing", "calibrate again"
            raise error
        return self._outcome

    def plot_residuals(self, ax: Axes | None = None) -> Axes:
        """Draw the residuals over time; returns the axes."""
        from ._plots import residuals

        return residuals(self, ax)

    def plot_parameters(self, ax: Axes | None = None) -> Axes:
        """Draw each parameter with its standard deviation; returns the axes."""
        from ._plots import parameters

        return parameters(self, ax)

    def plot_correlation(self, ax: Axes | None = None) -> Axes:
        """Draw the correlation of the parameters; returns the axes."""
        from ._plots import correlation

        return correlation(self, ax)

    def plot_temperature(self, ax: Axes | None = None, *, sensor: Literal["accelerometer", "gyroscope"] = "accelerometer") -> Axes:
        """Draw the bias of each axis of a sensor over temperature, with two standard deviations; returns the axes."""
        from ._plots import temperature

        return temperature(self, sensor, ax)

    # its use

    def _corrects(self) -> _native.Correction:
        if self._correction is None:
            self._correction = _native.Correction(self._text)
        return self._correction

    @overload
    def correct(
        self, accelerometer: npt.ArrayLike, gyroscope: None = None, *, temperature_c: npt.ArrayLike | None = None
    ) -> Array: ...

    @overload
    def correct(
        self, accelerometer: None, gyroscope: npt.ArrayLike, *, temperature_c: npt.ArrayLike | None = None
    ) -> Array: ...

    @overload
    def correct(
        self,
        accelerometer: npt.ArrayLike,
        gyroscope: npt.ArrayLike,
        *,
        temperature_c: npt.ArrayLike | None = None,
    ) -> tuple[Array, Array]: ...

    def correct(
        self,
        accelerometer: npt.ArrayLike | None = None,
        gyroscope: npt.ArrayLike | None = None,
        *,
        temperature_c: npt.ArrayLike | None = None,
    ) -> Array | tuple[Array, Array]:
        """Correct samples: raw → true.

        Parameters
        ----------
        accelerometer : (n, 3) array, optional
            Readings in m/s², or in counts where the calibration is of counts.
        gyroscope : (n, 3) array, optional
            Readings in rad/s or counts, at the same times.
        temperature_c : float or (n,) array, optional
            Temperature, °C, where the calibration follows it.

        Returns
        -------
        array or pair of arrays, (n, 3)
            Specific force in m/s², angular rate in rad/s.

        Raises
        ------
        ExperimentError, RecordingError
            Where the calibration is not of the sensor, or shapes differ.
        """
        force, rate, _, _ = self._correct(accelerometer, gyroscope, temperature_c, False)
        if force is None or rate is None:
            alone = force if force is not None else rate
            assert alone is not None
            return alone
        return force, rate

    def _correct(
        self,
        accelerometer: npt.ArrayLike | None,
        gyroscope: npt.ArrayLike | None,
        temperature_c: npt.ArrayLike | None,
        with_sd: bool,
    ) -> list[Array | None]:
        if accelerometer is None and gyroscope is None:
            raise experiment_error("there is nothing to correct", "give `accelerometer`, `gyroscope` or both")
        correction = self._corrects()
        tables = []
        for name, given in (("accelerometer", accelerometer), ("gyroscope", gyroscope)):
            if given is not None and correction.unit(name) is None:
                raise experiment_error(f"the calibration has no {name}", "leave it away", code="sensor-missing")
            tables.append(None if given is None else as_table(name, given).tobytes())
        temperatures = None
        if temperature_c is not None:
            temperatures = as_list("temperature_c", np.atleast_1d(temperature_c)).tobytes()
        corrected = correction.apply(tables[0], tables[1], temperatures, with_sd)
        return [None if of is None else table(of) for of in corrected]

    def apply(self, data: Any, *, sd: bool = False, **reading: Any) -> Any:
        """Correct a recording: a frame, a path, or what :func:`read_recording` gave.

        Parameters
        ----------
        data : frame, path, bytes or Recording
            The recording.
        sd : bool
            Add the standard uncertainty of the correction: columns ``ax_sd_mps2`` and so on.
        **reading
            What the file does not state: arguments of :func:`read_recording`.

        Returns
        -------
        frame
            ``t_s``, ``ax_mps2`` …, ``gx_radps`` …, of the library that came in.
        """
        from ._recording import Recording, at_times, read_recording, side_by_side

        if isinstance(data, Recording):
            read = read_recording(data, **reading)
        else:
            in_counts = [of for of in ("accelerometer", "gyroscope") if self._corrects().unit(of) == "counts"]
            read = read_recording(data, **{**{f"{of}_unit": "counts" for of in in_counts}, **reading})
        like = read._like
        accelerometer, gyroscope = read.accelerometer, read.gyroscope
        t_s, values = side_by_side(accelerometer, gyroscope)
        given: list[Array | None] = []
        for name, samples, table_of in zip(("accelerometer", "gyroscope"), (accelerometer, gyroscope), values):
            unit = self._corrects().unit(name)
            given.append(None if unit is None else table_of)
            if samples is not None and unit is not None and samples.unit != unit:
                message = f"the readings of the {name} are in {samples.unit}, the calibration is of readings in {unit}"
                raise experiment_error(message, "give readings in that unit", code="calibration-unsuited")
        temperature, first = read.temperature_c, accelerometer or gyroscope
        if temperature is not None and first is not None:
            temperature = at_times(t_s, first.t_s, temperature)
        corrected = self._correct(given[0], given[1], temperature, sd)
        columns: dict[str, Any] = {"t_s": t_s}
        for number, ending in enumerate(("mps2", "radps", "mps2", "radps")):
            found, letter = corrected[number], "ag"[number % 2]
            if found is not None:
                middle = "sd_" if number > 1 else ""
                columns.update({f"{letter}{axis}_{middle}{ending}": found[:, k] for k, axis in enumerate("xyz")})
        return frame(columns, like)

    # files

    def to_json(self) -> str:
        """The text of ``calibration.json``."""
        return self._text

    def save(self, path: Path) -> None:
        """Write ``calibration.json``."""
        write(path, self._text)

    @classmethod
    def load(
        cls,
        path: Path,
        *,
        format: Literal["calibrant", "kalibr", "imu_tk", "imucal", "c", "openvins"] | None = None,
        unit: Literal["si", "counts"] | None = None,
        sensor: Literal["accelerometer", "gyroscope"] | None = None,
    ) -> Calibration:
        """Read a calibration: ours, or one of Kalibr, OpenVINS, imu_tk or imucal.

        Parameters
        ----------
        path : path
            The file.
        format : str, optional
            Its format, where the content does not show it.
        unit : {"si", "counts"}, optional
            Unit of the readings, where the file does not say.
        sensor : str, optional
            The sensor, for files of one sensor that do not name it.
        """
        options = {"format": format, "unit": unit, "sensor": sensor}
        text, findings = _native.read_calibration(os.fspath(path), as_json(options))
        try:
            with open(path, encoding="utf-8") as file:
                own = file.read()
            data = json.loads(own)
            if isinstance(data, dict) and data.get("kind") in ("calibration", "campaign-calibration", "machine"):
                text = own
        except (OSError, ValueError):
            pass
        try:
            found = cls(text)
            _ = (found.verdict, found.converged, found.diagnostics, found.holds, found.rotations)
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            message = f"{os.fspath(path)}: it was changed, or is damaged ({type(error).__name__}: {error})"
            raise experiment_error(message, "copy or write it again", code="file-damaged") from None
        found._notes = diagnostics(json.loads(findings))
        return found

    def convert(
        self,
        path: Path,
        format: Literal[
            "calibrant",
            "kalibr",
            "imu_tk",
            "imucal",
            "c",
            "openvins",
            "basalt",
            "px4",
            "ardupilot",
            "imufusion",
            "librealsense",
            "imu_calib",
        ]
        | None = None,
        *,
        gauge: Literal["lower", "upper", "symmetric"] | None = None,
        sensor: Literal["accelerometer", "gyroscope"] | None = None,
        after: Path | None = None,
        noise: Sequence[Path] = (),
        drop: Sequence[Literal["cross-axis", "gyroscope-matrix", "gain-temperature", "g-sensitivity"]] = (),
        drop_g_sensitivity: bool = False,
        temperature_c: float | None = None,
        rostopic: str | None = None,
        update_rate: float | None = None,
        into: bool = False,
    ) -> Converted:
        """Write it in the format of another program.

        Parameters
        ----------
        path : path
            Where to write it. imu_tk has a file for each sensor: ``NAME.calib`` stands for ``NAME_acc.calib`` and ``NAME_gyro.calib``.
        format : str, optional
            The format; as the ending of the path says by default.
        gauge : str, optional
            Turn the true frame of both sensors into this gauge of the accelerometer.
        sensor : str, optional
            Write one sensor alone.
        after : path, optional
            The calibration that had corrected the readings of this one. What is written then corrects raw readings, in one step.
        noise : list of paths
            Noise densities: files ``noise.json``, or ``imu.yaml`` of Kalibr.
        drop : list of str
            Parts that are left out, because the format has no place for them. This changes the correction; the notes have the largest error.
        drop_g_sensitivity : bool
            The same as ``drop=["g-sensitivity"]``.
        temperature_c : float, optional
            Evaluate biases and gains at this temperature, °C, and leave out the terms of temperature.
        rostopic : str, optional
            The ROS topic of the IMU, for Kalibr and OpenVINS.
        update_rate : float, optional
            Rate of the readings, Hz, for Kalibr, OpenVINS and basalt; that of the noise or of the recording by default.
        into : bool
            ``path`` is a calibration of basalt that gets this IMU. Everything else in it stays.

        Returns
        -------
        Converted
            The paths of the files, and what the format cannot hold.

        Raises
        ------
        ExperimentError
            Where the format cannot hold the correction.
        """
        changes = {
            "format": format,
            "gauge": gauge,
            "sensor": sensor,
            "after": None if after is None else os.fspath(after),
            "noise": [os.fspath(of) for of in noise],
            "drop": [*drop, *(["g-sensitivity"] if drop_g_sensitivity else [])],
            "temperature_c": temperature_c,
            "rostopic": rostopic,
            "update_rate": update_rate,
            "into": into,
        }
        paths, notes = _native.convert_calibration(self._text, os.fspath(path), as_json(changes))
        return Converted(tuple(os.fspath(written) for written in paths), diagnostics(json.loads(notes)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Calibration) and self._text == other._text

    def __hash__(self) -> int:
        return hash(self._text)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_again, (self._text, self._notes, self._like))


def _again(text: str, notes: tuple[Diagnostic, ...], like: Any) -> Calibration:
    found = Calibration(text, like=like)
    found._notes = notes
    return found
