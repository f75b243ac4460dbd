"""The Allan deviation of six axes at rest: AllanTools and calibrant."""

import allantools
import calibrant as cb
import numpy as np

JOB, PEER = "the Allan deviation of six axes, two hours", "AllanTools"
RATE_HZ, N, K = 100.0, (0.02, 0.002), (0.002, 0.0002)  # Hz, m/s²/√Hz and rad/s/√Hz, m/s²/√s and rad/s/√s


def prepare():
    """Times and readings of an accelerometer and a gyroscope, white noise, with a random walk on y; and the averaging times at which both shall answer."""
    rng = np.random.default_rng(1)
    count = int(7200 * RATE_HZ)
    t = np.arange(count) / RATE_HZ
    sensors = []
    for white, walk in zip(N, K):
        readings = white * np.sqrt(RATE_HZ) * rng.standard_normal((count, 3))
        readings[:, 1] += np.cumsum(walk / np.sqrt(RATE_HZ) * rng.standard_normal(count))
        sensors.append(readings)
    sensors[0][:, 2] += 9.81
    return t, *sensors, with_calibrant(t, *sensors)["accelerometer"].tau_s


def with_allantools(_, accelerometer, gyroscope, taus):
    return [allantools.oadev(axis, rate=100.0, data_type="freq", taus=taus) for axis in [*accelerometer.T, *gyroscope.T]]


def with_calibrant(t, accelerometer, gyroscope, *_):
    return cb.noise(cb.recording(t, accelerometer, gyroscope), hold_s=(-1.0, t[-1] + 1.0))


def compare(ours, theirs):
    """The same deviations at all averaging times."""
    deviations = np.hstack([sensor.allan_deviation for sensor in ours.sensors])
    difference = max(np.abs(ours_of / found[1] - 1).max() for ours_of, found in zip(deviations.T, theirs))
    print(f"  {len(ours.tau_s)} averaging times, largest relative difference {difference:.1e}")
    for sensor, white, walk in zip(ours.sensors, N, K):
        print(f"  {sensor.sensor}: N {sensor.white.round(6)} (true {white}), K {sensor.rate_random_walk.round(6)} (true {walk} on y, nan: not determined)")
    return difference < 1e-8
