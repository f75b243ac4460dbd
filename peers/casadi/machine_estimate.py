"""A sensor on a small machine, calibrated with noisy joints: solved with CasADi and IPOPT, beside calibrant's answer.

    minimise over c, p:  1/2 sum |y - S f(tau) - b|^2 / sigma^2          both sensors
                       + 1/2 sum (q_log - q(t; c))^2 / sigma_q^2
                       + 1/2 sum (p - mean)^2 / sd^2

Nothing is shared with calibrant but the JSON file. The problem, lengths in m, angles in rad, matrices row by row:

    chain.joints    list of {translation [3], rotation [9], kind "revolute" or "prismatic", axis [3]}, base to tip
    chain.tip       {translation [3], rotation [9]} after the last joint
    knots           {start, spacing, points}: with u = (t - start)/spacing and k = floor(u), control points k..k+3 act at t
    joint_log       {times, positions (one row per time), sd (one per joint)}
    imu             {times, accelerometer, gyroscope (rows), accelerometer_sd, gyroscope_sd, middle}
    gravity         magnitude, m/s^2
    mounting        nominal rotation tip from sensor [9]
    prior           {mean, sd}: one entry per parameter; sd null where nothing is known
    start           parameters to start at; may be missing (the prior's mean)

Parameters, in this order, 35 + 7 n: accelerometer bias 3, S_a 9, gyroscope bias 3, S_g 9, lever arm 3, mounting rotation
vector 3, tilt 2, delay of accelerometer, delay of gyroscope, clock rate, geometry 6 per joint (translation, rotation vector),
zeros n. What they mean:

    tau = t + rate (t - middle) + delay           joint variable = q(tau) + zero
    joint transform = origin * [exp(r), d] * motion along or about the axis
    tip from sensor = nominal * exp(mounting)     gravity = exp([tilt_x, tilt_y, 0]) (0, 0, -g)

The result: parameters, covariance (inverse of the Gauss-Newton information, control points marginalised), points, cost, and
last_step_sd: the Gauss-Newton step left at the answer, in standard deviations. A sample's piece of the spline depends on its
delay, so IPOPT solves with fixed pieces, and again until the pieces fit the answer.

Usage: machine_estimate.py PROBLEM.json RESULT.json
       machine_estimate.py --example PROBLEM.json [SEED]       writes a problem with two joints, and the truth in it
Exit status 1 where the step left exceeds 1e-6 standard deviations.
"""

import json
import os
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import casadi as ca  # noqa: E402  (threads must be set first)
import numpy as np  # noqa: E402

TOLERANCE = 1e-6
IPOPT = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.nlp_scaling_method": "none",  # the unknowns are scaled below
    "ipopt.tol": 1e-9,
    "ipopt.acceptable_iter": 0,
    "ipopt.max_iter": 200,
}
GROUPS = (("bias_a", 3), ("matrix_a", 9), ("bias_g", 3), ("matrix_g", 9), ("lever", 3), ("mounting", 3), ("tilt", 2),
          ("delay_a", 1), ("delay_g", 1), ("rate", 1))
CUBIC = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6  # powers of u by control points


def split(p, joints):
    parts, at = {}, 0
    for name, size in (*GROUPS, ("geometry", 6 * joints), ("zeros", joints)):
        parts[name] = p[at : at + size]
        at += size
    return parts


def square(values):
    return ca.reshape(values, 3, 3).T


def exponential(v):
    """Rotation of a vector below 0.3 rad: a series, which has derivatives at zero, too."""
    s, k = ca.dot(v, v), ca.skew(v)
    a = b = 0
    for n in range(8, -1, -1):
        a, b = 1 - s / ((2 * n + 2) * (2 * n + 3)) * a, 1 - s / ((2 * n + 3) * (2 * n + 4)) * b
    return ca.SX.eye(3) + a * k + b / 2 * ca.mtimes(k, k)


def basis(u, spacing):
    """Weights of four control points in value, velocity and acceleration at u in [0, 1) of a piece."""
    powers = (ca.vertcat(1, u, u**2, u**3), ca.vertcat(0, 1, 2 * u, 3 * u**2), ca.vertcat(0, 0, 2, 6 * u))
    return [ca.mtimes(CUBIC.T, w) / spacing**order for order, w in enumerate(powers)]


