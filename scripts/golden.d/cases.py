"""The cases of scripts/golden: command lines and the files that they read."""

import dataclasses
import functools
import os
import re
import shlex
import subprocess
from pathlib import Path

from broken import broken_cases, noise_faults

PRESETS = ("report", "report-unknown", "report-noisy", "static-poses", "static-poses-counts", "imu", "imu-counts", "ferraris")
FORMATS = ("imu.json", "imu.yaml", "imu.h")


@dataclasses.dataclass
class Case:
    """Command lines, run one after the other in a directory that has `files` (content by path)."""

    name: str
    commands: list
    files: dict


class Maker:
    """Makes inputs with the binary whose outputs are recorded: once, for all who compare with them."""

    def __init__(self, root, binary, place):
        self.examples = root / "examples"
        self.binary = binary
        self.place = place
        place.mkdir(parents=True)

    def example(self, name):
        return (self.examples / name).read_text()

    @functools.cache
    def preset(self, name):
        return subprocess.run([self.binary, "init", name], check=True, capture_output=True, text=True).stdout

    @functools.cache
    def simulated(self, experiment, options=""):
        """What `simulate` makes of an experiment: the content of each file."""
        directory = self.place / str(len(list(self.place.iterdir())))
        directory.mkdir()
        (directory / "experiment.toml").write_text(experiment)
        command = [self.binary, "simulate", "experiment.toml", *shlex.split(options), "-o", "made"]
        done = subprocess.run(command, cwd=directory, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"simulate {options} of\n{experiment}\n{done.stderr}")
        made = (path for path in (directory / "made").iterdir() if path.suffix in (".csv", ".json"))
        # without the line that names the program: the cases are of plain tables
        return {path.name: re.sub(r"\A# calibrant.*\n", "", path.read_text()) for path in made}

    @functools.cache
    def calibrated(self, experiment, recording):
        """calibration.json of a recording."""
        directory = self.place / str(len(list(self.place.iterdir())))
        directory.mkdir()
        (directory / "experiment.toml").write_text(experiment)
        (directory / "recording.csv").write_text(recording)
        command = [self.binary, "calibrate", "experiment.toml", "recording.csv", "--no-report", "-o", "."]
        subprocess.run(command, cwd=directory, check=True, capture_output=True)
        return (directory / "calibration.json").read_text()


def replaced(text, *edits):
    """The text with each (old, new) replaced once; what is not there is a mistake."""
    for old, new in edits:
        if old not in text:
            raise ValueError(f"{old!r} is not in\n{text}")
        text = text.replace(old, new, 1)
    return text


def all_cases(root, binary, place):
    """Every case, and what is skipped and why."""
    maker = Maker(root, binary, place)
    real, skipped = real_cases(maker, Path(os.environ.get("CALIBRANT_DATA", root / ".." / "shared" / "data")))
    groups = [example_cases(maker), preset_cases(maker), design_cases(maker), simulated_cases(maker), file_cases(maker), real, broken_cases(maker, Case)]
    cases = [case for group in groups for case in group]
    names = [case.name for case in cases]
    if double := {name for name in names if names.count(name) > 1}:
        raise ValueError(f"two cases of one name: {double}")
    return cases, skipped


def example_cases(maker):
    """The commands of each example's README, in one directory."""
    for folder in sorted(path for path in maker.examples.iterdir() if path.is_dir()):
        files = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "README.md"}
        blocks = re.findall(r"```sh\n(.*?)```", (folder / "README.md").read_text(), re.DOTALL)
        lines = [line.partition(" #")[0].strip() for block in blocks for line in block.splitlines()]
        commands = [line.removeprefix("calibrant ") for line in lines if line.startswith("calibrant ")]
        yield Case(f"example/{folder.name}", commands, files)


