"""6: a machine, from arrays of motion capture."""

import numpy as np

import calibrant as cb

m = np.load("mocap.npz")
poses = cb.Poses(m["t"], m["p"], m["q"])  # (n,) s, (n, 3) m, (n, 4) w x y z
ex = cb.Experiment.preset("mocap", machine={"up": "z", "mount": {"lever_m": [0, 0, 0.02], "lever_sd_m": 0.05}})
cal = cb.calibrate("imu.csv", ex, log=poses)
print([cal[f"lever.{axis}"].value for axis in "xyz"], cal["delay.accelerometer"].value)
cal.plot_residuals()