def model(problem):
    """The two sensors' readings as functions of (four control points, start of the piece, t, parameters)."""
    joints = problem["chain"]["joints"]
    n, h = len(joints), problem["knots"]["spacing"]
    points, begin, t, p = ca.SX.sym("c", n, 4), ca.SX.sym("begin"), ca.SX.sym("t"), ca.SX.sym("p", 35 + 7 * n)
    of = split(p, n)
    answers = []
    for sensor in "ag":
        tau = t + of["rate"] * (t - problem["imu"]["middle"]) + of[f"delay_{sensor}"]
        q, v, a = (ca.mtimes(points, w) for w in basis((tau - begin) / h, h))
        q = q + of["zeros"]
        # Everything in axes of the link reached: gravity enters as an acceleration of the base.
        tilt = exponential(ca.vertcat(of["tilt"], 0))
        force = -ca.mtimes(tilt, ca.DM([0, 0, -problem["gravity"]]))
        rate, angular = ca.SX.zeros(3), ca.SX.zeros(3)

        def carry(offset, turn, force, rate, angular):
            force = force + ca.cross(angular, offset) + ca.cross(rate, ca.cross(rate, offset))
            return (ca.mtimes(turn.T, x) for x in (force, rate, angular))

        for j, joint in enumerate(joints):
            geometry = of["geometry"][6 * j : 6 * j + 6]
            axis = ca.DM(joint["axis"])
            force, rate, angular = carry(
                ca.DM(joint["translation"]), ca.DM(np.reshape(joint["rotation"], (3, 3))), force, rate, angular
            )
            force, rate, angular = carry(geometry[:3], exponential(geometry[3:]), force, rate, angular)
            if joint["kind"] == "revolute":
                k = ca.skew(axis)
                turn = ca.SX.eye(3) + ca.sin(q[j]) * k + (1 - ca.cos(q[j])) * ca.mtimes(k, k)
                angular = angular + axis * a[j] + ca.cross(rate, axis * v[j])
                rate = rate + axis * v[j]
                force, rate, angular = (ca.mtimes(turn.T, x) for x in (force, rate, angular))
            else:
                offset = axis * q[j]
                force = force + ca.cross(angular, offset) + ca.cross(rate, ca.cross(rate, offset))
                force = force + axis * a[j] + 2 * ca.cross(rate, axis * v[j])
        tip = problem["chain"]["tip"]
        force, rate, angular = carry(
            ca.DM(tip["translation"]), ca.DM(np.reshape(tip["rotation"], (3, 3))), force, rate, angular
        )
        mount = ca.mtimes(ca.DM(np.reshape(problem["mounting"], (3, 3))), exponential(of["mounting"]))
        force, rate, angular = carry(of["lever"], mount, force, rate, angular)
        felt = force if sensor == "a" else rate
        reading = ca.mtimes(square(of[f"matrix_{sensor}"]), felt) + of[f"bias_{sensor}"]
        answers.append(ca.Function(f"reading_{sensor}", [points, begin, t, p], [reading]))
    return answers


def pieces(problem, times):
    knots = problem["knots"]
    place = (np.asarray(times) - knots["start"]) / knots["spacing"]
    if place.min() < 0 or place.max() > knots["points"] - 3 + 1e-9:
        sys.exit("machine_estimate: a time lies outside the knots")
    return np.minimum(np.floor(place).astype(int), knots["points"] - 4)  # the last piece has its end


def moved(problem, p):
    """Each sensor's sample times in time of the motion."""
    of = split(np.asarray(p), len(problem["chain"]["joints"]))
    t = np.asarray(problem["imu"]["times"])
    shifted = t + of["rate"] * (t - problem["imu"]["middle"])
    return [shifted + of["delay_a"], shifted + of["delay_g"]]


