"""The calibration problems of `examples/peer_estimate.rs`, solved with CasADi and IPOPT, beside calibrant's answers.

    minimise over p, a:  1/2 sum_k |(y_k - S alpha(t_k; a) - b) / sigma|^2
                       + 1/2 sum_i |((a_{i+1} - a_i)/dtau_i - u_i) / sigma_u,i|^2      with a_0 (and a_N) known

Where gravity gamma acts, the stimulus is alpha + gamma + o, and the offset o (tilt and magnitude) is an unknown with the prior
1/2 o' P^-1 o.

Each problem is written down as it reads, in the node accelerations, with exact second derivatives and without any of
calibrant's structure; nothing is shared between the two programs but the JSON file. A third answer decides who is right where they
differ: Gauss-Newton with residuals and gradients in extended precision, written in NumPy.

What the comparison grants IPOPT: building the problem and its derivatives is not timed, only the call of the solver, and neither
is the covariance, which calibrant's time includes. IPOPT's times are of the processor (one thread), so that other work on
the machine does not count; calibrant's are of the wall.

Usage: estimate.py PROBLEMS.json [RESULTS.json]
Exit status 1 where an estimate differs by more than 1e-6 standard deviations, or a covariance by more than 1e-6.
"""

import json
import os
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import casadi as ca  # noqa: E402  (threads must be set first)
import numpy as np  # noqa: E402

TOLERANCE = 1e-6  # on estimates in standard deviations, and on covariances relative to sqrt(C_ii C_jj)
SOLVES = 40
RANK_TOLERANCE = 1e-11  # singular values of the scaled Jacobian, relative to the largest

# Linear algebra is MUMPS, which comes with CasADi. The unknowns are scaled below, so IPOPT's own scaling of the objective, which
# depends on the gradient at the start, is off: with it a tolerance means something else in every case, and 1e-12 is below
# rounding in some.
DEFAULT = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.nlp_scaling_method": "none",
    "ipopt.acceptable_iter": 0,
    "ipopt.max_iter": 300,
}
# The loosest power of ten at which every case comes within 1e-6 standard deviations of its optimum. (At 1e-8, IPOPT's default, some
# are 1e-6 off; at 1e-6, 4e-4.)
TIGHT = DEFAULT | {"ipopt.tol": 1e-9}


class Problem:
    """One case of the file as arrays, and where its unknowns stand in the vector z = (p, free nodes)."""

    def __init__(self, case):
        self.t = np.array(case["sample_times_s"])
        self.y = np.array(case["readings_mps2"])
        self.tau = np.array(case["node_times_s"])
        self.command = np.array(case["commanded_mps2"])
        self.sigma = np.array(case["noise_mps2"])
        self.nominal = np.array(case["nominal"])
        self.full = case["model"] == "full"
        self.known = case["trust"].startswith("known")
        # gravity: its force, and a factor of the covariance of its unknown offset o, the last unknowns of z
        gravity = case.get("gravity")
        self.force = np.array(gravity["force_mps2"]) if gravity else np.zeros(3)
        self.offset_root = np.linalg.cholesky(np.array(gravity["offset_covariance"])) if gravity else None
        self.jerk_sd = None if case["jerk_sd_mps3"] is None else np.array(case["jerk_sd_mps3"])
        self.size = len(self.nominal)
        self.nodes = len(self.tau)
        # sample k lies in interval i at lambda: alpha = (1 - lambda) a_i + lambda a_{i+1}
        self.interval = np.clip(np.searchsorted(self.tau, self.t, side="right") - 1, 0, self.nodes - 2)
        self.dtau = np.diff(self.tau)
        self.lam = (self.t - self.tau[self.interval]) / self.dtau[self.interval]
        self.jerk = np.diff(self.command, axis=0) / self.dtau[:, None]
        # a known motion is data, not an unknown
        self.fixed = np.zeros(self.nodes, dtype=bool)
        self.fixed[0] = case["start_known"]
        self.fixed[-1] |= case["end_known"]
        if self.known:
            self.fixed[:] = True
        self.free = np.flatnonzero(~self.fixed)

    def start(self):
        """Nominal parameters; the commanded motion, or where nothing is known of it, the readings themselves."""
        nodes = self.command.copy()
        if self.jerk_sd is None:
            nearest = np.abs(self.t[None, :] - self.tau[:, None]).argmin(axis=1)
            nodes[self.free] = self.y[nearest[self.free]]
        if self.jerk_sd is None and self.offset_root is not None:
            nodes[self.free] -= self.force
        offset = np.zeros(3 * (self.offset_root is not None))
        return np.concatenate([self.nominal, nodes[self.free].ravel(), offset])

    def force_at_rest(self, z, zeros):
        """What the sensor senses beside the motion, gamma + o."""
        force = zeros(3, 1)
        for axis in range(3):
            force[axis, 0] = self.force[axis]
            if self.offset_root is not None:
                force[axis, 0] += z[self.size + 3 * len(self.free) + axis]
        return force

    def unpack(self, z, zeros):
        """Bias, matrix and nodes of a vector of unknowns; `zeros(rows, columns)` makes a matrix of z's kind."""
        matrix, nodes = zeros(3, 3), zeros(self.nodes, 3)
        entries = [(0, 0), (1, 1), (2, 2)]
        if self.full:
            entries += [(row, column) for row in range(3) for column in range(3) if row != column]
        for k, (row, column) in enumerate(entries):
            matrix[row, column] = z[3 + k]
        for i in np.flatnonzero(self.fixed):
            for axis in range(3):
                nodes[i, axis] = self.command[i, axis]
        for k, i in enumerate(self.free):
            for axis in range(3):
                nodes[i, axis] = z[self.size + 3 * k + axis]
        return z[:3], matrix, nodes


