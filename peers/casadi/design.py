"""The design problems of `examples/peer_design.rs`, solved with CasADi and IPOPT, beside calibrant's answers.

    minimise over a:  phi(C(a))      with C the covariance of the sensor's parameters, subject to the arm's limits

`design_problem.py` says what a motion is worth, densely and in NumPy; `design_nlp.py` is the nonlinear program. All motions, the
peer's and calibrant's, are judged by the former. The peer starts from random motions: jerk U(-1, 1) u_max/10, shrunk into the limits.

Velocity and displacement are limited at ten times of each interval while IPOPT searches. Its best motions are then improved with a
hundred times and shrunk to keep the limits for all t: that value is compared with calibrant's, whose motions must keep them for all t.

What the comparison grants IPOPT: building problem and derivatives, drawing starts, judging motions and the improvement just said
are not timed, only the calls of the solver. Its times are of the processor (one thread), calibrant's of the wall.

Where three axes share nothing, the peer is also given each by itself, and the better of the two answers counts.

Usage: design.py PROBLEMS.json [RESULTS.json] [--starts 20]     compare with calibrant
       design.py --reference [RESULTS.json] [--starts 80]       the cases D1 to D4 on the peer alone
Exit status 1 where calibrant is worse than the peer by more than 1e-6 (D: nats; A: or by 1e-4 of what it is above the share that
biases have whatever the motion does), where a lower bound is above the best value found, where a motion breaks a limit by more than
1e-6 or where the two programs disagree on what a motion is worth.
"""

import argparse
import json
import sys

import design_nlp  # sets the number of threads, so before NumPy
import casadi as ca
import numpy as np
from design_problem import DesignProblem

WORSE = 1e-6  # relative; D: nats
WORSE_ABOVE_FLOOR = 1e-4  # A is flat: relative to what is above the share of biases
REACHED = 1e-6  # a value counts as reached when it is as close as this
BROKEN = 1e-6  # limits, relative
DISAGREE = 1e-7  # on the value of the same motion; the dense V loses digits where process noise is far above that of the readings
ROUNDING = 1e-9  # by which a bound may be above a value
FINE = 100  # times per interval in the improvement for all t
IMPROVED = 5  # how many of the best motions are improved
SOLVED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")


def difference(letter, value, other):
    """How much worse than `other`: relative, for D in nats."""
    return value - other if letter == "D" else value / other - 1


def multistart(problem, starts, seed=1, options=None):
    """Solves from random motions: value, motion, status, iterations and time of each."""
    program = design_nlp.Program(problem, options)
    rng = np.random.default_rng(seed)
    runs = []
    for _ in range(starts):
        motion, status, iterations, seconds = program.solve(problem.random_motion(rng))
        # where IPOPT gave up, what it returns counts as well if it keeps the limits
        allowed = problem.violation(motion, problem.times_per_interval) <= BROKEN
        value = problem.value(motion) if allowed else np.inf
        runs.append({"value": value, "motion": motion, "status": status, "iterations": iterations, "seconds": seconds})
    return runs, program.build_s


def for_all_t(case, runs):
    """The best value with limits that hold for all t, and its motion: the best few motions solved again on a fine grid."""
    coarse = DesignProblem(case)
    best = distinct(coarse.letter, runs)
    if coarse.limits["velocity_mps"] is None and coarse.limits["displacement_m"] is None:
        return best[0]["value"], best[0]["motion"]
    fine = DesignProblem(case, times_per_interval=FINE)
    program = design_nlp.Program(fine, {"ipopt.mu_init": 1e-4, "ipopt.max_iter": 200})
    whole = DesignProblem(case, times_per_interval=10 * FINE)
    candidates = []
    for run in best:
        for motion in (run["motion"], program.solve(0.999 * run["motion"])[0]):
            kept = whole.shrunk(motion)
            if whole.violation(kept) <= BROKEN:
                candidates.append((whole.value(kept), kept))
    return min(candidates, key=lambda pair: pair[0])


def distinct(letter, runs):
    """The best few runs of different values."""
    chosen = []
    for run in sorted((run for run in runs if np.isfinite(run["value"])), key=lambda run: run["value"]):
        if not chosen or difference(letter, run["value"], chosen[-1]["value"]) > REACHED:
            chosen.append(run)
    return chosen[:IMPROVED]


def time_until(letter, runs, target):
    """Time of the solver until a value is as good as the target, and how many of the starts are; None where none is."""
    hits = [difference(letter, run["value"], target) <= REACHED for run in runs]
    if not any(hits):
        return None, 0
    return sum(run["seconds"] for run in runs[: hits.index(True) + 1]), sum(hits)


