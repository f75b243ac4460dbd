"""Campaigns over temperature: the best soaks, and simulated ones."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Iterable, Literal, Mapping, Union

from . import _native
from ._arrays import Path, as_json, thread_count, whole
from ._calibrate import experiment_of_kind
from ._choice import Known, texts_of
from ._exceptions import experiment_error
from ._experiment import Experiment
from ._frames import frame, library_of
from ._page import Page, make_directory
from ._recording import Recording
from ._simulate import Truth, recording_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Soak:
    """A soak of a campaign: a temperature at which the sensor is calibrated.

    Attributes
    ----------
    temperature_c : float
        Temperature of the chamber, °C.
    direction : {"up", "down"}
        Reached from below, or from above.
    wait_min : float
        From the end of the ramp to the first hold, min.
    blocks : int
        Number of blocks of holds.
    begin_min, end_min : float
        When the chamber has reached the temperature, and when the last hold ends, min after the start.
    """

    temperature_c: float
    direction: Literal["up", "down"]
    wait_min: float
    blocks: int
    begin_min: float = float("nan")
    end_min: float = float("nan")


AnySoak = Union[Soak, Mapping[str, Any]]


class CampaignDesign(Page):
    """The best campaign over temperature that was found.

    Attributes
    ----------
    soaks : tuple of Soak
        The soaks in their order.
    value : float
        The criterion: what is minimised.
    bound : float
        No campaign of soaks on the grid of temperatures in this time has a lower value.
    gap : float
        How far the value is above the bound: a share of it; for the criterion D a difference.
    sd : dict of float
        Standard deviation of each quantity, root of its mean variance over the range, in the unit that `data` states: ``sd["accelerometer.bias"]``.
    data : dict
        All of it, as in ``design.json``.
    """

    def __init__(self, page: _native.Page, ramp_k_per_min: float) -> None:
        super().__init__(page)
        self._ramp_k_per_min = ramp_k_per_min
        certificate = self.data["certificate"]
        self.value: float = self.data["value"]
        self.bound: float = certificate["lower_bound"]
        self.gap: float = certificate["gap"]
        self.soaks: tuple[Soak, ...] = tuple(Soak(**soak) for soak in self.data["soaks"])
        self.sd: dict[str, float] = {of["name"]: of["sd"] for of in self.data["channels"]}

    def to_frame(self, like: Any = None) -> Any:
        """The timetable as a frame: soak, temperature_c, direction, wait_min, blocks, begin_min, end_min."""
        columns: dict[str, Any] = {"soak": list(range(1, len(self.soaks) + 1))}
        for name in Soak.__dataclass_fields__:
            columns[name] = [getattr(soak, name) for soak in self.soaks]
        return frame(columns, None if like is None else library_of(like))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the temperature of the chamber over time, with the soaks in it; returns the axes."""
        from ._plots import chamber

        return chamber(self, self._ramp_k_per_min, ax)

    def __repr__(self) -> str:
        return f"CampaignDesign({len(self.soaks)} soaks, gap {self.gap:.2g})"


def design_campaign(
    experiment: Any,
    *,
    known: Known = (),
    add_min: float | None = None,
    threads: int | None = None,
) -> CampaignDesign:
    """Find the soaks that determine biases and gains best over temperature: which temperatures, from which side, how long to wait, how many holds.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[campaign]``.
    known : Calibration or list of Calibration
        Earlier calibrations over temperature: the soaks are added to theirs, and the scatter that they found counts.
    add_min : float, optional
        Time of the campaign, min, in place of ``budget_min`` of the experiment: with `known` the time that is added.
    threads : int, optional
        Number of threads; all cores by default.

    Returns
    -------
    CampaignDesign

    Raises
    ------
    ExperimentError
        Where there is no ``[campaign]``.
    Infeasible
        Where there is no time for a soak.

    Examples
    --------
    >>> import calibrant as cb
    >>> small = cb.Experiment.preset("campaign", campaign={"range_c": [0.0, 40.0], "budget_min": 110.0})
    >>> best = cb.design_campaign(small)
    >>> best.soaks[-1].end_min < 110.0 and best.bound <= best.value
    True
    """
    made = experiment_of_kind(experiment, "campaign")
    added = None if add_min is None else float(add_min)
    page = _native.design_campaign(made._native, texts_of(known), add_min=added, threads=thread_count(threads))
    return CampaignDesign(page, float(made["campaign"]["ramp_k_per_min"]))


