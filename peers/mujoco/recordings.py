"""Recordings of an IMU on a UR5e arm, made by MuJoCo: the physics is not calibrant's.

Each recording is a folder NNN with three files.

    recording.csv   t_s, specific force in m/s^2, rate in rad/s, as the IMU gives them
    joints.csv      t_s and the encoder's reading of each joint, by the URDF's joint names
    truth.json      every quantity that was drawn

MuJoCo gets positions, velocities and accelerations of a cubic B-spline at each sample's time and answers with its own
accelerometer and gyroscope. Nothing is integrated. Times and signs:

    motion time = (1 + clock_rate) t + delay      t: time of the IMU, one delay for each sensor
    true joint angle = reading + zero             y = S f + b + noise
    joint transform = origin * [exp(r), d] * exp(axis q)        geometry of a joint: d in m, then r in rad
    gravity = exp([tilt_x, tilt_y, 0]) (0, 0, -g)

The arm rests for a margin before and after the motion, and the joint log covers both margins. Collisions of the arm are not
looked at. Recording k of a seed is the same however many are written, and the geometry options change nothing else.

Usage: recordings.py FOLDER [options], with the URDF in $CALIBRANT_DATA/arms/ur5e.urdf or --urdf.
With --check the first recording is compared with a recursion written in NumPy; exit status 1 above 1e-10.
"""

import argparse
import json
import os
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import mujoco  # noqa: E402  (threads must be set first)
import numpy as np  # noqa: E402
from scipy.interpolate import BSpline  # noqa: E402
from scipy.ndimage import gaussian_filter1d  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

GRAVITY = 9.80665
TIP = "tool0"
LEVER = np.array([0.020, -0.030, 0.040])
MARGIN = 0.2  # seconds of rest before and after the motion; delays stay far below
KNOT = 0.2  # seconds between knots
SMOOTHING = 0.6 / KNOT  # of the random control points: speed 2.5 rad/s and acceleration 5 rad/s^2 are then reached together
SPEED, ACCELERATION = 2.5, 5.0
TAPER = 7  # knots over which the motion starts and ends
TOLERANCE = 1e-10
UP = np.array([[i, j, k] for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1) if abs(i) + abs(j) + abs(k) in (1, 3)])
UP = UP / np.linalg.norm(UP, axis=1, keepdims=True)  # faces and corners of a cube: where gravity has to point
NEAR, TRIES = 0.9, 50  # cosine to the nearest posture of each; motions tried before the best is taken


class Arm:
    """The arm in MuJoCo, and its own reading of the URDF for the check."""

    def __init__(self, urdf):
        root = ElementTree.parse(urdf).getroot()
        for link in root.iter("link"):
            for collision in link.findall("collision"):
                link.remove(collision)  # the meshes of package:// cannot be found
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"))
        spec.compiler.fusestatic = False  # or the tool frame is merged away
        site = spec.body(TIP).add_site(name="imu", pos=LEVER)
        for kind in (mujoco.mjtSensor.mjSENS_ACCELEROMETER, mujoco.mjtSensor.mjSENS_GYRO):
            spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site.name)
        self.model = spec.compile()
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT | mujoco.mjtDisableBit.mjDSBL_CONTACT
        self.model.site_sameframe[:] = 0  # or a site that was compiled at its body's origin ignores a new position
        self.model.body_sameframe[:] = 0
        self.data = mujoco.MjData(self.model)
        self.names = [self.model.joint(j).name for j in range(self.model.njnt)]
        self.bodies = self.model.jnt_bodyid.copy()
        self.limits = np.abs(self.model.jnt_range).min(axis=1)
        self.nominal = self.model.body_pos[self.bodies].copy(), rotations(self.model.body_quat[self.bodies])
        self.chain = chain(root)

    def place(self, truth):
        """Put the recording's geometry, mount and gravity into the model."""
        position, rotation = self.nominal
        model = self.model
        model.body_pos[self.bodies] = position + rotation.apply(truth.geometry[:, :3])
        model.body_quat[self.bodies] = quaternions(rotation * Rotation.from_rotvec(truth.geometry[:, 3:]))
        model.site_pos[0] = truth.lever
        model.site_quat[0] = quaternions(truth.mount)
        model.opt.gravity[:] = truth.gravity

    def sense(self, q, v, a):
        """Specific force and rate at each state, in the axes of the IMU."""
        answer = np.empty((len(q), 6))
        model, data = self.model, self.data
        for row, qpos, qvel, qacc in zip(answer, q, v, a):
            data.qpos, data.qvel, data.qacc = qpos, qvel, qacc
            mujoco.mj_inverse(model, data)  # sensors of a given acceleration: forward dynamics would replace it
            row[:] = data.sensordata
        return answer


