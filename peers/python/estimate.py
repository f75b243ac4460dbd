"""An accelerometer on a motion that is not quite as commanded, with its covariance: CasADi with IPOPT, and calibrant."""

import calibrant as cb
import casadi as ca
import numpy as np

JOB, PEER = "an accelerometer on a noisy motion", "CasADi"


def prepare():
    """Sample times, readings, node times, commanded acceleration, and sd of the noise and of each jerk."""
    simulated = cb.simulate(cb.Experiment.preset("report-noisy"))
    samples, motion = simulated.recording.accelerometer, simulated.motion
    jerk = np.diff(motion.acceleration_mps2, axis=0) / np.diff(motion.t_s)[:, None]
    return samples.t_s, samples.values, motion.t_s, motion.acceleration_mps2, 2e-4, 0.01 + 0.01 * np.abs(jerk)


def with_casadi(t, y, tau, command, noise, jerk_sd):
    """Bias, scale factors and nodes, and the covariance of all: least squares, each unknown in units of its sd."""
    intervals = np.clip(np.searchsorted(tau, t, side="right") - 1, 0, len(tau) - 2)
    share = (t - tau[intervals]) / np.diff(tau)[intervals]
    weights = np.zeros((len(t), len(tau)))
    weights[np.arange(len(t)), intervals] = 1 - share
    weights[np.arange(len(t)), intervals + 1] = share
    b, k, a = ca.SX.sym("b", 1, 3), ca.SX.sym("k", 1, 3), ca.SX.sym("a", len(tau) - 1, 3)
    nodes = ca.vertcat(ca.DM(command[:1]), a)
    ones = ca.DM.ones(len(t), 1)
    readings = (y - ones @ b - (ca.sparsify(ca.DM(weights)) @ nodes) * (ones @ k)) / noise
    excess = (nodes[1:, :] - nodes[:-1, :] - np.diff(command, axis=0)) / np.diff(tau)[:, None] / jerk_sd
    residuals = ca.vertcat(ca.vec(readings), ca.vec(excess))
    z = ca.vertcat(b.T, k.T, ca.vec(a))
    jacobian = ca.Function("jacobian", [z], [ca.jacobian(residuals, z)])
    start = np.concatenate([np.zeros(3), np.ones(3), command[1:].ravel(order="F")])
    unit = 1 / np.linalg.norm(np.array(jacobian(start)), axis=0)
    x = ca.SX.sym("x", len(start))
    cost = ca.substitute(ca.sumsqr(residuals) / 2, z, start + unit * x)
    options = {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False, "ipopt.nlp_scaling_method": "none", "ipopt.tol": 1e-9}
    solution = ca.nlpsol("solver", "ipopt", {"x": x, "f": cost}, options)(x0=0)
    z = start + unit * np.array(solution["x"]).ravel()
    j = np.array(jacobian(z))
    return z[:6], np.linalg.inv(j.T @ j)[:6, :6]


def with_calibrant(t, y, tau, command, *_):
    return cb.calibrate(cb.recording(t, y), cb.Experiment.preset("report-noisy"), motion=cb.Motion(tau, command))


def compare(ours, theirs):
    """The same estimates and covariance."""
    values, covariance = theirs
    sd = np.sqrt(np.diag(covariance))
    off = np.abs((ours.values - values) / sd).max()
    spread = np.abs((ours.covariance - covariance) / np.outer(sd, sd)).max()
    print(f"  largest difference: estimates {off:.1e} sd, covariance {spread:.1e}")
    return off < 1e-6 and spread < 1e-6
