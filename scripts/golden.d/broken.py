"""Inputs with something wrong in them: experiment files, recordings, motions, sections, calibrations, command lines."""

import json
import random

import formats


def broken_cases(maker, Case):
    def case(name, commands, files):
        return Case(f"broken/{name}", [commands] if isinstance(commands, str) else commands, files)

    for group in (experiments, poor_texts, motions, imus, poses, ferraris, binaries, calibrations, usage):
        yield from group(maker, case)


def edited(text, old, new):
    if old not in text:
        raise ValueError(f"{old!r} is not in\n{text}")
    return text.replace(old, new, 1)


# --- experiment files ---

MOTION_EDITS = [
    ("unknown-key", "interval_s = 1.0", "intervall_s = 1.0"),
    ("unknown-section", "[limits]", "[limit]"),
    ("key-of-another-section", "axes = 3", "axes = 3\nrate_hz = 5.0"),
    ("two-axes", "axes = 3", "axes = 2"),
    ("number-in-quotes", "axes = 3", 'axes = "3"'),
    ("gyroscope-alone", '"accelerometer"', '"gyroscope"'),
    ("negative-noise", "noise_mps2 = 2e-4", "noise_mps2 = -2e-4"),
    ("noise-nan", "noise_mps2 = 2e-4", "noise_mps2 = nan"),
    ("noise-of-two-axes", "noise_mps2 = 2e-4", "noise_mps2 = [1e-4, 2e-4]"),
    ("no-noise", "noise_mps2 = 2e-4", ""),
    ("misspelt-choice", '"known"', '"knwon"'),
    ("unknown-without-ends", '"known"', '"unknown"'),
    ("noisy-without-input-noise", '"known"', '"noisy"'),
    ("no-intervals", "intervals = 10", "intervals = 0"),
    ("rate-too-low", "rate_hz = 10.0", "rate_hz = 1e-3"),
    ("key-twice", "rate_hz = 10.0", "rate_hz = 10.0\nrate_hz = 20.0"),
    ("no-value", "rate_hz = 10.0", "rate_hz ="),
    ("another-schema", "schema = 1", "schema = 2"),
    ("unknown-prior", 'prior = "none"', 'prior = "flat"'),
    ("unknown-criterion", 'criterion = "A"', 'criterion = "Z"'),
    ("boolean-for-number", "interval_s = 1.0", "interval_s = true"),
    ("huge-interval", "interval_s = 1.0", "interval_s = 1e30"),
    ("limit-of-nothing", "jerk_mps3 = 30.0", "jerk_mps3 = 0.0"),
]

IMU_EDITS = [
    ("latitude", "latitude_deg = 52.0", "latitude_deg = 152.0"),
    ("gravity-and-no-place", "latitude_deg = 52.0          # gravity, with its uncertainty, and how the Earth turns\nheight_m = 30.0\n", ""),
    ("gauge", '"lower"', '"middle"'),
    ("unit", '"radps"', '"rpm"'),
    ("many-poses", "poses = 24", "poses = 1000000000"),
    ("too-many-samples", "poses = 24", "poses = 1000000"),
    ("known-name", "\n[holds]", '\n[known]\n"gyroscope.bais.x" = 0.1\n[holds]'),
    ("known-sd", "\n[holds]", '\n[known]\n"gyroscope.scale.x" = { value = 1.0, sd = 1e-200 }\n[holds]'),
    ("temperature-order", "\n[holds]", "\n[temperature]\ngyroscope_bias = 6\n[holds]"),
    ("columns-unit", "\n[holds]", '\n[columns]\naccelerometer_unit = "furlong"\n[holds]'),
    ("turn-axis", "g_sensitivity = true", 'turns = [{ start_s = 7.0, end_s = 11.0, axis = "w", angle_deg = 360.0 }]'),
    ("interval-backwards", "poses = 24", "intervals_s = [[5.0, 1.0], [6.0, 9.0]]"),
    ("intervals-overlap", "poses = 24", "intervals_s = [[1.0, 5.0], [4.0, 9.0]]"),
    ("face-sd", "poses = 24", "face_sd_deg = 12.0"),
    ("two-axes", "axes = 3", "axes = 1"),
]


def experiments(maker, case):
    good = maker.preset("report")
    made = maker.simulated(good)
    files = {"recording.csv": made["recording.csv"], "motion.csv": made["motion.csv"]}
    commands = ["simulate broken.toml -o made", "calibrate broken.toml recording.csv --motion motion.csv -o result"]
    for name, old, new in MOTION_EDITS:
        yield case(f"experiment/{name}", commands, files | {"broken.toml": edited(good, old, new)})
    hand = maker.example("06_whole_imu/hand.toml")
    recording = {"recording.csv": quick_imu(maker)[1]}
    for name, old, new in IMU_EDITS:
        yield case(f"experiment/imu-{name}", ["simulate broken.toml -o made", "calibrate broken.toml recording.csv --no-report -o result"], recording | {"broken.toml": edited(hand, old, new)})
    texts = {
        "empty": b"",
        "binary": b"\x00\x01\x02",
        "latin-1": b"schema = 1\n# caf\xe9\n",
        "only-schema": b"schema = 1\n",
        "csv": b"t_s,ax,ay,az\n0,1,2,3\n",
        "motion-and-holds": good + '[holds]\ngravity_mps2 = 9.81\ngauge = "upper"\n',
    }
    for name, text in texts.items():
        yield case(f"experiment/{name}", ["simulate broken.toml -o made", "study broken.toml -o out"], {"broken.toml": text})
    yield case("experiment/none", ["simulate absent.toml -o made", "simulate folder -o made"], {"folder/inside.toml": ""})