def rotations(wxyz):
    return Rotation.from_quat(np.roll(wxyz, -1, axis=-1))


def quaternions(rotation):
    return np.roll(rotation.as_quat(canonical=True), 1, axis=-1)


def chain(root):
    """Joints from the base to the tip: (moves, translation, rotation, axis)."""
    parents = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    joints, link = [], TIP
    while link in parents:
        joint = parents[link]
        origin = joint.find("origin")
        axis = joint.find("axis")
        joints.append((
            joint.get("type") != "fixed",
            np.fromstring(origin.get("xyz"), sep=" "),
            Rotation.from_euler("xyz", np.fromstring(origin.get("rpy"), sep=" ")),
            None if axis is None else np.fromstring(axis.get("xyz"), sep=" "),
        ))
        link = joint.find("parent").get("link")
    return joints[::-1]


class Truth:
    """What is drawn for one recording. The order of the draws is fixed, and a zero sd still draws."""

    def __init__(self, rng, joints, o):
        identity = np.eye(3)
        self.geometry = np.hstack([
            o.translation_sd * rng.standard_normal((joints, 3)), o.rotation_sd * rng.standard_normal((joints, 3))
        ])
        self.zeros = o.zero_sd * rng.standard_normal(joints)
        self.lever = LEVER + o.lever_sd * rng.standard_normal(3)
        self.mount_error = np.radians(o.mount_sd_deg) * rng.standard_normal(3)
        self.mount = Rotation.from_rotvec(self.mount_error)
        self.tilt = np.radians(o.tilt_sd_deg) * rng.standard_normal(2)
        self.gravity = Rotation.from_rotvec([*self.tilt, 0.0]).apply([0.0, 0.0, -GRAVITY])
        common, half = o.delay_sd * rng.standard_normal(), o.delay_difference_sd * rng.standard_normal() / 2
        self.delays = common + half, common - half
        self.clock_rate = o.clock_sd * rng.standard_normal()
        self.matrix = [identity + o.matrix_sd * rng.standard_normal((3, 3)) for _ in range(2)]
        self.bias = [o.acc_bias_sd * rng.standard_normal(3), o.gyro_bias_sd * rng.standard_normal(3)]
        self.g_sensitivity = o.g_sensitivity_sd * rng.standard_normal((3, 3))

    def document(self, names, o, number):
        flat = {}
        for sensor, matrix, bias in zip(("accelerometer", "gyroscope"), self.matrix, self.bias):
            for i, x in enumerate("xyz"):
                flat[f"{sensor}.bias.{x}"] = bias[i]
                for j, y in enumerate("xyz"):
                    flat[f"{sensor}.matrix.{x}{y}"] = matrix[i, j]
        for i, x in enumerate("xyz"):
            for j, y in enumerate("xyz"):
                flat[f"gyroscope.g_sensitivity.{x}{y}"] = self.g_sensitivity[i, j]
        middle = MARGIN + o.seconds / 2
        return {
            "made_by": f"MuJoCo {mujoco.__version__}",
            "seed": o.seed,
            "recording": number,
            "options": {k: v for k, v in vars(o).items() if k not in ("folder", "urdf", "check")},
            "parameters": flat,
            "lever_m": self.lever.tolist(),
            "tip_from_sensor": {"quaternion_wxyz": quaternions(self.mount).tolist(), "error_rad": self.mount_error.tolist()},
            "tilt_rad": self.tilt.tolist(),
            "gravity_mps2": self.gravity.tolist(),
            "delays_s": dict(zip(("accelerometer", "gyroscope"), self.delays)),
            "delays_at_middle_s": {
                s: d + self.clock_rate * middle for s, d in zip(("accelerometer", "gyroscope"), self.delays)
            },
            "middle_s": middle,
            "clock_rate": self.clock_rate,
            "joints": names,
            "geometry": self.geometry.tolist(),
            "zeros": self.zeros.tolist(),
        }


