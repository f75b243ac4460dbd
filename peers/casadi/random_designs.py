"""Small random design problems: do calibrant's answers hold up, and is a lower bound ever above a value that exists?

Two to six intervals (three and more for the full model), one axis or three, every combination of limits that bounds the acceleration, trust known and noisy,
every criterion, nominal matrices with and without cross-axis sensitivity. The file is that of `design.py`, without `calibrant`.

Usage: random_designs.py SEED COUNT OUT.json                            writes problems
       random_designs.py --check PROBLEMS.json [--starts 20] [--search 5]   with calibrant's answers in the file
The check looks for the best motion with IPOPT and with a random search of so many seconds per problem (moves of single nodes,
shrunk into the limits), and calibrant's own motion counts too. Exit status 1 as `design.py`, or where a lower bound is above it.
"""

import argparse
import json
import sys
import time

import design  # sets the number of threads, so before NumPy
import numpy as np
from design_problem import DesignProblem, parameter_names

LIMITS = ("acceleration_mps2", "jerk_mps3", "intercept_mps2", "velocity_mps", "displacement_m")
LETTERS = ("A", "D", "E", "M", "c", "I")


def rounded(value):
    """Four digits, so that the file can be read by people."""
    return float(f"{value:.4g}")


def random_limits(rng, interval_s, intervals):
    """Limits that bound the acceleration: jerk needs the intercept's and the other way round. Sizes at which each may bind."""
    while True:
        acceleration, jerk, intercept, velocity, displacement = given = rng.random(len(LIMITS)) < 0.45
        if acceleration or velocity or displacement or (jerk and intercept):
            break
    a_max = 10 ** rng.uniform(0.3, 1.7)
    duration = interval_s * intervals
    typical = {
        "acceleration_mps2": a_max,
        "jerk_mps3": a_max / interval_s,
        "intercept_mps2": a_max,
        "velocity_mps": a_max * interval_s,
        "displacement_m": a_max * interval_s * duration / 4,
    }
    limits = {key: rounded(typical[key] * 10 ** rng.uniform(-0.4, 0.4)) if on else None for key, on in zip(LIMITS, given)}
    return limits | {"rest": str(rng.choice(["none", "start", "both"]))}


def random_nominal(rng, axes, model):
    """Near the unit matrix; a full one may have cross-axis sensitivities, which couple the axes where there is process noise."""
    matrix = np.diag(1 + 0.05 * rng.standard_normal(axes))
    if model == "full" and rng.random() < 0.5:
        matrix += 0.05 * rng.standard_normal((axes, axes)) * (1 - np.eye(axes))
    return {
        "bias": [rounded(b) for b in 0.1 * rng.standard_normal(axes)],
        "matrix": [[rounded(entry) for entry in row] for row in matrix],
    }


def random_criterion(rng, axes, model):
    names = parameter_names(axes, model)
    letter = str(rng.choice(LETTERS))
    weights, scale = {}, [1.0] * len(names)
    if letter == "c":
        chosen = rng.choice(names, size=rng.integers(1, len(names) + 1), replace=False)
        weights = {str(name): rounded(10 ** rng.uniform(-1, 1)) for name in sorted(chosen)}
    if letter not in "cI" and rng.random() < 0.5:  # c has its weights, I its units
        scale = [0.1 if name.startswith("bias") else 0.005 for name in names]
    return {
        "letter": letter,
        "weights": weights,
        "range_mps2": rounded(10 ** rng.uniform(0, 1.5)) if letter == "I" else None,
        "scale": scale,
    }


