"""Reads imucal files that calibrant wrote, and has calibrant read one that imucal wrote.

usage: formats.py CALIBRANT, the path of the program. Fails where the two programs correct a reading differently.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from imucal import CalibrationInfo, FerrarisCalibrationInfo

TOLERANCE = 1e-12  # m/s² and rad/s


def imu(unit_acc, unit_gyr):
    """A calibration object of imucal with everything in it; gyroscope and K_ga per deg/s, as imucal has them."""
    rng = np.random.default_rng(1)
    gain_acc, gain_gyr = (208.0 if unit_acc == "a.u." else 1.0), (16.5 if unit_gyr == "a.u." else 1.0)

    def rotation():
        r = np.eye(3) + rng.normal(0, 0.01, (3, 3))
        return r / np.linalg.norm(r, axis=1, keepdims=True)

    return FerrarisCalibrationInfo(
        K_a=np.diag(gain_acc * rng.normal(1, 0.01, 3)),
        R_a=rotation(),
        b_a=gain_acc * rng.normal(0, 0.3, 3),
        K_g=np.diag(gain_gyr * rng.normal(1, 0.01, 3)),
        R_g=rotation(),
        K_ga=gain_gyr * rng.normal(0, 5e-3, (3, 3)),
        b_g=gain_gyr * rng.normal(0, 0.5, 3),
        from_acc_unit=unit_acc,
        from_gyr_unit=unit_gyr,
    )


def corrected(info, acc, gyr):
    """imucal's correction in m/s² and rad/s."""
    force, rate = info.calibrate(acc, gyr, acc_unit=info.from_acc_unit, gyr_unit=info.from_gyr_unit)
    return force, np.deg2rad(rate)


def corrected_by_calibrant(path, acc, gyr):
    """The correction in a calibrant JSON, true to raw: y_a = S_a f + b_a, y_g = S_g w + b_g + G f."""
    imu = json.loads(Path(path).read_text(encoding="utf8"))
    a, g = imu["accelerometer"], imu["gyroscope"]
    counts = g["reading_unit"] == "counts"
    s_a = np.array(a["matrix_counts_per_mps2"] if counts else a["matrix"])
    s_g = np.array(g["matrix_counts_per_radps"] if counts else g["matrix"])
    b_a, b_g = (np.array(of["bias_counts"] if counts else of[si]) for of, si in ((a, "bias_mps2"), (g, "bias_radps")))
    gamma = np.array(g["g_sensitivity_counts_per_mps2" if counts else "g_sensitivity_radps_per_mps2"])
    force = np.linalg.solve(s_a, (acc - b_a).T).T
    readings = gyr if counts else np.deg2rad(gyr)
    return force, np.linalg.solve(s_g, (readings - b_g - force @ gamma.T).T).T


def main():
    calibrant = Path(sys.argv[1]).resolve()
    rng = np.random.default_rng(2)
    worst = 0.0
    with tempfile.TemporaryDirectory() as directory:
        directory = Path(directory)
        for unit_acc, unit_gyr in (("a.u.", "a.u."), ("m/s^2", "deg/s")):
            counts = unit_acc == "a.u."
            acc = rng.uniform(-20, 20, (1000, 3)) * (208 if counts else 1)
            gyr = rng.uniform(-500, 500, (1000, 3)) * (16.5 if counts else 1)
            theirs, ours, again = (directory / name for name in ("theirs.json", "ours.json", "again.json"))
            info = imu(unit_acc, unit_gyr)
            info.to_json_file(theirs)
            for arguments in (["convert", theirs, ours], ["convert", ours, again, "--to", "imucal"]):
                subprocess.run([calibrant, *arguments], check=True, stdout=subprocess.DEVNULL)
            wanted = corrected(info, acc, gyr)
            for name, found in (
                ("imucal's file, read by calibrant", corrected_by_calibrant(ours, acc, gyr)),
                ("calibrant's file, read by imucal", corrected(CalibrationInfo.from_json_file(again), acc, gyr)),
            ):
                difference = max(np.abs(one - other).max() for one, other in zip(wanted, found))
                worst = max(worst, difference)
                print(f"{name}, readings in {unit_acc} and {unit_gyr}: largest difference {difference:.1e}")
    if worst > TOLERANCE:
        sys.exit(f"the corrections differ by {worst:.1e}, more than {TOLERANCE:.0e}")


if __name__ == "__main__":
    main()
