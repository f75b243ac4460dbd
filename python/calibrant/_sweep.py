"""Designs for several values of one quantity: what time, or a stronger machine, is worth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Array, as_list, thread_count
from ._calibrate import as_experiment
from ._choice import Known, choice, texts_of
from ._exceptions import experiment_error
from ._frames import frame, library_of
from ._page import Page
from ._progress import Progress, Told

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Sweep(Page):
    """The best motions or campaigns as one quantity changes. Where it was interrupted, it has the values that are finished.

    Attributes
    ----------
    quantity, unit : str
        What was changed, and its unit.
    values : (n,) array
        Its values, in `unit`. A duration is a whole number of intervals.
    parameters : tuple of str
        The names of the parameters; of a campaign of its quantities, such as ``"accelerometer.bias"``.
    sd : (n, p) array
        Standard deviation of each parameter with the best motion, in its unit; NaN where there is none. Of a campaign the root of its mean variance over the range.
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as in ``sweep.json``.
    """

    def __init__(self, quantity: str, page: _native.Page) -> None:
        super().__init__(page)
        self.quantity = quantity
        kind = self.data["kind"]
        self.unit = "min" if kind == "campaign-sweep" else str(self.data.get("unit", "s"))
        points = self.data["campaigns" if kind == "campaign-sweep" else "points"]
        key = {"sweep": "value", "campaign-sweep": "budget_min"}.get(kind, "duration_s")
        self.values: Array = np.array([of[key] for of in points], dtype=np.float64)
        if kind == "sweep":
            designs = [of.get("design") or {} for of in points]
            listed: list[Any] = next((of["parameters"] for of in designs if of), [])
            self.parameters = tuple(str(of["name"]) for of in listed)
            sds = [(of.get("optimal") or {}).get("sd") for of in designs]
        else:
            self.parameters = tuple(self.data["quantities" if kind == "campaign-sweep" else "parameters"])
            sds = [of["sd"] for of in points]
        none = [np.nan] * len(self.parameters)
        rows = [none if sd is None else [np.nan if of is None else of for of in sd] for sd in sds]
        self.sd: Array = np.array(rows, dtype=np.float64).reshape(len(points), len(self.parameters))

    def to_frame(self, like: Any = None) -> Any:
        """The standard deviations as a frame: the quantity, then a column ``…_sd`` for each parameter."""
        columns: dict[str, Any] = {self.quantity: self.values}
        columns.update({f"{name}_sd": self.sd[:, k] for k, name in enumerate(self.parameters)})
        return frame(columns, None if like is None else library_of(like))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the standard deviation of each parameter over the quantity; returns the axes."""
        from ._plots import sweep

        return sweep(self, ax)

    def __repr__(self) -> str:
        return f"Sweep({self.quantity}: {len(self.values)} values)"


def sweep(
    experiment: Any,
    quantity: str,
    values: npt.ArrayLike,
    *,
    known: Known = (),
    criterion: str | None = None,
    starts: int | None = None,
    seed: int | None = 1,
    certificate: bool = True,
    force: bool = False,
    threads: int | None = None,
    progress: Progress = False,
) -> Sweep:
    """Design the best motion, trajectory of a machine, or campaign over temperature, for each value of a quantity.

    Ctrl-C gives the values that are finished; of a campaign none.

    Parameters
    ----------
    experiment : Experiment, path or str
        An experiment with ``[motion]`` and ``[limits]``, with ``[machine]`` and joints, or with ``[campaign]``.
    quantity : str
        ``"duration"`` in s; of a motion also ``"acceleration"``, ``"jerk"``, ``"intercept"``, ``"velocity"``, ``"displacement"``, ``"rate"``
        or ``"noise"``, in SI. Of a campaign ``"budget"``, its time in min.
    values : (n,) array
        Its values, above 0; at most 1000.
    known, criterion, starts, seed, certificate, force, threads, progress
        As in :func:`design`. A campaign takes `known`, `threads` and `progress`.

    Returns
    -------
    Sweep

    Examples
    --------
    >>> import calibrant as cb
    >>> swept = cb.sweep("stage", "duration", [5, 10], starts=1, certificate=False)
    >>> bool(swept.sd[1, 1] < swept.sd[0, 1])
    True
    """
    made = as_experiment(experiment)
    listed = as_list("values", values).tolist()
    if made._is_campaign:
        if quantity != "budget":
            raise experiment_error(f"`quantity` is {quantity!r}", 'a campaign over temperature is swept over its time: "budget", in min')
        if criterion is not None or starts is not None or not certificate:
            raise experiment_error(
                "`criterion`, `starts` and `certificate` are not for a campaign over temperature",
                "leave them away; what a campaign minimises stands in [campaign]",
                code="experiment-unsuited",
            )
        with Told(progress) as told:
            page = _native.sweep_campaign(
                made._native, texts_of(known), listed, threads=thread_count(threads), progress=told
            )
        return Sweep(quantity, page)
    chosen = choice(
        known=known, criterion=criterion, starts=starts, seed=seed, certificate=certificate, force=force
    )
    with Told(progress) as told:
        return Sweep(quantity, _native.sweep(made._native, quantity, listed, chosen, threads=thread_count(threads), progress=told))
