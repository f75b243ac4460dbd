"""Broken trajectories: does `calibrant design arm.toml --evaluate` flag each, and for the right reason?

A trajectory is designed with limits that leave room. Bumps of one or several joints, found by a random search, then break one limit each by little and keep all others: position,
velocity, acceleration, jerk, tip speed, sensor range, self-collision. Which limits a bump breaks is judged here: joint limits from the piecewise polynomials,
the rest at 4000 times, from homogeneous matrices and their differences. A box grows instead, until the good
trajectory is too near to it; and the whole arm is lowered towards the floor, which may break other limits, too. Other files are not at rest at the end, or are no trajectories.

A row of the table: what was done, the exit status, what evaluation.json says is broken (or the message), and whether this is the reason.

Usage: broken.py CALIBRANT [--folder DIR] [--seed 1]; the arm is that of the preset. Exit status 1 where the good trajectory is flagged, or a broken one is not for its reason.
"""

import argparse
import csv
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from itertools import combinations
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402  (threads must be set first)
from scipy.interpolate import BSpline, CubicSpline  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

URDF = Path(__file__).parents[2] / "crates/calibrant-io/presets/machines/arm.urdf"
STEP, GRAVITY = 0.2, 9.80665
# to design, and to evaluate: the second has room
LIMITS = {"position": (6.0, 6.2), "velocity": (2.4, 3.0), "acceleration": (3.2, 5.0), "jerk": (34.0, 36.0), "tip_speed_mps": (1.4, 1.5)}
ROOM_M = 0.02  # the clearance of the design
CLEARANCE_M = 0.005
FORCE = 1.012  # range of the accelerometer over the largest force of the good trajectory
BODY, RADIUS = [0.0, 0.0, 0.025], 0.05  # the sensor's, of the preset
BOX = [0.45, 0.35, 0.2], [0.15, 0.15, 0.2]
BEYOND = 0.004  # part of a limit by which it is broken at most; m for a distance, so that bodies still do not touch
BUMPS = {  # joints, and width in knots (0: a constant, 1: two neighbours apart) of the bumps that may break a limit
    "position": ([5, 3, 0], 0), "velocity": ([5], 8), "acceleration": ([5], 3), "jerk": ([0, 5], 1), "tip speed": ([0, 1, 2], 6), "specific force": ([1, 2, 3, 4], 2),
    "self": ([2, 3, 4], 6),
}
REASONS = {  # kind of the limit in evaluation.json, and what `of` has
    "position": ("position", ""), "velocity": ("velocity", ""), "acceleration": ("acceleration", ""), "jerk": ("jerk", ""), "tip speed": ("speed", ""),
    "specific force": ("specific force", ""), "self": ("distance", ""),
}


def arguments():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("calibrant")
    p.add_argument("--folder", type=Path, default=Path("target/peer_broken"))
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--threads", type=int, default=1)
    return p.parse_args()


def run(o, *words):
    words = [o.calibrant, "--threads", str(o.threads), "--force", "--color", "never", *map(str, words)]
    return subprocess.run(words, capture_output=True, text=True)


def key(text, name, value, section=None):
    """The experiment file with this key set; the preset has each key, perhaps as a comment."""
    begin = text.index(f"\n[{section}]") if section else 0
    found = re.compile(rf"^(# )?{name} = [^\n#]*", re.MULTILINE).search(text, begin)
    return text[: found.start()] + f"{name} = {value} " + text[found.end() :]


def experiment(preset, which, force):
    text = preset
    for name, of in LIMITS.items():
        value = of[which]
        text = key(text, name, f"[{-value}, {value}]" if name == "position" else value, "machine.limits")
    center, half = BOX
    text = key(text, "boxes", f"[{{ center_m = {center}, half_m = {half} }}]")
    text = key(text, "floor_m", 0.0)
    text = key(text, "clearance_m", (ROOM_M, CLEARANCE_M)[which])
    text = key(text, "starts", 1, "design")
    return key(text, "range_mps2", force) if force else text