class SimulatedCampaign:
    """The recordings of a simulated campaign, with the truth behind them.

    Attributes
    ----------
    recordings : list of Recording
        The recording of each soak, in their order: what :func:`calibrate` takes.
    truth : Truth
        The true parameters: the mean of both branches.
    seed : int
        The seed of the sensor.
    """

    def __init__(self, made: _native.CampaignSimulation, asked: dict[str, Any]) -> None:
        self._made, self._asked = made, asked
        about = json.loads(made.about())
        self.truth = Truth(json.loads(made.truth()))
        self.seed: int = about["seed"]
        self.recordings: list[Recording] = [self._recording(number, name) for number, name in enumerate(about["names"])]

    def _recording(self, number: int, name: str) -> Recording:
        samples = partial(self._made.samples, number)
        return recording_of(name, samples, self._made.temperature_c(number), 3)

    def save(self, directory: Path) -> None:
        """Write the files of ``calibrant simulate``: ``soak_01.csv`` and so on, and ``truth.json``."""
        make_directory(directory)
        self._made.write(os.fspath(directory))

    def __reduce__(self) -> tuple[Any, ...]:
        # the same arguments give the same bits
        return (_simulated, (self._asked,))

    def __repr__(self) -> str:
        return f"SimulatedCampaign({len(self.recordings)} soaks, seed {self.seed})"


def simulate_campaign(
    experiment: Any, *, soaks: CampaignDesign | Iterable[AnySoak] | None = None, seed: int | None = None
) -> SimulatedCampaign:
    """Draw a sensor from what an experiment says of its type, and simulate a recording of each soak.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[campaign]``.
    soaks : CampaignDesign or list of Soak, optional
        The soaks; dicts with ``temperature_c``, ``direction``, ``wait_min`` and ``blocks`` do, too. Those of :func:`design_campaign` by default.
    seed : int, optional
        Seed of all random numbers; that of the experiment by default.

    Returns
    -------
    SimulatedCampaign

    Examples
    --------
    >>> import calibrant as cb
    >>> soaks = [cb.Soak(60.0, "up", 10.0, 1), cb.Soak(-20.0, "down", 10.0, 1)]
    >>> cb.simulate_campaign("campaign", soaks=soaks, seed=2)
    SimulatedCampaign(2 soaks, seed 2)
    """
    made = experiment_of_kind(experiment, "campaign")
    if soaks is None:
        soaks = design_campaign(made)
    listed = soaks.soaks if isinstance(soaks, CampaignDesign) else soaks
    rows = [_row(soak) for soak in listed]
    if not rows:
        raise experiment_error("`soaks` is empty", "give the soaks of a design, or leave it away")
    return _simulated({"experiment": made, "soaks": as_json(rows), "seed": whole("seed", seed, 0)})


def _row(soak: AnySoak) -> dict[str, Any]:
    if not isinstance(soak, (Soak, Mapping)):
        raise experiment_error(f"`soaks` has {type(soak).__name__}", "give the soaks of a design, or dicts like them")
    row = asdict(soak) if isinstance(soak, Soak) else dict(soak)
    return {name: value for name, value in row.items() if name not in ("begin_min", "end_min")}


def _simulated(asked: dict[str, Any]) -> SimulatedCampaign:
    experiment: Experiment = asked["experiment"]
    return SimulatedCampaign(_native.simulate_campaign(experiment._native, asked["soaks"], seed=asked["seed"]), asked)