def single_axes(case):
    """The problems of each axis by itself, where they share nothing: a diagonal model, and nominal matrix, of three axes."""
    matrix = np.array(case["nominal"]["matrix"], dtype=float)
    if case["axes"] == 1 or case["model"] == "full" or np.any(matrix != np.diag(np.diag(matrix))):
        return []
    return [single_axis(case, axis) for axis in range(case["axes"])]


def single_axis(case, axis):
    def own(value):
        return value[axis] if isinstance(value, list) else value

    criterion, nominal = case["criterion"], case["nominal"]
    weights = {name: (criterion.get("weights") or {}).get(f"{name[:-1]}{'xyz'[axis]}", 0.0) for name in ("bias.x", "scale.x")}
    scale = criterion.get("scale")
    letter = criterion["letter"]
    if letter == "c" and not any(weights.values()):
        letter = "A"  # this axis does not matter, but must be determined
    return case | {
        "axes": 1,
        "noise_mps2": own(case["noise_mps2"]),
        "limits": {key: own(value) for key, value in case["limits"].items()},
        "criterion": criterion | {"letter": letter, "weights": weights, "scale": scale and [scale[axis], scale[axis + case["axes"]]]},
        "nominal": {"bias": [own(nominal["bias"])], "matrix": [[nominal["matrix"][axis][axis]]]},
        "reference_value": None,
    }


def axis_by_axis(case, starts, times_per_interval):
    """The same with each axis by itself: fewer local optima to find at once. None where axes cannot be separated."""
    rows = [peer(single, starts, times_per_interval) for single in single_axes(case)]
    if not rows:
        return None
    problem = DesignProblem(case, times_per_interval)
    motions = {key: np.hstack([row[key] for row in rows]) for key in ("motion_mps2", "motion_all_t_mps2")}
    return {
        "value": problem.value(motions["motion_mps2"]),
        "value_all_t": problem.value(motions["motion_all_t_mps2"]),
        "motion_all_t_mps2": motions["motion_all_t_mps2"].tolist(),
        "sd_all_t": list(np.sqrt(np.diag(problem.covariance(motions["motion_all_t_mps2"])))),
        "total_s": sum(row["total_s"] for row in rows),
        "until_best_s": sum(row["until_best_s"] for row in rows),
    }


def peer(case, starts, times_per_interval=10):
    """What the peer makes of a problem."""
    problem = DesignProblem(case, times_per_interval)
    runs, build_s = multistart(problem, starts)
    if not distinct(problem.letter, runs):
        raise ValueError(f"{problem.name}: no motion from the peer: {sorted({run['status'] for run in runs})}")
    best = distinct(problem.letter, runs)[0]
    always, motion = for_all_t(case, runs)
    seconds = [run["seconds"] for run in runs]
    until_best, hits = time_until(problem.letter, runs, best["value"])
    row = {
        "name": problem.name,
        "axes": problem.axes,
        "letter": problem.letter,
        "starts": starts,
        "value": best["value"],
        "violation": problem.violation(best["motion"]),
        "value_all_t": always,
        "sd": list(np.sqrt(np.diag(problem.covariance(best["motion"])))),
        "sd_all_t": list(np.sqrt(np.diag(problem.covariance(motion)))),
        "motion_mps2": best["motion"].tolist(),
        "motion_all_t_mps2": motion.tolist(),
        "solved": sum(run["status"] in SOLVED for run in runs),
        "hits": hits,
        "iterations": float(np.median([run["iterations"] for run in runs])),
        "build_s": build_s,
        "median_s": float(np.median(seconds)),
        "total_s": sum(seconds),
        "until_best_s": until_best,
    }
    reference = case.get("reference_value")
    if reference is not None:
        row["until_reference_s"], row["reference_hits"] = time_until(problem.letter, runs, reference)
        # with a share h of starts reaching it, one takes 1/h starts on average: says more than the luck of one order
        hits = row["reference_hits"]
        row["expected_until_reference_s"] = sum(seconds) / hits if hits else None
    separate = axis_by_axis(case, starts, times_per_interval)
    row["axis_by_axis"] = separate
    if separate and separate["value_all_t"] < row["value_all_t"]:
        row |= {key: separate[key] for key in ("value_all_t", "motion_all_t_mps2", "sd_all_t")}
    return row