class Arm:
    """Poses of the links from a URDF file, and the distances of the capsules that design.json states."""

    def __init__(self, urdf, base, tip, document):
        self.names, self.steps = [], []
        parents = {j.find("child").get("link"): j for j in ElementTree.parse(urdf).getroot().findall("joint")}
        path, link = [], tip
        while link != base:
            path.append(parents[link])
            link = parents[link].find("parent").get("link")
        fixed = np.eye(4)
        for joint in path[::-1]:
            origin, step = joint.find("origin"), np.eye(4)
            if origin is not None:
                step[:3, :3] = Rotation.from_euler("xyz", np.array(origin.get("rpy", "0 0 0").split(), float)).as_matrix()
                step[:3, 3] = np.array(origin.get("xyz", "0 0 0").split(), float)
            fixed = fixed @ step
            if joint.get("type") != "fixed":
                self.names.append(joint.get("name"))
                self.steps.append((fixed, np.array(joint.find("axis").get("xyz").split(), float)))
                fixed = np.eye(4)
        self.tip = fixed
        self.bodies = document["bodies"]
        left_out = {frozenset(pair["bodies"]) for pair in document["left_out"]}
        self.pairs = [
            (a, b)
            for a, b in combinations(range(len(self.bodies)), 2)
            if self.bodies[a]["frame"] != self.bodies[b]["frame"] and frozenset((self.bodies[a]["name"], self.bodies[b]["name"])) not in left_out
        ]

    def frames(self, q):
        """Poses after each joint, the base first; then the tip's."""
        pose = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        poses = [pose]
        for j, (fixed, axis) in enumerate(self.steps):
            turn = np.broadcast_to(np.eye(4), (len(q), 4, 4)).copy()
            turn[:, :3, :3] = Rotation.from_rotvec(q[:, j : j + 1] * axis).as_matrix()
            pose = pose @ fixed @ turn
            poses.append(pose)
        return poses, pose @ self.tip

    def distances(self, q):
        """Smallest distance of each kind at each time: self, floor, box."""
        poses, _ = self.frames(q)
        ends = []
        for body in self.bodies:
            pose = poses[body["frame"]]
            ends.append([[pose[:, :3, :3] @ np.array(c[k]) + pose[:, :3, 3] for k in ("from_m", "to_m")] + [c["radius_m"]] for c in body["capsules"]])
        own = np.min([segments(*a[:2], *b[:2]) - a[2] - b[2] for i, j in self.pairs for a in ends[i] for b in ends[j]], axis=0)
        floor, box = np.full((2, len(q)), np.inf)
        for body, capsules in zip(self.bodies, ends):
            if body["frame"] < 2:
                continue
            for p, r, radius in capsules:
                floor = np.minimum(floor, np.minimum(p[:, 2], r[:, 2]) - radius)
                for share in np.linspace(0, 1, 21):
                    out = np.abs(p + share * (r - p) - BOX[0]) - BOX[1]
                    d = np.linalg.norm(np.maximum(out, 0), axis=1) + np.minimum(out.max(axis=1), 0)
                    box = np.minimum(box, d - radius)
        return {"self": own, "floor": floor, "box": box}


def segments(p, q, r, s):
    """Distances of segments: from 41 points of the first to the second. The error is below 0.1 mm for links of half a metre."""
    best = np.full(len(p), np.inf)
    v = s - r
    vv = np.maximum((v * v).sum(1), 1e-15)
    for share in np.linspace(0, 1, 41) if np.abs(q - p).max() > 0.03 else (0.0, 0.5, 1.0):
        x = p + share * (q - p)
        b = np.clip(((x - r) * v).sum(1) / vv, 0, 1)
        best = np.minimum(best, np.linalg.norm(x - r - b[:, None] * v, axis=1))
    return best


