"""The same jobs in Python with calibrant and with its peers: what a user types, processor time, and whether the answers agree.

Usage: compare.py [JOB ...]      session, allan, estimate, motion, doe; default: all
Times are processor times of all threads in one process, medians of alternating runs, without imports. Exit status 1 where calibrant's answer is worse.
"""

import inspect
import statistics
import sys
import time
import warnings
from importlib import import_module

JOBS = ("session", "allan", "estimate", "motion", "doe")
RUNS = 9
ENOUGH_S = 20.0  # of one job


def lines_typed(job, function):
    """Lines that a user writes: the body, without a docstring and blanks; and what it calls."""
    parts = [inspect.getsource(part).split("\n") for part in (function, *getattr(job, "TYPED", ()))]
    lines = [line.strip() for part in parts for line in part]
    return sum(bool(line) and not line.startswith(('"""', "#", "def with_")) for line in lines)


def seconds(function, data):
    begin = time.process_time()
    answer = function(*data)
    return answer, time.process_time() - begin


def run(name):
    """One row of the table, and whether calibrant's answer is as good."""
    job = import_module(name)
    theirs_of = next(value for key, value in vars(job).items() if key.startswith("with_") and key != "with_calibrant")
    data = job.prepare()
    times = {"ours": [], "theirs": []}
    began = time.perf_counter()
    print(f"{job.JOB}, {job.PEER}")
    while len(times["ours"]) < RUNS and (not times["ours"] or time.perf_counter() - began < ENOUGH_S):
        theirs, took = seconds(theirs_of, data)
        times["theirs"].append(took)
        ours, took = seconds(job.with_calibrant, data)
        times["ours"].append(took)
    ours_s, theirs_s = (statistics.median(times[who]) for who in ("ours", "theirs"))
    good = job.compare(ours, theirs)
    row = [job.JOB, job.PEER, lines_typed(job, theirs_of), lines_typed_of_calibrant(job), f"{1e3 * theirs_s:.3g}", f"{1e3 * ours_s:.3g}", f"{theirs_s / ours_s:.3g}"]
    return row, good


def lines_typed_of_calibrant(job):
    source = inspect.getsource(job.with_calibrant).split("\n")
    return sum(bool(line.strip()) and not line.startswith("def ") for line in source)


def main():
    warnings.simplefilter("ignore")
    rows, good = zip(*(run(name) for name in sys.argv[1:] or JOBS))
    heads = ["job", "peer", "lines, peer", "lines, calibrant", "peer, ms", "calibrant, ms", "ratio"]
    for row in (heads, ["---"] * len(heads), *rows):
        print("| " + " | ".join(map(str, row)) + " |")
    sys.exit(not all(good))


main()