def symbolic(problem):
    """Unknowns, residuals r with cost 1/2 r'r, and equality constraints (increments without noise), in CasADi's SX."""
    z = ca.SX.sym("z", len(problem.start()))
    b, matrix, nodes = problem.unpack(z, ca.SX.zeros)
    at_rest = problem.force_at_rest(z, ca.SX.zeros)
    residuals, constraints = [], []
    if problem.offset_root is not None:
        residuals.append(ca.mtimes(ca.DM(np.linalg.inv(problem.offset_root)), at_rest - problem.force))
    for k, i in enumerate(problem.interval):
        alpha = (1 - problem.lam[k]) * nodes[int(i), :].T + problem.lam[k] * nodes[int(i) + 1, :].T
        residuals.append((problem.y[k] - ca.mtimes(matrix, alpha + at_rest) - b) / problem.sigma)
    if problem.jerk_sd is not None and not problem.known:
        for i, sd in enumerate(problem.jerk_sd):
            excess = (nodes[i + 1, :] - nodes[i, :]) / problem.dtau[i] - problem.jerk[i].reshape(1, 3)
            for axis in range(3):
                if sd[axis] > 0:
                    residuals.append(excess[axis] / sd[axis])
                else:
                    constraints.append(excess[axis])
    return z, ca.vertcat(*residuals), ca.vertcat(*constraints)


def solve(z, residuals, constraints, start, unit, options):
    """IPOPT's solution, its statistics, and the times of the solver's calls. It sees x in z = start + unit x."""
    x = ca.SX.sym("x", z.shape[0])
    in_x = ca.substitute([ca.sumsqr(residuals) / 2, constraints], [z], [start + unit * x])
    nlp = {"x": x, "f": in_x[0], "g": in_x[1]}
    solver = ca.nlpsol("solver", "ipopt", nlp, options)
    times = []
    for _ in range(SOLVES + 3):
        begin = time.process_time()
        solution = solver(x0=0, lbg=0, ubg=0)
        times.append(time.process_time() - begin)
    return start + unit * np.array(solution["x"]).ravel(), solver.stats(), np.array(times[3:])


def null_space(constraints):
    """An orthonormal basis of the directions that keep linear constraints."""
    if constraints.shape[0] == 0:
        return np.eye(constraints.shape[1])
    _, singular, rows = np.linalg.svd(constraints)
    rank = int((singular > 1e-12 * singular[0]).sum())
    return rows[rank:].T


def information_factor(jacobian, constraints):
    """Basis Z, column scales d and singular values of J Z / d: the information of all that is free is (J Z)'(J Z)."""
    basis = null_space(constraints)
    reduced = jacobian @ basis
    scale = np.linalg.norm(reduced, axis=0)
    scale[scale == 0] = 1
    return basis, scale, np.linalg.svd(reduced / scale, full_matrices=False)


def covariance(jacobian, constraints):
    """Inverse of the Gauss-Newton information of all unknowns, constraints eliminated: a covariance of all of z."""
    basis, scale, (_, singular, rows) = information_factor(jacobian, constraints)
    root = (basis / scale) @ rows.T / singular
    return root @ root.T