class Judge:
    """What each limit leaves: below 0 it is broken, in parts of the limit (distances: in parts of 1 m)."""

    def __init__(self, arm, sensor_body, force):
        self.arm, self.body, self.force = arm, sensor_body, force
        self.when = {}  # knot at which each limit is nearest, of the last motion that was judged

    def joints(self, points):
        """Of control points: positions, velocities, accelerations, jerks of the joints; exact but for the positions' and velocities' extrema between 10 times a knot."""
        spline = curve(points)
        t = np.linspace(0, spline.x[-1], 10 * (len(spline.x) - 1) + 1)
        peaks = np.abs(spline(t)).max(), np.abs(spline(t, 1)).max(), np.abs(spline(t, 2)).max(), np.abs(np.diff(points, 3, axis=0)).max() / STEP**3
        return {name: 1 - peak / LIMITS[name][1] for name, peak in zip(("position", "velocity", "acceleration", "jerk"), peaks)}

    def sensor(self, points, times=2000):
        spline = curve(points)
        h = 1e-4
        t = np.linspace(h, spline.x[-1] - h, times)
        before, here, after = (self.arm.frames(spline(at))[1] for at in (t - h, t, t + h))
        turned = (after - before)[:, :3, :3] @ here[:, :3, :3].transpose(0, 2, 1) / (2 * h)
        rate = np.stack([turned[:, 2, 1], turned[:, 0, 2], turned[:, 1, 0]], 1)
        tip, ball = ((after - before) @ np.append(point, 1.0) / (2 * h) for point in (np.zeros(3), self.body))
        # the fastest point of the ball: what turns about the rate adds to what is across it
        spin = np.linalg.norm(rate, axis=1)
        along = (ball[:, :3] * rate).sum(1) / np.maximum(spin, 1e-12)
        across = np.sqrt(np.maximum((ball[:, :3] ** 2).sum(1) - along**2, 0)) + RADIUS * spin
        speeds = np.maximum(np.linalg.norm(tip[:, :3], axis=1), np.hypot(along, across))
        self.when["tip speed"], speed = t[speeds.argmax()] / STEP + 1, speeds.max()
        lifted = (after[:, :3, 3] - 2 * here[:, :3, 3] + before[:, :3, 3]) / h**2 + [0, 0, GRAVITY]
        forces = np.abs(np.einsum("kji,kj->ki", here[:, :3, :3], lifted)).max(axis=1)
        self.when["specific force"], force = t[forces.argmax()] / STEP + 1, forces.max()
        return {"tip speed": 1 - speed / LIMITS["tip_speed_mps"][1], "specific force": 1 - force / self.force}, force

    def all(self, points, times=1000):
        left = self.joints(points) | self.sensor(points, times)[0]
        spline = curve(points)
        t = np.linspace(0, spline.x[-1], times)
        distances = self.arm.distances(spline(t))
        self.when |= {name: t[d.argmin()] / STEP + 1 for name, d in distances.items()}
        return left | {name: d.min() - CLEARANCE_M for name, d in distances.items()}


def control_points(path):
    rows = [row for row in csv.reader(open(path)) if row and not row[0].startswith("#")]
    numbers = np.array(rows[1:], float)
    n = (len(rows[0]) - 1) // 3
    q, v, a = numbers[:, 1 : 1 + n], numbers[:, 1 + n : 1 + 2 * n], numbers[:, 1 + 2 * n :]
    middle = q - a * STEP**2 / 6  # of a uniform cubic B-spline
    first = middle[0] - STEP * v[0] + STEP**2 / 2 * a[0]
    last = middle[-1] + STEP * v[-1] + STEP**2 / 2 * a[-1]
    return rows[0], np.vstack([first, middle, last])


def curve(points):
    knots = STEP * (np.arange(len(points) + 4) - 3)
    spline = BSpline(knots, points, 3)
    t = STEP * np.arange(len(points) - 2)
    return CubicSpline(t, spline(t), bc_type=((1, spline(0.0, 1)), (1, spline(t[-1], 1))))


def rows_of(points, header):
    spline = curve(points)
    t = spline.x
    return [header, *(list(row) for row in np.column_stack([t, spline(t), spline(t, 1), spline(t, 2)]))]


def write(path, rows):
    path.write_text("\n".join(",".join(x if isinstance(x, str) else f"{x:.17g}" for x in row) for row in rows) + "\n")


