"""Do designed trajectories touch anything? MuJoCo looks, with the convex hulls of the collision meshes.

Ten designs for the UR5e (seeds 1 to 10, preset `arm`, a floor and a box beside the arm), each at 10 000 times. All pairs of bodies that are no neighbours count, whichever
pairs calibrant left out, and all but the base against floor and box; the sensor's body is the ball of the experiment. calibrant's capsules contain the meshes, so
the distance of the hulls is at least the clearance that a design promises.

Then three motions that must be found: the arm folds onto itself, reaches through the floor, sweeps through the box.

Usage: contacts.py CALIBRANT [--urdf UR5E.URDF] [--folder DIR] [--designs 10] [--times 10000]; the URDF is $CALIBRANT_DATA/arms/ur5e.urdf, with its meshes beside it.
Exit status 1 where a design comes nearer than its clearance, or a contact is not found.
"""

import argparse
import json
import os
import sys
import time
import xml.etree.ElementTree as ElementTree
from itertools import combinations
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import mujoco  # noqa: E402  (threads must be set first)
import numpy as np  # noqa: E402
from arm_experiment import calibrant, experiment, trajectory  # noqa: E402
from scipy.interpolate import CubicSpline  # noqa: E402

SENSOR = {"center": [0.0, 0.0, 0.025], "radius": 0.05}  # of the preset
BOX = {"center": [0.45, 0.35, 0.2], "half": [0.15, 0.15, 0.2]}
FAR = 0.3  # m: distances beyond are not told apart
FOUND = {  # first and last posture in degrees, and what must touch
    "folds onto itself": ([0, -90, 0, -90, 90, 0], [0, -90, 175, -90, 90, 0], None),
    "reaches through the floor": ([0, -90, 0, -90, 90, 0], [0, 30, 0, -90, 90, 0], "floor"),
    "sweeps through the box": ([-170, 0, 0, -90, 90, 0], [170, 0, 0, -90, 90, 0], "box"),
}


class World:
    """The arm with its meshes, floor and box."""

    def __init__(self, urdf):
        root = ElementTree.parse(urdf).getroot()
        for mesh in root.iter("mesh"):
            mesh.set("filename", os.path.abspath(urdf.parent / mesh.get("filename").removeprefix("package://")))
        ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", fusestatic="false", strippath="false", balanceinertia="true")
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"))
        kinds = mujoco.mjtGeom
        spec.body("tool0").add_geom(name="sensor", type=kinds.mjGEOM_SPHERE, size=[SENSOR["radius"], 0, 0], pos=SENSOR["center"])
        spec.worldbody.add_geom(name="box", type=kinds.mjGEOM_BOX, size=BOX["half"], pos=BOX["center"])
        spec.worldbody.add_geom(name="floor", type=kinds.mjGEOM_PLANE, size=[5, 5, 0.1], pos=[0, 0, 0])
        self.model = model = spec.compile()
        self.data = mujoco.MjData(model)
        self.names = [model.joint(j).name for j in range(model.njnt)]
        self.geoms = [model.geom(k).name or model.body(model.geom_bodyid[k]).name for k in range(model.ngeom)]
        moved = [self.joints_before(model.geom_bodyid[k]) for k in range(model.ngeom)]
        world = {"box", "floor"}
        self.pairs = []
        for i, j in combinations(range(model.ngeom), 2):
            outside = len(world & {self.geoms[i], self.geoms[j]})
            apart = abs(moved[i] - moved[j])
            # neighbours touch; the base stands on the floor, and the shoulder turns above it
            if outside == 0 and apart >= 2 or outside == 1 and apart >= 2:
                self.pairs.append((i, j))

    def joints_before(self, body):
        count = 0
        while body:
            count += self.model.body_jntnum[body]
            body = self.model.body_parentid[body]
        return count

    def nearest(self, spline, times):
        """Smallest distance, its pair, its time; and the number of times with a contact."""
        best, touched = (FAR, "nothing", 0.0), 0
        for t, q in zip(times, spline(times)):
            self.data.qpos = q
            mujoco.mj_kinematics(self.model, self.data)
            here = FAR
            for i, j in self.pairs:
                d = mujoco.mj_geomDistance(self.model, self.data, i, j, FAR, None)
                here = min(here, d)
                if d < best[0]:
                    best = d, f"{self.geoms[i]} - {self.geoms[j]}", t
            touched += here < 0
        return *best, touched


def colliding(first, last):
    """A slow motion from one posture to another: 20 s."""
    t = np.linspace(0, 20, 101)
    share = t / t[-1]
    share = share**3 * (10 - 15 * share + 6 * share**2)
    first, last = np.radians(first), np.radians(last)
    return CubicSpline(t, first + share[:, None] * (last - first), bc_type="clamped")


def options():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("calibrant")
    data = os.environ.get("CALIBRANT_DATA")
    p.add_argument("--urdf", type=Path, default=Path(data) / "arms/ur5e.urdf" if data else None, required=not data)
    p.add_argument("--folder", type=Path, default=Path("target/peer_contacts"))
    p.add_argument("--designs", type=int, default=10)
    p.add_argument("--times", type=int, default=10_000)
    p.add_argument("--threads", type=int, default=1)
    return p.parse_args()


def main():
    o = options()
    toml = experiment(o, o.folder, {"boxes": json.dumps([{"center_m": BOX["center"], "half_m": BOX["half"]}]).replace(":", " =").replace('"', "")})
    world = World(o.urdf)
    print(f"{len(world.pairs)} pairs of bodies, {o.times} times of each motion; distances of convex hulls")
    wrong = 0
    for seed in range(1, o.designs + 1):
        start = time.monotonic()
        calibrant(o, "design", toml, "--seed", seed, "-o", o.folder / f"{seed}")
        elapsed = time.monotonic() - start
        document = json.loads((o.folder / f"{seed}/design.json").read_text())
        names, spline = trajectory(o.folder / f"{seed}/trajectory.csv")
        assert names == world.names
        distance, pair, at, touched = world.nearest(spline, np.linspace(0, spline.x[-1], o.times))
        clearance = document["clearance_m"]
        wrong += distance < clearance
        print(f"  seed {seed:2d}: value {document['optimal']['value']:.2f}, nearest {1e3 * distance:6.2f} mm, {pair} at {at:.2f} s; {touched} contacts (designed in {elapsed:.0f} s)")
    for name, (first, last, what) in FOUND.items():
        spline = colliding(first, last)
        distance, pair, at, touched = world.nearest(spline, np.linspace(0, spline.x[-1], o.times // 10))
        wrong += not (distance < 0 and (what is None and "floor" not in pair and "box" not in pair or what is not None and what in pair))
        print(f"  {name}: nearest {1e3 * distance:.1f} mm, {pair} at {at:.2f} s; {touched} contacts")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
