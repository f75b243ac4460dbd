"""A design problem as a nonlinear program for CasADi and IPOPT.

    minimise over a:  phi(C(a)),  C = F^-1,  F = sum over axes of G' V^-1 G      subject to |rows a| <= limits

Written as a user would who knows CasADi: SX expressions with exact second derivatives, unknowns and objective of order one, one
solver for all starts, no printing. All readings lie in the span of the basis B = [1, added increments] = U R (QR, once, in numbers), so
N + 1 numbers per axis say as much as the M samples, and V is of that size. What is not smooth becomes smooth with more unknowns:

    |u| of the process noise   w >= u, w >= -u                  (more noise never helps, so w = |u| at the optimum)
    M                          t >= C_ii
    E                          F - t I = L L', t as large as can be
"""

import os
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import casadi as ca  # noqa: E402  (threads must be set first)
import numpy as np  # noqa: E402

OBJECTIVE = 1e4  # the objective at the start: A hardly changes between good and bad motions, and IPOPT stops on small gradients
OPTIONS = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,  # the line search tries motions where F is singular to rounding; IPOPT backs off
    "ipopt.linear_solver": "mumps",
    "ipopt.nlp_scaling_method": "none",
    "ipopt.max_iter": 300,
    "ipopt.tol": 1e-8,
    "ipopt.fast_step_computation": "yes",
    "ipopt.mu_init": 1.0,  # a little better than 0.1 here, in time and in optima found; \"adaptive\" takes twice as long
}


def cholesky(a):
    """L with L L' = A, in symbols, without pivoting."""
    n = a.shape[0]
    lower = ca.SX(n, n)
    for j in range(n):
        lower[j, j] = ca.sqrt(a[j, j] - ca.sumsqr(lower[j, :j]))
        for i in range(j + 1, n):
            lower[i, j] = (a[i, j] - ca.dot(lower[i, :j], lower[j, :j])) / lower[j, j]
    return lower


def forward(lower, right):
    """L^-1 B by forward substitution."""
    rows = []
    for i in range(lower.shape[0]):
        row = right[i, :]
        for j in range(i):
            row = row - lower[i, j] * rows[j]
        rows.append(row / lower[i, i])
    return ca.vertcat(*rows)


def increments(nodes):
    """[a_0; a_1 - a_0; ...] in symbols."""
    return ca.vertcat(nodes[0, :], nodes[1:, :] - nodes[:-1, :])


def coupled_axes(problem):
    """Axes whose readings must be treated together: all, where process noise reaches them through a matrix that is not diagonal."""
    diagonal = np.count_nonzero(problem.matrix - np.diag(np.diag(problem.matrix))) == 0
    if problem.noisy and not diagonal:
        return [list(range(problem.axes))]
    return [[axis] for axis in range(problem.axes)]


def process_spread(problem, size, axis, root):
    """R_z Q R_z' of one axis: covariance of the compressed stimulus, from |u| = size."""
    q = ((problem.floor + problem.ratio * size[:, axis]) * problem.interval_s) ** 2
    spread = ca.mtimes([root, ca.diag(q), root.T])
    if problem.both_ends:
        image = ca.mtimes(root, q)
        spread -= ca.mtimes(image, image.T) / ca.sum1(q)
    return spread


def information_blocks(problem, nodes, size):
    """Pairs (places of the parameters, their information): blocks of F that do not touch each other."""
    r = np.linalg.qr(problem.basis, mode="r")
    whole, root = ca.sparsify(ca.DM(np.triu(r))), ca.sparsify(ca.DM(np.triu(r)[:, 1:]))
    stimulus = ca.mtimes(whole, increments(nodes))
    spread = [process_spread(problem, size, axis, root) for axis in range(problem.axes)] if problem.noisy else None
    return [axes_information(problem, axes, whole, stimulus, spread) for axes in coupled_axes(problem)]


