"""A design problem in NumPy: what the readings of a motion tell of the sensor, its limits, its random starts.

Everything here is dense and literal: it judges the motions of all programs by the formula as it reads, and shares nothing with
calibrant but the JSON file. Shapes: N intervals, n axes (1 or 3), M samples, p parameters; motions are (N + 1, n) accelerations.
"""

import numpy as np

FINE = 1000  # times per interval at which limits are checked
UNLIMITED = 30.0  # stands for a limit that is not given, when starts are drawn


def parameter_names(axes, model):
    """Biases, scale factors, then cross-axis sensitivities by row: `bias.x`, `scale.x`, `matrix.xy`, ..."""
    letters = "xyz"[:axes]
    names = [f"bias.{axis}" for axis in letters] + [f"scale.{axis}" for axis in letters]
    if model == "full":
        names += [f"matrix.{row}{column}" for row in letters for column in letters if row != column]
    return names


class DesignProblem:
    """One problem of the file as arrays.

    `times_per_interval`: at how many times l/times, l = 1 ... times, of each interval velocity and displacement are limited.
    """

    def __init__(self, case, times_per_interval=10):
        self.name = case["name"]
        self.axes, self.model = case["axes"], case["model"]
        self.intervals, self.interval_s = case["intervals"], case["interval_s"]
        self.times_per_interval = times_per_interval
        self.names = parameter_names(self.axes, self.model)
        self.noise = per_axis(case["noise_mps2"], self.axes)
        self.noisy = case["trust"] == "noisy"
        self.both_ends = case["known_ends"] == "both"
        noise = case["input_noise"] if self.noisy else None
        self.floor, self.ratio = (noise["floor_mps3"], noise["ratio"]) if noise else (0.0, 0.0)
        self.matrix = np.array(case["nominal"]["matrix"], dtype=float)[: self.axes, : self.axes]
        limits = case["limits"]
        keys = ("acceleration_mps2", "jerk_mps3", "intercept_mps2", "velocity_mps", "displacement_m")
        self.limits = {key: per_axis(limits.get(key), self.axes) for key in keys}
        self.rest_at_end = limits["rest"] == "both"
        self.letter = case["criterion"]["letter"]
        self.scale = np.array(case["criterion"].get("scale") or np.ones(len(self.names)), dtype=float)
        self.weights = case["criterion"].get("weights") or {}
        self.range = case["criterion"].get("range_mps2")
        gravity = case.get("gravity")
        self.force = np.array(gravity["force_mps2"])[: self.axes] if gravity else np.zeros(self.axes)
        self.offset_covariance = np.array(gravity["offset_covariance"])[: self.axes, : self.axes] if gravity else None
        self._sample(case["rate_hz"])

    def _sample(self, rate_hz):
        """alpha = basis [a_0; increments]: ones, and what each increment has added by t_j, clip((t_j - tau_i)/dt, 0, 1)."""
        duration = self.intervals * self.interval_s
        self.samples = round(duration * rate_hz) + 1
        phase = np.arange(self.samples) / rate_hz / self.interval_s
        added = np.clip(phase[:, None] - np.arange(self.intervals)[None, :], 0, 1)
        self.basis = np.column_stack([np.ones(self.samples), added])

    def columns(self, row):
        """Which components of the stimulus the reading of axis `row` depends on."""
        return range(self.axes) if self.model == "full" else [row]

    def places(self, row):
        """Where the parameters of the reading of axis `row` stand: its bias, then its entries of the matrix."""
        letters = "xyz"
        entry = lambda c: f"scale.{letters[c]}" if c == row else f"matrix.{letters[row]}{letters[c]}"  # noqa: E731
        return [self.names.index(name) for name in [f"bias.{letters[row]}", *map(entry, self.columns(row))]]

    def increments(self, motion):
        """[a_0; a_1 - a_0; ...], the coordinates of a motion in the basis."""
        return np.vstack([motion[:1], np.diff(motion, axis=0)])

    def jerk(self, motion):
        return np.diff(motion, axis=0) / self.interval_s

    def process_covariance(self, motion, axis):
        """Covariance of the increments: Q = diag((floor + ratio |u_i|) dt)^2; the end known too: Q - Q 1 1'Q / 1'Q 1."""
        if not self.noisy:
            return np.zeros((self.intervals, self.intervals))
        q = ((self.floor + self.ratio * np.abs(self.jerk(motion)[:, axis])) * self.interval_s) ** 2
        covariance = np.diag(q)
        if self.both_ends and q.sum() > 0:
            covariance -= np.outer(q, q) / q.sum()
        return covariance

    def information(self, motion):
        """F = G' V^-1 G with V = Sigma + (S x B) Q (S x B)': the marginal covariance of all readings, dense (nM x nM)."""
        n, m = self.axes, self.samples
        alpha, added = self.basis @ self.increments(motion), self.basis[:, 1:]
        g = np.zeros((n * m, len(self.names)))
        v = np.diag(np.repeat(self.noise**2, m))
        spread = [added @ self.process_covariance(motion, axis) @ added.T for axis in range(n)]
        alpha = alpha + self.force
        for row in range(n):
            own = slice(row * m, (row + 1) * m)
            g[own, self.places(row)] = np.column_stack([np.ones(m), alpha[:, list(self.columns(row))]])
            for other in range(n):
                block = slice(other * m, (other + 1) * m)
                for axis in range(n):
                    v[own, block] += self.matrix[row, axis] * self.matrix[other, axis] * spread[axis]
        whitened = np.linalg.solve(np.linalg.cholesky(v), g)
        return whitened.T @ whitened

    def tilt_share(self):
        """Of the covariance: gravity's offset o ~ N(0, P) is a constant S o of the readings, as is the bias."""
        share = np.zeros((len(self.names), len(self.names)))
        if self.offset_covariance is not None:
            share[: self.axes, : self.axes] = self.matrix @ self.offset_covariance @ self.matrix.T
        return share

    def covariance(self, motion):
        """F^-1, the columns of F scaled to unit diagonal first; and the share of the tilt."""
        f = self.information(motion)
        d = 1 / np.sqrt(np.diag(f))
        return np.outer(d, d) * np.linalg.inv(f * np.outer(d, d)) + self.tilt_share()

    def trace_weights(self):
        """W of the criteria that are tr(W C).

        A: 1/scale^2. c: w_i/scale_i^2. I, the mean of |delta s|^2 for s uniform in [-R, R]^n with
        delta s = -S^-1 (delta b + delta S s): (S^-T S^-1)_rq between biases r and q, R^2/3 times it between entries (r, c) and (q, c).
        """
        if self.letter in "Ac":
            weight = [1.0 if self.letter == "A" else self.weights.get(name, 0.0) for name in self.names]
            return np.diag(np.array(weight) / self.scale**2)
        inverse = np.linalg.inv(self.matrix)
        metric, weights = inverse.T @ inverse, np.zeros((len(self.names), len(self.names)))
        for row in range(self.axes):
            for other in range(self.axes):
                left, right = self.places(row), self.places(other)
                weights[left[0], right[0]] = metric[row, other]
                for i, column in zip(left[1:], self.columns(row)):
                    for j, same in zip(right[1:], self.columns(other)):
                        if column == same:
                            weights[i, j] = metric[row, other] * self.range**2 / 3
        return weights

    def criterion(self, covariance):
        """Its value for a covariance. E, M, D: of C_ij / (scale_i scale_j)."""
        scaled = covariance / np.outer(self.scale, self.scale)
        if self.letter == "D":
            d = np.sqrt(np.diag(scaled))
            return float(2 * np.log(d).sum() + np.linalg.slogdet(scaled / np.outer(d, d))[1])
        if self.letter == "E":
            return float(np.linalg.eigvalsh(scaled)[-1])
        if self.letter == "M":
            return float(np.diag(scaled).max())
        return float((self.trace_weights() * covariance).sum())

    def value(self, motion):
        return self.criterion(self.covariance(motion))

    def floor_of_value(self):
        """What biases alone cost whatever the motion does, in A: sum_r (sigma_r / scale_r)^2 / M; else 0."""
        if self.letter != "A" or self.offset_covariance is not None:
            return 0.0
        return float(((self.noise / self.scale[: self.axes]) ** 2).sum() / self.samples)

    def path(self, times_per_interval):
        """Matrices that take the nodes of one axis to velocity and displacement at l/times of each interval, from rest.

        v = v_i + dt (l a_i + l^2/2 (a_{i+1} - a_i)),  d = d_i + l dt v_i + dt^2 (l^2/2 a_i + l^3/6 (a_{i+1} - a_i))
        """
        dt, velocity, displacement = self.interval_s, [], []
        nodes = np.eye(self.intervals + 1)
        v, d = np.zeros(self.intervals + 1), np.zeros(self.intervals + 1)
        for a, b in zip(nodes[:-1], nodes[1:]):
            for fraction in np.arange(1, times_per_interval + 1) / times_per_interval:
                velocity.append(v + dt * (fraction * a + fraction**2 / 2 * (b - a)))
                displacement.append(d + fraction * dt * v + dt**2 * (fraction**2 / 2 * a + fraction**3 / 6 * (b - a)))
            v, d = velocity[-1], displacement[-1]
        return np.array(velocity), np.array(displacement)

    def lines(self):
        """Rows that take the nodes of one axis to the jerks u_i and the intercepts x_i = a_i - u_i tau_i."""
        nodes = np.eye(self.intervals + 1)
        jerk = np.diff(nodes, axis=0) / self.interval_s
        return jerk, nodes[:-1] - jerk * (np.arange(self.intervals) * self.interval_s)[:, None]

    def limited(self, times_per_interval):
        """Pairs (limit per axis, rows): |rows a| <= limit, for each limit given."""
        rows = (np.eye(self.intervals + 1), *self.lines(), *self.path(times_per_interval))
        return [(limit, part) for limit, part in zip(self.limits.values(), rows) if limit is not None]

    def end_velocity(self):
        """The row that takes the nodes of one axis to the velocity at the end."""
        return self.path(1)[0][-1]

    def violation(self, motion, times_per_interval=FINE):
        """How far a motion exceeds its limits, relative to each limit; at rest at the end: velocity over its largest."""
        worst = -np.inf
        for limit, rows in self.limited(times_per_interval):
            worst = max(worst, float((np.abs(rows @ motion) / limit).max()) - 1)
        if self.rest_at_end:
            largest = np.abs(self.path(times_per_interval)[0] @ motion).max(axis=0)
            worst = max(worst, float((np.abs(self.end_velocity() @ motion) / largest).max()))
        return worst

    def shrunk(self, motion):
        """The motion, each axis times the largest factor up to one that keeps its limits: all are linear in it."""
        factor = np.ones(self.axes)
        for limit, rows in self.limited(self.times_per_interval):
            peak = np.abs(rows @ motion).max(axis=0)
            factor = np.minimum(factor, limit / np.maximum(peak, limit))
        return motion * factor

    def random_motion(self, rng, part=0.1):
        """Jerk u_i ~ U(-1, 1) part u_max, a_0 ~ U(-1, 1) part a_max; at rest at the end: less the mean; shrunk into the limits."""

        def largest(key):
            given = self.limits[key]
            return part * (np.full(self.axes, UNLIMITED) if given is None else given)

        first = rng.uniform(-1, 1, self.axes) * largest("acceleration_mps2")
        jerk = rng.uniform(-1, 1, (self.intervals, self.axes)) * largest("jerk_mps3")
        motion = first + np.vstack([np.zeros(self.axes), np.cumsum(jerk * self.interval_s, axis=0)])
        if self.rest_at_end:
            motion -= self.end_velocity() @ motion / (self.intervals * self.interval_s)
        return self.shrunk(motion)


def per_axis(value, axes):
    """A number, or one per axis, as an array; None stays."""
    return None if value is None else np.broadcast_to(np.array(value, dtype=float), (axes,))
