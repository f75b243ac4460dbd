"""Reads follow_joint_trajectory.yaml by the definition of the ROS 2 message, and compares it with trajectory.csv.

    python goal.py follow_joint_trajectory.yaml trajectory.csv

The goal is made as a message of `rosbags`: its types refuse fields that are not there. It goes through CDR and back, and its points, joined by cubic Hermite
polynomials as ROS 2's joint trajectory controller does, must be the trajectory.
"""

import csv
import sys

import numpy as np
import yaml
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from scipy.interpolate import BPoly, CubicHermiteSpline

# control_msgs, branch `master` of ros-controls: JointTolerance.msg, JointComponentTolerance.msg, and the goal of FollowJointTrajectory.action
DEFINITIONS = {
    "control_msgs/msg/JointTolerance": "string name\nfloat64 position\nfloat64 velocity\nfloat64 acceleration\n",
    "control_msgs/msg/JointComponentTolerance": "string joint_name\nuint16 component\nfloat64 position\nfloat64 velocity\nfloat64 acceleration\n",
    "control_msgs/action/FollowJointTrajectory_Goal": """trajectory_msgs/JointTrajectory trajectory
trajectory_msgs/MultiDOFJointTrajectory multi_dof_trajectory
JointTolerance[] path_tolerance
JointComponentTolerance[] component_path_tolerance
JointTolerance[] goal_tolerance
JointComponentTolerance[] component_goal_tolerance
builtin_interfaces/Duration goal_time_tolerance
""".replace("JointTolerance[]", "control_msgs/JointTolerance[]").replace("JointComponentTolerance[]", "control_msgs/JointComponentTolerance[]"),
}


def message(store, name, given):
    """A message of this type, with defaults for what is not given."""
    fields = {}
    kind = store.types[name]
    rest = dict(given)
    for field, (code, spec) in store.get_msgdef(name).fields:
        fields[field] = value(store, code, spec, rest.pop(field, None))
    assert not rest, f"{name} has no field {sorted(rest)}"
    return kind(**fields)


def value(store, code, spec, given):
    if code == 1:  # a basic type, and its length
        basic = spec[0]
        return given if given is not None else ("" if basic == "string" else 0)
    if code == 2:
        return message(store, spec, given or {})
    (inner, detail), _ = spec
    if inner == 2:
        return [message(store, detail, of) for of in given or []]
    if detail[0] == "string":
        return list(given or [])
    return np.array(given or [], np.float64)


def main():
    text, table = sys.argv[1:3]
    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, definition in DEFINITIONS.items():
        store.register(get_types_from_msg(definition, name))
    name = "control_msgs/action/FollowJointTrajectory_Goal"
    made = message(store, name, yaml.safe_load(open(text)))
    goal = store.deserialize_cdr(store.serialize_cdr(made, name), name)
    rows = [row for row in csv.reader(open(table)) if row and not row[0].startswith("#")]
    numbers, n = np.array(rows[1:], float), len(goal.trajectory.joint_names)
    assert [column.rsplit("_", 1)[0] for column in rows[0][1 : 1 + n]] == list(goal.trajectory.joint_names)
    t = np.array([p.time_from_start.sec + 1e-9 * p.time_from_start.nanosec for p in goal.trajectory.points])
    q, v = (np.array([getattr(p, key) for p in goal.trajectory.points]) for key in ("positions", "velocities"))
    assert (np.diff(t) > 0).all() and abs(t - (numbers[:, 0] - numbers[0, 0])).max() < 1e-9
    curve = CubicHermiteSpline(t, q, v)
    # the rows with their accelerations: quintic, and the same curve
    joints = numbers[:, 1:].reshape(len(numbers), 3, n)
    spline = BPoly.from_derivatives(numbers[:, 0] - numbers[0, 0], joints)
    at = np.linspace(0, t[-1], 20011)
    off = np.abs(curve(at) - spline(at)).max()
    print(f"{len(t)} points of {n} joints, farthest from the trajectory {off:.1e}; {len(open(text).read()) / 1024:.0f} KiB")
    sys.exit(int(off >= 1e-8))


if __name__ == "__main__":
    main()
