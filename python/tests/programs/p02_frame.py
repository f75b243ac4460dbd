"""2: a DataFrame."""

import polars as pl

import calibrant as cb

df = pl.read_parquet("walk.parquet").rename({"accX": "ax_g", "accY": "ay_g", "accZ": "az_g"})
rec = cb.read_recording(df, gyroscope_unit="deg/s", rate_hz=102.4)
print(rec.findings, rec.inspect().missing_orientations)
cal = cb.calibrate(rec, cb.Experiment.preset("imu", holds={"gravity_mps2": 9.8132, "gauge": "lower"}))
cal.to_frame().write_csv("parameters.csv")  # polars in, polars out
