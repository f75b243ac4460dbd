"""The Allan deviation of simulated noise with calibrant and with AllanTools: the same deviations, degrees of freedom, and what each says of N.

White noise, white noise with a random walk, and a drift beside white noise, made here with numpy. calibrant's deviations must be AllanTools' `oadev`
to rounding, its degrees of freedom those of `edf_simple` (the handbook's formulas, NIST SP 1065) to 1 % for white noise. `edf_greenhall` is shown too:
it is off by up to 17 % at clusters of a few samples.

Usage: allan.py CALIBRANT [SAMPLES]
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import allantools
import numpy as np

RATE_HZ = 100.0
N, K = 0.02, 0.02  # m/s^2/sqrt(Hz), m/s^2/sqrt(s)


def recording(samples, rng):
    """Three axes: white noise, with a random walk, with a drift."""
    white = N * np.sqrt(RATE_HZ) * rng.standard_normal((samples, 3))
    white[:, 1] += np.cumsum(K / np.sqrt(RATE_HZ) * rng.standard_normal(samples))
    white[:, 2] += 9.81 + 1e-3 * np.arange(samples) / RATE_HZ
    return white


def with_calibrant(program, readings, directory):
    path = Path(directory) / "recording.csv"
    times = np.arange(len(readings)) / RATE_HZ
    table = np.column_stack([times, readings])
    np.savetxt(path, table, delimiter=",", header="t_s,ax_mps2,ay_mps2,az_mps2", comments="", fmt="%.17g")
    command = [program, "noise", str(path), "--hold", "-1", str(times[-1] + 1), "--json"]
    began = time.perf_counter()
    out = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return json.loads(out)["sensors"][0], time.perf_counter() - began


def main():
    program = sys.argv[1]
    samples = int(sys.argv[2]) if len(sys.argv) > 2 else 30_000
    readings = recording(samples, np.random.default_rng(1))
    with tempfile.TemporaryDirectory() as directory:
        found, seconds = with_calibrant(program, readings, directory)
    failed = False
    for axis, values in zip(found["axes"], readings.T):
        allan = axis["allan"]
        began = time.perf_counter()
        taus, theirs, _, _ = allantools.oadev(values, rate=RATE_HZ, data_type="freq", taus=np.array(allan["tau_s"]))
        their_seconds = time.perf_counter() - began
        ours = np.interp(taus, allan["tau_s"], allan["deviation"])
        worst = np.max(np.abs(ours / theirs - 1))
        failed |= len(taus) != len(ours) or worst > 1e-8
        print(f"axis {axis['axis']}: {len(taus)} cluster times, largest relative difference of the deviation {worst:.1e}", end="")
        print(f" (oadev took {1e3 * their_seconds:.1f} ms)")
        if axis["axis"] == "x":
            clusters = np.array(allan["cluster_samples"])
            chosen = [i for i, m in enumerate(clusters) if samples / m > 40]
            ours = np.array([allan["degrees_of_freedom"][i] for i in chosen])
            simple = np.array([allantools.edf_simple(samples + 1, int(clusters[i]), 0) for i in chosen])
            greenhall = [
                allantools.edf_greenhall(0, 2, int(clusters[i]), samples + 1, overlapping=True, modified=False) for i in chosen
            ]
            for name, edf in (("edf_simple", simple), ("edf_greenhall", np.array(greenhall))):
                ratio = ours / edf
                print(f"  degrees of freedom of white noise over those of {name}: {ratio.min():.4f} to {ratio.max():.4f}")
            failed |= np.max(np.abs(ours / simple - 1)) > 0.01
        n, k = axis["random_walk"], axis["rate_random_walk"]
        at_1_s = float(np.exp(np.interp(0.0, np.log(taus), np.log(theirs))))
        print(f"  N = {n['value']:.6f} ± {n['sd']:.6f} (true {N}); oadev read at 1 s: {at_1_s:.6f}")
        if k["determined"]:
            print(f"  K = {k['value']:.5f} ± {k['sd']:.5f}, 95 % {k['low']:.5f} to {k['high']:.5f} (true {K if axis['axis'] == 'y' else 0})")
        else:
            print(f"  K not determined, below {k['upper_limit']:.5f} (true {K if axis['axis'] == 'y' else 0}): {k['reason']}")
        drift = axis["drift"]
        if drift["significant"]:
            print(f"  drift {drift['per_s']:.6f} ± {drift['sd']:.6f} m/s^2/s")
    print(f"calibrant, whole command: {seconds:.3f} s for 3 axes of {samples} samples")
    sys.exit(int(failed))


main()
