"""The motion of one axis that determines bias and scale factor best: CasADi with IPOPT, and calibrant. Case D1 of COMPARE.md."""

import calibrant as cb
import casadi as ca
import numpy as np

JOB, PEER = "the best motion of one axis", "CasADi"
STARTS = 20


def prepare():
    """The starts of the peer: accelerations of the eleven nodes."""
    return (np.random.default_rng(1).uniform(-30, 30, (STARTS, 11)),)


def with_casadi(starts):
    """The best of IPOPT's solutions: its trace, its motion, and how many of the starts reach it."""
    t = np.arange(101) / 10
    weights = np.maximum(0, 1 - np.abs(t[:, None] - np.arange(11)))
    a = ca.SX.sym("a", 11)
    alpha = ca.sparsify(ca.DM(weights)) @ a
    first, second = ca.sum1(alpha), ca.sumsqr(alpha)
    trace = (101 + second) / (101 * second - first**2)  # of the inverse of [[101, first], [first, second]]
    options = {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False, "ipopt.max_iter": 300}
    solver = ca.nlpsol("solver", "ipopt", {"x": a, "f": 1e4 * trace, "g": a[1:] - a[:-1]}, options)
    found = [solver(x0=start, lbx=-30, ubx=30, lbg=-30, ubg=30) for start in starts]
    values = np.array([2e-4**2 * float(solution["f"]) / 1e4 for solution in found])
    return values.min(), np.array(found[values.argmin()]["x"]).ravel(), int((values < values.min() * (1 + 1e-6)).sum())


def with_calibrant(*_):
    sensor = {"noise_mps2": 2e-4}
    motion = {"intervals": 10, "interval_s": 1.0, "rate_hz": 10.0, "known_ends": "start", "clock": None}
    limits = {"acceleration_mps2": 30.0, "jerk_mps3": 30.0}
    none = ("velocity_mps", "displacement_m", "rest", "start_acceleration_mps2", "end_acceleration_mps2")
    return cb.design(cb.Experiment.preset("stage", sensor=sensor, motion=motion, limits=limits | dict.fromkeys(none)))


def compare(ours, theirs):
    """The same trace of the covariance."""
    value, _, hits = theirs
    print(f"  trace: CasADi {value:.8g}, reached by {hits} of {STARTS} starts; calibrant {ours.value:.8g}, at most {ours.gap:.1e} above the best possible")
    return ours.value <= value * (1 + 1e-6)
