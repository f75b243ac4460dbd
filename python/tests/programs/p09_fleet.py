"""9: a fleet; run it again to continue. With `client=ray`, on a cluster."""

import calibrant as cb

result = cb.fleet.calibrate("line/*.csv", cb.Experiment.from_toml("imu.toml"), "results")
print(result.calibrated, result.failed, result.earlier)
table = result.to_table()
print(table.select(["file", "verdict", "code", "error"]))