class Nominal:
    """The arm as the URDF has it, upright, with the sensor where it should be."""

    def __init__(self, joints):
        self.geometry = np.zeros((joints, 6))
        self.lever, self.mount, self.gravity = LEVER, Rotation.identity(), np.array([0.0, 0.0, -GRAVITY])


def motion(rng, limits, seconds):
    """Random joint motion, at rest at both ends: a cubic B-spline and its two derivatives, over all time."""
    moving = round(seconds / KNOT) + 1
    white = rng.standard_normal((moving + 40, len(limits)))
    points = gaussian_filter1d(white, SMOOTHING, axis=0)
    points = points / points.std(axis=0) + 0.7 * (lambda s: s / s.std(axis=0))(gaussian_filter1d(white, 4 * SMOOTHING, axis=0))
    points = points[20:-20]
    ramp = np.clip((np.arange(moving) - 2) / TAPER, 0.0, 1.0)
    ramp = ramp**3 * (10 - 15 * ramp + 6 * ramp**2)
    points = points * (ramp * ramp[::-1])[:, None]
    fastest = np.abs(np.diff(points, axis=0)).max(axis=0) / KNOT
    hardest = np.abs(np.diff(points, 2, axis=0)).max(axis=0) / KNOT**2
    points *= np.minimum(np.minimum(SPEED / fastest, ACCELERATION / hardest), (0.95 * limits - 1) / np.abs(points).max(axis=0))
    points += rng.uniform(-1.0, 1.0, len(limits))  # the posture of rest
    rest = 8  # equal control points before and after, beyond the margins
    points = np.pad(points, ((rest, rest), (0, 0)), mode="edge")
    knots = MARGIN + KNOT * (np.arange(len(points) + 4) - rest - 2)
    spline = BSpline(knots, points, 3, extrapolate=False)
    return spline, spline.derivative(), spline.derivative(2)


def varied_motion(arm, rng, seconds):
    """A random motion in which gravity points everywhere, judged on the nominal arm; the best of the tries otherwise."""
    arm.place(Nominal(len(arm.names)))
    best = None
    for _ in range(TRIES):
        candidate = motion(rng, arm.limits, seconds)
        q = candidate[0](MARGIN + np.arange(0.0, seconds, 0.1))
        force = arm.sense(q, 0 * q, 0 * q)[:, :3] / GRAVITY
        near = (force @ UP.T).max(axis=0).min()
        if best is None or near > best[0]:
            best = near, candidate
        if near >= NEAR:
            break
    return best[1]


def recursion(arm, truth, q, v, a):
    """Specific force and rate by a recursion over the chain in world axes; shares nothing with MuJoCo."""
    n = len(q)
    rotation, rate = Rotation.identity(n), np.zeros((n, 3))
    angular, linear = np.zeros((n, 3)), np.zeros((n, 3))

    def shift(offset):
        arms = rotation.apply(offset)
        return linear + np.cross(angular, arms) + np.cross(rate, np.cross(rate, arms))

    j = 0
    for moves, translation, turn, axis in arm.chain:
        linear, rotation = shift(translation), rotation * turn
        if moves:
            linear = shift(truth.geometry[j, :3])
            rotation = rotation * Rotation.from_rotvec(truth.geometry[j, 3:])
            world = rotation.apply(axis)
            angular = angular + world * a[:, j : j + 1] + np.cross(rate, world * v[:, j : j + 1])
            rate = rate + world * v[:, j : j + 1]
            rotation = rotation * Rotation.from_rotvec(axis * q[:, j : j + 1])
            j += 1
    linear = shift(truth.lever)
    sensor = (rotation * truth.mount).inv()
    return np.hstack([sensor.apply(linear - truth.gravity), sensor.apply(rate)])


def table(path, header, columns, digits):
    line = ",".join(["%.6f"] + [f"%.{digits}f"] * (columns.shape[1] - 1)) + "\n"
    path.write_text(",".join(header) + "\n" + (line * len(columns)) % tuple(columns.ravel().tolist()))


