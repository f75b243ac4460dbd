"""Times `calibrant calibrate` on a whole IMU beside the crate imu-calib: the same two files, in alternation.

usage: compare.py CALIBRANT IMU_CALIB_PEER [--runs N] [--other "COMMAND"]

CALIBRANT is the program, IMU_CALIB_PEER the one that `cargo build --release` makes of this directory. calibrant reads both files, calibrates, and writes
calibration.json and report.html with its Allan plots, or (`--no-report`) calibration.json alone; imu-calib reads, calibrates and prints. COMMAND is any other program to be timed with them, such as imu_tk's
`test_imu_calib` with its arguments. Times are those of whole processes: wall, and processor time of all threads, user and system.

The recording is imu_tk's xsens_acc.mat and xsens_gyro.mat, in xsens-mti-static of the directory that CALIBRANT_DATA names, or of ../shared/data beside the repository.
Skipped where it is absent.
"""

import argparse
import os
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def recording():
    data = Path(os.environ.get("CALIBRANT_DATA", Path(__file__).parents[2] / ".." / "shared" / "data"))
    return [data / "xsens-mti-static" / name for name in ("xsens_acc.mat", "xsens_gyro.mat")]


def run(command, directory):
    """Wall and processor time of a process, s, and what it printed."""
    out = directory / "stdout"
    with open(out, "wb") as stdout:
        started = time.perf_counter()
        process = subprocess.Popen(command, stdout=stdout, stderr=subprocess.DEVNULL, cwd=directory)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - started
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{shlex.join(map(str, command))}: exit status {process.returncode}")
    return wall, usage.ru_utime + usage.ru_stime, out.read_text(encoding="utf8", errors="replace")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("calibrant", type=Path)
    parser.add_argument("peer", type=Path)
    parser.add_argument("--runs", type=int, default=30)
    parser.add_argument("--other", type=shlex.split, help="another command to be timed")
    arguments = parser.parse_args()
    files = [path.resolve() for path in recording()]
    if not all(path.is_file() for path in files):
        print(f"SKIPPED: {files[0]} is not there; set CALIBRANT_DATA to the directory with the recordings")
        return
    with tempfile.TemporaryDirectory() as directory:
        directory = Path(directory)
        calibrant = arguments.calibrant.resolve()
        subprocess.run([calibrant, "init", "imu-counts", "-o", directory / "imu.toml"], check=True, stderr=subprocess.DEVNULL)
        commands = {
            "calibrant": [calibrant, "calibrate", "imu.toml", files[0], "--gyroscope", files[1], "-o", "out"],
            "no report": [calibrant, "calibrate", "imu.toml", files[0], "--gyroscope", files[1], "-o", "bare", "--no-report"],
            "imu-calib": [arguments.peer.resolve(), *files],
        }
        if arguments.other:
            commands[Path(arguments.other[0]).name] = arguments.other
        times = {name: [] for name in commands}
        for number in range(arguments.runs + 1):
            for name, command in commands.items():
                wall, processor, printed = run(command, directory)
                if number:  # the first warms the caches
                    times[name].append((wall, processor))
                elif name == "imu-calib":
                    print(printed)
                elif name == "calibrant":
                    print("calibrant:\n" + "".join(line + "\n" for line in printed.splitlines() if "rms" in line))
    medians = {name: [statistics.median(column) for column in zip(*rows)] for name, rows in times.items()}
    print(f"medians of {arguments.runs} runs in alternation (range); the ratio is the peer's time over calibrant's")
    for name, rows in times.items():
        words = [f"{name:12}"]
        for what, column, median, ours in zip(("wall", "processor"), zip(*rows), medians[name], medians["calibrant"]):
            words.append(
                f"{what} {1e3 * median:6.1f} ms ({1e3 * min(column):.1f} to {1e3 * max(column):.1f}), ratio {median / ours:.2f}"
            )
        print("  ".join(words))


if __name__ == "__main__":
    main()