def covariance_time(derivatives, solution, slope):
    """Time of the covariance the cheap way: residual Jacobian, normal matrix, inverse; the constraints' basis is not counted."""
    basis = null_space(slope) if slope.shape[0] else None
    times = []
    for _ in range(SOLVES + 3):
        begin = time.process_time()
        jacobian = np.array(derivatives(solution)[1])
        if basis is not None:
            jacobian = jacobian @ basis
        np.linalg.inv(jacobian.T @ jacobian)
        times.append(time.process_time() - begin)
    return float(np.median(times[3:]))


def referee(problem, z, constraints, jacobian):
    """The optimum to extended precision: Gauss-Newton from z, residuals and gradient in long double, steps in double."""

    def parts(z):
        b, matrix, nodes = problem.unpack(z, lambda rows, columns: np.zeros((rows, columns), dtype=np.longdouble))
        t, tau = problem.t.astype(np.longdouble), problem.tau.astype(np.longdouble)
        dtau = np.diff(tau)
        lam = ((t - tau[problem.interval]) / dtau[problem.interval])[:, None]
        at_rest = problem.force_at_rest(z, lambda rows, columns: np.zeros((rows, columns), dtype=np.longdouble))
        alpha = (1 - lam) * nodes[problem.interval] + lam * nodes[problem.interval + 1] + at_rest.T
        sigma = problem.sigma.astype(np.longdouble)
        data = (problem.y - alpha @ matrix.T - b) / sigma
        # derivatives by hand: each residual is bilinear in (S, a)
        j = np.zeros((3 * len(t), len(z)), dtype=np.longdouble)
        samples = np.arange(len(t))
        entries = [(row, row) for row in range(3)]
        if problem.full:
            entries += [(row, column) for row in range(3) for column in range(3) if row != column]
        for row in range(3):
            j[3 * samples + row, row] = -1 / sigma[row]
        for k, (row, column) in enumerate(entries):
            j[3 * samples + row, 3 + k] = -alpha[:, column] / sigma[row]
        place = np.full(problem.nodes, -1)
        place[problem.free] = problem.size + 3 * np.arange(len(problem.free))
        for shift, weight in ((0, 1 - lam[:, 0]), (1, lam[:, 0])):
            at = place[problem.interval + shift]
            for row in range(3):
                for column in range(3):
                    hit = at >= 0
                    j[3 * samples[hit] + row, at[hit] + column] += -matrix[row, column] * weight[hit] / sigma[row]
        r = [data.ravel()]
        rows = [j]
        gap = []
        if problem.offset_root is not None:
            inverse = np.linalg.inv(problem.offset_root).astype(np.longdouble)
            for row in range(3):
                j[3 * samples + row, -3:] = -matrix[row] / sigma[row]
            r.append(inverse @ (at_rest[:, 0] - problem.force))
            rows.append(np.hstack([np.zeros((3, len(z) - 3), dtype=np.longdouble), inverse]))
        if problem.jerk_sd is not None and not problem.known:
            command = np.diff(problem.command.astype(np.longdouble), axis=0) / dtau[:, None]
            excess = np.diff(nodes, axis=0) / dtau[:, None] - command
            for i, sd in enumerate(problem.jerk_sd):
                for axis in range(3):
                    if sd[axis] == 0:
                        gap.append(excess[i, axis])
                        continue
                    row = np.zeros((1, len(z)), dtype=np.longdouble)
                    for node, sign in ((i, -1), (i + 1, 1)):
                        if place[node] >= 0:
                            row[0, place[node] + axis] = sign / dtau[i] / sd[axis]
                    r.append(excess[i, axis : axis + 1] / sd[axis])
                    rows.append(row)
        return np.concatenate(r), np.vstack(rows), np.array(gap)

    z = z.astype(np.longdouble)
    basis, scale, (_, singular, rows) = information_factor(jacobian, constraints)
    root = (basis / scale) @ rows.T / singular
    for _ in range(60):
        r, j, gap = parts(z)
        gradient = j.T @ r
        if len(gap):
            z = z - np.linalg.lstsq(constraints, gap.astype(float), rcond=None)[0]
            r, j, _ = parts(z)
            gradient = j.T @ r
        step = root.astype(np.longdouble) @ (root.T.astype(np.longdouble) @ gradient)
        z = z - step
        decrement = float(np.sqrt(step @ gradient))
        if decrement < 1e-11:
            break
    return z, decrement