def axes_information(problem, axes, whole, stimulus, spread):
    """F = (L^-1 G)'(L^-1 G), L L' = V, of the readings of these axes."""
    places, designs = [], []
    for row in axes:
        places += problem.places(row)
        # gravity is a constant beside the motion
        sensed = [stimulus[:, column] + whole[:, 0] * float(problem.force[column]) for column in problem.columns(row)]
        designs.append(ca.horzcat(whole[:, 0], *sensed))
    design = ca.diagcat(*designs)
    if not problem.noisy:
        whitened = design / problem.noise[axes[0]]
        return places, ca.mtimes(whitened.T, whitened)
    own = np.eye(problem.intervals + 1)
    rows = [[sum(problem.matrix[r, m] * problem.matrix[q, m] * spread[m] for m in axes) for q in axes] for r in axes]
    for k, row in enumerate(axes):
        rows[k][k] = rows[k][k] + problem.noise[row] ** 2 * own
    v = ca.vertcat(*[ca.horzcat(*blocks) for blocks in rows])
    # in units of the noise, so that L is of order one
    unit = problem.noise[axes[0]]
    whitened = forward(cholesky(v / unit**2), ca.densify(design) / unit)
    return places, ca.mtimes(whitened.T, whitened)


class Program:
    """The nonlinear program of a problem: unknowns x = [nodes, velocities, displacements, |u|, t, L], objective, constraints, their bounds."""

    def __init__(self, problem, options=None):
        self.problem = problem
        begin = time.process_time()
        self.unknowns, self.lower, self.upper = [], [], []
        self.constraints, self.least, self.most = [], [], []
        self.unit = self._unit()
        self._motion()
        self.blocks = information_blocks(problem, self.nodes, self.size)
        self.reference = ca.SX.sym("reference")
        objective = self._objective()
        nlp = {"x": ca.vertcat(*self.unknowns), "f": objective, "g": ca.vertcat(*self.constraints), "p": self.reference}
        self.solver = ca.nlpsol("solver", "ipopt", nlp, OPTIONS | (options or {}))
        self.build_s = time.process_time() - begin

    def _unit(self):
        """A size of accelerations that the limits allow, per axis: a limit of a, or of u or v or d over an interval."""
        p, dt = self.problem, self.problem.interval_s
        factors = dict(zip(p.limits, (1.0, dt, 1.0, 1 / dt, 1 / dt**2)))
        return np.min([limit * factors[key] for key, limit in p.limits.items() if limit is not None], axis=0)

    def _largest_step(self):
        """Bounds of |a_{i+1} - a_i| in units: v is a quadratic and d a cubic within +-limit, so |a| <= 8 v/dt, 96 d/dt^2 (Markov)."""
        p, dt = self.problem, self.problem.interval_s
        factors = dict(zip(p.limits, (2.0, dt, np.inf, 16 / dt, 192 / dt**2)))
        return np.min([limit * factors[key] for key, limit in p.limits.items() if limit is not None], axis=0) / self.unit

    def _unknown(self, name, count, low=-np.inf, high=np.inf):
        x = ca.SX.sym(name, count)
        self.unknowns.append(x)
        self.lower.append(np.broadcast_to(np.asarray(low, dtype=float), (count,)))
        self.upper.append(np.broadcast_to(np.asarray(high, dtype=float), (count,)))
        return x

    def _constrain(self, expression, low, high):
        self.constraints.append(expression)
        self.least.append(np.full(expression.numel(), low, dtype=float))
        self.most.append(np.full(expression.numel(), high, dtype=float))

    def _motion(self):
        """Nodes with their limits; limits of the acceleration are bounds on the unknowns."""
        p = self.problem
        limit = p.limits["acceleration_mps2"]
        high = np.inf if limit is None else np.repeat(limit / self.unit, p.intervals + 1)
        x = ca.reshape(self._unknown("a", (p.intervals + 1) * p.axes, -high, high), p.intervals + 1, p.axes)
        self.nodes = x * ca.repmat(ca.DM(self.unit).T, p.intervals + 1, 1)
        for key, rows in zip(("jerk_mps3", "intercept_mps2"), p.lines()):
            if p.limits[key] is not None:
                for axis in range(p.axes):
                    share = rows * (self.unit[axis] / p.limits[key][axis])
                    self._constrain(ca.mtimes(ca.sparsify(ca.DM(share)), x[:, axis]), -1, 1)
        # velocity, and displacement where it is limited, as unknowns at the nodes: rows stay short
        self.orders = 2 if p.limits["displacement_m"] is not None else 1
        self.orders *= p.limits["velocity_mps"] is not None or p.rest_at_end or self.orders == 2
        for axis in range(p.axes * (self.orders > 0)):
            self._path(x[:, axis], axis)
        self.size = self._jerk_size(x) if p.noisy and p.ratio > 0 else ca.SX.zeros(p.intervals, p.axes)

    def _path(self, a, axis):
        """Velocity and displacement of an axis from rest, in units of unit dt and unit dt^2: unknowns at the nodes, limits between them."""
        p = self.problem
        step = self.unit[axis] * p.interval_s ** np.arange(1, self.orders + 1)
        given = [p.limits["velocity_mps"], p.limits["displacement_m"]][: self.orders]
        most = [np.inf if limit is None else limit[axis] / unit for limit, unit in zip(given, step)]
        high = np.repeat(most, p.intervals)
        if p.rest_at_end:
            high[p.intervals - 1] = 0
        state = ca.reshape(self._unknown(f"path{axis}", len(high), -high, high), p.intervals, self.orders)
        state = ca.vertcat(ca.SX.zeros(1, self.orders), state)
        for i in range(p.intervals):
            for l in np.arange(1, p.times_per_interval + 1) / p.times_per_interval:
                rise = a[i + 1] - a[i]
                v = state[i, 0] + l * a[i] + l**2 / 2 * rise
                d = state[i, 1] + l * state[i, 0] + l**2 / 2 * a[i] + l**3 / 6 * rise if self.orders == 2 else None
                for order, reached in enumerate([v, d][: self.orders]):
                    if l == 1:
                        self._constrain(reached - state[i + 1, order], 0, 0)
                    elif np.isfinite(most[order]):
                        self._constrain(reached / most[order], -1, 1)

    def _jerk_size(self, x):
        """w >= |u|, which is not smooth where it matters: an interval of constant acceleration is the quietest."""
        p = self.problem
        high = np.repeat(self._largest_step(), p.intervals)
        w = ca.reshape(self._unknown("w", p.intervals * p.axes, 0, high), p.intervals, p.axes)
        step = x[1:, :] - x[:-1, :]
        self._constrain(ca.vec(w - step), 0, np.inf)
        self._constrain(ca.vec(w + step), 0, np.inf)
        return w * ca.repmat(ca.DM(self.unit / p.interval_s).T, p.intervals, 1)

    def _scaled(self, places, f):
        """Information of parameters divided by their scales."""
        scale = ca.diag(ca.DM(self.problem.scale[places]))
        return ca.mtimes([scale, f, scale])

    def _objective(self):
        letter = self.problem.letter
        if letter == "D":
            return sum(self._log_determinant(*block) for block in self.blocks)
        if letter == "E":
            return self._largest_eigenvalue()
        inverses = [(places, forward(cholesky(f), ca.SX.eye(len(places)))) for places, f in self.blocks]
        if letter == "M":
            return self._largest_variance(inverses)
        weights = self.problem.trace_weights()
        total = 0
        for places, inverse in inverses:
            w = weights[np.ix_(places, places)]
            for i, j in zip(*np.nonzero(w)):
                total += w[i, j] * ca.dot(inverse[:, int(i)], inverse[:, int(j)])
        return OBJECTIVE * total / self.reference

    def _log_determinant(self, places, f):
        """ln det (F^-1 + N) of scaled parameters, N = R R' the share of the tilt: ln det (I + R' F R) - ln det F."""
        scaled = self._scaled(places, f)
        value = -2 * ca.sum1(ca.log(ca.diag(cholesky(scaled))))
        share = self.problem.tilt_share()
        scale = self.problem.scale[places]
        own = share[np.ix_(places, places)] / np.outer(scale, scale)
        if not own.any():
            return value
        # blocks are treated by themselves: an upright sensor with a diagonal matrix
        others = np.setdiff1d(np.arange(len(share)), places)
        assert not share[np.ix_(places, others)].any()
        eigenvalues, vectors = np.linalg.eigh(own)
        root = ca.DM(vectors[:, eigenvalues > 1e-12] * np.sqrt(eigenvalues[eigenvalues > 1e-12]))
        inner = ca.SX.eye(root.shape[1]) + ca.mtimes([root.T, scaled, root])
        return value + 2 * ca.sum1(ca.log(ca.diag(cholesky(inner))))

    def _largest_variance(self, inverses):
        t = self._unknown("t", 1, 0)
        for places, inverse in inverses:
            scaled = inverse / ca.repmat(ca.DM(self.problem.scale[places]).T, len(places), 1)
            self._constrain(ca.sum1(scaled**2).T / self.reference - t, -np.inf, 0)
        return t

    def _largest_eigenvalue(self):
        t = self._unknown("t", 1, 0)
        for k, (places, f) in enumerate(self.blocks):
            n = len(places)
            entries = self._unknown(f"l{k}", n * (n + 1) // 2)
            lower = ca.SX(ca.Sparsity.lower(n), entries)
            gap = self._scaled(places, f) * self.reference - t * ca.SX.eye(n) - ca.mtimes(lower, lower.T)
            self._constrain(ca.vertcat(*[gap[i, j] for j in range(n) for i in range(j, n)]), 0, 0)
        return -t

    def start(self, motion):
        """x of a motion, and the value there; |u| is begun a little above what it is, t a little within."""
        p = self.problem
        value = p.value(motion)
        parts = [(motion / self.unit).T.ravel()]
        for axis in range(p.axes):
            states = [rows @ motion[:, axis] / self.unit[axis] for rows in p.path(1)]
            parts += [state / p.interval_s**order for order, state in enumerate(states[: self.orders], start=1)]
        if p.noisy and p.ratio > 0:
            parts.append((np.abs(np.diff(motion, axis=0)) / self.unit).T.ravel() + 0.01)
        if p.letter == "M":
            parts.append([1.1])
        if p.letter == "E":
            parts += [[0.9], *self._factors(motion, 0.9, value)]
        reference = value if p.letter != "D" else 1.0
        return np.concatenate(parts), reference

    def _factors(self, motion, t, value):
        """L of F - t I at a motion, by columns as CasADi stores them."""
        p = self.problem
        f = p.information(motion) * np.outer(p.scale, p.scale) * value
        for places, _ in self.blocks:
            lower = np.linalg.cholesky(f[np.ix_(places, places)] - t * np.eye(len(places)))
            yield np.concatenate([lower[j:, j] for j in range(len(places))])

    def solve(self, motion):
        """Best motion from this start (shrunk by IPOPT's tolerance into its limits), and what the solver says."""
        p = self.problem
        x, reference = self.start(motion)
        begin = time.process_time()
        solution = self.solver(
            x0=x,
            p=reference,
            lbx=np.concatenate(self.lower),
            ubx=np.concatenate(self.upper),
            lbg=np.concatenate(self.least) if self.least else [],
            ubg=np.concatenate(self.most) if self.most else [],
        )
        elapsed = time.process_time() - begin
        count = (p.intervals + 1) * p.axes
        nodes = np.array(solution["x"]).ravel()[:count].reshape(p.axes, -1).T * self.unit
        stats = self.solver.stats()
        return p.shrunk(nodes), stats["return_status"], stats["iter_count"], elapsed
