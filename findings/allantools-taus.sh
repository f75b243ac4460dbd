#!/bin/sh
# AllanTools 2024.6: the deviations that come back are not those of the cluster times that were asked for.
# A time is rounded to whole samples, times that become the same are one, and times above half of the record are left out. There is no warning: arrays that
# are put beside the times that were asked for have another length, or stand beside the wrong times.
# Without `data_type="freq"` rates count as phase, which is also no error: another number at the same time.
# Seen, an hour of white noise at 100 Hz:
#     asked 0.01, 0.012, 0.015, 0.1, 1.0, 1000.0, 2000.0
#     got   0.01, 0.02, 0.1, 1.0, 1000.0
#     deviation at 1 s: as rates 0.00199, by default 0.0346
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet allantools==2024.6 numpy==2.4.6 scipy==1.17.0
"$folder/venv/bin/python" - <<'END'
import warnings

import allantools
import numpy as np

warnings.simplefilter("error")
N, RATE_HZ = 2e-3, 100.0
rate = np.random.default_rng(1).normal(0, N * RATE_HZ**0.5, 360_000)
asked = [0.01, 0.012, 0.015, 0.1, 1.0, 1000.0, 2000.0]
got, deviations, _, _ = allantools.oadev(rate, rate=RATE_HZ, data_type="freq", taus=asked)
print("asked", ", ".join(map(str, asked)))
print("got  ", ", ".join(str(float(t)) for t in got))
default = allantools.oadev(rate, rate=RATE_HZ, taus=[1.0])[1][0]
as_rate = deviations[list(got).index(1.0)]
print(f"deviation at 1 s: as rates {as_rate:.3g}, by default {default:.3g}")
assert list(got) == [0.01, 0.02, 0.1, 1.0, 1000.0] and abs(as_rate / N - 1) < 0.05 and default > 15 * as_rate
END
