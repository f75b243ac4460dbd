"""The best trajectory of an arm for its IMU, by CasADi and IPOPT; and how long calibrant takes to a trajectory as good.

The problem is that of a case file (JSON): minimise ln det C over the control points of cubic splines of the joints, C the covariance of the 24 parameters of an
accelerometer and a gyroscope with every nuisance (lever arm, mounting, tilt, zeros, geometry, delays, clock) under its prior; limits of positions, velocities, accelerations and jerks
on control points; ranges of the sensor, tip speed and distances of capsules at collocation times. All functions are CasADi's: the recursion over the chain below, with algorithmic
derivatives. The Hessian is IPOPT's limited memory: the exact one takes minutes.

An engineer's way: the start is that of 30 random smooth motions within the joint limits which collides least, if at all; 28 control points per joint, then 53. IPOPT's time is that until its
iterate is feasible (1e-4) and within 0.05 of its best value. calibrant's is that of the whole command on as many control points: all starts, proofs, and the file.
Both are processor time.
What IPOPT's answer breaks between collocation times is printed, and forgiven; calibrant's answer has been proved.

Usage: arm.py CASE.json [--case PROGRAM] [options]    PROGRAM: cargo's example `case` of calibrant-machine-design (PROGRAM CASE.json trajectory.csv SEED STARTS)
Exit status 1 where calibrant does not reach IPOPT's best value, or is less than --times faster.
"""

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import casadi as ca  # noqa: E402  (threads must be set first)
import numpy as np  # noqa: E402

FEASIBLE, NEAR = 1e-4, 0.05
IPOPT = {
    "ipopt.hessian_approximation": "limited-memory",
    "ipopt.limited_memory_max_history": 15,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-3,
    "ipopt.acceptable_tol": 1e-2,
    "ipopt.mu_strategy": "monotone",
    "print_time": False,
}
GAUSS = {28: 5, 53: 4}  # points of an interval for the integral
COLLOCATION = {28: 4, 53: 3}  # times of an interval for ranges and distances
BACK_OFF_M, BACK_OFF = 0.0025, 0.008  # what is left for the time between collocation times


def fixed_transform(origin):
    """Rotation and translation of a URDF's origin."""
    if origin is None:
        return np.eye(3), np.zeros(3)
    r, p, y = (float(x) for x in origin.get("rpy", "0 0 0").split())
    x = np.array([[1, 0, 0], [0, np.cos(r), -np.sin(r)], [0, np.sin(r), np.cos(r)]])
    m = np.array([[np.cos(p), 0, np.sin(p)], [0, 1, 0], [-np.sin(p), 0, np.cos(p)]])
    z = np.array([[np.cos(y), -np.sin(y), 0], [np.sin(y), np.cos(y), 0], [0, 0, 1]])
    return z @ m @ x, np.array([float(v) for v in origin.get("xyz", "0 0 0").split()])


def chain(case, folder):
    """[(rotation, translation, axis)] of the joints, and the tip's fixed transform."""
    parents = {j.find("child").get("link"): j for j in ElementTree.parse(folder / case["urdf"]).getroot().findall("joint")}
    path, link = [], case["tip"]
    while link != case["base"]:
        path.append(parents[link])
        link = parents[link].find("parent").get("link")
    joints, rotation, shift = [], np.eye(3), np.zeros(3)
    for joint in path[::-1]:
        turn, move = fixed_transform(joint.find("origin"))
        rotation, shift = rotation @ turn, shift + rotation @ move
        if joint.get("type") == "revolute":
            joints.append((rotation, shift, np.array([float(x) for x in joint.find("axis").get("xyz").split()])))
            rotation, shift = np.eye(3), np.zeros(3)
    return joints, (rotation, shift)


def turn(axis, angle):
    k = ca.DM(np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]]))
    return ca.DM.eye(3) + ca.sin(angle) * k + (1 - ca.cos(angle)) * ca.mtimes(k, k)