def preset_cases(maker):
    """Each preset written down, simulated, calibrated; and designed for, where it has a motion."""
    for name in PRESETS:
        commands = [f"init {name}", f"init {name} -o preset.toml", f"init {name} -o preset.toml", "simulate preset.toml --seed 11 -o made"]
        motion = " --motion made/motion.csv" if name.startswith("report") else ""
        commands.append(f"calibrate preset.toml made/recording.csv{motion} -o result")
        if motion:
            commands += ["design preset.toml --starts 2 --no-certificate -o best", "design preset.toml --json -o certified"]
        yield Case(f"preset/{name}", commands, {})
    edits = [("sensors = 30 ", "sensors = 3 "), ("motions = 10 ", "motions = 2 "), ("points = 41 ", "points = 7 "), ("sensors = 50 ", "sensors = 4 ")]
    study = replaced(maker.preset("report"), *edits)
    yield Case("study/report", ["study --sensors 8 -o out"], {})
    yield Case("study/small", ["study study.toml --starts 2 -o out"], {"study.toml": study})
    yield Case("study/json", ["study study.toml --sensors 2 --starts 1 --seed 5 --threads 2 --json -o out"], {"study.toml": study})
    yield Case("study/unknown", ["study study.toml --sensors 4 --json -o out"], {"study.toml": maker.preset("report-unknown")})


def design_cases(maker):
    """Small searches: every criterion, other limits, the certificate, sweeps."""
    arm = replaced(maker.example("05_design_a_motion/arm.toml"), ("starts = 30", "starts = 3"))
    short = replaced(arm, ("intervals = 10", "intervals = 5"))
    simulated = maker.simulated(short, "--seed 2")
    files = {"short.toml": short, "motion.csv": simulated["motion.csv"], "recording.csv": simulated["recording.csv"]}
    for letter in "ADEM":
        yield Case(f"design/criterion-{letter}", [f"design short.toml --criterion {letter} --json -o out"], files)
    weights = replaced(short, ('criterion = "A"', 'criterion = "c"\nweights = { "scale.x" = 1.0, "bias.z" = 2.0 }'))
    yield Case("design/criterion-c", ["design short.toml --json -o out"], {"short.toml": weights})
    reading = replaced(short, ('criterion = "A"', 'criterion = "I"\nrange_mps2 = 15.0'), ('scale_by = "datasheet"', 'scale_by = "none"'))
    yield Case("design/criterion-I", ["design short.toml --json -o out"], {"short.toml": reading})
    yield Case("design/certificate", ["design short.toml -o out"], {"short.toml": replaced(short, ("certificate = false", "certificate = true"), ("intervals = 5", "intervals = 3"))})
    yield Case("design/dense", ["design short.toml --sample-rate 50 --seed 4 --starts 1 -o out"], files)
    yield Case("design/evaluate", ["design short.toml --evaluate motion.csv --json -o out"], files)
    yield Case("design/sweep", ["design short.toml --sweep jerk=10:40:3 --starts 1 -o out", "design short.toml --sweep noise=1e-4,1e-3 --starts 1 --json -o more"], files)
    chain = ["calibrate short.toml recording.csv --motion motion.csv -o first", "design short.toml --from first/calibration.json --from first/calibration.json --threads 2 -o next"]
    yield Case("design/from", chain, files)
    noisy = replaced(short, ('trust = "known"', 'trust = "noisy"\nknown_ends = "start"\ninput_noise = { floor_mps3 = 0.01, ratio = 0.01 }'), ("intervals = 5", "intervals = 3"))
    yield Case("design/noisy", ["design short.toml --starts 1 --json -o out"], {"short.toml": noisy})


def simulated_cases(maker):
    """Recordings of simulated sensors. What `simulate` makes is a case; what is made of the recording is another, from the stored recording."""
    for name, experiment, options, calibrate in [*hand_recordings(maker), *many_recordings(maker), *table_recordings(maker), *pose_recordings(maker)]:
        made = maker.simulated(experiment, options)
        yield Case(f"simulate/{name}", [f"simulate experiment.toml {options} -o made".replace("  ", " ")], {"experiment.toml": experiment})
        files = {"experiment.toml": experiment, "recording.csv": made["recording.csv"]}
        if "--validate" in calibrate:
            files["other.csv"] = maker.simulated(experiment, f"{options} --recording 2".strip())["recording.csv"]
        yield Case(f"calibrate/{name}", [f"calibrate experiment.toml recording.csv {calibrate}-o result"], files)
    for name, experiment, options, calibrate in motion_recordings(maker):
        made = maker.simulated(experiment, options)
        yield Case(f"simulate/{name}", [f"simulate experiment.toml {options} -o made".replace("  ", " ")], {"experiment.toml": experiment})
        files = {"experiment.toml": experiment, "recording.csv": made["recording.csv"], "motion.csv": made["motion.csv"]}
        yield Case(f"calibrate/{name}", [f"calibrate experiment.toml recording.csv --motion motion.csv {calibrate}-o result"], files)