def least_squares_time(problem):
    """Time of estimate and covariance with NumPy, where the motion is known and no solver of nonlinear problems is needed."""
    times = []
    for _ in range(200):
        begin = time.process_time()
        alpha = problem.command[problem.interval] * (1 - problem.lam[:, None])
        alpha += problem.command[problem.interval + 1] * problem.lam[:, None]
        for axis in range(3):
            columns = alpha if problem.full else alpha[:, axis : axis + 1]
            x = np.column_stack([np.ones(len(alpha)), columns])
            np.linalg.lstsq(x, problem.y[:, axis], rcond=None)
            np.linalg.inv(x.T @ x)
        times.append(time.process_time() - begin)
    return float(np.median(times))


def compare(case):
    """Solves one case and sets it beside calibrant's answer."""
    problem = Problem(case)
    z, residuals, constraints = symbolic(problem)
    derivatives = ca.Function("derivatives", [z], [residuals, ca.jacobian(residuals, z), ca.jacobian(constraints, z)])
    start = problem.start()
    # each unknown in units of its standard deviation when all others are known
    unit = 1 / np.linalg.norm(np.array(derivatives(start)[1]), axis=0)
    solution, stats, times = solve(z, residuals, constraints, start, unit, TIGHT)
    _, default_stats, default_times = solve(z, residuals, constraints, start, unit, DEFAULT)
    r, jacobian, slope = (np.array(part) for part in derivatives(solution))
    slope = slope.reshape(-1, len(solution))
    row = {
        "model": case["model"],
        "trust": case["trust"],
        "seed": case["seed"],
        "status": stats["return_status"],
        "iterations": stats["iter_count"],
        "calibrant_s": case["wall_s"],
        "ipopt_s": {
            "median": float(np.median(times)),
            "fastest": float(np.min(times)),
            "p95": float(np.quantile(times, 0.95)),
        },
        "ipopt_default_s": float(np.median(default_times)),
        "ipopt_default_iterations": default_stats["iter_count"],
    }
    _, _, (_, singular, _) = information_factor(jacobian, slope)
    row["rank_deficiency"] = int((singular < RANK_TOLERANCE * singular[0]).sum())
    row["singular_values"] = sorted(singular)[:8]
    answer = case["answer"]
    if "not_identifiable" in answer:
        row["not_identifiable"] = answer["not_identifiable"]
        row["names_parameters"] = answer["names_parameters"]
        return row
    c = covariance(jacobian, slope)
    row["covariance_s"] = covariance_time(derivatives, solution, slope)
    ours = np.array(answer["covariance"])
    p = slice(0, problem.size)
    sd = np.sqrt(np.diag(c)[p])
    exact, decrement = referee(problem, solution, slope, jacobian)
    values, nodes = np.array(answer["values"]), np.array(answer["motion_mps2"])
    # what is left of the gradient g, as the length of the Gauss-Newton step in standard deviations: (g' C g)^(1/2)
    gradient = jacobian.T @ r.ravel()
    row |= {
        "calibrant_status": answer["status"],
        "calibrant_iterations": answer["iterations"],
        "dp_sd": float(np.abs((solution[p] - values) / sd).max()),
        "covariance": float((np.abs(c[p, p] - ours) / np.outer(sd, sd)).max()),
        "gradient_sd": float(np.sqrt(max(gradient @ c @ gradient, 0.0))),
        "referee_decrement": decrement,
        "dp_ipopt_referee_sd": float(np.abs((exact[p] - solution[p]) / sd).max()),
        "dp_calibrant_referee_sd": float(np.abs((exact[p] - values) / sd).max()),
        "chi2": float(abs(r.ravel() @ r.ravel() - answer["chi2"]) / answer["chi2"]),
    }
    if len(problem.free):
        motion = slice(problem.size, problem.size + 3 * len(problem.free))
        node_sd = np.sqrt(np.diag(c)[motion])
        node_sd = np.where(node_sd > 0, node_sd, 1)
        row["motion_sd"] = float(np.abs((solution[motion] - nodes[problem.free].ravel()) / node_sd).max())
    else:
        row["motion_sd"] = 0.0
        if problem.offset_root is None:
            row["numpy_s"] = least_squares_time(problem)
    return row


def span(values, digits=3):
    """`median (smallest to largest)`, or the one number where they agree."""
    low, middle, high = (f"{value:.{digits}g}" for value in (min(values), float(np.median(values)), max(values)))
    return middle if low == high else f"{middle} ({low} to {high})"