class Model:
    """Functions of one time: what is felt, the information, the limits."""

    def __init__(self, case, folder):
        self.case, (self.joints, self.tip) = case, chain(case, folder)
        self.n = n = len(self.joints)
        self.up = np.array(case["up"], float)
        self.q, self.v, self.a, self.j = (ca.SX.sym(name, n) for name in "qvaj")
        priors = case["priors"]
        groups = [("lever", 3, priors["lever_m"]), ("mount", 3, priors["mount_rad"]), ("tilt", 2, priors["tilt_rad"]), ("gravity", 1, priors["gravity_mps2"]),
                  ("zero", n, priors["zero_rad"]), ("shift", 3 * n, priors["geometry_m"]), ("turn", 3 * n, priors["geometry_rad"])]
        self.unknown = {name: ca.SX.sym(name, size) for name, size, sd in groups if sd > 0}
        self.sds = np.concatenate([np.full(size, sd) for _, size, sd in groups if sd > 0])
        self.of = lambda name, size: self.unknown.get(name, ca.DM.zeros(size))

    def felt(self):
        """Specific force and rate of the sensor, to first order in the unknowns."""
        n, case = self.n, self.case
        small = lambda d: ca.SX.eye(3) + ca.skew(d)
        first = np.eye(3)[(np.argmax(np.abs(self.up)) + 1) % 3]
        first = first - self.up * (first @ self.up)
        first /= np.linalg.norm(first)
        tilt = self.of("tilt", 2)
        lean = tilt[0] * first + tilt[1] * np.cross(self.up, first)
        a = (case["gravity_mps2"] + self.of("gravity", 1)) * ca.mtimes(small(lean), self.up)
        w, dw = ca.SX.zeros(3), ca.SX.zeros(3)

        def carried(rotation, shift, a, w, dw):
            a = a + ca.cross(dw, shift) + ca.cross(w, ca.cross(w, shift))
            return (ca.mtimes(rotation.T, x) for x in (a, w, dw))

        for i, (rotation, shift, axis) in enumerate(self.joints):
            moved = shift + ca.mtimes(rotation, self.of("shift", 3 * n)[3 * i : 3 * i + 3])
            turned = ca.mtimes(ca.SX(rotation), small(self.of("turn", 3 * n)[3 * i : 3 * i + 3]))
            a, w, dw = carried(turned, moved, a, w, dw)
            q = turn(axis, self.q[i] + self.of("zero", n)[i])
            a, w, dw = (ca.mtimes(q.T, x) for x in (a, w, dw))
            dw = dw + ca.cross(w, ca.SX(axis)) * self.v[i] + axis * self.a[i]
            w = w + axis * self.v[i]
        a, w, dw = carried(ca.SX(self.tip[0]), ca.SX(self.tip[1]), a, w, dw)
        sensor = case["sensor"]
        angle = np.linalg.norm(sensor.get("rotvec", [0, 0, 0]))
        nominal = turn(np.array(sensor["rotvec"]) / angle, angle) if angle > 0 else ca.SX.eye(3)
        a, w, _ = carried(ca.mtimes(nominal, small(self.of("mount", 3))), ca.SX(sensor["lever_m"]) + self.of("lever", 3), a, w, dw)
        return ca.vertcat(a, w)

    def sample(self):
        """Information of one second at (q, v, a, j) and time from the middle, as a vector."""
        y, case, n = self.felt(), self.case, self.n
        unknowns = ca.vertcat(*self.unknown.values())
        at = ca.SX.zeros(unknowns.shape)
        by_unknowns = ca.substitute(ca.jacobian(y, unknowns), unknowns, at)
        y = ca.substitute(y, unknowns, at)
        rate = ca.jtimes(y, ca.vertcat(self.q, self.v, self.a), ca.vertcat(self.v, self.a, self.j))
        t = ca.SX.sym("t")
        delays = ca.vertcat(ca.horzcat(rate[:3], ca.SX.zeros(3)), ca.horzcat(ca.SX.zeros(3), rate[3:]))
        nuisance = ca.horzcat(by_unknowns, delays, rate * t)
        noise = case["noise"]
        speed = ca.sumsqr(self.v)
        grown = 1 + (noise.get("moving_factor", 1.0) ** 2 - 1) * speed / (speed + noise.get("moving_speed", 0.2) ** 2)
        rows = []
        for s, density in enumerate((noise["acc_mps2_rthz"], noise["gyr_radps_rthz"])):
            for i in range(3):
                own = ca.SX.zeros(1, 24)
                own[0, 12 * s + 4 * i] = 1
                own[0, 12 * s + 4 * i + 1 : 12 * s + 4 * i + 4] = y[3 * s : 3 * s + 3].T
                rows.append(ca.horzcat(own, nuisance[3 * s + i, :]) / density)
        rows = ca.vertcat(*rows)
        information = ca.mtimes(rows.T, rows) / grown
        self.size = information.shape[0]
        self.lower = ca.tril(ca.DM.ones(self.size, self.size)).sparsity()
        lower = ca.project(information, self.lower)
        self.y = ca.Function("y", [self.q, self.v, self.a], [y])
        entries = ca.vertcat(*[lower.nz[k] for k in range(lower.nnz())])
        return ca.Function("sample", [self.q, self.v, self.a, self.j, t], [entries])

    def value(self):
        """ln det of the covariance of the 24 parameters, of the entries of the information."""
        entries = ca.SX.sym("entries", self.lower.nnz())
        lower = ca.densify(ca.SX(self.lower, entries))
        information = lower + lower.T - ca.diag(ca.diag(lower))
        p, priors = self.size - 24, self.case["priors"]
        prior = np.zeros((p, p))
        prior[np.arange(p - 3), np.arange(p - 3)] = 1 / self.sds**2
        common, difference = 0.25 / priors["delay_s"] ** 2, 1 / priors["delay_difference_s"] ** 2
        prior[p - 3, p - 3] = prior[p - 2, p - 2] = common + difference
        prior[p - 3, p - 2] = prior[p - 2, p - 3] = common - difference
        prior[p - 1, p - 1] = 1 / priors["clock"] ** 2
        nuisances = information[24:, 24:] + prior
        whole = ca.blockcat([[information[:24, :24], information[:24, 24:]], [information[24:, :24], nuisances]])
        logarithm = lambda m: 2 * ca.sum1(ca.log(ca.diag(ca.chol(m))))
        return ca.Function("value", [entries], [logarithm(nuisances) - logarithm(whole)])

    def limits(self, margin, back):
        """Ranges, tip speed and distances at one time: at least 0 each, in parts of the limit, and in m."""
        case = self.case
        y = self.y(self.q, self.v, self.a)
        rows = [1 - (y[:3] / (case["range"]["f_mps2"] * (1 - back))) ** 2, 1 - (y[3:] / (case["range"]["w_radps"] * (1 - back))) ** 2]
        rotation, place = ca.SX.eye(3), ca.SX.zeros(3)
        frames = [(rotation, place)]
        for i, (fixed, shift, axis) in enumerate(self.joints):
            place = place + ca.mtimes(rotation, shift)
            rotation = ca.mtimes(ca.mtimes(rotation, fixed), turn(axis, self.q[i]))
            frames.append((rotation, place))
        if case.get("tip_speed_mps"):
            tip = place + ca.mtimes(rotation, self.tip[1])
            rows.append(1 - ca.sumsqr(ca.jtimes(tip, self.q, self.v)) / (case["tip_speed_mps"] * (1 - back)) ** 2)
        ends = []
        for capsule in case["capsules"]:
            rotation, place = frames[capsule["frame"]]
            ends.append([place + ca.mtimes(rotation, ca.DM(capsule[k])) for k in "ab"])
        length = [np.linalg.norm(np.subtract(capsule["a"], capsule["b"])) for capsule in case["capsules"]]
        for i, j in case["pairs"]:
            least = case["capsules"][i]["r"] + case["capsules"][j]["r"] + margin
            rows.append((squared_distance(ends[i], ends[j], length[i], length[j]) - least**2) / (2 * least))
        floor = case["world"].get("floor_z")
        for capsule, pair in zip(case["capsules"], ends):
            if floor is not None and capsule["frame"] >= 2:
                rows += [end[2] - capsule["r"] - floor - margin for end in pair]
        assert not case["world"].get("boxes"), "boxes are not in this script"
        return ca.Function("limits", [self.q, self.v, self.a], [ca.vertcat(*rows)])


