"""10: two calibrations, and the records."""

import calibrant as cb

before, after = cb.Calibration.load("2025.json"), cb.Calibration.load("2026.json")
change = cb.compare(before, after)
print(change.to_frame(), change.chi2, change.p_value)
change.plot()
with cb.Records("line.db") as records:
    records.add(before, after)
    print(records.drift("A17"))