def compare(case, starts):
    """A problem on the peer, beside calibrant's answer where there is one."""
    row = peer(case, starts)
    answer = case.get("calibrant")
    if not answer:
        return row
    problem = DesignProblem(case)
    motion = np.array(answer["acceleration_mps2"], dtype=float).reshape(problem.intervals + 1, -1)[:, : problem.axes]
    covariance = problem.covariance(motion)
    value = problem.criterion(covariance)
    scale = problem.names.index("scale.x")
    floor = problem.floor_of_value()
    bound = answer.get("lower_bound")
    return row | {
        "calibrant": answer["value"],
        "calibrant_s": answer["seconds"],
        "calibrant_until_reference_s": answer.get("seconds_to_reference"),
        "worse": difference(problem.letter, answer["value"], row["value_all_t"]),
        "worse_above_floor": (answer["value"] - floor) / (row["value_all_t"] - floor) - 1 if floor else None,
        "scale_sd": float(np.sqrt(covariance[scale, scale]) / row["sd_all_t"][scale] - 1),
        "disagreement": abs(difference(problem.letter, answer["value"], value)),
        "calibrant_violation": problem.violation(motion),
        "lower_bound": bound,
        "bound_above": None if bound is None else difference(problem.letter, bound, min(row["value_all_t"], value)),
    }


def failures(rows):
    for row in rows:
        if "calibrant" not in row:
            continue
        name = f"{row['name']} ({row['letter']})"
        if not row["worse"] <= WORSE:
            yield f"{name}: calibrant's value {row['calibrant']:.9g} is worse than the peer's {row['value_all_t']:.9g} by {row['worse']:.1e}"
        elif row["worse_above_floor"] is not None and not row["worse_above_floor"] <= WORSE_ABOVE_FLOOR:
            yield f"{name}: above what biases cost at least, calibrant is worse by {row['worse_above_floor']:.1e}"
        if not row["disagreement"] <= DISAGREE:
            yield f"{name}: on the value of calibrant's motion the programs differ by {row['disagreement']:.1e}"
        if not row["calibrant_violation"] <= BROKEN:
            yield f"{name}: calibrant's motion breaks a limit by {row['calibrant_violation']:.1e}"
        if row["bound_above"] is not None and not row["bound_above"] <= ROUNDING:
            yield f"{name}: the lower bound {row['lower_bound']:.9g} is above a value that exists, by {row['bound_above']:.1e}"


def text(value, form, factor=1.0):
    """A number, or a dash where there is none."""
    return "-" if value is None else format(value * factor, form)


def print_table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|---" * 2 + "|--:" * (len(heads) - 2) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def print_values(rows):
    heads = ["problem", "criterion", "IPOPT", "breaks a limit by", "axis by axis", "best for all t"]
    heads += ["calibrant", "against for all t", "above floor", "sd(scale.x)", "disagreement", "breaks a limit by", "bound - value"]
    lines = []
    for row in rows:
        get = row.get
        lines.append(
            [row["name"], row["letter"], f"{row['value']:.8g}", f"{max(row['violation'], 0):.1e}"]
            + [text(row["axis_by_axis"] and row["axis_by_axis"]["value"], ".8g"), f"{row['value_all_t']:.8g}"]
            + [text(get("calibrant"), ".8g"), text(get("worse"), "+.1e"), text(get("worse_above_floor"), "+.1e")]
            + [text(get("scale_sd"), "+.1e"), text(get("disagreement"), ".0e"), text(get("calibrant_violation"), "+.0e")]
            + [text(get("bound_above"), "+.1e")]
        )
    print_table(heads, lines)


def print_times(rows):
    heads = ["problem", "criterion", "starts solved", "reach its best", "iterations", "per start, ms", "until its best, ms"]
    heads += ["reach the reference", "until then, ms", "expected, ms", "all starts, ms", "axis by axis, ms"]
    heads += ["calibrant, ms", "until the reference, ms", "ratio", "ratio, per start", "ratio until the reference"]
    lines = []
    for row in rows:
        get = row.get
        own, own_until = get("calibrant_s"), get("calibrant_until_reference_s")
        expected = get("expected_until_reference_s")
        lines.append(
            [row["name"], row["letter"], f"{row['solved']}/{row['starts']}", str(row["hits"]), f"{row['iterations']:.0f}"]
            + [text(row["median_s"], ".3g", 1e3), text(row["until_best_s"], ".3g", 1e3), text(get("reference_hits"), "d", 1)]
            + [text(get("until_reference_s"), ".3g", 1e3), text(expected, ".3g", 1e3), text(row["total_s"], ".3g", 1e3)]
            + [text(row["axis_by_axis"] and row["axis_by_axis"]["total_s"], ".3g", 1e3)]
            + [text(own, ".3g", 1e3), text(own_until, ".3g", 1e3)]
            + [text(own and row["total_s"] / own, ".3g"), text(own and row["median_s"] / own, ".3g")]
            + [text(own_until and expected and expected / own_until, ".3g")]
        )
    print_table(heads, lines)