def squared_distance(one, other, length, other_length):
    """Of two segments, by clamped parameters (Ericson, Real-Time Collision Detection, 5.1.9)."""
    clamp = lambda x: ca.fmax(0, ca.fmin(1, x))
    p, d, r, e = one[0], one[1] - one[0], other[0], other[1] - other[0]
    w = p - r
    a, b, c, f, g = ca.sumsqr(d), ca.dot(d, e), ca.dot(d, w), ca.sumsqr(e), ca.dot(e, w)
    s = t = 0
    if length > 1e-6 and other_length > 1e-6:
        s = clamp((b * g - c * f) / (a * f - b * b + 1e-9))
        t = clamp((b * s + g) / f)
        s = clamp((b * t - c) / a)
    elif length > 1e-6:
        s = clamp(-c / a)
    elif other_length > 1e-6:
        t = clamp(g / f)
    return ca.sumsqr(w + s * d - t * e)


def spline(points, step, t):
    """Matrices from control points to position, velocity, acceleration, jerk at times t."""
    k = np.clip(np.floor(t / step + 1e-12).astype(int), 0, points - 4)
    u = t / step - k
    values = [
        np.stack([(1 - u) ** 3, 3 * u**3 - 6 * u**2 + 4, -3 * u**3 + 3 * u**2 + 3 * u + 1, u**3]) / 6,
        np.stack([-((1 - u) ** 2), 3 * u**2 - 4 * u, -3 * u**2 + 2 * u + 1, u**2]) / 2 / step,
        np.stack([1 - u, 3 * u - 2, -3 * u + 1, u]) / step**2,
        np.outer([-1, 3, -3, 1], np.ones_like(u)) / step**3,
    ]
    matrices = []
    for of in values:
        matrix = np.zeros((len(t), points))
        for m in range(4):
            matrix[np.arange(len(t)), k + m] = of[m]
        matrices.append(matrix)
    return matrices


