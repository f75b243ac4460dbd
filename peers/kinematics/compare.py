"""What the tip of an arm feels, with calibrant, Pinocchio and MuJoCo: specific force, rate and angular acceleration in random states.

usage: compare.py PEER_KINEMATICS [STATES], the path of the example, and the number of states of each arm. The arms are those of
$CALIBRANT_DATA/arms. Fails where calibrant differs by more than 1e-12 of the largest value.

MuJoCo merges links that do not move into their parents, and cannot find the meshes of packages: both are switched off.
"""

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import mujoco
import numpy as np
import pinocchio

ARMS = (("ur5e.urdf", "world", "tool0"), ("fr3.urdf", "base", "fr3_link8"))
GRAVITY = np.array([0.0, 0.0, -9.81])  # m/s²
TOLERANCE = 1e-12
QUANTITIES = ("specific force", "rate", "angular acceleration")


def with_calibrant(program, path, base, tip, states):
    rows = "\n".join(",".join(repr(float(number)) for number in row) for row in states.reshape(len(states), -1))
    out = subprocess.run([program, path, base, tip], input=rows, check=True, capture_output=True, text=True).stdout
    return np.array([[float(word) for word in line.split(",")] for line in out.split()]).reshape(-1, 3, 3)


def with_pinocchio(path, tip, states):
    model = pinocchio.buildModelFromUrdf(str(path))
    data, frame = model.createData(), model.getFrameId(tip)
    found = []
    for q, qd, qdd in states:
        pinocchio.forwardKinematics(model, data, q, qd, qdd)
        pinocchio.updateFramePlacement(model, data, frame)
        acceleration = pinocchio.getFrameClassicalAcceleration(model, data, frame, pinocchio.LOCAL)
        rate = pinocchio.getFrameVelocity(model, data, frame, pinocchio.LOCAL).angular
        force = acceleration.linear - data.oMf[frame].rotation.T @ GRAVITY
        found.append([force, rate, acceleration.angular])
    return np.array(found)


def with_mujoco(path, tip, states):
    robot = ElementTree.parse(path).getroot()
    for link in robot.iter("link"):
        for shape in link.findall("collision") + link.findall("visual"):
            link.remove(shape)
    spec = mujoco.MjSpec.from_string(ElementTree.tostring(robot, encoding="unicode"))
    spec.compiler.fusestatic = False
    spec.body(tip).add_site(name="sensor")
    for kind in ("ACCELEROMETER", "GYRO", "FRAMEANGACC"):
        sensor = spec.add_sensor(name=kind, type=getattr(mujoco.mjtSensor, f"mjSENS_{kind}"))
        sensor.objtype, sensor.objname = mujoco.mjtObj.mjOBJ_SITE, "sensor"
    model = spec.compile()
    model.opt.gravity[:] = GRAVITY
    data = mujoco.MjData(model)
    found = []
    for data.qpos[:], data.qvel[:], data.qacc[:] in states:
        mujoco.mj_inverse(model, data)
        force, rate, angular_acceleration = data.sensordata.reshape(3, 3)
        # MuJoCo gives the angular acceleration in the axes of the world
        found.append([force.copy(), rate.copy(), data.site("sensor").xmat.reshape(3, 3).T @ angular_acceleration])
    return np.array(found)


def main():
    program = Path(sys.argv[1]).resolve()
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000
    arms = Path(os.environ.get("CALIBRANT_DATA", "../shared/data")) / "arms"
    if not arms.is_dir():
        print(f"SKIPPED: {arms} is not there; set CALIBRANT_DATA", file=sys.stderr)
        return
    rng = np.random.default_rng(20)
    worst = 0.0
    for name, base, tip in ARMS:
        path = arms / name
        joints = pinocchio.buildModelFromUrdf(str(path)).nq
        # positions rad, velocities rad/s, accelerations rad/s²
        states = rng.uniform(-1, 1, (count, 3, joints)) * np.array([np.pi, np.pi, 10.0])[:, None]
        ours = with_calibrant(program, path, base, tip, states)
        for peer, theirs in (("Pinocchio", with_pinocchio(path, tip, states)), ("MuJoCo", with_mujoco(path, tip, states))):
            for k, quantity in enumerate(QUANTITIES):
                difference = np.abs(ours[:, k] - theirs[:, k]).max() / np.abs(theirs[:, k]).max()
                worst = max(worst, difference)
                print(f"{name}, {count} states, {quantity}: differs from {peer} by {difference:.1e} of the largest value")
    if worst > TOLERANCE:
        sys.exit(f"the kinematics differ by {worst:.1e}, more than {TOLERANCE:.0e}")


if __name__ == "__main__":
    main()
