#!/bin/sh
# allan-variance-analyzer 1.0.4: what it finds depends on how it is asked.
# 1. `compute_allan_variances` with its default overlap of 0.5 is not the Allan deviation: means of bins that are one sample apart are compared, since the
#    overlap goes on as a number of samples to where a share is expected. With overlap=0.0, as the class AllanVarianceAnalyzer has it, it is right.
# 2. The random walk K is the height of a line of slope 1/2 through all periods, whatever they show. Of white noise alone it finds one, and the longer the
#    periods, the smaller: "K" falls as 1/period_max. A smaller K by a larger period_max says nothing of the sensor.
# Seen, an hour of white noise of N = 1e-3 at 100 Hz, deviation times the root of the period at 0.1, 1 and 10 s, which is N:
#     overlap 0.0      0.000998 0.000989 0.000988
#     default overlap  0.000316 0.000100 0.000032
#     K of periods up to  30 s: 1.5e-04
#     K of periods up to 100 s: 4.5e-05
#     K of periods up to 300 s: 1.6e-05
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet allan-variance-analyzer==1.0.4 numpy==2.4.6
TQDM_DISABLE=1 "$folder/venv/bin/python" - <<'END'
import numpy as np
from allan_variance_analyzer.analysis import compute_rate_random_walk
from allan_variance_analyzer.statistics import compute_allan_variances

N, RATE_HZ = 1e-3, 100
white = np.random.default_rng(3).normal(0, N * RATE_HZ**0.5, (3600 * RATE_HZ, 6))
periods = np.array([0.1, 1.0, 10.0])
found = {}
for name, options in [("overlap 0.0", {"overlap": 0.0}), ("default overlap", {})]:
    deviations = compute_allan_variances(white, periods, RATE_HZ, **options) ** 0.5
    found[name] = (deviations * periods[:, None] ** 0.5).mean(axis=1)
    print(f"{name:15} ", *(f"{value:.6f}" for value in found[name]))
walks = []
for longest in [30, 100, 300]:
    periods = np.arange(0.1, longest, step=0.1 if longest <= 100 else 1.0)
    deviations = compute_allan_variances(white, periods, RATE_HZ, overlap=0.0) ** 0.5
    walks.append(compute_rate_random_walk(periods, deviations)[0][0])
    print(f"K of periods up to {longest:3} s: {walks[-1]:.1e}")
assert np.allclose(found["overlap 0.0"], N, rtol=0.05)
assert np.allclose(found["default overlap"], N * np.array([0.316, 0.1, 0.0316]), rtol=0.05)
assert np.all(np.abs(np.array(walks) * [30, 100, 300] / 4.6e-3 - 1) < 0.3)
END
