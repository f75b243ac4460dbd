"""The experiment of an IMU on a UR5e with its meshes: the preset of calibrant with a few keys changed. Calls of calibrant, and its trajectory.csv."""

import csv
import json
import os
import re
import subprocess

import numpy as np
from scipy.interpolate import CubicSpline

RANGES = {"range_mps2": "39.2", "range_radps": "17.4"}


def calibrant(o, *arguments, allow=(0,)):
    """Runs a command of calibrant. A status that is not allowed ends the script."""
    done = subprocess.run(
        [o.calibrant, "--threads", str(o.threads), "--force", "--color", "never", *map(str, arguments)], capture_output=True, text=True
    )
    if done.returncode not in allow:
        raise SystemExit(f"calibrant {' '.join(map(str, arguments))}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def with_keys(text, keys):
    """The experiment file with these keys set: `name`, or `section.name` where several sections have it. The preset has each key once, perhaps as a comment."""
    for key, value in keys.items():
        section, _, name = key.rpartition(".")
        begin = text.index(f"\n[{section}]") if section else 0
        line = re.compile(rf"^(# )?{name} = [^\n#]*", re.MULTILINE)
        found = line.search(text, begin)
        if found is None:
            raise SystemExit(f"the preset has no key {key}")
        text = text[: found.start()] + f"{name} = {value} " + text[found.end() :]
    return text


def experiment(o, folder, keys):
    """Writes the preset `arm` for the UR5e of the data folder."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "arm.toml"
    preset = folder / "preset.toml"
    calibrant(o, "init", "arm", "-o", preset)
    machine = {"machine.urdf": json.dumps(os.path.abspath(o.urdf)), "machine.base": '"base_link"', "machine.tip": '"tool0"',
               "machine.packages": json.dumps([os.path.abspath(o.urdf.parent)]), "floor_m": "0.0"}
    path.write_text(with_keys(preset.read_text(), machine | RANGES | keys))
    return path


def trajectory(path):
    """The cubic spline of a trajectory.csv, which begins and ends at rest, and its joints."""
    rows = [row for row in csv.reader(open(path)) if row and not row[0].startswith("#")]
    numbers = np.array(rows[1:], float)
    n = (len(rows[0]) - 1) // 3
    names = [column.removesuffix("_rad") for column in rows[0][1 : 1 + n]]
    t, q, v, a = numbers[:, 0], *np.split(numbers[:, 1:], 3, axis=1)
    spline = CubicSpline(t, q, bc_type="clamped")
    for order, given in ((1, v), (2, a)):
        assert np.abs(spline(t, order) - given).max() < 1e-6, "the rows are not those of one cubic spline at rest at both ends"
    return names, spline


def write_trajectory(path, names, spline):
    """A trajectory.csv with a row at each knot."""
    header = ["t_s", *(f"{n}_{unit}" for unit in ("rad", "radps", "radps2") for n in names)]
    t = spline.x
    rows = np.column_stack([t, spline(t), spline(t, 1), spline(t, 2)])
    path.write_text("\n".join([",".join(header), *(",".join(f"{x:.15g}" for x in row) for row in rows)]) + "\n")