def bump(rng, points, joints, width, near):
    """A smooth change of one joint that keeps the ends at rest; or a constant one."""
    n = len(points)
    shape = np.zeros(points.shape)
    joint = rng.choice(joints)
    if width == 0 or width > 5 and rng.random() < 0.5:
        shape[:, joint] = rng.choice([-1, 1])
        return shape
    if width == 1:
        at = rng.integers(6, n - 7)
        shape[at : at + 2, joint] = rng.choice([-1, 1]) * np.array([0.1, -0.1])
        return shape
    width = width * np.exp(0.4 * rng.normal())
    at = rng.uniform(6, n - 6) if near is None else np.clip(near + 3 * rng.normal(), 6, n - 6)
    curve = np.exp(-0.5 * ((np.arange(n) - at) / width) ** 2)
    ends = np.clip((np.minimum(np.arange(n), np.arange(n)[::-1]) - 2) / 6, 0, 1)
    shape[:, joint] = rng.choice([-1, 1]) * curve * ends**3 * (10 - 15 * ends + 6 * ends**2)
    return shape


def just_broken(judge, points, wanted, rng, tries=300):
    """The points, changed so that only the wanted limit is broken, and by little; and by how much."""
    joints, width = BUMPS[wanted]
    cheap = wanted in ("position", "velocity", "acceleration", "jerk")

    def room(size, times):
        left = judge.joints(points + size * shape)
        return left if cheap or min(left.values()) < 0 else judge.all(points + size * shape, times)

    judge.all(points, 1000)
    near = judge.when.get(wanted)
    for _ in range(tries):
        shape = bump(rng, points, joints, width, near)
        low, high = 0.0, 0.02
        while high < 4 and min(judge.joints(points + high * shape).values()) > 2e-3:
            low, high = high, 1.3 * high
        if not cheap:  # up to the largest that keeps the limits of the joints
            sizes = np.linspace(0, low, 13)
            high = next((size for size in sizes[1:] if min(room(size, 200).values()) < 0), low)
            low = high - sizes[1]
        if room(high, 200).get(wanted, 1.0) > -BEYOND / 2:
            continue  # another limit comes first
        for _ in range(16):
            middle = (low + high) / 2
            low, high = (low, middle) if room(middle, 600).get(wanted, 1.0) < -BEYOND / 2 else (middle, high)
        changed = points + high * shape
        for times in (300, 4000):
            left = judge.all(changed, times)
            if any(space > -BEYOND / 4 if name == wanted else space < 1e-3 for name, space in left.items()) or -left[wanted] > BEYOND:
                break
        else:
            return changed, -left[wanted]
    return None, None


def main():
    o = arguments()
    o.folder.mkdir(parents=True, exist_ok=True)
    run(o, "init", "arm", "-o", o.folder / "preset.toml")
    preset = (o.folder / "preset.toml").read_text()
    (o.folder / "tight.toml").write_text(experiment(preset, 0, None))
    done = run(o, "design", o.folder / "tight.toml", "-o", o.folder / "good")
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    document = json.loads((o.folder / "good/design.json").read_text())
    header, points = control_points(o.folder / "good/trajectory.csv")
    arm = Arm(URDF, "base", "flange", document)
    judge = Judge(arm, np.array(BODY), np.inf)
    judge.force = FORCE * judge.sensor(points, 4000)[1]
    toml = o.folder / "arm.toml"
    toml.write_text(experiment(preset, 1, judge.force))

    wrong = 0
    broken, _, _, message = evaluate(o, toml, o.folder / "good/trajectory.csv", "good")
    print(f"the good trajectory: {broken or 'nothing is broken'} {message}; room by our own judge {min(judge.all(points, 4000).values()):.3f}", flush=True)
    wrong += bool(broken)

    rng = np.random.default_rng(o.seed)
    # the box grows until the good trajectory is too near to it
    near = arm.distances(curve(points)(np.linspace(0, STEP * (len(points) - 3), 20000)))["box"].min() - CLEARANCE_M + BEYOND / 2
    grown = o.folder / "box.toml"
    grown.write_text(key(toml.read_text(), "boxes", f"[{{ center_m = {BOX[0]}, half_m = {[float(half + near) for half in BOX[1]]} }}]"))
    broken, status, names, message = evaluate(o, grown, o.folder / "good/trajectory.csv", "box")
    right = status != 0 and broken and all(k == "distance" and "box" in n for k, n in names)
    wrong += not right
    print(f"  {f'box larger by {1e3 * near:.0f} mm':32} status {status}  {'; '.join(broken) or 'nothing is broken'} {message}  {'right' if right else 'WRONG'}", flush=True)

    for size in np.arange(0.02, 1.5, 0.02):
        low = [points + sign * size * np.eye(points.shape[1])[1] for sign in (1, -1)]
        low = [one for one in low if arm.distances(curve(one)(np.linspace(0, STEP * (len(one) - 3), 2000)))["floor"].min() < CLEARANCE_M - BEYOND / 2]
        if low:
            break
    write(o.folder / "floor.csv", rows_of(low[0], header))
    broken, status, names, message = evaluate(o, toml, o.folder / "floor.csv", "floor")
    right = status != 0 and any("floor" in name for _, name in names)
    wrong += not right
    print(f"  {f'shoulder lower by {size:.2f} rad':32} status {status}  {'; '.join(broken) or 'nothing is broken'} {message}  {'right' if right else 'WRONG'}", flush=True)

    for wanted, (kind, of) in REASONS.items():
        changed, beyond = just_broken(judge, points, wanted, rng)
        if changed is None:
            print(f"  {wanted}: no bump was found that breaks it alone")
            wrong += 1
            continue
        path = o.folder / f"{wanted.replace(' ', '_')}.csv"
        write(path, rows_of(changed, header))
        broken, status, names, message = evaluate(o, toml, path, wanted)
        by = f"{1e3 * beyond:.1f} mm" if kind == "distance" else f"{100 * beyond:.2f} %"
        right = status != 0 and broken and all(k == kind and of in n for k, n in names) and not re.search("floor|box", str(names))
        wrong += not right
        print(f"  {wanted + ' by ' + by:32} status {status}  {'; '.join(broken) or 'nothing is broken'} {message}  {'right' if right else 'WRONG'}", flush=True)

    for name, rows, reason in files(header, points):
        path = o.folder / f"{name.replace(' ', '_')}.csv"
        write(path, rows)
        broken, status, names, message = evaluate(o, toml, path, name)
        right = status != 0 and re.search(reason, " ".join([*broken, message])) is not None
        wrong += not right
        print(f"  {name:32} status {status}  {'; '.join(broken)} {message}  {'right' if right else 'WRONG'}", flush=True)
    return int(wrong > 0)