def print_deviations(rows):
    """Standard deviations of the peer's best, of one axis."""
    lines = []
    for row in rows:
        scale = row["axes"]
        lines.append(
            [row["name"], row["letter"], f"{row['value']:.8g}", f"{row['sd'][0]:.7g}", f"{row['sd'][scale]:.6g}"]
            + [f"{row['value_all_t']:.8g}", f"{row['sd_all_t'][0]:.7g}", f"{row['sd_all_t'][scale]:.6g}"]
        )
    print_table(["problem", "criterion", "f", "sd(b)", "sd(K)", "f for all t", "sd(b)", "sd(K)"], lines)


REFERENCES = {"D1": 3.9654638e-10, "D2": 3.9733241e-10, "D3": 3.9902749e-10, "D3'": 3.985998e-10, "D4": 1.103672e-05}


def reference_case(name, axes, letter):
    """D1 ... D4: N = 10 intervals of 1 s, 10 Hz, sigma = 2e-4 m/s^2; criterion A, or c with all weight on scale.x."""
    limits = {"acceleration_mps2": 30.0, "jerk_mps3": 30.0, "intercept_mps2": None, "velocity_mps": None, "displacement_m": None}
    limits["rest"] = "none"
    if name == "D2":
        limits |= {"acceleration_mps2": None, "intercept_mps2": 30.0}
    if name in ("D3", "D3'"):
        limits |= {"velocity_mps": 10.0, "displacement_m": 10.0, "rest": "both"}
    if name == "D4":
        limits |= {"acceleration_mps2": 20.0, "jerk_mps3": 20.0}
    return {
        "name": f"{name}, {axes} ax{'i' if axes == 1 else 'e'}s",
        "axes": axes,
        "model": "scale-bias",
        "intervals": 10,
        "interval_s": 1.0,
        "rate_hz": 10.0,
        "noise_mps2": 2e-4,
        "trust": "noisy" if name == "D4" else "known",
        "input_noise": {"floor_mps3": 0.01, "ratio": 0.01} if name == "D4" else None,
        "known_ends": "start",
        "limits": limits,
        "criterion": {"letter": letter, "weights": {"scale.x": 1.0}, "range_mps2": None, "scale": [1.0] * 2 * axes},
        "nominal": {"bias": [0.0] * axes, "matrix": np.eye(axes).tolist()},
        "reference_value": axes * REFERENCES[name] if letter == "A" else None,
    }


def reference_rows(starts):
    """D1 to D4 with one axis and three, and what is best for the scale factor alone."""
    cases = [reference_case(name, axes, "A") for axes in (1, 3) for name in REFERENCES]
    cases += [reference_case(name, 1, "c") for name in REFERENCES]
    for case in cases:
        print(f"{case['name']}, {case['criterion']['letter']} ...", file=sys.stderr)
        yield peer(case, starts, times_per_interval=1 if "D3'" in case["name"] else 10)  # D3': at the nodes only


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problems", nargs="?", help="problems with calibrant's answers")
    parser.add_argument("results", nargs="?", help="where to write what came out, as JSON")
    parser.add_argument("--reference", nargs="?", const="", metavar="RESULTS", help="the cases D1 to D4 on the peer alone")
    parser.add_argument("--starts", type=int, help="random starts, 20 (--reference: 80)")
    return parser.parse_args()


def load(path):
    """The problems of a file: a list, or an object that holds one."""
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    return document["problems"] if isinstance(document, dict) else document


def main():
    options = arguments()
    if options.problems is None and options.reference is None:
        sys.exit("give a file of problems, or --reference")
    print(f"CasADi {ca.__version__} with IPOPT, NumPy {np.__version__}\n")
    if options.reference is not None:
        rows, results = list(reference_rows(options.starts or 80)), options.reference
        print_deviations(rows)
    else:
        rows, results = [compare(case, options.starts or 20) for case in load(options.problems)], options.results
    print_values(rows)
    print_times(rows)
    if results:
        with open(results, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
    wrong = list(failures(rows))
    for line in wrong:
        print(f"WORSE: {line}", file=sys.stderr)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
