#!/bin/sh
# Pinocchio 4.1.0: `getFrameAcceleration` is not what an accelerometer feels, in any of its three reference frames.
# A hinge at x = 5 m turns at 2 rad/s; a frame 1 m from it moves on a circle, with 4 m/s^2 towards the hinge.
# `getFrameAcceleration` is spatial: it says 0 for all three. `getFrameClassicalAcceleration` says 4 for LOCAL and LOCAL_WORLD_ALIGNED. For WORLD it says 20,
# since it is that of the point of the body at the origin of the world, 5 m from the hinge on its other side.
# Seen:
#     LOCAL               spatial [0. 0. 0.]  classical [-4.  0.  0.]
#     WORLD               spatial [0. 0. 0.]  classical [20.  0.  0.]
#     LOCAL_WORLD_ALIGNED spatial [0. 0. 0.]  classical [-4.  0.  0.]
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet pin==4.1.0 numpy==2.4.6
"$folder/venv/bin/python" - <<'END'
import numpy as np
import pinocchio as pin

model = pin.Model()
hinge = model.addJoint(0, pin.JointModelRZ(), pin.SE3(np.eye(3), np.array([5.0, 0, 0])), "hinge")
tip = model.addFrame(pin.Frame("tip", hinge, 0, pin.SE3(np.eye(3), np.array([1.0, 0, 0])), pin.FrameType.OP_FRAME))
data = model.createData()
pin.forwardKinematics(model, data, np.zeros(1), np.array([2.0]), np.zeros(1))
pin.updateFramePlacements(model, data)
seen = []
for name in ["LOCAL", "WORLD", "LOCAL_WORLD_ALIGNED"]:
    of = getattr(pin, name)
    spatial = pin.getFrameAcceleration(model, data, tip, of).linear.round(12) + 0.0
    classical = pin.getFrameClassicalAcceleration(model, data, tip, of).linear.round(12) + 0.0
    print(f"{name:19} spatial {spatial}  classical {classical}")
    seen.append((*spatial, *classical))
assert seen == [(0, 0, 0, -4, 0, 0), (0, 0, 0, 20, 0, 0), (0, 0, 0, -4, 0, 0)]
END