class Problem:
    """The program of one number of control points."""

    def __init__(self, model, points, margin_m):
        case, n = model.case, model.n
        self.model, self.points, self.duration = model, points, case["duration_s"]
        self.step = step = self.duration / (points - 3)
        ends = np.zeros((points, points - 4))  # the first three are one, and the last three
        for k in range(points):
            ends[k, min(max(k - 2, 0), points - 5)] = 1
        assert case.get("home") is None, "a free posture of rest"
        x = ca.MX.sym("x", (points - 4) * n)
        controls = ca.mtimes(ca.DM(ca.sparsify(ends)), ca.reshape(x, points - 4, n))
        self.controls = ca.Function("controls", [x], [controls])

        nodes, weights = np.polynomial.legendre.leggauss(GAUSS.get(points, 4))
        t = ((np.arange(points - 3)[:, None] + (nodes + 1) / 2) * step).ravel()
        weights = np.tile(weights * step / 2, points - 3)
        states = [ca.mtimes(ca.sparsify(ca.DM(m)), controls).T for m in spline(points, step, t)]
        sampled = model.sample().map(len(t), "serial")(*states, ca.DM(t - self.duration / 2).T)
        value = model.value()(ca.mtimes(sampled, weights))

        each = COLLOCATION.get(points, 3)
        t = np.arange((points - 3) * each + 1) * step / each
        states = [ca.mtimes(ca.sparsify(ca.DM(m)), controls).T for m in spline(points, step, t)[:3]]
        limits = model.limits(margin_m, BACK_OFF)
        rows = [ca.vec(limits.map(len(t), "serial")(*states))]
        low, high = [np.zeros(rows[0].shape[0])], [np.full(rows[0].shape[0], np.inf)]
        self.promised = model.limits(case["clearance_m"], 0.0)
        joints = case["joints"]
        difference = np.eye(points)
        for order, key in enumerate((None, "velocity", "acceleration", "jerk")):
            if order:
                difference = np.diff(difference, axis=0) / step
            largest = np.array(joints[key]) if key else np.array(joints["upper"])
            lowest = -largest if key else np.array(joints["lower"])
            used = difference[np.abs(difference @ ends).max(axis=1) > 1e-9]
            scale = np.tile((largest - lowest) / 2, (len(used), 1))
            rows.append(ca.vec(ca.mtimes(ca.sparsify(ca.DM(used)), controls) / scale))
            low.append((np.tile(lowest, (len(used), 1)) / scale).T.ravel())
            high.append((np.tile(largest, (len(used), 1)) / scale).T.ravel())
        self.low, self.high = np.concatenate(low), np.concatenate(high)
        self.nlp = {"x": x, "f": value, "g": ca.vertcat(*rows)}
        self.watch = Watch(x.shape[0], self.nlp["g"].shape[0], self.low, self.high)
        self.solver = None

    def solve(self, start, seconds):
        """The trace (processor time, value, largest violation), and the answer."""
        if self.solver is None:
            self.solver = ca.nlpsol("arm", "ipopt", self.nlp, IPOPT | {"iteration_callback": self.watch, "ipopt.max_cpu_time": seconds, "ipopt.max_iter": 3000})
        self.watch.trace = []
        self.watch.begun = time.process_time()
        answer = self.solver(x0=start, lbg=self.low, ubg=self.high)
        return self.watch.trace, np.array(answer["x"]).ravel(), self.solver.stats()["return_status"]

    def start(self, rng, tries=30):
        """Of random motions the one that leaves ranges and distances most room, or breaks them least."""
        return max((self.random(rng) for _ in range(tries)), key=lambda x: self.between(x, 300))

    def random(self, rng, room=0.8):
        """A smooth random motion within the joint limits."""
        case, n, count = self.model.case, self.model.n, self.points - 4
        joints = case["joints"]
        lower, upper = np.array(joints["lower"]), np.array(joints["upper"])
        t = np.arange(count) * self.step
        motion = np.zeros((count, n))
        for _ in range(4):
            motion += rng.normal(size=n) * np.sin(2 * np.pi * np.outer(t, rng.uniform(0.05, 0.35, n)) + rng.uniform(0, 2 * np.pi, n))
        ramp = np.clip(np.minimum(t, t[::-1]) / 2.5, 0, 1)
        motion *= (ramp**3 * (10 - 15 * ramp + 6 * ramp**2))[:, None]
        free = np.vstack([motion[:1]] * 2 + [motion] + [motion[-1:]] * 2)
        for j in range(n):
            used, points = 0.0, free[:, j]
            for order, key in ((1, "velocity"), (2, "acceleration"), (3, "jerk")):
                used = max(used, np.abs(np.diff(points, order)).max() / self.step**order / joints[key][j])
            used = max(used, np.ptp(points) / (upper[j] - lower[j]))
            motion[:, j] *= room / used
        middle = (upper + lower) / 2 - (motion.max(axis=0) + motion.min(axis=0)) / 2
        spare = (upper - lower - np.ptp(motion, axis=0)) / 2
        return (motion + middle + 0.9 * spare * rng.uniform(-1, 1, n)).T.ravel()

    def between(self, x, times=4000):
        """Least room of ranges and distances at so many times, by the limits themselves."""
        controls = np.array(self.controls(x))
        t = np.linspace(0, self.duration, times)
        states = [(m @ controls).T for m in spline(self.points, self.step, t)[:3]]
        return float(np.array(self.promised.map(times)(*states)).min())


