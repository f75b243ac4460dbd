"""Figures, as those of the report. Each takes axes or makes some, and returns them; none is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._exceptions import experiment_error
from ._sheet import with_sd

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._calibration import Calibration
    from ._campaign import CampaignDesign
    from ._compare import Comparison
    from ._design import Design
    from ._motion import Joints
    from ._noise import SensorNoise
    from ._pose_design import PoseDesign
    from ._sweep import Sweep

# the report's: Okabe and Ito's, which differ for readers with all common kinds of colour vision
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILLION, PURPLE, GREY = (
    "#000000 #e69f00 #56b4e9 #009e73 #0072b2 #d55e00 #cc79a7 #6e7781".split()
)
AXES = {"x": VERMILLION, "y": GREEN, "z": BLUE}
AXES_OF_GYROSCOPE = {"x": ORANGE, "y": PURPLE, "z": SKY}
LINES = (BLACK, ORANGE, BLUE, SKY, VERMILLION, GREEN, PURPLE, GREY)


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
    ax.grid(True, color="#e3e7eb", linewidth=0.6)
    ax.set_axisbelow(True)
    return ax


def _legend(ax: Axes, columns: int = 1) -> None:
    """A legend that stays readable over what is drawn."""
    ax.legend(loc="upper right", fontsize="small", ncols=columns, framealpha=0.9, edgecolor="none")


def _by_line(ax: Axes, names: list[str]) -> Axes:
    """A line for each name, from above."""
    ax.set_yticks(range(len(names)), names, fontsize="small")
    ax.set_ylim(len(names) - 0.4, -0.6)
    return _clean(ax)


def _height(lines: int) -> float:
    return 1.0 + 0.2 * max(lines, 1)


def residuals(calibration: Calibration, ax: Axes | None) -> Axes:
    """Residuals in their standard deviations over time."""
    ax, farthest = _axes(ax), 3.5
    for of in calibration.residuals():
        used, scaled = of.weights > 0.0, of.residuals / of.sd
        colours = AXES if of.sensor == "accelerometer" else AXES_OF_GYROSCOPE
        colour, label = colours[of.axis or "z"], f"{of.sensor} {of.axis}"
        marker, size = "o", 1.0
        if of.kind != "sample":
            colour, label = (BLUE, "holds") if of.kind == "hold" else (VERMILLION, "rotations")
            marker, size = "o" if of.kind == "hold" else "^", 5.0
        ax.plot(of.t_s[used], scaled[used], marker, ms=size, color=colour)
        ax.plot([], [], marker, ms=max(size, 5.0), color=colour, label=label)
        if not used.all():
            ax.plot(of.t_s[~used], scaled[~used], "x", ms=5, color=colour, label=f"{label}, not used")
        farthest = max(farthest, 1.1 * float(np.nanmax(np.abs(scaled), initial=0.0)))
    for level in (-2.0, 0.0, 2.0):
        ax.axhline(level, color=GREY, linewidth=0.8, linestyle="--" if level else "-", zorder=1)
    # the legend has its place above the points
    lines = -(-len(ax.get_legend_handles_labels()[1]) // 2)
    ax.set_ylim(-farthest, (1.0 + 0.13 * lines) * farthest)
    ax.set_xlabel("time (s)")
    ax.set_ylabel("residual / its standard deviation")
    _legend(ax, columns=2)
    return _clean(ax)


def parameters(calibration: Calibration, ax: Axes | None) -> Axes:
    """Standard deviation of each parameter, in its unit; its value stands beside the point."""
    known = [of for of in calibration.parameters if np.isfinite(of.sd) and of.sd > 0.0]
    if not known:
        raise experiment_error("the calibration states no standard deviations", "there is nothing to draw")
    ax = _axes(ax, height=_height(len(known)))
    units = list(dict.fromkeys(of.unit for of in known))
    for unit, colour in zip(units, (BLUE, ORANGE, GREEN, PURPLE, SKY, GREY)):
        places = [k for k, of in enumerate(known) if of.unit == unit]
        ax.plot([known[k].sd for k in places], places, "o", ms=5, color=colour, label=unit or "1")
    ax.set_xscale("log")
    # room for the values, to the right of their points
    least, most = ax.get_xlim()
    ax.set_xlim(least, most * (most / least) ** 0.6)
    for k, of in enumerate(known):
        text = with_sd(of.value, of.sd)
        ax.annotate(text, (of.sd, k), textcoords="offset points", xytext=(7, 0), va="center", fontsize="small")
    ax.set_xlabel("standard deviation, in the unit of the parameter")
    ax.legend(title="unit", loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small", frameon=False)
    return _by_line(ax, [of.name for of in known])


def correlation(calibration: Calibration, ax: Axes | None) -> Axes:
    """Correlation of the parameters."""
    names = list(calibration)
    size = 2.0 + 0.19 * len(names)
    ax = _axes(ax, size + 0.8, size)
    image = ax.imshow(calibration.correlation, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    ax.set_xticks(range(len(names)), names, rotation=90, fontsize="x-small")
    ax.set_yticks(range(len(names)), names, fontsize="x-small")
    ax.figure.colorbar(image, ax=ax, label="correlation", shrink=0.8)
    return ax


def temperature(calibration: Calibration, sensor: str, ax: Axes | None) -> Axes:
    """Bias of each axis over temperature, with a band of two standard deviations."""
    powers = ("bias", "bias_per_k", *(f"bias_per_k{order}" for order in range(2, 6)))
    names, thermal = list(calibration), calibration.data.get("temperature") or {}
    reference_c = float(thermal.get("reference_c", 0.0))
    low, high = thermal.get("range_c") or (reference_c - 25.0, reference_c + 25.0)
    celsius = np.linspace(low, high, 201)
    of_axis = {
        axis: {order: names.index(f"{sensor}.{part}.{axis}") for order, part in enumerate(powers) if f"{sensor}.{part}.{axis}" in names}
        for axis in "xyz"
    }
    if not any(order > 0 for places in of_axis.values() for order in places):
        message = f"no bias of the {sensor} follows temperature in this calibration"
        raise experiment_error(message, "set its order in [temperature], or draw the other `sensor`", code="calibration-unsuited")
    ax, (values, covariance) = _axes(ax), (calibration.values, calibration.covariance)
    is_change = False
    for axis, places in of_axis.items():
        if not places:
            continue
        is_change |= 0 not in places
        rows = np.stack([(celsius - reference_c) ** order for order in places], axis=1)
        listed = list(places.values())
        bias = rows @ values[listed]
        sd = np.sqrt(np.maximum(np.einsum("ti,ij,tj->t", rows, covariance[np.ix_(listed, listed)], rows), 0.0))
        ax.plot(celsius, bias, color=AXES[axis], label=axis)
        ax.fill_between(celsius, bias - 2.0 * sd, bias + 2.0 * sd, color=AXES[axis], alpha=0.2, linewidth=0)
    ax.set_xlabel("temperature (°C)")
    unit = (calibration.data.get(sensor) or {}).get("reading_unit") or ""
    what = f"bias less that at {reference_c:g} °C" if is_change else "bias"
    ax.set_ylabel(f"{what} of the {sensor} ({unit}), ±2 sd")
    _legend(ax, columns=3)
    return _clean(ax)


_ROOM_C = 25.0


def chamber(design: CampaignDesign, ramp_k_per_min: float, ax: Axes | None) -> Axes:
    """Temperature of the chamber over time, and the holds in it."""
    ax = _axes(ax)
    ends = tuple(design.data["range_c"])
    at_min, at_c = 0.0, _ROOM_C
    times, temperatures = [at_min], [at_c]
    for soak in design.soaks:
        for celsius in _way(at_c, soak.temperature_c, ramp_k_per_min * (soak.begin_min - at_min), ends):
            at_min, at_c = at_min + abs(celsius - at_c) / ramp_k_per_min, celsius
            times.append(at_min)
            temperatures.append(at_c)
        at_min = soak.end_min
        times.append(at_min)
        temperatures.append(at_c)
    times.append(at_min + abs(_ROOM_C - at_c) / ramp_k_per_min)
    temperatures.append(_ROOM_C)
    ax.plot(times, temperatures, color=GREY, linewidth=1.0)
    for direction, colour in (("up", VERMILLION), ("down", BLUE)):
        side = {"up": "below", "down": "above"}[direction]
        label: str | None = f"holds, reached from {side}"
        for soak in design.soaks:
            if soak.direction == direction:
                span = [soak.begin_min + soak.wait_min, soak.end_min]
                ax.plot(span, [soak.temperature_c] * 2, color=colour, linewidth=4.0, solid_capstyle="butt", label=label)
                label = None
    ax.set_xlabel("time (min)")
    ax.set_ylabel("temperature of the chamber (°C)")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize="small", frameon=False)
    return _clean(ax)


def _way(from_c: float, to_c: float, length_k: float, ends: tuple[float, ...]) -> list[float]:
    """Where the chamber turns on its way of this length: at an end of the range, at both, or nowhere."""
    low, high = ends
    ways = [[to_c], [high, to_c], [low, to_c], [high, low, to_c]]
    return min(ways, key=lambda way: abs(sum(abs(b - a) for a, b in zip([from_c, *way], way)) - length_k))


def motion(design: Design, ax: Axes | None) -> Axes:
    """Acceleration of a motion over time."""
    ax = _axes(ax)
    if design.motion is not None:
        for k, axis in enumerate("xyz"[: design.motion.axes]):
            # lines that coincide stay visible
            ax.plot(design.motion.t_s, design.motion.acceleration_mps2[:, k], color=AXES[axis], lw=3.0 - k, label=axis)
        if design.motion.axes > 1:
            _legend(ax, columns=3)
    ax.set_xlabel("time (s)")
    ax.set_ylabel("acceleration (m/s²)")
    return _clean(ax)


def poses(design: PoseDesign, ax: Axes | None) -> Axes:
    """The directions that are up, as longitude and latitude."""
    ax = _axes(ax)
    x, y, z = design.directions.T
    longitude, latitude = np.degrees(np.arctan2(y, x)), np.degrees(np.arcsin(np.clip(z, -1.0, 1.0)))
    ax.plot(longitude, latitude, "o", color=BLUE)
    for number, place in enumerate(zip(longitude, latitude), 1):
        ax.annotate(str(number), place, textcoords="offset points", xytext=(5, 4), fontsize="small")
    ax.set_xlim(-190, 190)
    ax.set_ylim(-100, 100)
    ax.set_xticks(range(-180, 181, 60))
    ax.set_yticks(range(-90, 91, 30))
    ax.set_xlabel("longitude of the direction that is up, about z from x (°)")
    ax.set_ylabel("latitude, towards z (°)")
    return _clean(ax)


def joints(log: Joints, ax: Axes | None) -> Axes:
    """Positions of joints over time."""
    ax = _axes(ax, width=8.5)
    for k, (name, positions) in enumerate(zip(log.names, log.positions.T)):
        ax.plot(log.t_s, positions, color=LINES[k % len(LINES)], label=name)
    ax.set_xlabel("time (s)")
    ax.set_ylabel("position of the joint (rad or m)")
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize="small", frameon=False)
    return _clean(ax)


def sweep(swept: Sweep, ax: Axes | None) -> Axes:
    """Standard deviation of each parameter over the quantity that was swept."""
    ax = _axes(ax, width=8.5)
    for k, (name, sds) in enumerate(zip(swept.parameters, swept.sd.T)):
        style = ("o-", "s--", "^:", "D-.")[k // len(LINES) % 4]
        ax.loglog(swept.values, sds, style, ms=4, color=LINES[k % len(LINES)], label=name)
    ax.set_xlabel(f"{swept.quantity} ({swept.unit})" if swept.unit else swept.quantity)
    ax.set_ylabel("standard deviation, in the unit of each parameter")
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize="small", frameon=False)
    return _clean(ax)


def allan(noise: SensorNoise, ax: Axes | None) -> Axes:
    """Allan deviation with its confidence interval."""
    ax = _axes(ax)
    for k, axis in enumerate(noise.axes):
        ax.loglog(noise.tau_s, noise.allan_deviation[:, k], color=AXES[axis], label=axis)
        ax.fill_between(
            noise.tau_s, noise.allan_low[:, k], noise.allan_high[:, k], color=AXES[axis], alpha=0.2, linewidth=0
        )
    ax.set_xlabel("cluster time τ (s)")
    ax.set_ylabel(f"Allan deviation of the {noise.sensor} ({noise.unit})")
    _legend(ax, columns=3)
    return _clean(ax)


def differences(comparison: Comparison, ax: Axes | None) -> Axes:
    """Differences in their standard deviations."""
    rows = [row for row in comparison.data["quantities"] if row.get("difference_in_sd") is not None]
    ax = _axes(ax, height=_height(len(rows)))
    ax.axvspan(-2.0, 2.0, color="#eef0f2", label="±2 standard deviations")
    ax.plot([row["difference_in_sd"] for row in rows], range(len(rows)), "o", ms=5, color=BLUE)
    ax.set_xlabel("difference / its standard deviation")
    _legend(ax)
    return _by_line(ax, [row["name"] for row in rows])
