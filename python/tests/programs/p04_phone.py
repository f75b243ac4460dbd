"""4: a phone, with a file for each sensor."""

import calibrant as cb

rec = cb.read_recording(
    "Accelerometer.csv",
    gyroscope="Gyroscope.csv",
    columns={"time": "seconds_elapsed"},
    time_unit="s",
    accelerometer_unit="m/s²",
    gyroscope_unit="rad/s",
)
try:
    cal = cb.calibrate(rec, gravity_mps2=9.8132)
except cb.NotIdentifiable as error:
    for group in error.groups:
        print(group.parameters, group.reason, "→", group.remedy)
    raise SystemExit(4)
for d in cal.diagnostics:
    print(d.severity, d.code, d.message)
