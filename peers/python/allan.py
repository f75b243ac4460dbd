"""The Allan deviation of three axes at rest: AllanTools and calibrant."""

import allantools
import calibrant as cb
import numpy as np

JOB, PEER = "the Allan deviation of three axes", "AllanTools"
RATE_HZ, N, K = 100.0, 0.02, 0.02  # Hz, m/s²/√Hz, m/s²/√s


def prepare():
    """Times and readings of five minutes, white noise, with a random walk on y; and the averaging times at which both shall answer."""
    rng = np.random.default_rng(1)
    readings = N * np.sqrt(RATE_HZ) * rng.standard_normal((30_000, 3)) + [0.0, 0.0, 9.81]
    readings[:, 1] += np.cumsum(K / np.sqrt(RATE_HZ) * rng.standard_normal(len(readings)))
    t = np.arange(len(readings)) / RATE_HZ
    return t, readings, with_calibrant(t, readings).sensors[0].tau_s


def with_allantools(_, readings, taus):
    return [allantools.oadev(axis, rate=100.0, data_type="freq", taus=taus) for axis in readings.T]


def with_calibrant(t, readings, *_):
    return cb.noise(cb.recording(t, readings), hold_s=(-1.0, t[-1] + 1.0))


def compare(ours, theirs):
    """The same deviations at all averaging times."""
    sensor = ours.sensors[0]
    difference = max(np.abs(sensor.allan_deviation[:, axis] / found[1] - 1).max() for axis, found in enumerate(theirs))
    print(f"  {len(sensor.tau_s)} averaging times, largest relative difference {difference:.1e}")
    print(f"  calibrant: N {sensor.white.round(5)} (true {N}), K {sensor.rate_random_walk.round(4)} (true {K} on y, nan: not determined)")
    return difference < 1e-8
