#!/bin/sh
# VQF 2.1.2: a slow rate table counts as rest. By default rates below 2 deg/s (restThGyr) with a steady accelerometer are the bias of the gyroscope
# (biasClip is 2 deg/s, too), so that the heading stands still while the table turns. At 2.1 deg/s it follows.
# Seen, two minutes about the vertical at 100 Hz, no noise:
#     1.0 deg/s: turned by 120.0, heading 1.7, bias 1.000 deg/s
#     1.9 deg/s: turned by 228.0, heading 3.2, bias 1.900 deg/s
#     2.1 deg/s: turned by 252.0, heading 252.0, bias 0.000 deg/s
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet vqf==2.1.2 numpy==2.4.6
"$folder/venv/bin/python" - <<'END'
import numpy as np
from vqf import VQF

headings, biases = [], []
for rate in [1.0, 1.9, 2.1]:
    filter_ = VQF(0.01)
    for _ in range(12_000):
        filter_.update(np.radians([0, 0, rate]), np.array([0, 0, 9.81]))
    w, _, _, z = filter_.getQuat6D()
    headings.append(np.degrees(2 * np.arctan2(z, w)) % 360)
    biases.append(np.degrees(filter_.getBiasEstimate()[0][2]))
    print(f"{rate} deg/s: turned by {120 * rate:.1f}, heading {headings[-1]:.1f}, bias {biases[-1]:.3f} deg/s")
assert np.allclose(headings, [1.7, 3.2, 252], atol=0.1) and np.allclose(biases, [1, 1.9, 0], atol=1e-3)
END