def print_cases(rows):
    print(
        "| model | trust | seed | Δp, sd | ΔC | Δa, sd | Δχ² | IPOPT off, sd | calibrant off, sd "
        "| iterations | IPOPT, ms | calibrant, ms | ratio |"
    )
    print("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    for row in rows:
        if "dp_sd" not in row:
            continue
        ipopt, own = row["ipopt_s"]["median"], row["calibrant_s"]["median"]
        print(
            f"| {row['model']} | {row['trust']} | {row['seed']} "
            f"| {row['dp_sd']:.1e} | {row['covariance']:.1e} | {row['motion_sd']:.1e} "
            f"| {row['chi2']:.1e} | {row['dp_ipopt_referee_sd']:.1e} | {row['dp_calibrant_referee_sd']:.1e} "
            f"| {row['iterations']} / {row['calibrant_iterations']} | {ipopt * 1e3:.2f} | {own * 1e3:.4f} | {ipopt / own:.0f} |"
        )


def print_summary(rows):
    groups = {}
    for row in rows:
        groups.setdefault((row["model"], row["trust"]), []).append(row)
    print(
        "| model | trust | cases | Δp, sd | ΔC | IPOPT iterations | IPOPT, ms | calibrant, ms | ratio "
        "| ratio with the peer's covariance | ratio of the fastest | ratio at IPOPT's default tolerance |"
    )
    print("|---|---|--:|--:|--:|---|---|---|---|---|---|---|")
    for (model, trust), group in groups.items():
        if "dp_sd" not in group[0]:
            continue
        ipopt = [row["ipopt_s"]["median"] for row in group]
        own = [row["calibrant_s"]["median"] for row in group]
        loose = [row["ipopt_default_s"] for row in group]
        whole = [(row["ipopt_s"]["median"] + row["covariance_s"]) / row["calibrant_s"]["median"] for row in group]
        fastest = [row["ipopt_s"]["fastest"] / row["calibrant_s"]["fastest"] for row in group]
        print(
            f"| {model} | {trust} | {len(group)} "
            f"| {max(row['dp_sd'] for row in group):.1e} | {max(row['covariance'] for row in group):.1e} "
            f"| {span([row['iterations'] for row in group])} | {span([1e3 * t for t in ipopt])} | {span([1e3 * t for t in own])} "
            f"| {span([a / b for a, b in zip(ipopt, own)])} | {span(whole)} | {span(fastest)} "
            f"| {span([a / b for a, b in zip(loose, own)])} |"
        )
    print()
    for (model, trust), group in groups.items():
        if "numpy_s" in group[0]:
            print(
                f"{model}, {trust}: NumPy least squares (no solver needed) {span([1e3 * row['numpy_s'] for row in group])} ms,",
                f"{span([row['numpy_s'] / row['calibrant_s']['median'] for row in group])} times calibrant's",
            )
    for row in rows:
        if "not_identifiable" in row and row["seed"] == 1:
            print(
                f"{row['model']}, {row['trust']}: IPOPT says {row['status']} after {row['iterations']} iterations,",
                f"{1e3 * row['ipopt_s']['median']:.1f} ms; its information matrix has rank deficiency {row['rank_deficiency']}.",
            )
            print(f"  calibrant says ({1e3 * row['calibrant_s']['median']:.4f} ms): {row['not_identifiable']}")


def failures(rows):
    for row in rows:
        name = f"{row['model']}, {row['trust']}, seed {row['seed']}"
        if "not_identifiable" in row:
            if row["rank_deficiency"] == 0:
                yield f"{name}: calibrant says not identifiable, the information has full rank"
            if not row["names_parameters"]:
                yield f"{name}: the message does not name the parameters"
            continue
        if row["calibrant_status"] != "converged":
            yield f"{name}: calibrant's status is {row['calibrant_status']}"
        if not row["dp_sd"] <= TOLERANCE:
            yield (
                f"{name}: estimates differ by {row['dp_sd']:.1e} sd; from the optimum, "
                f"IPOPT is {row['dp_ipopt_referee_sd']:.1e} off, calibrant {row['dp_calibrant_referee_sd']:.1e}"
            )
        if row["status"] != "Solve_Succeeded":
            yield f"{name}: IPOPT's status is {row['status']}"
        if not row["covariance"] <= TOLERANCE:
            yield f"{name}: covariances differ by {row['covariance']:.1e}"


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        document = json.load(file)
    print(f"calibrant {document['calibrant']}, CasADi {ca.__version__} with IPOPT, NumPy {np.__version__}")
    print(f"medians of {document['repetitions']} calibrations and of {SOLVES} solves per case\n")
    rows = [compare(case) for case in document["cases"]]
    print_cases(rows)
    print()
    print_summary(rows)
    if len(sys.argv) > 2:
        with open(sys.argv[2], "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
    wrong = list(failures(rows))
    for line in wrong:
        print(f"DIFFERENT: {line}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
