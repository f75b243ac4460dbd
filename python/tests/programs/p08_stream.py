"""8: a stream."""

import numpy as np

import calibrant as cb

cal = cb.Calibration.load("calibration.json")
with open("raw.f64", "rb") as raw, open("true.f64", "wb") as out:
    while chunk := raw.read(6 * 8 * 1000):
        y = np.frombuffer(chunk).reshape(-1, 6)
        out.write(np.hstack(cal.correct(y[:, :3], y[:, 3:], temperature_c=31.5)).tobytes())
