"""The same simulated recording with calibrant and with dedrunk-cli: how far each is from the truth.

calibrant simulates the IMU of `init imu`, whose gyroscope has a g-sensitivity. dedrunk reads the readings as an MCAP bag.

Usage, with dedrunk-cli==0.1.1 mcap==1.6.0 rosbags==0.11.9 numpy==2.4.6: compare.py CALIBRANT [RECORDINGS]
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from mcap.writer import Writer
from rosbags.typesys import Stores, get_typestore

GROUPS = ["accelerometer.gain", "accelerometer.bias", "gyroscope.gain", "gyroscope.bias"]
NAMES = ["geometry_msgs/msg/Vector3", "geometry_msgs/msg/Quaternion", "std_msgs/msg/Header", "builtin_interfaces/msg/Time", "sensor_msgs/msg/Imu"]


def write_bag(table, path):
    types = get_typestore(Stores.ROS2_HUMBLE)
    definition, _ = types.generate_msgdef(NAMES[-1], ros_version=2)
    vector, quaternion, header, time, imu = (types.types[name] for name in NAMES)
    zeros = np.zeros(9)
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "")
        schema = writer.register_schema(NAMES[-1], "ros2msg", definition.encode())
        channel = writer.register_channel("/imu", "cdr", schema)
        for t, *values in table:
            ns = 10**18 + round(1e9 * t)
            stamp = header(time(ns // 10**9, ns % 10**9), "imu")
            message = imu(stamp, quaternion(0, 0, 0, 1), zeros, vector(*values[3:]), zeros, vector(*values[:3]), zeros)
            writer.add_message(channel, ns, bytes(types.serialize_cdr(message, NAMES[-1])), ns)
        writer.finish()


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True)


def errors(calibrant, folder, found, truth):
    """Largest error of each group: `compare` takes gains and biases, which no frame changes."""
    printed = json.loads(run(calibrant, "compare", truth, folder / found, "--json").stdout)
    differences = {row["name"]: abs(row["difference"]) for row in printed["quantities"]}
    return [max(differences[f"{group}.{axis}"] for axis in "xyz") for group in GROUPS]


def main():
    calibrant, dedrunk = Path(sys.argv[1]).resolve(), Path(sys.executable).with_name("dedrunk")
    found = {"calibrant": [], "dedrunk": []}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(calibrant, "init", "imu", "-o", folder / "imu.toml")
        for seed in range(1, 1 + int(sys.argv[2] if len(sys.argv) > 2 else 1)):
            made = folder / str(seed)
            run(calibrant, "simulate", folder / "imu.toml", "-o", made, "--seed", seed)
            write_bag(np.loadtxt(made / "recording.csv", delimiter=",", skiprows=1), made / "imu.mcap")
            run(calibrant, "calibrate", folder / "imu.toml", made / "recording.csv", "-o", made / "out")
            run(dedrunk, "-y", "intrinsics", made / "imu.mcap", "-O", made / "imu.yaml")
            for program, file in [("calibrant", "out/calibration.json"), ("dedrunk", "imu.yaml")]:
                found[program].append(errors(calibrant, made, file, made / "truth.json"))
    print(f"{'largest error':20}", *(f"{group:>19}" for group in GROUPS))
    for program, rows in found.items():
        print(f"{program:20}", *(f"{value:19.1e}" for value in np.max(rows, axis=0)))


main()
