"""The Allan deviation of three axes at rest: AllanTools and calibrant."""

import allantools
import calibrant as cb
import numpy as np

JOB, PEER = "the Allan deviation of three axes", "AllanTools"
RATE_HZ, N, K = 100.0, 0.02, 0.02  # Hz, m/s²/√Hz, m/s²/√s


def prepare():
    """Times and readings of five minutes: white noise, with a random walk on y."""
    rng = np.random.default_rng(1)
    readings = N * np.sqrt(RATE_HZ) * rng.standard_normal((30_000, 3)) + [0.0, 0.0, 9.81]
    readings[:, 1] += np.cumsum(K / np.sqrt(RATE_HZ) * rng.standard_normal(len(readings)))
    return np.arange(len(readings)) / RATE_HZ, readings


def with_allantools(t, readings):
    taus = np.arange(1, len(t) // 2) / 100.0
    taus = taus[np.unique(np.geomspace(1, len(taus), 50).astype(int)) - 1]
    return [allantools.oadev(axis, rate=100.0, data_type="freq", taus=taus) for axis in readings.T]


def with_calibrant(t, readings):
    return cb.noise(cb.recording(t, readings), hold_s=(-1.0, t[-1] + 1.0))


def compare(ours, theirs):
    """The same deviations, where both have them."""
    sensor = ours.sensors[0]
    difference = 0.0
    for axis, (taus, deviations, _, _) in enumerate(theirs):
        near = np.argmin(np.abs(sensor.tau_s[:, None] - taus), axis=1)
        both = np.isclose(sensor.tau_s, taus[near], rtol=1e-9)
        difference = max(difference, np.abs(sensor.allan_deviation[both, axis] / deviations[near[both]] - 1).max())
    print(f"  {both.sum()} cluster times in common, largest relative difference {difference:.1e}")
    print(f"  calibrant: N {sensor.white.round(5)} (true {N}), K {sensor.rate_random_walk.round(4)} (true {K} on y)")
    return both.sum() > 10 and difference < 1e-8
