"""IPOPT for Pyomo without an `ipopt` program: Pyomo writes the model as an .nl file, CasADi reads it and brings IPOPT and MUMPS.

No package index has an IPOPT that Pyomo can call by itself: see COMPARE.md for what was tried. The .nl file is what an `ipopt`
program would be given, so the problem that is solved is Pyomo's, with second derivatives by CasADi instead of the AMPL library.
"""

import os
import tempfile
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import casadi as ca  # noqa: E402  (threads must be set first)
import pyomo.environ as pyo  # noqa: E402
from pyomo.opt import SolverResults, SolverStatus, TerminationCondition  # noqa: E402
from pyomo.repn.plugins.nl_writer import NLWriter  # noqa: E402

OPTIONS = {
    "expand": True,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,
    "ipopt.linear_solver": "mumps",
    "ipopt.max_iter": 3000,
}


class Ipopt:
    """What Pyomo.DoE asks of a solver: `solve(model, tee)`; the last call's time in the solver and iterations are kept."""

    def __init__(self, **options):
        self.options = OPTIONS | {f"ipopt.{key}": value for key, value in options.items()}
        self.solver_s, self.iterations, self.unknowns, self.rows = 0.0, 0, 0, 0

    def solve(self, model, tee=False):
        del tee
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "model.nl")
            with open(path, "w", encoding="ascii") as file:
                names = NLWriter().write(model, file, linear_presolve=True)
            problem = ca.NlpBuilder()
            problem.import_nl(path, {})
        return self._solve(problem, names)

    def _solve(self, problem, names):
        g = ca.vertcat(*problem.g)
        solver = ca.nlpsol("solver", "ipopt", {"x": ca.vertcat(*problem.x), "f": problem.f, "g": g}, self.options)
        bounds = {"lbx": problem.x_lb, "ubx": problem.x_ub, "lbg": problem.g_lb, "ubg": problem.g_ub}
        begin = time.process_time()
        solution = solver(x0=problem.x_init, **bounds)
        self.solver_s = time.process_time() - begin
        stats = solver.stats()
        self.iterations, self.unknowns, self.rows = stats["iter_count"], len(problem.x), g.numel()
        for variable, value in zip(names.variables, solution["x"].full().ravel()):
            variable.set_value(float(value), skip_validation=True)
        for variable, expression in reversed(names.eliminated_vars):
            variable.set_value(pyo.value(expression), skip_validation=True)
        return outcome(stats["return_status"])


def outcome(status):
    """The result as Pyomo speaks of it."""
    results = SolverResults()
    good = status in ("Solve_Succeeded", "Solved_To_Acceptable_Level")
    results.solver.status = SolverStatus.ok if good else SolverStatus.warning
    results.solver.termination_condition = TerminationCondition.optimal if good else TerminationCondition.other
    results.solver.message = status
    return results
