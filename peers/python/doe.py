"""The same motion by Pyomo.DoE, and by calibrant. IPOPT is that of CasADi: see `../pyomo`, whose model of the experiment serves here."""

import importlib.util
import logging
import sys
from pathlib import Path

import motion
import numpy as np

JOB, PEER = "the same motion", "Pyomo.DoE"
PEERS = Path(__file__).resolve().parents[1]
STARTS = 3

sys.path.insert(0, str(PEERS / "pyomo"))
spec = importlib.util.spec_from_file_location("doe_of_pyomo", PEERS / "pyomo" / "design.py")
doe_of_pyomo = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(doe_of_pyomo)
logging.getLogger("pyomo").setLevel(logging.ERROR)

TYPED = (doe_of_pyomo.Motion, doe_of_pyomo.solve)
with_calibrant = motion.with_calibrant


def prepare():
    """The peer's problem, and its starts."""
    problem = doe_of_pyomo.DesignProblem(doe_of_pyomo.casadi_design.reference_case("D1", 1, "A"))
    rng = np.random.default_rng(1)
    return problem, [problem.random_motion(rng)[:, 0] for _ in range(STARTS)]


def with_pyomo(problem, starts):
    return [doe_of_pyomo.solve(problem, start)["value"] for start in starts]


def compare(ours, theirs):
    """The same trace of the covariance."""
    hits = sum(value < min(theirs) * (1 + 1e-6) for value in theirs)
    print(f"  trace: Pyomo.DoE {min(theirs):.8g}, reached by {hits} of {STARTS} starts; calibrant {ours.value:.8g}")
    return ours.value <= min(theirs) * (1 + 1e-6)