def evaluate(o, toml, path, name):
    """What is broken, as sentences; the exit status; kind and object of each broken limit; the first line of an error."""
    folder = o.folder / f"evaluated_{name.replace(' ', '_')}"
    for old in folder.glob("evaluation.*"):
        old.unlink()
    done = run(o, "design", toml, "--evaluate", path, "--seconds", 0.3, "-o", folder)  # the best beside it does not matter here
    file = folder / "evaluation.json"
    if not file.exists():
        return [], done.returncode, [], done.stderr.strip().splitlines()[0].replace(str(path) + ": ", "")
    limits = [limit for limit in json.loads(file.read_text())["evaluation"]["limits"] if limit["is_broken"] or not limit["is_proved"]]
    broken = [f"{limit['kind']} of {limit['of']} {limit['used']:.4f}" for limit in limits]
    return broken, done.returncode, [(limit["kind"], limit["of"]) for limit in limits], ""


def files(header, points):
    """Trajectories that are none, their names, and what a message must say."""
    good = rows_of(points, header)
    moving = max(range(40, 80), key=lambda k: np.abs(curve(points)(STEP * k, 1)).max())
    yield "not at rest at the end", good[: moving + 2], "begin and end"
    yield "not at rest at the start", [header, *([row[0] - STEP * moving, *row[1:]] for row in good[moving + 1 :])], "begin and end"
    late = [list(row) for row in good]
    late[30][0] += 0.05
    yield "knots not uniform", late, "even|uniform|knots at these times"
    yield "joint misnamed", [[column.replace("elbow", "ellbow") for column in header], *good[1:]], "elbow"
    yield "two rows", good[:3], "begin and end|row|knot|short"
    bent = [list(row) for row in good]
    bent[30][1 + len(points[0])] += 0.01
    yield "a velocity that is not the spline's", bent, "spline"
    yield "no velocities", [[x for k, x in enumerate(row) if k <= len(points[0])] for row in good], "velocit|spline"
    unfinite = [list(row) for row in good]
    unfinite[30][2] = float("nan")
    yield "not a number", unfinite, "number|finite|NaN|nan|spline"


if __name__ == "__main__":
    sys.exit(main())