def hand_recordings(maker):
    """An IMU that is held still and turned by hand: name, experiment, options of `simulate`, options of `calibrate`."""
    hand = maker.example("06_whole_imu/hand.toml")
    place = "latitude_deg = 52.0          # gravity, with its uncertainty, and how the Earth turns\nheight_m = 30.0\n"
    counts = replaced(
        maker.preset("imu-counts"),
        ('unit = "counts" ', 'gain_counts_per_mps2 = 415.0\noffset_counts = 32768.0\nunit = "counts" '),
        ("# gain_counts_per_radps", "gain_counts_per_radps"),
    )
    temperature = "\n[temperature]\nreference_c = 25.0\n"
    yield "hand-plain", hand, "--seed 1", ""
    yield "hand-validated", hand, "--seed 2", "--validate other.csv "
    yield "hand-folds", hand, "--seed 4", "--folds 4 "
    yield "hand-json", hand, "--seed 5 --recording 3", "--json "
    yield "hand-upper", replaced(hand, ('"lower"', '"upper"')), "--seed 6", "--no-report "
    yield "hand-symmetric", replaced(hand, ('"lower"', '"symmetric"')), "--seed 7", "--no-report "
    yield "hand-no-latitude", replaced(hand, (place, "gravity_mps2 = 9.81\n")), "--seed 8", "--no-report "
    yield "hand-south", replaced(hand, (place, "gravity_mps2 = 9.7964\ngravity_sd_mps2 = 1e-4\nlatitude_deg = -33.9\n")), "--seed 9", "--no-report "
    yield "hand-bias-follows-temperature", hand + temperature + "gyroscope_bias = 1\n", "--seed 10", ""
    yield "hand-all-follows-temperature", hand + temperature + "accelerometer_bias = 1\naccelerometer_scale = 1\ngyroscope_bias = 2\ngyroscope_scale = 1\n", "--seed 11", "--validate other.csv --no-report "
    yield "hand-fixed", hand + '\n[known]\n"gyroscope.bias.x" = 0.25\n"accelerometer.scale.y" = 1.02\n', "--seed 12", "--no-report "
    yield "hand-prior", hand + '\n[known]\n"gyroscope.scale.y" = { value = 1.3, sd = 1e-3 }\n"accelerometer.bias.z" = { value = 3.0, sd = 0.01 }\n', "--seed 13", "--folds 3 --no-report "
    yield "hand-scale-bias", replaced(hand, ('model = "full"', 'model = "scale-bias"'), ("g_sensitivity = true", 'g_sensitivity = false\nmodel = "scale-bias"')), "--seed 14", "--no-report "
    yield "hand-long-holds", replaced(hand, ("poses = 24", "poses = 14"), ("hold_s = 3.0", "hold_s = 25.0"), ("rate_hz = 100.0", "rate_hz = 50.0")), "--seed 15", ""
    yield "hand-few", replaced(hand, ("poses = 24", "poses = 12")), "--seed 16", "--folds 3 "
    yield "hand-many", replaced(hand, ("poses = 24", "poses = 48"), ("rate_hz = 100.0", "rate_hz = 50.0")), "--seed 17", "--no-report --threads 2 "
    yield "hand-counts", counts, "--seed 18", ""
    yield "hand-noise-given", replaced(hand, ("g_sensitivity = true", "g_sensitivity = true\nnoise_radps = 2e-3")), "--seed 19", "--no-report "


