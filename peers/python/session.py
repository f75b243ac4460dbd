"""A whole IMU from six faces and three turns: imucal and calibrant. The session is simulated, so that the true sensor is known."""

import json
import tempfile
from pathlib import Path

import calibrant as cb
import numpy as np
import pandas as pd
from imucal import FerrarisCalibration, ferraris_regions_from_section_list

JOB, PEER = "a whole IMU from six faces and three turns", "imucal"
RATE_HZ, GRAVITY, NOISE = 102.4, 9.81, (0.02, 0.1)  # Hz; m/s²; m/s² and deg/s, of a sample
TRUE = np.array([[1.01, 0.004, -0.003], [0.002, 0.99, 0.005], [-0.004, 0.001, 1.005]])  # of both sensors
BIAS = np.array([0.1, -0.2, 0.15])  # m/s², and deg/s
AXES = "xyz"


def prepare():
    """A frame of samples, and the list of sections as imucal has it: first and last row of each."""
    rng = np.random.default_rng(1)
    steps, rows = [], 0
    sections = {}
    for axis in range(3):
        for name, sign in (("p", 1), ("a", -1)):
            up = sign * np.eye(3)[axis]
            force, rate = np.tile(GRAVITY * up, (600, 1)), np.zeros((600, 3))
            sections[f"{AXES[axis]}_{name}"] = {"start": rows + 50, "end": rows + 550}
            steps.append((force, rate))
            rows += 600
    for axis in range(3):
        # one turn by -360° about an axis that is upright, in four seconds
        shape = np.sin(np.pi * (np.arange(410) + 0.5) / 410) ** 2
        rate = np.zeros((610, 3))
        rate[100:510, axis] = -360 * shape / shape.sum() * RATE_HZ
        sections[f"{AXES[axis]}_rot"] = {"start": rows + 50, "end": rows + 560}
        steps.append((np.tile(GRAVITY * np.eye(3)[axis], (610, 1)), rate))
        rows += 610
    force, rate = (np.vstack(parts) for parts in zip(*steps))
    readings = [true @ TRUE.T + BIAS + noise * rng.standard_normal(true.shape) for true, noise in zip((force, rate), NOISE)]
    columns = [f"{sensor}_{axis}" for sensor in ("acc", "gyr") for axis in AXES]
    path = Path(tempfile.mkdtemp()) / "sections.json"
    path.write_text(json.dumps(sections), encoding="utf8")
    return pd.DataFrame(np.hstack(readings), columns=columns), path


def with_imucal(frame, sections):
    regions = ferraris_regions_from_section_list(frame, pd.read_json(sections, orient="index"))
    return FerrarisCalibration(grav=9.81).compute(regions, 102.4, from_acc_unit="m/s^2", from_gyr_unit="deg/s")


def with_calibrant(frame, sections):
    recording = cb.read_recording(frame, rate_hz=102.4, accelerometer_unit="m/s²", gyroscope_unit="deg/s")
    experiment = cb.Experiment.preset("ferraris", holds={"gravity_mps2": 9.81})
    return cb.calibrate(recording, experiment, sections=sections)


def compare(ours, theirs):
    """What each says of the true sensor."""
    true = {"accelerometer": TRUE, "gyroscope": TRUE}
    found = {"accelerometer": theirs.K_a @ theirs.R_a, "gyroscope": theirs.K_g @ theirs.R_g}
    worst = {"imucal": 0.0, "calibrant": 0.0, "sd": 0.0}
    for sensor, matrix in true.items():
        for row in range(3):
            for column in range(3):
                name = f"{sensor}.scale.{AXES[row]}" if row == column else f"{sensor}.matrix.{AXES[row]}{AXES[column]}"
                parameter = ours[name]
                worst["imucal"] = max(worst["imucal"], abs(found[sensor][row, column] - matrix[row, column]))
                worst["calibrant"] = max(worst["calibrant"], abs(parameter.value - matrix[row, column]))
                worst["sd"] = max(worst["sd"], abs(parameter.value - matrix[row, column]) / parameter.sd)
    print(f"  largest error of an entry of S: imucal {worst['imucal']:.1e}, calibrant {worst['calibrant']:.1e}, {worst['sd']:.1f} of its sd")
    return worst["calibrant"] <= 1.05 * worst["imucal"] and worst["sd"] < 5
