#!/bin/sh
# MuJoCo 4.0.0 and Pinocchio 4.1.0 take different axes for the velocity of a free body, under the same six numbers, linear first.
# MuJoCo: the linear velocity in the axes of the world, the angular one in those of the body. Pinocchio: both in those of the body.
# (The quaternion differs, too: w first in MuJoCo, last in Pinocchio.) Here a body that is turned by 90 degrees about z has the velocity 1 0 0 1 0 0.
# Seen, both in the axes of the world:
#     MuJoCo    linear [1. 0. 0.] angular [0. 1. 0.]
#     Pinocchio linear [0. 1. 0.] angular [0. 1. 0.]
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet mujoco==4.0.0 pin==4.1.0 numpy==2.4.6 scipy==1.17.0
"$folder/venv/bin/python" - <<'END'
import mujoco
import numpy as np
import pinocchio as pin
from scipy.spatial.transform import Rotation

HALF, STEP = np.sqrt(0.5), 1e-5
velocity = np.array([1.0, 0, 0, 1, 0, 0])


def in_world(before, after):
    """Positions and quaternions (w last) a step apart as velocities in the axes of the world."""
    turn = Rotation.from_quat(after[3:]) * Rotation.from_quat(before[3:]).inv()
    return np.round((after[:3] - before[:3]) / STEP, 3) + 0.0, np.round(turn.as_rotvec() / STEP, 3) + 0.0


model = mujoco.MjModel.from_xml_string(
    '<mujoco><option gravity="0 0 0"/><worldbody><body><freejoint/><geom type="sphere" size=".1"/></body></worldbody></mujoco>'
)
w_last = [0, 1, 2, 4, 5, 6, 3]
before = np.array([0, 0, 0, HALF, 0, 0, HALF])
after = before.copy()
mujoco.mj_integratePos(model, after, velocity, STEP)
of_mujoco = in_world(before[w_last], after[w_last])
print("MuJoCo    linear", of_mujoco[0], "angular", of_mujoco[1])
model = pin.Model()
model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "free")
before = np.array([0, 0, 0, 0, 0, HALF, HALF])
of_pinocchio = in_world(before, pin.integrate(model, before, velocity * STEP))
print("Pinocchio linear", of_pinocchio[0], "angular", of_pinocchio[1])
x, y = np.eye(3)[:2]
assert all(np.array_equal(found, expected) for found, expected in zip([*of_mujoco, *of_pinocchio], [x, y, y, y]))
END
