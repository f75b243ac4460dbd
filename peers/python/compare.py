"""The same jobs in Python with calibrant and with its peers: what a user types, processor time, and whether the answers agree.

Usage: compare.py [JOB ...]      session, allan, estimate, motion, doe; default: all
Times are processor times of all threads in one process, medians of up to nine alternating runs, without imports. Exit status 1 where calibrant's answer is worse.
"""

import inspect
import os
import statistics
import sys
import time
import warnings
from importlib import import_module

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the peers' arrays are small: more threads only spin

JOBS = ("session", "allan", "estimate", "motion", "doe")
RUNS = 9
ENOUGH_S = 20.0  # of one job


def lines_typed(*parts):
    """Lines that a user writes: bodies without docstrings and blanks."""
    lines = [line.strip() for part in parts for line in inspect.getsource(part).split("\n")]
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
    lines = lines_typed(theirs_of, *getattr(job, "TYPED", ())), lines_typed(job.with_calibrant)
    return [job.JOB, job.PEER, *lines, f"{1e3 * theirs_s:.3g}", f"{1e3 * ours_s:.3g}", f"{theirs_s / ours_s:.2g}"], good


def main():
    warnings.simplefilter("ignore")
    rows, good = zip(*(run(name) for name in sys.argv[1:] or JOBS))
    heads = ["job", "peer", "lines, peer", "lines, calibrant", "peer, ms", "calibrant, ms", "ratio"]
    for row in (heads, ["---"] * len(heads), *rows):
        print("| " + " | ".join(map(str, row)) + " |")
    sys.exit(not all(good))


main()
