"""Runs trajectory.script and compares its targets with trajectory.csv.

    python urscript.py trajectory.script trajectory.csv [STEPTIME]

An interpreter of the lines that the program uses: assignments, `while`, `if`, calls. Each servoj takes one step of the controller. The targets must be the cubic
Hermite interpolation of the rows (scipy), and the first movej must lead to the first of them.
"""

import csv
import re
import sys

import numpy as np
from scipy.interpolate import CubicHermiteSpline


def run(text, steptime):
    """The posture of movej, and the targets of servoj, one for each step."""
    lines, depth = [], 0
    for line in text.splitlines():
        code = line.split("#")[0].strip()
        if not code:
            continue
        if code == "end":
            depth -= 1
            continue
        lines.append("    " * depth + code)
        depth += code.endswith(":")
    assert depth == 0, "each def, while and if has an end"
    start, targets = [], []
    known = {
        "movej": lambda q, a, v: start.append(q),
        "servoj": lambda q, a, v, t, lookahead, gain: targets.append((q, t, lookahead, gain)),
        "stopj": lambda a: None,
        "sleep": lambda t: None,
        "floor": lambda x: int(np.floor(x)),
        "get_steptime": lambda: steptime,
    }
    used = set(re.findall(r"([a-z_]+)\(", text)) - set(known) - {"calibrant_trajectory"}
    assert not used, f"functions that this interpreter does not know: {used}"
    names = {"__builtins__": {}, **known}
    exec("\n".join(lines), names)  # noqa: S102: the program is ours
    names["calibrant_trajectory"]()
    assert all(t == steptime and 0.03 <= lookahead <= 0.2 and 100 <= gain <= 2000 for _, t, lookahead, gain in targets)
    return np.array(start), np.array([q for q, *_ in targets])


def main():
    script, table = sys.argv[1:3]
    steptime = float(sys.argv[3]) if len(sys.argv) > 3 else 0.002
    rows = [row for row in csv.reader(open(table)) if row and not row[0].startswith("#")]
    numbers, n = np.array(rows[1:], float), 6
    assert rows[0][0] == "t_s" and len(rows[0]) == 1 + 3 * n
    curve = CubicHermiteSpline(numbers[:, 0], numbers[:, 1 : 1 + n], numbers[:, 1 + n : 1 + 2 * n])
    start, targets = run(open(script).read(), steptime)
    times = numbers[0, 0] + steptime * np.arange(len(targets))
    assert abs(times[-1] - numbers[-1, 0]) < steptime, "the program ends with the trajectory"
    off = np.abs(targets - curve(times)).max()
    print(f"{len(targets)} targets, farthest from the trajectory {off:.1e} rad; start off by {np.abs(start[0] - targets[0]).max():.1e} rad")
    sys.exit(not (len(start) == 1 and off < 1e-9 and np.abs(start[0] - targets[0]).max() < 1e-11))


if __name__ == "__main__":
    main()