def record(arm, o, number):
    rng = np.random.default_rng([o.seed, number])
    truth = Truth(rng, len(arm.names), o)
    q, v, a = varied_motion(arm, rng, o.seconds)
    arm.place(truth)

    t = MARGIN + np.arange(round(o.seconds * o.rate) + 1) / o.rate
    measured, clean, worst = [t[:, None]], [], 0.0
    for sensor in range(2):
        tau = (1 + truth.clock_rate) * t + truth.delays[sensor]
        states = q(tau), v(tau), a(tau)
        sensed = arm.sense(*states)
        if o.check and number == 0:
            worst = max(worst, np.abs(sensed - recursion(arm, truth, *states)).max())
        clean.append(sensed)
    noise = o.acc_noise, o.gyro_noise
    for sensor in range(2):
        ideal = clean[sensor][:, 3 * sensor : 3 * sensor + 3]
        y = ideal @ truth.matrix[sensor].T + truth.bias[sensor] + noise[sensor] * rng.standard_normal(ideal.shape)
        measured.append(y + clean[1][:, :3] @ truth.g_sensitivity.T if sensor == 1 else y)

    s = np.arange(round((o.seconds + 2 * MARGIN) * o.encoder_rate) + 1) / o.encoder_rate
    reading = q(s) - truth.zeros
    reading = reading + o.encoder_sd * rng.standard_normal(reading.shape)
    if o.resolution > 0:
        reading = o.resolution * np.round(reading / o.resolution)

    folder = o.folder / f"{number:03d}"
    folder.mkdir(parents=True, exist_ok=True)
    axes = [f"{k}_{x}_{u}" for k, u in (("acc", "mps2"), ("gyro", "radps")) for x in "xyz"]
    table(folder / "recording.csv", ["t_s", *axes], np.hstack(measured), 9)
    table(folder / "joints.csv", ["t_s", *(f"{n}_rad" for n in arm.names)], np.hstack([s[:, None], reading]), 10)
    (folder / "truth.json").write_text(json.dumps(truth.document(arm.names, o, number), indent=1) + "\n")
    force = clean[0][:, :3] / np.linalg.norm(clean[0][:, :3], axis=1, keepdims=True)
    return worst, (force @ UP.T).max(axis=0).min()


def options():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("folder", type=Path)
    data = os.environ.get("CALIBRANT_DATA")
    p.add_argument("--urdf", type=Path, default=Path(data) / "arms/ur5e.urdf" if data else None, required=not data)
    p.add_argument("-n", "--number", type=int, default=300)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--check", action="store_true", help="compare the first recording with a NumPy recursion")
    p.add_argument("--geometry", choices=("exact", "perturbed"), default="perturbed")
    for name, value, text in (
        ("seconds", 20.0, "length of the motion"),
        ("rate", 200.0, "IMU samples per second"),
        ("encoder-rate", 500.0, "encoder samples per second"),
        ("encoder-sd", 2e-5, "rad"),
        ("resolution", 0.0, "of the encoder, rad; 0 for none"),
        ("translation-sd", 3e-4, "of each joint's transform, m"),
        ("rotation-sd", 3e-4, "of each joint's transform, rad"),
        ("zero-sd", 3e-4, "of each joint's zero, rad"),
        ("lever-sd", 2e-3, "m"),
        ("mount-sd-deg", 0.5, "per axis"),
        ("tilt-sd-deg", 0.5, "about x and y"),
        ("delay-sd", 10e-3, "of both sensors together, s"),
        ("delay-difference-sd", 1e-3, "accelerometer less gyroscope, s"),
        ("clock-sd", 50e-6, "of the clock's rate"),
        ("matrix-sd", 5e-3, "of each entry of S"),
        ("acc-bias-sd", 0.1, "m/s^2"),
        ("gyro-bias-sd", 0.01, "rad/s"),
        ("acc-noise", 0.0055, "m/s^2 per sample"),
        ("gyro-noise", 9e-4, "rad/s per sample"),
        ("g-sensitivity-sd", 0.0, "rad/s per m/s^2"),
    ):
        p.add_argument(f"--{name}", type=float, default=value, help=f"{text} (default {value:g})")
    o = p.parse_args()
    if o.geometry == "exact":
        o.translation_sd = o.rotation_sd = o.zero_sd = 0.0
    return o


def main():
    o = options()
    arm = Arm(o.urdf)
    start = time.monotonic()
    worst, nearest = zip(*(record(arm, o, number) for number in range(o.number)))
    print(f"{o.number} recordings in {time.monotonic() - start:.1f} s")
    print(f"specific force comes within {np.degrees(np.arccos(min(nearest))):.0f} deg of each face and corner of a cube")
    if o.check:
        print(f"largest difference from the recursion: {max(worst):.2e}")
        return int(max(worst) > TOLERANCE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
