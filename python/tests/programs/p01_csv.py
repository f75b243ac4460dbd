"""1: a CSV."""

import calibrant as cb

cal = cb.calibrate("recording.csv", gravity_mps2=9.8132)  # by hand; accelerometer or IMU, as the file has it
scale = cal["accelerometer.scale.x"]
print(cal.summary(), f"{scale.value:.6f} ± {scale.sd:.6f}")
cal.raise_for_verdict().report("report.html")
cal.save("calibration.json")