def predicted(problem, readings, segments, points, p):
    knots, times = problem["knots"], np.asarray(problem["imu"]["times"])
    for reading, k in zip(readings, segments):
        # All four control points of a sample side by side: map() takes blocks of columns.
        local = points[:, (k[:, None] + np.arange(4)).ravel().tolist()]
        begin = (knots["start"] + knots["spacing"] * k)[None, :]
        yield reading.map(len(times))(local, begin, times[None, :], ca.repmat(p, 1, len(times)))


def log_matrix(problem):
    knots, times = problem["knots"], np.asarray(problem["joint_log"]["times"])
    k = pieces(problem, times)
    u = (times - knots["start"]) / knots["spacing"] - k
    weights = np.zeros((len(times), knots["points"]))
    np.put_along_axis(weights, k[:, None] + np.arange(4), (u[:, None] ** np.arange(4)) @ CUBIC, axis=1)
    return weights


def residuals(problem, readings, segments, x):
    n, count = len(problem["chain"]["joints"]), problem["knots"]["points"]
    points, p = ca.reshape(x[: n * count], n, count), x[n * count :]
    imu, log, prior = problem["imu"], problem["joint_log"], problem["prior"]
    parts = []
    for y, value in zip(("accelerometer", "gyroscope"), predicted(problem, readings, segments, points, p)):
        parts.append(ca.vec(value - np.transpose(imu[y])) / imu[f"{y}_sd"])
    scale = 1 / np.asarray(log["sd"])
    difference = ca.mtimes(points, ca.sparsify(ca.DM(log_matrix(problem))).T) - np.transpose(log["positions"])
    parts.append(ca.vec(ca.mtimes(ca.diag(ca.DM(scale)), difference)))
    known = [i for i, sd in enumerate(prior["sd"]) if sd is not None]
    mean, sd = np.array(prior["mean"])[known], np.array([prior["sd"][i] for i in known])
    parts.append((p[known] - mean) / sd)
    return ca.vertcat(*parts)


def solve(problem):
    n, count = len(problem["chain"]["joints"]), problem["knots"]["points"]
    size = 35 + 7 * n
    if len(problem["prior"]["mean"]) != size or len(problem["prior"]["sd"]) != size:
        sys.exit(f"machine_estimate: the prior needs {size} entries")
    readings = model(problem)
    log = np.asarray(problem["joint_log"]["positions"])
    points = np.linalg.lstsq(log_matrix(problem), log, rcond=None)[0]
    x = np.concatenate([points.ravel(), problem.get("start") or problem["prior"]["mean"]]).astype(float)
    segments = [pieces(problem, times) for times in moved(problem, x[n * count :])]
    for rounds in range(1, 21):
        z = ca.MX.sym("z", len(x))
        r = residuals(problem, readings, segments, z)
        function = ca.Function("r", [z], [r, ca.jacobian(r, z)])
        length = np.linalg.norm(np.asarray(function(x)[1]), axis=0)
        if not length.all():
            sys.exit(f"machine_estimate: nothing measures the unknowns {np.flatnonzero(length == 0).tolist()} (points first)")
        scale = 1 / length
        s = ca.MX.sym("s", len(x))
        cost = ca.Function("cost", [z], [ca.sumsqr(r) / 2])
        answer = ca.nlpsol("solver", "ipopt", {"x": s, "f": cost(x + scale * s)}, IPOPT)
        x = x + scale * np.asarray(answer(x0=0)["x"]).ravel()
        status = answer.stats()["return_status"]
        now = [pieces(problem, times) for times in moved(problem, x[n * count :])]
        changed = sum(int((a != b).sum()) for a, b in zip(now, segments))
        segments = now
        if not changed:
            break
    value, jacobian = (np.asarray(a) for a in function(x))
    scale = 1 / np.linalg.norm(jacobian, axis=0)
    triangle = np.linalg.qr(np.hstack([jacobian * scale, value]), mode="r")
    inverse = np.linalg.inv(triangle[n * count : -1, n * count : -1]) * scale[n * count :, None]
    covariance = inverse @ inverse.T  # the last block of R holds the parameters with the control points marginalised
    step = inverse @ triangle[n * count : -1, -1]
    return {
        "parameters": x[n * count :].tolist(),
        "covariance": covariance.tolist(),
        "points": x[: n * count].reshape(count, n).tolist(),
        "cost": float((value**2).sum() / 2),
        "residuals": len(value),
        "unknowns": len(x),
        "last_step_sd": float(np.abs(step / np.sqrt(np.diag(covariance))).max()),
        "rounds": rounds,
        "pieces_changed": changed,
        "ipopt": status,
    }


