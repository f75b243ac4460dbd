"""3: arrays."""

import numpy as np

import calibrant as cb

t, f, w = (np.load(f"{name}.npy") for name in ("t", "f", "w"))  # (n,) s, (n, 3) g, (n, 3) deg/s
cal = cb.calibrate(cb.recording(t, f, w, accelerometer_unit="g", gyroscope_unit="deg/s"), gravity_mps2=9.8132)
z = (cal.values - 1.0) / cal.sd
sd_of_sum = np.sqrt(cal.covariance.sum())
force, rate = cal.correct(9.80665 * f, np.deg2rad(w))
print(z.shape, sd_of_sum, force.shape, rate.shape)