class Watch(ca.Callback):
    """Notes value and violation of each iterate."""

    def __init__(self, nx, ng, low, high):
        ca.Callback.__init__(self)
        self.nx, self.ng, self.low, self.high, self.trace, self.begun = nx, ng, low, high, [], 0.0
        self.construct("watch")

    def get_n_in(self):
        return ca.nlpsol_n_out()

    def get_n_out(self):
        return 1

    def get_sparsity_in(self, i):
        size = {"x": self.nx, "lam_x": self.nx, "g": self.ng, "lam_g": self.ng, "f": 1, "lam_p": 0}[ca.nlpsol_out(i)]
        return ca.Sparsity.dense(size)

    def eval(self, given):
        names = [ca.nlpsol_out(i) for i in range(ca.nlpsol_n_out())]
        g = np.array(given[names.index("g")]).ravel()
        violation = max(0.0, (self.low - g).max(), (g - self.high).max())
        self.trace.append((time.process_time() - self.begun, float(given[names.index("f")]), violation))
        return [0]


def calibrant(program, case, seed, starts, knot_s):
    """Value and processor time of one command."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([program, case, Path(folder) / "trajectory.csv", str(seed), str(starts), "D", str(knot_s)], capture_output=True, text=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    value = float(re.match(r"(-?[\d.]+)", done.stdout).group(1))
    return value, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("case_file", type=Path)
    p.add_argument("--case", help="program that designs with calibrant; without it IPOPT alone")
    p.add_argument("--points", type=int, nargs="+", default=[28, 53])
    p.add_argument("--starts", type=int, default=3, help="of IPOPT, for each number of control points")
    p.add_argument("--seconds", type=float, default=150, help="processor time of a start of IPOPT at most")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--calibrant-starts", type=int, nargs="+", default=[1, 2, 4, 8], help="the first that reaches IPOPT's value counts")
    p.add_argument("--times", type=float, default=20)
    o = p.parse_args()
    case = json.loads(o.case_file.read_text())
    model = Model(case, o.case_file.resolve().parent.parent)

    best = {}
    for points in o.points:
        problem = Problem(model, points, case["clearance_m"] + BACK_OFF_M)
        for k in range(o.starts):
            trace, x, status = problem.solve(problem.start(np.random.default_rng([o.seed, k])), o.seconds)
            feasible = [(t, f) for t, f, violation in trace if violation <= FEASIBLE]
            if not feasible:
                print(f"  {points} control points, start {k}: nothing feasible in {trace[-1][0]:.1f} s ({status}), {len(trace)} iterations", flush=True)
                continue
            value = min(f for _, f in feasible)
            until = next(t for t, f in feasible if f <= value + NEAR)
            print(f"  {points} control points, start {k}: {value:.2f} after {until:.1f} s ({len(trace)} iterations, {trace[-1][0]:.1f} s, {status}); least room between {problem.between(x):.1e}", flush=True)
            if points not in best or value < best[points][0]:
                best[points] = value, until
    failed = not best
    if o.case:
        for points, (value, until) in best.items():
            knot_s = case["duration_s"] / (points - 3)
            rows = [(starts, *calibrant(o.case, o.case_file, o.seed, starts, knot_s)) for starts in o.calibrant_starts]
            for starts, found, seconds in rows:
                print(f"  calibrant, {points} control points, {starts} starts: {found:.2f} in {seconds:.2f} s")
            reached = [seconds for _, found, seconds in rows if found <= value]
            ratio = until / min(reached) if reached else 0.0
            failed |= ratio < o.times
            print(f"{case['name']}: IPOPT's best of {points} control points {value:.2f} after {until:.1f} s; " + (f"calibrant in {min(reached):.2f} s, {ratio:.0f} times faster" if reached else "calibrant does not reach it"))
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