def example(seed):
    """Two joints, 6 s: the second axis is tilted, and the truth is drawn from the prior."""
    rng = np.random.default_rng(seed)
    n, h = 2, 0.2
    identity = np.eye(3).ravel().tolist()
    turn = [1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0]
    joints = [
        {"translation": [0.0, 0.0, 0.3], "rotation": identity, "kind": "revolute", "axis": [0.0, 0.6, 0.8]},
        {"translation": [0.1, 0.0, 0.4], "rotation": turn, "kind": "revolute", "axis": [0.0, 0.0, 1.0]},
    ]
    t, s = np.arange(0.2, 6.2, 0.02), np.linspace(0.0, 6.4, 641)
    count = 35
    sd = [0.1] * 3 + [5e-3] * 9 + [0.01] * 3 + [5e-3] * 9 + [2e-3] * 3 + [0.009] * 3 + [0.009] * 2 + [0.01] * 2 + [1e-4]
    sd += [3e-4] * (7 * n)
    mean = [0.0] * 3 + identity + [0.0] * 3 + identity + [0.02, -0.03, 0.04] + [0.0] * (8 + 7 * n)
    problem = {
        "chain": {"joints": joints, "tip": {"translation": [0.3, 0.0, 0.0], "rotation": identity}},
        "knots": {"start": 0.0, "spacing": h, "points": count},
        "joint_log": {"times": s.tolist(), "sd": [1e-4] * n},
        "imu": {"times": t.tolist(), "accelerometer_sd": 0.02, "gyroscope_sd": 2e-3, "middle": float((t[0] + t[-1]) / 2)},
        "gravity": 9.80665,
        "mounting": identity,
        "prior": {"mean": mean, "sd": [None] * 24 + sd[24:]},  # nothing is known of the sensor
    }
    truth = np.array(mean) + np.array(sd) * rng.standard_normal(len(mean))
    x = np.arange(count)[:, None]
    points = 1.2 * np.sin(x * [0.35, 0.52] + rng.uniform(0, 6, n)) + 0.1 * rng.standard_normal((count, n))
    segments = [pieces(problem, times) for times in moved(problem, truth)]
    values = predicted(problem, model(problem), segments, ca.DM(points.T), ca.DM(truth))
    for name, value in zip(("accelerometer", "gyroscope"), values):
        clean = np.asarray(ca.evalf(value) if isinstance(value, ca.MX) else value).T
        problem["imu"][name] = (clean + problem["imu"][f"{name}_sd"] * rng.standard_normal(clean.shape)).tolist()
    q = log_matrix(problem) @ points
    problem["joint_log"]["positions"] = (q + 1e-4 * rng.standard_normal(q.shape)).tolist()
    problem["truth"] = truth.tolist()
    return problem


def main(arguments):
    if arguments[0] == "--example":
        with open(arguments[1], "w") as file:
            json.dump(example(int(arguments[2]) if len(arguments) > 2 else 1), file)
        return 0
    with open(arguments[0]) as file:
        problem = json.load(file)
    result = solve(problem)
    with open(arguments[1], "w") as file:
        json.dump(result, file, indent=1)
    freedom = result["residuals"] - result["unknowns"]
    print(f"{result['ipopt']}, rounds {result['rounds']}, samples whose piece changed last: {result['pieces_changed']}")
    print(f"cost {result['cost']:.6f} with {freedom} degrees of freedom; step left {result['last_step_sd']:.1e} sd")
    if "truth" in problem:
        error = np.array(result["parameters"]) - problem["truth"]
        weighted = error @ np.linalg.solve(result["covariance"], error)
        print(f"squared error in sd: {weighted:.1f} with {len(error)} parameters")
    return int(result["last_step_sd"] > TOLERANCE or result["pieces_changed"] > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]) if len(sys.argv) > 2 else __doc__)
