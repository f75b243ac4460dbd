"""Two calibrations side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._arrays import number
from ._calibration import Calibration
from ._exceptions import experiment_error
from ._frames import frame, library_of
from ._page import Page

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Comparison(Page):
    """Two calibrations of a sensor, b less a, by quantities that do not depend on the true frame.

    Attributes
    ----------
    chi2 : float
        Overall difference, squared, in units of its covariance; NaN where a covariance is missing.
    degrees_of_freedom : int
        Of `chi2`.
    p_value : float
        Probability of a larger `chi2` where nothing changed.
    diagnostics : tuple of Diagnostic
        What was noticed.
    data : dict
        All of it, as ``calibrant compare --json`` writes it.
    """

    def __init__(self, page: _native.Page, like: Any = None) -> None:
        super().__init__(page)
        self._like = like
        overall = self.data.get("overall") or {}
        self.chi2 = number(overall.get("chi2"))
        self.degrees_of_freedom = int(overall.get("degrees_of_freedom") or 0)
        self.p_value = number(overall.get("p_value"))

    def to_frame(self, like: Any = None) -> Any:
        """The quantities as a frame: name, unit, a, a_sd, b, b_sd, difference, difference_sd, difference_in_sd, p_value."""
        rows = self.data["quantities"]
        numbers = ("a", "a_sd", "b", "b_sd", "difference", "difference_sd", "difference_in_sd", "p_value")
        columns: dict[str, Any] = {name: [row[name] for row in rows] for name in ("name", "unit")}
        columns.update({name: np.array([number(row.get(name)) for row in rows]) for name in numbers})
        return frame(columns, self._like if like is None else library_of(like))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw each difference in its standard deviations; returns the axes."""
        from ._plots import differences

        return differences(self, ax)

    def __repr__(self) -> str:
        return f"Comparison(χ² {self.chi2:.4g} for {self.degrees_of_freedom}, p {self.p_value:.3g})"


def compare(a: Calibration, b: Calibration, *, names: tuple[str, str] = ("a", "b")) -> Comparison:
    """Compare two calibrations of a sensor, whatever their conventions.

    Parameters
    ----------
    a, b : Calibration
        The calibrations.
    names : (str, str)
        What the sheet calls them.

    Returns
    -------
    Comparison

    Raises
    ------
    ExperimentError
        Where they have no sensor in common.
    """
    for given in (a, b):
        if not isinstance(given, Calibration):
            raise experiment_error(f"{type(given).__name__} is no calibration", "give calibrations: `Calibration.load(path)`")
    return Comparison(_native.compare((a.to_json(), names[0]), (b.to_json(), names[1])), a._like)
