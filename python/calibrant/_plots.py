"""Figures, as those of the report. Each takes axes or makes some, and returns them; none is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._exceptions import experiment_error

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._calibration import Calibration
    from ._compare import Comparison
    from ._design import Design
    from ._motion import Joints
    from ._noise import SensorNoise
    from ._pose_design import PoseDesign
    from ._sweep import Sweep

# those of the report
COLOURS = {"x": "#c0392b", "y": "#1e8449", "z": "#1f618d"}


def _axes(ax: Axes | None, width: float = 7.0, height: float = 4.0) -> Axes:
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise experiment_error("a figure needs matplotlib", "install it: pip install matplotlib") from None
    return plt.subplots(figsize=(width, height), layout="constrained")[1]


def _clean(ax: Axes) -> Axes:
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color="#dddddd", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def residuals(calibration: Calibration, ax: Axes | None) -> Axes:
    """Residuals in their standard deviations over time."""
    ax = _axes(ax)
    for of in calibration.residuals():
        used = of.weights > 0.0
        marker = "." if of.kind == "sample" else "o"
        label = of.sensor if of.axis is None else f"{of.sensor} {of.axis}"
        colour = COLOURS.get(of.axis or "", "#333333" if of.sensor == "accelerometer" else "#b9770e")
        scaled = of.residuals / of.sd
        alpha = 0.5 if of.kind == "sample" else 1.0
        ax.plot(of.t_s[used], scaled[used], marker, ms=3 if of.kind == "sample" else 5, color=colour, alpha=alpha, label=label)
        if not used.all():
            ax.plot(of.t_s[~used], scaled[~used], "x", ms=5, color=colour, label=f"{label}, not used")
    for level in (-2.0, 2.0):
        ax.axhline(level, color="#888888", linewidth=0.8, linestyle="--")
    ax.axhline(0.0, color="#888888", linewidth=0.8)
    ax.set_xlabel("time, s")
    ax.set_ylabel("residual / its standard deviation")
    ax.legend(loc="upper right", fontsize="small", frameon=False)
    return _clean(ax)


def parameters(calibration: Calibration, ax: Axes | None) -> Axes:
    """Deviation of each parameter from its nominal value, with two standard deviations."""
    known = [of for of in calibration.parameters if np.isfinite(of.sd)]
    ax = _axes(ax, height=1.0 + 0.28 * max(len(known), 1))
    places = np.arange(len(known))
    ax.barh(places, [1e6 * of.sd for of in known], color="#1f618d", height=0.6)
    ax.set_yticks(places, [f"{of.name}, {of.unit or '1'}" for of in known], fontsize="small")
    ax.invert_yaxis()
    ax.set_xscale("log")
    ax.set_xlabel("standard deviation, 10⁻⁶ of the unit")
    return _clean(ax)


def correlation(calibration: Calibration, ax: Axes | None) -> Axes:
    """Correlation of the parameters."""
    size = 2.0 + 0.28 * max(len(calibration), 1)
    ax = _axes(ax, size + 1.0, size)
    names = list(calibration)
    image = ax.imshow(calibration.correlation, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    ax.set_xticks(range(len(names)), names, rotation=90, fontsize="x-small")
    ax.set_yticks(range(len(names)), names, fontsize="x-small")
    ax.figure.colorbar(image, ax=ax, label="correlation", shrink=0.8)
    return ax


def motion(design: Design, ax: Axes | None) -> Axes:
    """Acceleration of a motion over time."""
    ax = _axes(ax)
    if design.motion is not None:
        for k, axis in enumerate("xyz"[: design.motion.axes]):
            ax.plot(design.motion.t_s, design.motion.acceleration_mps2[:, k], color=COLOURS[axis], label=axis)
        if design.motion.axes > 1:
            ax.legend(frameon=False)
    ax.set_xlabel("time, s")
    ax.set_ylabel("acceleration, m/s²")
    return _clean(ax)


def poses(design: PoseDesign, ax: Axes | None) -> Axes:
    """The directions that are up, as longitude and latitude."""
    ax = _axes(ax)
    x, y, z = design.directions.T
    longitude, latitude = np.degrees(np.arctan2(y, x)), np.degrees(np.arcsin(np.clip(z, -1.0, 1.0)))
    ax.plot(longitude, latitude, "o", color="#1f618d")
    for number, place in enumerate(zip(longitude, latitude), 1):
        ax.annotate(str(number), place, textcoords="offset points", xytext=(4, 4), fontsize="small")
    ax.set_xlim(-180, 180)
    ax.set_ylim(-95, 95)
    ax.set_xlabel("longitude about z of the direction that is up, °")
    ax.set_ylabel("latitude, °")
    return _clean(ax)


def joints(log: Joints, ax: Axes | None) -> Axes:
    """Positions of joints over time."""
    ax = _axes(ax)
    for name, positions in zip(log.names, log.positions.T):
        ax.plot(log.t_s, positions, label=name)
    ax.set_xlabel("time, s")
    ax.set_ylabel("position, rad or m")
    ax.legend(fontsize="small", frameon=False)
    return _clean(ax)


def sweep(swept: Sweep, ax: Axes | None) -> Axes:
    """Standard deviation of each parameter over the quantity that was swept."""
    ax = _axes(ax)
    for name, sds in zip(swept.parameters, swept.sd.T):
        ax.loglog(swept.values, sds, "o-", ms=4, label=name)
    ax.set_xlabel(f"{swept.quantity}, {swept.unit}" if swept.unit else swept.quantity)
    ax.set_ylabel("standard deviation, in the unit of each parameter")
    ax.legend(fontsize="small", frameon=False)
    return _clean(ax)


def allan(noise: SensorNoise, ax: Axes | None) -> Axes:
    """Allan deviation with its confidence interval."""
    ax = _axes(ax)
    for k, axis in enumerate(noise.axes):
        colour = COLOURS[axis]
        ax.loglog(noise.tau_s, noise.allan_deviation[:, k], color=colour, label=axis)
        ax.fill_between(noise.tau_s, noise.allan_low[:, k], noise.allan_high[:, k], color=colour, alpha=0.2, linewidth=0)
    ax.set_xlabel("averaging time τ, s")
    ax.set_ylabel(f"Allan deviation of the {noise.sensor}, {noise.unit}")
    ax.legend(frameon=False)
    return _clean(ax)


def differences(comparison: Comparison, ax: Axes | None) -> Axes:
    """Differences in their standard deviations."""
    rows = [row for row in comparison.data["quantities"] if row.get("difference_in_sd") is not None]
    ax = _axes(ax, height=1.0 + 0.28 * max(len(rows), 1))
    places = np.arange(len(rows))
    ax.axvspan(-2.0, 2.0, color="#eeeeee")
    ax.plot([row["difference_in_sd"] for row in rows], places, "o", color="#1f618d")
    ax.set_yticks(places, [row["name"] for row in rows], fontsize="small")
    ax.invert_yaxis()
    ax.set_xlabel("difference / its standard deviation")
    return _clean(ax)