# --- texts that are no recording, or hardly one ---

POOR_TEXTS = {
    "empty": b"",
    "blank": b"\n\n  \n",
    "comments": b"# only a comment\n",
    "header": b"t_s,ax,ay,az\n",
    "one-row": b"t_s,ax,ay,az\n0,1,2,3\n",
    "elf": b"\x7fELF\x02\x01\x01\0\0\0",
    "zip": b"PK\x03\x04\x14\0\0\0",
    "gzip": b"\x1f\x8b\x08\0\0\0\0\0",
    "utf-16": b"\xff\xfet\0_\0s\0",
    "latin-1": b"t_s,ax,ay,az\n0,1,2,3\n\xfc,1,2,3\n",
    "old-mac": b"t_s,ax,ay,az\r0,1,2,3\n1,1,2,3\r",
    "all-nan": b"t_s,ax,ay,az\n0,nan,2,3\n1,nan,2,3\n",
    "out-of-range": b"t_s,ax,ay,az\n0,1,2,3\n1,1e300,2,3\n2,1,2,3\n",
    "infinite": b"t_s,ax,ay,az\n0,1,2,3\n1,1,-inf,3\n2,1,2,3\n",
    "one-time": b"t_s,ax,ay,az\n0,1,2,3\n0,1,2,3\n0,1,2,3\n",
    "backwards": b"t_s,ax,ay,az\n0,1,2,3\n2,1,2,3\n1,1,2,3\n",
    "short-row": b"t_s,ax,ay,az\n0,1,2,3\n1,1,2\n2,1,2,3\n",
    "long-row": b"t_s,ax,ay,az\n0,1,2,3\n1,1,2,3,4\n",
    "word": b"t_s,ax,ay,az\n0,1,2,3\n1,one,2,3\n2,1,2,3\n",
    "decimal-comma": b"t_s;ax;ay;az\n0,0;1,0;2,0;3,0\n",
    "missing-column": b"t_s,ax,ay\n0,1,2\n1,2,3\n",
    "unnamed": b"time,x,y,z\n0,1,2,3\n1,2,3,4\n",
    "mixed-units": b"t_s,ax_g,ay_counts,az\n0,1,2,3\n",
    "three-columns": b"0 1 2\n1 2 3\n",
    "json": b'{"t_s": [0, 1], "ax": [1, 2]}\n',
    "calibration": b'{\n"parameters": []}\n',
    "counts": b"t_s,ax_counts,ay_counts,az_counts\n0,1,2,3\n1,2,3,4\n",
    "outside": b"t_s,ax,ay,az\n90,1,2,3\n91,2,3,4\n",
}


def poor_texts(maker, case):
    experiment, hand = maker.preset("report"), maker.example("06_whole_imu/hand.toml")
    made = maker.simulated(experiment)
    files = {"experiment.toml": experiment, "hand.toml": hand, "motion.csv": made["motion.csv"]}
    commands = ["calibrate experiment.toml recording.csv --motion motion.csv -o result", "inspect recording.csv", "calibrate hand.toml recording.csv -o result", "noise recording.csv --json"]
    for name, text in POOR_TEXTS.items():
        yield case(f"text/{name}", commands, files | {"recording.csv": text})
    good = made["recording.csv"].splitlines()
    repairs = {
        "nan": [*good[:7], "0.6,NaN,1,2", *good[8:]],
        "row-twice": [*good[:7], *good[6:]],
        "time-twice": [*good[:7], good[6] + "e-1", *good[7:]],
        "cut-off": [*good[:101], "10.0,1."],
        "gap": [*good[:20], *good[40:]],
        "windows": [line + "\r" for line in good],
        "comment": ["# of the logger", *good],
    }
    for name, lines in repairs.items():
        yield case(f"repaired/{name}", commands[:2], files | {"recording.csv": "\n".join(lines) + ("" if name == "cut-off" else "\n")})


# --- commanded motions ---

MOTIONS = {
    "empty": "",
    "header": "t_s,ax_mps2,ay_mps2,az_mps2\n",
    "one-node": "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n",
    "no-header": "0,1,2,3\n1,2,3,4\n",
    "no-units": "t_s,ax,ay,az\n0,1,2,3\n1,2,3,4\n",
    "missing-axis": "t_s,ax_mps2,ay_mps2\n0,1,2\n1,2,3\n",
    "nan": "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,nan,3,4\n",
    "same-time": "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n0,2,3,4\n",
    "short-row": "t_s,ax_mps2,ay_mps2,az_mps2\n0,1,2,3\n1,2,3\n",
    "constant-y": "t_s,ax_mps2,ay_mps2,az_mps2\n" + "".join(f"{t},{t % 3},2,{(t * t) % 5}\n" for t in range(11)),
    "still": "t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,0\n10,0,0,0\n",
}


