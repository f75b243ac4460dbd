"""Case D1 (and D2, D3) of the design problem on Pyomo.DoE: the trace of the covariance, as its users would ask for it.

One axis, N = 10 intervals of 1 s, 10 Hz; y_k = K alpha(t_k) + b. Pyomo.DoE makes a copy of the model for each perturbed parameter
(central differences, exact here: the model is linear in b and K), ties the copies' designs together, and writes F, its Cholesky factor
and that one's inverse as constraints. Errors are in units of sigma, and b = 1, as steps are relative to the parameter; neither moves the
optimum. The sensitivities are scaled so that the objective is of order 100: it is the same as in `../casadi`, whose formula judges here.

D4 cannot be asked of Pyomo.DoE: its errors are independent, process noise makes those of one motion depend on each other.

Usage: design.py [D1 D2 D3 ...] [--starts 20]
"""

import argparse
import logging
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "casadi"))

import numpy as np  # noqa: E402
import pyomo.environ as pyo  # noqa: E402
from ipopt_of_casadi import Ipopt  # noqa: E402
from pyomo.contrib.doe import DesignOfExperiments  # noqa: E402

import design as casadi_design  # noqa: E402
from design_problem import DesignProblem  # noqa: E402

SCALE = 0.01  # of sensitivities: the objective is trace C / (sigma SCALE)^2


class Motion:
    """The experiment: nodes are decided, readings are predicted."""

    def __init__(self, problem, start):
        self.problem, self.start = problem, start

    def get_labeled_model(self):
        p, m = self.problem, pyo.ConcreteModel()
        limit = p.limits["acceleration_mps2"]
        bounds = (None, None) if limit is None else (-limit[0], limit[0])
        m.a = pyo.Var(range(p.intervals + 1), initialize=dict(enumerate(self.start)), bounds=bounds)
        m.b, m.K = pyo.Var(initialize=1.0), pyo.Var(initialize=1.0)
        m.b.fix()
        m.K.fix()
        m.y = pyo.Var(range(p.samples), initialize=0.0)
        weights = p.basis @ p.increments(np.eye(p.intervals + 1))
        m.readings = pyo.Constraint(range(p.samples), rule=lambda m, k: m.y[k] == m.K * self._row(m, weights[k]) + m.b)
        self._limit(m)
        self._label(m)
        return m

    def _row(self, m, row):
        """A linear form of the nodes, without its zeros."""
        return sum(float(row[i]) * m.a[i] for i in np.flatnonzero(row))

    def _limit(self, m):
        p = self.problem
        m.limits = pyo.ConstraintList()
        for limit, rows in p.limited(p.times_per_interval):
            if limit is not p.limits["acceleration_mps2"]:
                for row in rows:
                    m.limits.add((-1, self._row(m, row / limit[0]), 1))
        if p.rest_at_end:
            m.limits.add(self._row(m, p.end_velocity()) == 0)

    def _label(self, m):
        m.experiment_inputs = pyo.Suffix(direction=pyo.Suffix.LOCAL)
        m.experiment_inputs.update((m.a[i], None) for i in m.a)
        m.experiment_outputs = pyo.Suffix(direction=pyo.Suffix.LOCAL)
        m.experiment_outputs.update((m.y[k], 0.0) for k in m.y)
        m.measurement_error = pyo.Suffix(direction=pyo.Suffix.LOCAL)
        m.measurement_error.update((m.y[k], 1.0) for k in m.y)
        m.unknown_parameters = pyo.Suffix(direction=pyo.Suffix.LOCAL)
        m.unknown_parameters.update((parameter, pyo.value(parameter)) for parameter in (m.b, m.K))


def solve(problem, start):
    """Pyomo.DoE from one start: motion, status, time of the solver in the optimisation, and of the whole."""
    solver = Ipopt()
    begin = time.process_time()
    doe = DesignOfExperiments(
        Motion(problem, start),
        objective_option="trace",
        step=1e-3,
        scale_constant_value=SCALE,
        solver=solver,
        logger_level=logging.ERROR,
    )
    doe.run_doe()
    total = time.process_time() - begin
    motion = problem.shrunk(np.array(doe.results["Experiment Design"], dtype=float)[:, None])
    return {
        "value": problem.value(motion),
        "motion": motion,
        "status": doe.results["Termination Message"],
        "iterations": solver.iterations,
        "seconds": solver.solver_s,
        "whole_s": total,
        "size": f"{solver.unknowns} x {solver.rows}",
    }


def report(name, starts):
    case = casadi_design.reference_case(name, 1, "A")
    problem = DesignProblem(case, times_per_interval=1 if name == "D3'" else 10)
    rng = np.random.default_rng(1)
    runs = [solve(problem, problem.random_motion(rng)[:, 0]) for _ in range(starts)]
    best = min(runs, key=lambda run: run["value"])
    reference = case["reference_value"]
    until, hits = casadi_design.time_until("A", runs, reference)
    sd = np.sqrt(np.diag(problem.covariance(best["motion"])))
    solved = sum(run["status"] in casadi_design.SOLVED for run in runs)
    median = [float(np.median([run[key] for run in runs])) for key in ("iterations", "seconds", "whole_s")]
    return [
        *(name, f"{best['value']:.8g}", f"{best['value'] / reference - 1:+.1e}", f"{sd[0]:.7g}", f"{sd[1]:.6g}"),
        *(best["size"], f"{solved}/{starts}", str(hits), f"{median[0]:.0f}", f"{median[1] * 1e3:.3g}"),
        casadi_design.text(until, ".3g", 1e3),
        f"{median[2] * 1e3:.3g}",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=["D1"])
    parser.add_argument("--starts", type=int, default=20)
    options = parser.parse_args()
    logging.getLogger("pyomo").setLevel(logging.ERROR)
    heads = ["problem", "f", "against the reference", "sd(b)", "sd(K)", "unknowns x rows", "starts solved", "reach the reference"]
    heads += ["iterations", "IPOPT per start, ms", "until the reference, ms", "per start with Pyomo, ms"]
    casadi_design.print_table(heads, [report(name, options.starts) for name in options.names])


if __name__ == "__main__":
    main()
