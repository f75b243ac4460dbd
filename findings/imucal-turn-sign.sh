#!/bin/sh
# imucal 2.6.0: the turns of a Ferraris calibration must be clockwise, seen against the axis. `expected_angle` is -360 degrees by default.
# An ideal sensor that is turned by +360 degrees about each of its axes (right hand) gets a rotation R_g = -1, without an error or a warning. All rates that
# are corrected with it have the wrong sign.
# Seen:
#     turned by +360: diagonal of K_g [1. 1. 1.], of R_g [-1. -1. -1.]; a rate of 180 deg/s is corrected to -180
#     turned by -360: diagonal of K_g [1. 1. 1.], of R_g [1. 1. 1.]; a rate of 180 deg/s is corrected to 180
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet imucal==2.6.0
"$folder/venv/bin/python" - <<'END'
import warnings

import numpy as np
import pandas as pd
from imucal import FerrarisCalibration, ferraris_regions_from_section_list

warnings.simplefilter("error", UserWarning)
RATE_HZ, GRAVITY, SECTION = 100.0, 9.81, 200  # each turn: two seconds at 180 deg/s
seen = []
for turned in [360, -360]:
    rows, sections = [], {}

    def section(name, force, rate):
        sections[name] = [len(rows), len(rows) + SECTION]
        rows.extend([np.concatenate([force, rate])] * SECTION)

    for name, axis in zip("xyz", np.eye(3)):
        section(name + "_p", GRAVITY * axis, 0 * axis)
        section(name + "_a", -GRAVITY * axis, 0 * axis)
        section(name + "_rot", GRAVITY * axis, turned / 2 * axis)
    data = pd.DataFrame(rows, columns=["acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"])
    listed = pd.DataFrame.from_dict(sections, orient="index", columns=["start", "end"])
    regions = ferraris_regions_from_section_list(data, listed)
    calibration = FerrarisCalibration().compute(regions, RATE_HZ, from_acc_unit="m/s^2", from_gyr_unit="deg/s")
    _, rate = calibration.calibrate(np.array([[0, 0, GRAVITY]]), np.array([[180.0, 0, 0]]), "m/s^2", "deg/s")
    scale, turn = (np.diag(of).round(9) for of in (calibration.K_g, calibration.R_g))
    print(f"turned by {turned:+}: diagonal of K_g {scale}, of R_g {turn}; a rate of 180 deg/s is corrected to {rate[0][0]:.0f}")
    seen.append((*scale, *turn, round(rate[0][0])))
assert seen == [(1, 1, 1, -1, -1, -1, -180), (1, 1, 1, 1, 1, 1, 180)]
END