def motions(maker, case):
    experiment = maker.preset("report")
    recording = maker.simulated(experiment)["recording.csv"]
    files = {"experiment.toml": experiment, "recording.csv": recording}
    for name, text in MOTIONS.items():
        commands = ["calibrate experiment.toml recording.csv --motion motion.csv -o result", "design experiment.toml --evaluate motion.csv --starts 1 --no-certificate -o out"]
        yield case(f"motion/{name}", commands, files | {"motion.csv": text})
    unknown = maker.preset("report-unknown")
    made = maker.simulated(unknown)
    lines = made["motion.csv"].splitlines()
    for place in (1, -1):
        cells = lines[place].split(",")
        lines[place] = ",".join([*cells[:3], "1.5"])
    files = {"unknown.toml": unknown, "full.toml": edited(unknown, '"scale-bias"', '"full"'), "recording.csv": made["recording.csv"], "motion.csv": made["motion.csv"], "ends.csv": "\n".join(lines) + "\n"}
    yield case("motion/equal-ends", "calibrate unknown.toml recording.csv --motion ends.csv -o result", files)
    yield case("motion/full-matrix-of-unknown", "calibrate full.toml recording.csv --motion motion.csv -o result", files)
    yield case("motion/clash", "design clash.toml -o none", {"clash.toml": maker.example("05_design_a_motion/clash.toml")})


# --- recordings of an IMU ---


def quick_imu(maker):
    """An experiment with few samples, and the recording of an IMU."""
    hand = maker.example("06_whole_imu/hand.toml")
    quick = edited(edited(hand, "poses = 24", "poses = 18"), "rate_hz = 100.0", "rate_hz = 50.0")
    return quick, maker.simulated(quick, "--seed 3")["recording.csv"]


class Table:
    """Rows of numbers under a header."""

    def __init__(self, text):
        lines = text.splitlines()
        self.header = lines[0]
        self.rows = [[float(cell) for cell in line.split(",")] for line in lines[1:]]

    def text(self, rows=None, header=None):
        cells = ("" if value is None else repr(value) for row in rows or self.rows for value in row)
        width = len((rows or self.rows)[0])
        cells = list(cells)
        lines = [",".join(cells[at : at + width]) for at in range(0, len(cells), width)]
        return "\n".join([header or self.header, *lines]) + "\n"

    def each(self, change, header=None):
        """Every row changed: `change` gets its place and its numbers."""
        return self.text([change(place, list(row)) for place, row in enumerate(self.rows)], header)

    def columns(self, order, header=None):
        return self.each(lambda _, row: [row[place] for place in order], header)


def with_cell(row, column, value):
    row[column] = value
    return row


def scaled(row, columns, gain):
    return [value * gain if column in columns else value for column, value in enumerate(row)]