def random_case(rng, index):
    axes = int(rng.choice([1, 3]))
    model = "full" if axes == 3 and rng.random() < 0.5 else "scale-bias"
    # four parameters of a reading need four nodes
    intervals = int(rng.integers(3 if model == "full" else 2, 7))
    interval_s = float(rng.choice([0.5, 1.0, 2.0, 5.0]))
    noisy = bool(rng.random() < 0.4)
    # some noise free of the jerk, or none: then an interval without jerk is known exactly
    floor = rounded(10 ** rng.uniform(-3, -1)) if rng.random() < 0.8 else 0.0
    ratio = rounded(10 ** rng.uniform(-3, -1)) if floor == 0 or rng.random() < 0.7 else 0.0
    return {
        "name": f"random {index}",
        "axes": axes,
        "model": model,
        "intervals": intervals,
        "interval_s": interval_s,
        "rate_hz": float(rng.choice([2.0, 4.0, 10.0])),
        "noise_mps2": rounded(10 ** rng.uniform(-4, -2)),
        "trust": "noisy" if noisy else "known",
        "input_noise": {"floor_mps3": floor, "ratio": ratio} if noisy else None,
        "known_ends": str(rng.choice(["start", "both"])) if noisy else "start",
        "limits": random_limits(rng, interval_s, intervals),
        "criterion": random_criterion(rng, axes, model),
        "nominal": random_nominal(rng, axes, model),
        "reference_value": None,
    }


def random_search(problem, seconds, rng):
    """Best value of a search that knows nothing: random motions, then random changes of the best, larger and smaller in turn."""
    deadline = time.process_time() + seconds
    best, motion = np.inf, None
    while time.process_time() < deadline:
        value, candidate = descend(problem, rng, min(deadline, time.process_time() + seconds / 4))
        if value < best:
            best, motion = value, candidate
    return best, motion


def descend(problem, rng, deadline):
    """One descent from the best of a hundred random motions."""
    starts = [allowed(problem, problem.random_motion(rng, 3.0)) for _ in range(100)]
    values = [value_or_inf(problem, motion) for motion in starts]
    motion, value = starts[int(np.argmin(values))], min(values)
    size = 0.3
    while time.process_time() < deadline and size > 1e-7:
        spread = np.abs(motion).max(axis=0) * size * (rng.random(motion.shape) < 0.4)
        candidate = allowed(problem, motion + spread * rng.standard_normal(motion.shape))
        other = value_or_inf(problem, candidate)
        if other < value:
            value, motion, size = other, candidate, min(size * 1.5, 1.0)
        else:
            size *= 0.97
    return value, motion


def allowed(problem, motion):
    """At rest at the end where asked for, and shrunk into the limits."""
    if problem.rest_at_end:
        motion = motion - problem.end_velocity() @ motion / (problem.intervals * problem.interval_s)
    return problem.shrunk(motion)


def value_or_inf(problem, motion):
    try:
        return problem.value(motion)
    except np.linalg.LinAlgError:
        return np.inf


def check(case, starts, seconds, rng):
    """calibrant's answer beside IPOPT's and the random search's, whose best takes the place of IPOPT's where it is better."""
    row = design.compare(case, starts)
    found, motion = random_search(DesignProblem(case, times_per_interval=100), seconds, rng)
    whole = DesignProblem(case, times_per_interval=1000)
    kept = whole.shrunk(motion)
    row["search"] = whole.value(kept)
    if row["search"] < row["value_all_t"]:
        row["value_all_t"] = row["search"]
        if "calibrant" in row:
            row["worse"] = design.difference(row["letter"], row["calibrant"], row["search"])
    if row.get("lower_bound") is not None:
        row["bound_above"] = max(
            row["bound_above"], design.difference(row["letter"], row["lower_bound"], row["search"])
        )
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("make", nargs="*", metavar="SEED COUNT OUT")
    parser.add_argument("--check", metavar="PROBLEMS")
    parser.add_argument("--starts", type=int, default=20)
    parser.add_argument("--search", type=float, default=5.0)
    options = parser.parse_args()
    if options.check is None:
        seed, count, path = options.make
        rng = np.random.default_rng(int(seed))
        with open(path, "w", encoding="utf-8") as file:
            json.dump([random_case(rng, index) for index in range(int(count))], file, indent=1)
        return
    rng = np.random.default_rng(1)
    rows = [check(case, options.starts, options.search, rng) for case in design.load(options.check)]
    design.print_values(rows)
    better = sum(row["search"] < row["value"] for row in rows)
    print(f"{len(rows)} problems; in {better} the random search found more than {options.starts} starts of IPOPT")
    wrong = list(design.failures(rows))
    for line in wrong:
        print(f"WRONG: {line}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
