#!/bin/sh
# MuJoCo 4.0.0: three properties of a sensor that are not what their names say.
# 1. `interval` alone does nothing, nor does `nsample` alone: the sensor changes at every step. Only both together make it slower. Its value then
#    repeats, bit for bit, until the next one. With steps of 1 ms and an interval of 5 ms most values last five steps, and one of 398 lasted six.
# 2. `noise` adds no noise.
# 3. After `mj_step`, `data.time` is that of the new state, and `sensordata` belongs to the state before the step.
# Seen:
#     neither                            59 changes in 60 steps
#     interval="0.005"                   59 changes in 60 steps
#     nsample="1"                        59 changes in 60 steps
#     nsample="1" interval="0.005"       11 changes in 60 steps
#     lengths with both, in steps        5: 397, 6: 1
#     noise="0.5": standard deviation at rest 0.0
#     jointpos of a step is qpos before it: True
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${PYTHON:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet mujoco==4.0.0 numpy==2.4.6
"$folder/venv/bin/python" - <<'END'
import mujoco
import numpy as np

MODEL = """<mujoco><option timestep="0.001"/><worldbody>
  <body pos="1 0 0"><joint name="j" axis="0 1 0"/><geom type="capsule" size=".02" fromto="0 0 0 0 0 -1" mass="1"/><site name="s" pos="0 0 -1"/></body>
</worldbody><sensor><jointpos name="plain" joint="j"/><jointpos name="slow" joint="j" %s/><gyro name="noisy" site="s" noise="0.5"/></sensor></mujoco>"""


def run(attributes, steps, angle=1.0):
    model = mujoco.MjModel.from_xml_string(MODEL % attributes)
    data = mujoco.MjData(model)
    data.qpos[0] = angle
    rows = []
    for _ in range(steps):
        before = data.qpos[0]
        mujoco.mj_step(model, data)
        rows.append([before, data.sensor("plain").data[0], data.sensor("slow").data[0], *data.sensor("noisy").data])
    return np.array(rows)


both = 'nsample="1" interval="0.005"'
changes = {}
for attributes in ["", 'interval="0.005"', 'nsample="1"', both]:
    changes[attributes] = np.count_nonzero(np.diff(run(attributes, 60)[:, 2]))
    print(f"{attributes or 'neither':34} {changes[attributes]} changes in 60 steps")
lengths, counts = np.unique(np.diff(np.flatnonzero(np.diff(run(both, 2000)[:, 2]))), return_counts=True)
print("lengths with both, in steps       ", ", ".join(f"{k}: {n}" for k, n in zip(lengths, counts)))
sd = run("", 1000, angle=0.0)[:, 3:].std()
print("noise=\"0.5\": standard deviation at rest", sd)
rows = run("", 1000)
is_before = bool(np.array_equal(rows[:, 0], rows[:, 1]))
print("jointpos of a step is qpos before it:", is_before)
assert list(changes.values()) == [59, 59, 59, 11] and set(lengths) == {5, 6} and sd == 0.0 and is_before
END