def imu_faults(table):
    """Name and text of recordings of an IMU, each with one thing wrong."""
    count = len(table.rows)
    middle = count // 2
    rate, force = range(4, 7), range(1, 4)
    degrees = 57.29577951308232
    yield "rate-in-degrees", table.each(lambda _, row: scaled(row, rate, degrees))
    yield "rate-in-millidegrees", table.each(lambda _, row: scaled(row, rate, 1000 * degrees))
    yield "force-in-g", table.each(lambda _, row: scaled(row, force, 1 / 9.80665))
    yield "force-twice", table.each(lambda _, row: scaled(row, force, 2.0))
    yield "rate-halved", table.each(lambda _, row: scaled(row, rate, 0.5))
    yield "rate-reversed", table.each(lambda _, row: scaled(row, rate, -1.0))
    yield "rate-one-axis-reversed", table.each(lambda _, row: scaled(row, [5], -1.0))
    yield "rate-swapped-axes", table.columns([0, 1, 2, 3, 5, 4, 6])
    yield "rate-turned-axes", table.columns([0, 1, 2, 3, 5, 6, 4])
    yield "force-swapped-axes", table.columns([0, 2, 1, 3, 4, 5, 6])
    yield "both-turned-axes", table.columns([0, 2, 3, 1, 5, 6, 4])
    yield "sensors-swapped", table.columns([0, 4, 5, 6, 1, 2, 3])
    yield "dead-axis", table.each(lambda _, row: with_cell(row, 4, 0.0))
    yield "dead-gyroscope", table.each(lambda place, row: [*row[:4], *(1e-3 * ((place * 7919 + shift) % 13) for shift in (0, 5, 9))])
    yield "constant-force-axis", table.each(lambda _, row: with_cell(row, 2, 0.125))
    yield "saturated-rate", table.each(lambda _, row: [*row[:4], *(max(-0.7, min(0.7, value)) for value in row[4:])])
    yield "saturated-force", table.each(lambda _, row: with_cell(row, 3, min(6.0, row[3])))
    yield "gap", table.text(table.rows[:middle] + table.rows[middle + 200 :])
    yield "gaps-scattered", table.text([row for place, row in enumerate(table.rows) if place % 97 not in (5, 6, 7)])
    yield "nan-scattered", table.each(lambda place, row: with_cell(row, 1 + place % 6, float("nan")) if place % 53 == 7 else row)
    yield "cells-missing", table.each(lambda place, row: with_cell(row, 1 + place % 6, None) if place % 41 == 11 else row)
    yield "wild-sample", table.each(lambda place, row: with_cell(row, 5, -1e300) if place == middle else row)
    yield "wild-samples", table.each(lambda place, row: with_cell(row, 1 + place % 6, 1e12) if place % 301 == 100 else row)
    yield "spikes", table.each(lambda place, row: with_cell(row, 1 + place % 6, row[1 + place % 6] + (0.5 if place % 2 else -0.5)) if place % 67 == 13 else row)
    yield "small-spikes", table.each(lambda place, row: with_cell(row, 4, row[4] + 0.03) if place % 211 == 17 else row)
    yield "one-sided-spikes", table.each(lambda place, row: with_cell(row, 2, row[2] + 0.2) if place % 29 == 3 else row)
    yield "times-twice", table.text([row for place, row in enumerate(table.rows) for row in [row] * (2 if place % 83 == 19 else 1)])
    yield "time-backwards", table.each(lambda place, row: with_cell(row, 0, row[0] - 1.0) if place == middle else row)
    yield "time-in-milliseconds", table.each(lambda _, row: with_cell(row, 0, 1000 * row[0]))
    yield "time-jitter", table.each(lambda place, row: with_cell(row, 0, round(row[0] + 0.004 * ((place * 37) % 11 - 5) / 5, 6)))
    yield "time-since-1970", table.each(lambda _, row: with_cell(row, 0, round(1700000000 + row[0], 4)))
    yield "cut-short", table.text(table.rows[:500])
    yield "two-rows", table.text(table.rows[:2])
    yield "lost-gyroscope", table.columns([0, 1, 2, 3], "t_s,ax_mps2,ay_mps2,az_mps2")
    yield "no-units", table.text(header="t_s,ax,ay,az,gx,gy,gz")
    yield "other-names", table.text(header="stamp,accel_1,accel_2,accel_3,rot_1,rot_2,rot_3")
    yield "column-twice", table.text(header="t_s,ax_mps2,ax_mps2,az_mps2,gx_radps,gy_radps,gz_radps")
    yield "axis-missing", table.columns([0, 1, 2, 3, 4, 5], "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps")
    yield "free-acceleration", table.text(header="t_s,freeacc_x,freeacc_y,freeacc_z,gx_radps,gy_radps,gz_radps")
    yield "bias-jumps", table.each(lambda place, row: with_cell(row, 4, row[4] + 0.01) if place > middle else row)
    yield "force-jumps", table.each(lambda place, row: with_cell(row, 1, row[1] + 0.05) if place > middle else row)
    yield "gain-jumps", table.each(lambda place, row: scaled(row, rate, 1.02) if place > middle else row)
    yield "bias-drifts", table.each(lambda place, row: with_cell(row, 6, row[6] + 0.02 * place / count))
    yield "clock-offset", table.text([row[:4] + later[4:] for row, later in zip(table.rows, table.rows[6:])])
    yield "clock-skew", table.text([row[:4] + table.rows[min(count - 1, place + place * 40 // count)][4:] for place, row in enumerate(table.rows)])
    yield "rounded", table.each(lambda _, row: [row[0], *(round(value, 1) for value in row[1:4]), *(round(value, 2) for value in row[4:])])
    yield "filtered", filtered(table, 0.95)
    yield "vibrating", table.each(lambda place, row: with_cell(row, 1, row[1] + (0.3 if place % 4 < 2 else -0.3)))
    yield "noisy", noisy(table, 0.5, 0.05)
    yield "never-still", noisy(table, 8.0, 3.0)
    yield "one-hold-shaken", table.each(lambda place, row: with_cell(row, 1, row[1] + 0.4 * ((place % 10) - 4.5)) if 450 < place < 500 else row)
    lines = table.text().splitlines()
    yield "words-in-the-middle", "\n".join([*lines[:middle], "start of block", *lines[middle:]]) + "\n"


def filtered(table, pole):
    state = list(table.rows[0])

    def step(_, row):
        state[1:] = [pole * before + (1 - pole) * value for before, value in zip(state[1:], row[1:])]
        return [row[0], *state[1:]]

    return table.each(step)


def noisy(table, force_sd, rate_sd):
    source = random.Random(7)
    return table.each(lambda _, row: [row[0], *(value + source.gauss(0, force_sd) for value in row[1:4]), *(value + source.gauss(0, rate_sd) for value in row[4:])])


def noise_faults(recording):
    """Name and text of recordings of an IMU at rest, each with one thing wrong."""
    table = Table(recording)
    table.rows = table.rows[:8000]
    yield "spikes", table.each(lambda place, row: with_cell(row, 1 + place % 6, row[1 + place % 6] + 0.8) if place % 401 == 77 else row)
    yield "many-spikes", table.each(lambda place, row: with_cell(row, 4, row[4] + 0.5) if place % 31 == 7 else row)
    yield "wild", table.each(lambda place, row: with_cell(row, 2, 1e200) if place == 3000 else row)
    yield "filtered", filtered(table, 0.9)
    yield "vibrating", table.each(lambda place, row: with_cell(row, 3, row[3] + (0.2 if place % 8 < 4 else -0.2)))
    yield "drifting", table.each(lambda place, row: with_cell(row, 6, row[6] + 1e-6 * place))
    yield "rounded", table.each(lambda _, row: [row[0], *(round(value, 1) for value in row[1:4]), *(round(value, 2) for value in row[4:])])
    yield "dead", table.each(lambda _, row: with_cell(row, 5, 0.0))
    yield "gap", table.text(table.rows[:3000] + table.rows[3500:])
    yield "short", table.text(table.rows[:150])
    yield "moving", noisy(table, 5.0, 2.0)


def imus(maker, case):
    hand, recording = quick_imu(maker)
    table = Table(recording)
    for name, text in imu_faults(table):
        options = "--folds 3 " if name in ("bias-jumps", "spikes") else ""
        report = "" if name in ("gap", "wild-samples", "saturated-rate", "clock-offset", "rate-in-degrees") else "--no-report "
        yield case(f"imu/{name}", [f"calibrate hand.toml recording.csv {options}{report}-o result", "inspect recording.csv --json"], {"hand.toml": hand, "recording.csv": text})

    good = maker.calibrated(hand, recording)
    for name, text in imu_faults(table):
        if name in ("nan-scattered", "wild-sample", "saturated-rate", "gap", "times-twice", "lost-gyroscope", "force-in-g", "no-units", "column-twice"):
            yield case(f"apply/{name}", "apply good.json recording.csv -o true.csv", {"good.json": good, "recording.csv": text})

    half = len(table.rows) // 2
    other = Table(maker.simulated(hand, "--seed 3 --recording 2")["recording.csv"])
    another = Table(maker.simulated(hand, "--seed 4")["recording.csv"])
    validations = {
        "itself": recording,
        "copy": recording + "\n",
        "rounded-copy": table.each(lambda _, row: [row[0], *(round(value, 3) for value in row[1:])]),
        "copy-in-g": table.each(lambda _, row: scaled(row, range(1, 4), 1 / 9.80665), "t_s,ax_g,ay_g,az_g,gx_radps,gy_radps,gz_radps"),
        "part": table.text(table.rows[:half]),
        "every-second": table.text(table.rows[::2]),
        "later-copy": table.each(lambda _, row: with_cell(row, 0, row[0] + 1000.0)),
        "smoothed-copy": filtered(table, 0.5),
        "reordered-copy": table.text([[*first[:1], *second[1:]] for first, second in zip(table.rows, table.rows[half:] + table.rows[:half])]),
        "another-sensor": another.text(),
        "bias-moved": other.each(lambda _, row: [*row[:4], row[4] + 0.01, *row[5:]]),
        "gain-moved": other.each(lambda _, row: scaled(row, range(1, 4), 1.05)),
        "other-unit": other.each(lambda _, row: scaled(row, range(4, 7), 57.29577951308232)),
        "noisier": noisy(other, 0.05, 0.01),
        "turned": other.columns([0, 2, 3, 1, 5, 6, 4]),
        "too-short": other.text(other.rows[:60]),
        "one-hold": other.text(other.rows[:130]),
        "accelerometer-alone": other.columns([0, 1, 2, 3], "t_s,ax_mps2,ay_mps2,az_mps2"),
    }
    for name, text in validations.items():
        yield case(f"validate/{name}", "calibrate hand.toml recording.csv --validate other.csv --no-report -o result", {"hand.toml": hand, "recording.csv": recording, "other.csv": text})
    files = {"hand.toml": hand, "recording.csv": recording, "acc.csv": table.columns([0, 1, 2, 3], "t_s,ax_mps2,ay_mps2,az_mps2"), "gyro.csv": table.columns([0, 4, 5, 6], "t_s,gx_radps,gy_radps,gz_radps")}
    files["later.csv"] = Table(files["gyro.csv"]).each(lambda _, row: with_cell(row, 0, row[0] + 1000.0))
    commands = [
        "calibrate hand.toml acc.csv --gyroscope gyro.csv --no-report -o pair",
        "calibrate hand.toml gyro.csv --gyroscope acc.csv -o exchanged",
        "calibrate hand.toml acc.csv --gyroscope later.csv -o later",
        "calibrate hand.toml recording.csv --gyroscope recording.csv -o twice",
        "calibrate hand.toml acc.csv acc.csv --gyroscope gyro.csv -o missing",
        "calibrate hand.toml recording.csv recording.csv --folds 3 -o several",
        "calibrate hand.toml recording.csv --folds 1 -o folds",
        "calibrate hand.toml recording.csv --folds 1000 -o folds",
        "calibrate hand.toml recording.csv --validate absent.csv -o absent",
        "inspect acc.csv later.csv --json",
    ]
    yield case("imu/pairs", commands, files)
    known = {"gyroscope.scale.x": "0.0", "gyroscope.bias.x": "1000.0", "accelerometer.bias.x": "0.5", "accelerometer.scale.x": "0.0", "gyroscope.matrix.xy": "1e11"}
    for name, value in known.items():
        yield case(f"known/{name}", "calibrate known.toml recording.csv --no-report -o result", {"known.toml": f'{hand}\n[known]\n"{name}" = {value}\n', "recording.csv": recording})
    orders = hand + "\n[temperature]\ngyroscope_bias = 1\n"
    warmed = [(f"{20 + 25 * place / len(table.rows):.3f}" if place % 50 == 0 else None) for place in range(len(table.rows))]
    header = table.header + ",temp_c"
    temperatures = {
        "none": recording,
        "constant": table.each(lambda _, row: [*row, 25.0], header),
        "kelvin": table.each(lambda place, row: [*row, 300.0 + 20 * place / len(table.rows)], header),
        "sparse": "\n".join([header, *(f"{line},{cell or ''}" for line, cell in zip(recording.splitlines()[1:], warmed))]) + "\n",
    }
    for name, text in temperatures.items():
        yield case(f"temperature/{name}", "calibrate imu.toml recording.csv --no-report -o result", {"imu.toml": orders, "recording.csv": text})


# --- an accelerometer alone, in holds ---


def poses(maker, case):
    static = maker.preset("static-poses")
    quick = edited(edited(static, "hold_s = 5.0 ", "hold_s = 2.0 "), "rate_hz = 100.0 ", "rate_hz = 50.0 ")
    recording = maker.simulated(quick, "--seed 2")["recording.csv"]
    table = Table(recording)
    middle = len(table.rows) // 2
    faults = {
        "in-g": table.each(lambda _, row: scaled(row, [1, 2, 3], 1 / 9.80665)),
        "axis-dead": table.each(lambda _, row: with_cell(row, 3, 0.0)),
        "spikes": table.each(lambda place, row: with_cell(row, 1, row[1] + 1.0) if place % 61 == 9 else row),
        "wild": table.each(lambda place, row: with_cell(row, 2, 1e12) if place == middle else row),
        "knocked": table.each(lambda place, row: with_cell(row, 1, row[1] + 0.05) if place > middle else row),
        "saturated": table.each(lambda _, row: with_cell(row, 1, max(-5.0, row[1]))),
        "gap": table.text(table.rows[:middle] + table.rows[middle + 300 :]),
        "one-hold": table.text(table.rows[:90]),
        "few-holds": table.text(table.rows[:700]),
        "copy-of-holds": table.text(table.rows + [[row[0] + table.rows[-1][0] + 0.02, *row[1:]] for row in table.rows]),
        "hold-moved": table.each(lambda place, row: with_cell(row, 2, row[2] + 0.02 * (place % 90) / 90)),
        "filtered": filtered(table, 0.95),
        "free-of-gravity": table.each(lambda _, row: scaled(row, [1, 2, 3], 0.01)),
    }
    for name, text in faults.items():
        yield case(f"poses/{name}", ["calibrate static.toml recording.csv --folds 3 -o result", "inspect recording.csv"], {"static.toml": quick, "recording.csv": text})
    edits = {
        "no-holds": ("minimum_hold_s = 1.0", "minimum_hold_s = 30.0"),
        "given-outside": ("# intervals_s", "intervals_s"),
        "light-gravity": ("gravity_mps2 = 9.80665", "gravity_mps2 = 9.0"),
        "counts": ('unit = "mps2"', 'unit = "counts"'),
        "scale-bias": ('model = "full"', 'model = "scale-bias"'),
    }
    for name, edit in edits.items():
        yield case(f"poses/{name}", "calibrate static.toml recording.csv --no-report -o result", {"static.toml": edited(quick, *edit), "recording.csv": recording})
    copies = {
        "itself": recording,
        "thin": table.text(table.rows[::2]),
        "rounded": table.each(lambda _, row: [row[0], *(round(value, 2) for value in row[1:])]),
        "other-gain": Table(maker.simulated(quick, "--seed 2 --recording 2")["recording.csv"]).each(lambda _, row: scaled(row, [1, 2, 3], 1.05)),
    }
    for name, text in copies.items():
        yield case(f"validate/poses-{name}", "calibrate static.toml recording.csv --validate other.csv -o result", {"static.toml": quick, "recording.csv": recording, "other.csv": text})


# --- faces, turns and their sections ---


def ferraris(maker, case):
    table_toml, experiment, sections = (maker.example(f"06_whole_imu/{name}") for name in ("table.toml", "ferraris.toml", "sections.json"))
    recording = maker.simulated(table_toml, "--seed 3")["recording.csv"]
    table = Table(recording)
    files = {"ferraris.toml": experiment, "recording.csv": recording, "sections.json": sections}
    command = "calibrate ferraris.toml recording.csv --sections sections.json --no-report -o result"
    listed = json.loads(sections)

    def exchanged(one, other):
        return json.dumps(listed | {one: listed[other], other: listed[one]})

    late = json.dumps(listed | {"z_a": {"start": 10**6, "end": 10**6 + 100}})
    lists = {
        "turns-exchanged": exchanged("x_rot", "y_rot"),
        "faces-exchanged": exchanged("x_p", "x_a"),
        "turn-and-face-exchanged": exchanged("x_rot", "x_p"),
        "outside": late,
        "missing": json.dumps({name: section for name, section in listed.items() if name != "y_rot"}),
        "unknown-name": json.dumps(listed | {"w_p": listed["x_p"]}),
        "backwards": json.dumps(listed | {"x_p": {"start": listed["x_p"]["end"], "end": listed["x_p"]["start"]}}),
        "overlap": json.dumps(listed | {"x_p": listed["x_a"]}),
        "no-json": sections[:-20],
        "an-array": "[1, 2, 3]",
        "empty": "",
    }
    for name, text in lists.items():
        yield case(f"sections/{name}", command, files | {"sections.json": text})
    yield case("sections/none", [command.replace("sections.json", "absent.json"), "calibrate ferraris.toml recording.csv -o result"], files)
    recordings = {
        "opposite": table.each(lambda _, row: scaled(row, [4, 5, 6], -1.0)),
        "degrees": table.each(lambda _, row: scaled(row, [4, 5, 6], 57.29577951308232)),
        "heavy": table.each(lambda _, row: scaled(row, [1, 2, 3], 9.80665)),
        "mirrored": table.columns([0, 1, 2, 3, 5, 4, 6]),
        "both-turned": table.columns([0, 2, 3, 1, 5, 6, 4]),
        "gyroscope-turned": table.columns([0, 1, 2, 3, 5, 6, 4]),
    }
    for name, text in recordings.items():
        yield case(f"sections/recording-{name}", command, files | {"recording.csv": text})
    directions = '"x", "-x", "y", "-y", "z", "-z"'
    edits = {
        "face-wrong": (directions, '"x", "x", "y", "-y", "z", "-z"'),
        "faces-swapped": (directions, '"x", "-x", "z", "-y", "y", "-z"'),
        "faces-opposite": (directions, '"-x", "x", "-y", "y", "-z", "z"'),
        "faces-turned": (directions, '"y", "-y", "z", "-z", "x", "-x"'),
        "face-tilted": (directions, '[0.94, 0.34, 0.0], "-x", "y", "-y", "z", "-z"'),
        "turn-twice": ("start_s = 12.0, end_s = 16.0", "start_s = 7.0, end_s = 11.0"),
        "turn-opposite": ('axis = "x", angle_deg = 360.0', 'axis = "x", angle_deg = -360.0'),
        "turn-other-axis": ('end_s = 11.0, axis = "x"', 'end_s = 11.0, axis = "y"'),
        "turn-in-radians": ("angle_deg = 360.0", "angle_deg = 6.283"),
        "turn-early": ("start_s = 7.0", "start_s = 5.0"),
    }
    for name, edit in edits.items():
        yield case(f"table/{name}", "calibrate table.toml recording.csv --no-report -o result", {"table.toml": edited(table_toml, *edit), "recording.csv": recording})
    double = table_toml.replace("angle_deg = 360.0", "angle_deg = 720.0").replace("angle_deg = -360.0", "angle_deg = -720.0")
    about_x = "\n".join(line for line in table_toml.splitlines() if 'axis = "y"' not in line and 'axis = "z"' not in line)
    for name, text in {"turns-double": double, "turns-about-x": about_x}.items():
        yield case(f"table/{name}", "calibrate table.toml recording.csv --no-report -o result", {"table.toml": text, "recording.csv": recording})


# --- bags, Parquet and other formats of files ---


def binaries(maker, case):
    hand, recording = quick_imu(maker)
    bag, columns = formats.mcap(recording), formats.parquet(recording)
    two = formats.MCAP_MAGIC + bag[len(formats.MCAP_MAGIC) : -50]
    files = {
        "whole.mcap": bag,
        "cut.mcap": bag[: len(bag) * 3 // 4 + 100],
        "magic.mcap": bag[:8],
        "garbled.mcap": two[:2000] + bytes(300) + two[2300:],
        "whole.parquet": columns,
        "cut.parquet": columns[: len(columns) // 2],
        "garbled.parquet": columns[:-300] + bytes(100) + columns[-200:],
        "magic.parquet": b"PAR1",
        "named.mcap": columns,
        "named.parquet": recording,
    }
    for name, content in files.items():
        commands = [f"calibrate hand.toml {name} --no-report -o result", f"inspect {name} --json", f"inspect {name}"]
        if name.startswith(("whole", "cut")):
            commands += [f"noise {name} --sensor gyroscope --json", f"apply result/calibration.json {name} -o true.csv", f"inspect {name} --topic /none"]
        yield case(f"binary/{name}", commands, {"hand.toml": hand, name: content})
    imucal = "calibrate hand.toml recording.csv --format {} --no-report -o result"
    yield case("binary/wrong-format", [imucal.format(name) for name in ("mt-manager", "movella-dot", "euroc", "imu-tk", "imucal", "csv", "mcap", "parquet", "text")], {"hand.toml": hand, "recording.csv": recording})
    table = Table(recording)
    euroc = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
    euroc += "".join(",".join([str(round(row[0] * 1e9)), *map(repr, row[4:7] + row[1:4])]) + "\n" for row in table.rows)
    mt = "// Start Time: Unknown\n// Update Rate: 50.0Hz\n// Filter Profile: human (46.1)\nPacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\n"
    mt += "".join("\t".join([f"{(65000 + place) % 65536:05}", "", *map(repr, row[1:7])]) + "\n" for place, row in enumerate(table.rows))
    dot = "sep=,\nDeviceTag:,one\nFirmwareVersion:,2.0.0\nAppVersion:,2021.0\nOutputRate:,50Hz\nMeasurement Mode:,Rate quantities\nStartTime:,none\n© Movella\n\n"
    dot += "PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\n"
    dot += "".join(",".join([str(place), str((4294000000 + 20000 * place) % 2**32), *map(repr, row[1:4] + scaled(row, [4, 5, 6], 57.29577951308232)[4:7])]) + "\n" for place, row in enumerate(table.rows))
    plain = "".join(" ".join(map(repr, row)) + "\n" for row in table.rows)
    for name, text in {"euroc.csv": euroc, "mt.txt": mt, "dot.csv": dot, "plain.txt": plain, "semicolons.csv": recording.replace(",", ";"), "tabs.txt": recording.replace(",", "\t")}.items():
        yield case(f"format/{name}", [f"calibrate hand.toml {name} --no-report -o result", f"calibrate file.toml {name} --no-report -o result", f"inspect {name}", f"inspect {name} --json"], {"hand.toml": hand, "file.toml": edited(hand, 'unit = "radps"', ""), name: text})


# --- calibrations in files ---


def calibrations(maker, case):
    hand, recording = quick_imu(maker)
    good = maker.calibrated(hand, recording)
    other = maker.calibrated(maker.preset("static-poses"), maker.simulated(maker.preset("static-poses"), "--seed 3")["recording.csv"])
    singular = json.loads(good)
    for sensor in ("accelerometer", "gyroscope"):
        for key, value in list(singular.get(sensor, {}).items()):
            if isinstance(value, list) and len(value) == 3 and isinstance(value[0], list):
                singular[sensor][key] = [[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 0.0, 1.0]]
    later = json.loads(good) | {"schema": 99}
    texts = {
        "empty.json": "",
        "cut.json": good[: len(good) // 2],
        "array.json": "[]",
        "object.json": "{}",
        "later.json": json.dumps(later),
        "singular.json": json.dumps(singular),
        "nan.json": good.replace("0.", "NaN0.", 3),
        "words.json": json.dumps({key: "word" for key in json.loads(good)}),
        "recording.json": recording,
        "empty.yaml": "",
        "broken.yaml": "imu0:\n  accelerometers: [1, 2\n",
        "short.calib": "1 0 0\n0 1 0\n",
        "words.calib": "one two three\n",
        "nothing.h": "/* nothing */\n",
    }
    for name, text in texts.items():
        commands = [f"convert {name} out.yaml", f"apply {name} recording.csv -o out.csv", f"compare good.json {name} --json"]
        yield case(f"calibration/{name}", commands, {name: text, "good.json": good, "recording.csv": recording})
    commands = [
        "compare good.json other.json",
        "apply other.json recording.csv -o out.csv",
        "convert good.json out.txt",
        "convert good.json out.calib",
        "convert absent.json out.h",
        "convert good.json good.json",
        "convert good.json none/out.json",
        "convert good.json out.yaml --noise other.json",
        "convert good.json out.yaml --temperature 900",
        "apply good.json absent.csv -o out.csv",
        "apply good.json recording.csv -o recording.csv",
        "apply good.json recording.csv -o folder",
        "apply good.json recording.csv --temperature 30 -o warm.csv",
        "compare good.json good.json",
    ]
    yield case("calibration/mismatch", commands, {"good.json": good, "other.json": other, "recording.csv": recording, "folder/inside": ""})
    motion = maker.simulated(maker.preset("report"))
    yield case("calibration/from", ["design report.toml --from good.json --starts 1 --no-certificate -o out", "design report.toml --from motion.csv -o out"], {"report.toml": maker.preset("report"), "good.json": good, "motion.csv": motion["motion.csv"]})


# --- command lines and places ---


def usage(maker, case):
    report, static = maker.preset("report"), maker.preset("static-poses")
    made = maker.simulated(report)
    files = {"experiment.toml": report, "static.toml": static, "recording.csv": made["recording.csv"], "motion.csv": made["motion.csv"], "taken": "mine"}
    wrong = [
        "",
        "frobnicate",
        "calibrat experiment.toml",
        "init nosuch",
        "init report extra",
        "simulate experiment.toml",
        "simulate experiment.toml --seed -1 -o result",
        "simulate experiment.toml --recording 0 -o result",
        "calibrate experiment.toml --motion motion.csv -o result",
        "calibrate experiment.toml recording.csv -o result",
        "calibrate experiment.toml recording.csv --motion absent.csv -o result",
        "calibrate experiment.toml recording.csv --motion motion.csv --unit g -o result",
        "calibrate experiment.toml recording.csv motion.csv --motion motion.csv -o result",
        "calibrate static.toml recording.csv --motion motion.csv -o result",
        "study --sensors 0",
        "study static.toml -o result",
        "study --threads 0",
        "design static.toml -o result",
        "design experiment.toml --criterion Q -o result",
        "design experiment.toml --sweep colour=1,2 -o result",
        "design experiment.toml --sweep duration=5,-1 -o result",
        "design experiment.toml --sample-rate 0 -o result",
        "noise recording.csv --hold 5 1",
        "noise recording.csv --hold 0 1000",
        "noise recording.csv --unit rpm",
        "noise recording.csv --sensor gyroscope",
        "inspect recording.csv --gyroscope-unit g",
        "inspect recording.csv --columns static.toml",
        "inspect absent.csv",
    ]
    yield case("usage/commands", wrong, files)
    places = [
        "calibrate experiment.toml recording.csv --motion motion.csv -o taken",
        "calibrate experiment.toml recording.csv --motion motion.csv -o taken/below",
        "calibrate experiment.toml recording.csv recording.csv --motion motion.csv -o taken",
        "calibrate experiment.toml absent.csv --motion motion.csv -o taken",
        "calibrate experiment.toml recording.csv --motion motion.csv -o result",
        "simulate experiment.toml -o taken",
        "design experiment.toml -o taken",
        "noise recording.csv -o taken",
        "study --sensors 1 -o taken",
        "init -o taken/experiment.toml",
        "init -o taken",
        "init -o taken --force",
    ]
    yield case("usage/places", places, files | {"result/calibration.json/mine": ""})
    commands = ["calibrate experiment.toml summary.csv recording.csv --motion motion.csv -o .", "simulate static.toml --motion absent.csv -o made", "calibrate static.toml made/recording.csv --motion absent.csv -o result"]
    commands += ["calibrate static.toml made/recording.csv --no-report -o result", "calibrate static.toml broken.csv -o result"]
    yield case("usage/remains", commands, files | {"summary.csv": made["recording.csv"], "broken.csv": ""})