def many_recordings(maker):
    """Short recordings of an IMU: many sensors, and every kind of option with another."""
    hand = maker.example("06_whole_imu/hand.toml")
    short = replaced(hand, ("poses = 24", "poses = 18"), ("rate_hz = 100.0", "rate_hz = 50.0"))
    gauges = ("lower", "upper", "symmetric")
    extras = ("", "\n[temperature]\ngyroscope_bias = 1\n", '\n[known]\n"gyroscope.bias.y" = { value = 0.0, sd = 0.02 }\n')
    options = ("--folds 3 ", "--validate other.csv ", "--validate other.csv --folds 4 ", "")
    for seed in range(101, 125):
        experiment = replaced(short, ('"lower"', f'"{gauges[seed % 3]}"'), ("g_sensitivity = true", f"g_sensitivity = {'true' if seed % 2 else 'false'}"))
        yield f"short-{seed}", experiment + extras[seed // 3 % 3], f"--seed {seed}", f"--no-report {options[seed % 4]}"


def table_recordings(maker):
    """An IMU on a turntable: six faces and turns of known angle."""
    table = maker.example("06_whole_imu/table.toml")
    yield "table-plain", table, "--seed 3", ""
    yield "table-given-faces", replaced(table, ("[holds]", "[holds]\nface_sd_deg = 0.5")), "--seed 4", "--no-report "
    yield "table-vectors", replaced(table, ('"x", "-x"', "[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]"), ("g_sensitivity = true", "g_sensitivity = false")), "--seed 5", "--validate other.csv "
    yield "table-temperature", table + "\n[temperature]\ngyroscope_bias = 1\n", "--seed 6", "--no-report "
    yield "table-json", replaced(table, ("latitude_deg = 52.0\nheight_m = 30.0", "gravity_mps2 = 9.81")), "--seed 7", "--json --no-report "


def pose_recordings(maker):
    """An accelerometer alone, held still in many orientations."""
    static = maker.preset("static-poses")
    counts = maker.example("03_static_poses/counts.toml")
    yield "poses-plain", static, "--seed 1", ""
    yield "poses-validated", static, "--seed 2", "--validate other.csv "
    yield "poses-folds", replaced(static, ("poses = 24 ", "poses = 30 "), ('"upper"', '"lower"')), "--seed 3", "--folds 5 "
    yield "poses-few", replaced(static, ("poses = 24 ", "poses = 12 ")), "--seed 4", "--folds 2 --no-report "
    yield "poses-prior", replaced(static, ('prior = "none"', 'prior = "datasheet"'), ('"upper"', '"symmetric"'), ("poses = 24 ", "poses = 8 ")), "--seed 5", "--no-report "
    yield "poses-bent", replaced(static, ("poses = 24 ", 'nonlinearity = ["second-order", "gain-by-sign"]\nposes = 40 ')), "--seed 9", ""
    yield "poses-scale-bias", replaced(static, ('model = "full"', 'model = "scale-bias"')), "--seed 6", "--json "
    yield "poses-counts", counts, "--seed 7", ""
    yield "poses-counts-folds", counts, "--seed 8 --recording 2", "--folds 4 --no-report --threads 2 "


def motion_recordings(maker):
    """An accelerometer on an arm, whose motion is known, noisy or unknown."""
    known, noisy = (maker.example(f"01_robot_motion/{name}.toml") for name in ("known", "noisy"))
    unknown = maker.example("02_unknown_motion/experiment.toml")
    full = [('model = "scale-bias"', 'model = "full"'), ("scale_sd = 0.005", "scale_sd = 0.005\ncross_axis_sd = 0.01")]
    yield "motion-known", known, "--seed 31", ""
    yield "motion-known-full", replaced(known, *full), "--seed 32", ""
    yield "motion-known-one-axis", replaced(known, ("axes = 3", "axes = 1")), "--seed 33", "--json "
    yield "motion-known-counts", replaced(known, ("noise_mps2 = 2e-4", 'unit = "counts"\ngain_counts_per_mps2 = 1000.0\noffset_counts = 100.0\nnoise_counts = 0.5')), "--seed 34", ""
    yield "motion-noisy", noisy, "--seed 35", ""
    yield "motion-noisy-full", replaced(noisy, *full), "--seed 36", "--no-report "
    yield "motion-noisy-prior", noisy + '\n[calibrate]\nprior = "datasheet"\n', "--seed 37", "--no-report "
    yield "motion-noisy-ends", replaced(noisy, ('known_ends = "start"', 'known_ends = "both"'), ("rate_hz = 10.0", "rate_hz = 40.0")), "--seed 38", "--no-report "
    yield "motion-unknown", unknown, "--seed 39", ""
    yield "motion-unknown-fast", replaced(unknown, ("rate_hz = 2.0", "rate_hz = 10.0")), "--seed 40", "--json "
    yield "motion-unknown-prior", unknown + '\n[calibrate]\nprior = "datasheet"\n', "--seed 41", "--no-report "
    yield "motion-unknown-one-axis", replaced(unknown, ("axes = 3", "axes = 1")), "--seed 42", "--no-report "


def file_cases(maker):
    """Calibrations in every format, applied and compared; recordings looked at; noise; several recordings in one call."""
    hand, table = (maker.example(f"06_whole_imu/{name}.toml") for name in ("hand", "table"))
    recording = maker.simulated(hand, "--seed 3")["recording.csv"]
    of_hand = {"imu.json": maker.calibrated(hand, recording), "recording.csv": recording}
    of_table = maker.calibrated(table, maker.simulated(table, "--seed 3")["recording.csv"])
    for suffix in ("yaml", "h", "json"):
        commands = [f"convert imu.json out.{suffix}", f"convert out.{suffix} back.json", f"compare imu.json out.{suffix}", f"compare imu.json back.json --json"]
        yield Case(f"convert/imu-{suffix}", commands, of_hand)
    for sensor in ("accelerometer", "gyroscope"):
        drop = " --drop-g-sensitivity" if sensor == "gyroscope" else ""
        unit = "mps2" if sensor == "accelerometer" else "radps"
        commands = [f"convert imu.json out.calib --sensor {sensor}{drop}", "convert out.calib back.json", f"convert out.calib back.json --sensor {sensor} --unit {unit}"]
        commands.append(f"compare imu.json out.calib --sensor {sensor} --unit {unit}")
        yield Case(f"convert/imu-calib-{sensor}", commands, of_hand)
    imucal = ["convert imu.json out.json --to imucal", "convert imu.json out.json --to imucal --drop-g-sensitivity", "convert out.json back.yaml", "compare imu.json out.json", "convert out.json back.h"]
    yield Case("convert/imu-imucal", imucal, of_hand)
    for gauge in ("lower", "upper", "symmetric"):
        commands = [f"convert imu.json out.{suffix} --gauge {gauge}" for suffix in ("json", "yaml", "h")] + ["compare imu.json out.json --json"]
        yield Case(f"convert/gauge-{gauge}", commands, of_hand)
    yield Case("apply/imu", ["apply imu.json recording.csv -o out.csv", "convert imu.json imu.yaml", "apply imu.yaml recording.csv -o of-yaml.csv"], of_hand)
    yield Case("compare/imus", ["compare imu.json table.json", "compare imu.json table.json --json", "compare table.json imu.json --json"], of_hand | {"table.json": of_table})

    warm = hand + "\n[temperature]\ngyroscope_bias = 1\naccelerometer_scale = 2\n"
    recording_warm = maker.simulated(warm, "--seed 21")["recording.csv"]
    commands = ["apply imu.json recording.csv -o out.csv", "apply imu.json recording.csv --temperature 60 -o hot.csv", "apply imu.json cold.csv -o cold-out.csv"]
    commands += ["convert imu.json imu.yaml", "convert imu.json imu.yaml --temperature 40", "convert imu.json imu.h", "compare imu.json imu.h", "compare imu.json imu.yaml --json"]
    yield Case("convert/temperature", commands, {"imu.json": maker.calibrated(warm, recording_warm), "recording.csv": recording_warm, "cold.csv": recording})

    static, counts = maker.preset("static-poses"), maker.example("03_static_poses/counts.toml")
    poses, pose_counts = (maker.simulated(experiment, "--seed 3")["recording.csv"] for experiment in (static, counts))
    of_poses = {"acc.json": maker.calibrated(static, poses), "recording.csv": poses}
    commands = ["convert acc.json acc.calib", "convert acc.json acc.yaml", "convert acc.json acc.h", "convert acc.json imucal.json --to imucal", "apply acc.json recording.csv -o out.csv"]
    commands += ["compare acc.json acc.calib --unit mps2", "apply acc.calib recording.csv --unit mps2 -o of-calib.csv", "compare acc.json acc.h --json"]
    yield Case("convert/accelerometer", commands, of_poses)
    of_counts = {"acc.json": maker.calibrated(counts, pose_counts), "recording.csv": pose_counts}
    commands = ["convert acc.json acc.calib", "convert acc.json acc.yaml", "convert acc.json acc.h", "apply acc.json recording.csv -o out.csv", "compare acc.json acc.calib --unit counts --sensor accelerometer"]
    yield Case("convert/counts", commands, of_counts)

    yield Case("inspect/imu", ["inspect recording.csv", "inspect recording.csv --json"], of_hand)
    yield Case("inspect/accelerometer", ["inspect recording.csv", "inspect recording.csv --json"], of_poses)
    yield Case("inspect/counts", ["inspect recording.csv --json"], of_counts)
    yield Case("inspect/temperature", ["inspect recording.csv --json"], {"recording.csv": recording_warm})

    long = replaced(hand, ("poses = 24", "poses = 2"), ("hold_s = 3.0", "hold_s = 120.0"))
    at_rest = {"recording.csv": maker.simulated(long, "--seed 22")["recording.csv"]}
    commands = ["noise recording.csv -o noise", "noise recording.csv --json", "noise recording.csv --sensor gyroscope --hold 5 60 -o part", "noise recording.csv --sensor accelerometer --json --threads 2"]
    yield Case("noise/imu", commands, at_rest)
    for name, text in noise_faults(at_rest["recording.csv"]):
        yield Case(f"noise/{name}", ["noise recording.csv --json", "noise recording.csv --hold 1 50 --json"], {"recording.csv": text})
    commands = ["noise recording.csv --gain 415 --json", "noise recording.csv -o noise"]
    yield Case("noise/counts", commands, {"recording.csv": pose_counts})
    yield Case("noise/into-kalibr", ["noise recording.csv -o noise", "convert imu.json imu.yaml --noise noise/noise.json", "convert imu.json again.yaml --noise imu.yaml"], at_rest | {"imu.json": of_hand["imu.json"]})

    imus = {f"imu{seed}.csv": maker.simulated(hand, f"--seed {seed}")["recording.csv"] for seed in (1, 2)}
    imus |= {"hand.toml": hand, "broken.csv": "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps\n0,1,2,oops,4,5,6\n"}
    commands = ["calibrate hand.toml imu1.csv broken.csv imu2.csv absent.csv --threads 2 -o all", "calibrate hand.toml imu1.csv broken.csv --json --no-report -o json"]
    yield Case("many/imus", commands, imus)
    sensors = {f"{name}/rec.csv": maker.simulated(static, f"--seed {seed}")["recording.csv"] for seed, name in ((1, "one"), (2, "two"))}
    yield Case("many/accelerometers", ["calibrate static.toml one/rec.csv two/rec.csv -o all", "calibrate static.toml one/rec.csv two/rec.csv --json --no-report -o json"], sensors | {"static.toml": static})
    yield Case("many/one-for-all", ["--version", "--help", *(f"{command} --help" for command in ("init", "inspect", "design", "simulate", "calibrate", "study", "noise", "convert", "apply", "compare"))], {})


def real_cases(maker, data):
    """Recordings that were not made here."""
    cases, skipped = [], []

    def case(name, commands, files, texts=()):
        missing = [path for path in files.values() if not (data / path).is_file()]
        if missing:
            skipped.append(f"real/{name}: {data / missing[0]} is not there; set CALIBRANT_DATA to the directory with the recordings")
            return
        cases.append(Case(f"real/{name}", commands, {to: (data / path).read_bytes() for to, path in files.items()} | dict(texts)))

    pair = {"acc.mat": "xsens-mti-static/xsens_acc.mat", "gyro.mat": "xsens-mti-static/xsens_gyro.mat"}
    units = "--accelerometer-unit counts --gyroscope-unit counts"
    counts, static_counts = maker.preset("imu-counts"), maker.preset("static-poses-counts")
    case("xsens", ["calibrate imu.toml acc.mat --gyroscope gyro.mat -o result", "apply result/calibration.json acc.mat --gyroscope gyro.mat -o out.csv", "convert result/calibration.json imu.h"], pair, {"imu.toml": counts})
    case("xsens-folds", ["calibrate imu.toml acc.mat --gyroscope gyro.mat --folds 5 -o result"], pair, {"imu.toml": counts})
    case("xsens-json", ["calibrate imu.toml acc.mat --gyroscope gyro.mat --no-report --json --threads 2 -o result"], pair, {"imu.toml": replaced(counts, ("# latitude_deg", "latitude_deg"), ('"upper"', '"lower"'))})
    case("xsens-itself", ["calibrate imu.toml acc.mat --gyroscope gyro.mat --validate acc.mat --validate-gyroscope gyro.mat -o result"], pair, {"imu.toml": counts})
    case("xsens-exchanged", ["calibrate imu.toml gyro.mat --gyroscope acc.mat -o result"], pair, {"imu.toml": counts})
    case("xsens-accelerometer", ["calibrate static.toml acc.mat -o result", "calibrate static.toml acc.mat --folds 5 --json -o folds", "convert result/calibration.json acc.calib"], {"acc.mat": pair["acc.mat"]}, {"static.toml": static_counts})
    case("xsens-inspect", [f"inspect acc.mat gyro.mat {units}", f"inspect acc.mat --gyroscope gyro.mat {units} --json", "inspect acc.mat gyro.mat"], pair)
    case("xsens-noise", ["noise acc.mat --gyroscope gyro.mat --gain 414 --gyroscope-gain 4778,4758,4766 -o noise", "noise acc.mat --unit counts --json", "noise gyro.mat --sensor gyroscope --unit counts --json"], pair)

    ferraris = {"session.csv": "imucal-ferraris/example_ferraris_session.csv", "list.json": "imucal-ferraris/example_ferraris_session_list.json"}
    preset = maker.preset("ferraris")
    case("ferraris", ["calibrate ferraris.toml session.csv --sections list.json -o result", "convert result/calibration.json out.json --to imucal --drop-g-sensitivity", "apply result/calibration.json session.csv --columns ferraris.toml --gyroscope-unit deg/s -o out.csv"], ferraris, {"ferraris.toml": preset})
    case("ferraris-variants", ["calibrate ferraris.toml session.csv --sections list.json --json --no-report -o result", "calibrate ferraris.toml session.csv --json -o none"], ferraris, {"ferraris.toml": replaced(preset, ("g_sensitivity = true", "g_sensitivity = false"), ("# face_sd_deg", "face_sd_deg"))})
    case("ferraris-inspect", ["inspect session.csv", "inspect session.csv --rate-hz 102.4 --accelerometer-unit m/s2 --gyroscope-unit deg/s --json", "noise session.csv --columns ferraris.toml --gyroscope-unit deg/s --json"], ferraris, {"ferraris.toml": preset})

    for name, file in [("tab", "MT2022_ACC_GYRO_ROT_ALL_TAB_NAN_00B42D4B"), ("semicolon", "MT2022_ACC_GYRO_ROT_MAT_SEMICOLON_00B42D4B"), ("old", "MT46_01-000_00B42D4D"), ("no-sensors", "MT_012005D6-000_sit_to_stand-000_00B421ED")]:
        commands = ["inspect mt.txt", "inspect mt.txt --rate-hz 60 --json", "calibrate imu.toml mt.txt -o result", "noise mt.txt --rate-hz 60 --json"]
        case(f"mt-manager-{name}", commands, {"mt.txt": f"mt-manager/{file}.txt"}, {"imu.toml": maker.preset("imu")})
    for name, trial in [("slow", "broad_03_undisturbed_slow_rotation_C"), ("fast", "broad_21_undisturbed_fast_combined")]:
        commands = ["inspect imu.csv", "inspect imu.csv --json", "noise imu.csv -o noise", "noise imu.csv --json", "calibrate imu.toml imu.csv --no-report -o result"]
        case(f"broad-{name}", commands, {"imu.csv": f"broad-mocap/{trial}/imu.csv"}, {"imu.toml": maker.preset("imu")})
    return cases, skipped
