"""Hostile input, seeded: arrays of wrong shapes, types and numbers, and experiments that make no sense.

``python hostile.py [arrays] [experiments] [seed]`` counts the classes of errors. It fails where the native part panics, where a call takes
more than 20 s of the processor, and where an exception is none of `CalibrantError`, `TypeError` and `ValueError`. An experiment may ask for
work that takes longer; it is then interrupted, and must end.
"""

from __future__ import annotations

import collections
import contextlib
import signal
import sys
import warnings
from typing import Any, Callable, Iterator

import numpy as np

import calibrant as cb

LONGEST_S = 20  # of the unoptimised build
ALLOWED = (cb.CalibrantError, TypeError, ValueError)
NUMBERS = [0.0, -0.0, 1.0, -1.0, 1e-320, 1e-30, 1e30, 1e300, -1e308, np.nan, np.inf, -np.inf, 2.0**53, 2.0**64]
TEXTS = ["", " ", "x", "NaN", "\0", "𝕏", "a\nb", "\u202e", "\ud800", "holds", "../../..", "é" * 3000, "1e999", "[machine]", '"""']

Call = Callable[[], Any]


class Hang(BaseException):
    """A call that takes too long; `heeded`: it ended when it was asked to."""

    heeded = True


@contextlib.contextmanager
def no_longer_than(seconds: float) -> Iterator[None]:
    """Raise :exc:`Hang` where the block takes more time of the processor, or twenty times that of the clock."""

    rung: list[int] = []

    def ring(*_: object) -> None:
        rung.append(1)
        hang = Hang(f"longer than {seconds} s")
        hang.heeded = len(rung) == 1
        raise hang

    timers = ((signal.ITIMER_PROF, signal.SIGPROF, seconds), (signal.ITIMER_REAL, signal.SIGALRM, 20.0 * seconds))
    before = [signal.signal(number, ring) for _, number, _ in timers]
    for timer, _, after in timers:
        # a second one ends what does not heed the first
        signal.setitimer(timer, after, seconds)
    try:
        yield
    finally:
        for (timer, number, _), handler in zip(timers, before):
            signal.setitimer(timer, 0.0)
            signal.signal(number, handler)


def outcome(call: Call, may_be_long: bool = False) -> str:
    """The class of what a call does; with the text where that is not allowed."""
    try:
        with no_longer_than(LONGEST_S):
            call()
    except ALLOWED as error:
        if getattr(error, "code", "") == "internal-error":
            return f"FAILED: {error}"
        try:
            str(error).encode()
        except UnicodeEncodeError:
            return "FAILED: an error that cannot be printed"
        return type(error).__name__
    except Hang as hang:
        return "long" if may_be_long and hang.heeded else f"FAILED: {hang}"
    except BaseException as error:
        return f"FAILED: {type(error).__name__}: {str(error)[:300]}"
    return "accepted"


def number(rng: np.random.Generator) -> float:
    return float(rng.choice(NUMBERS)) if rng.random() < 0.7 else float(rng.normal() * 10.0 ** rng.integers(-12, 13))


def base(rng: np.random.Generator, columns: int) -> Any:
    """A table of readings that would do."""
    count = int(rng.choice([0, 1, 2, 3, 7, 64, 3000], p=[0.08, 0.08, 0.08, 0.08, 0.18, 0.25, 0.25]))
    table = rng.normal(size=(count, columns)) * rng.choice([0.0, 1e-3, 1.0])
    if columns == 3 and count:
        hold = np.repeat(rng.permutation(np.vstack([np.eye(3), -np.eye(3)])), -(-count // 6), axis=0)[:count]
        table = table + 9.81 * hold
    return table


def spoilt(rng: np.random.Generator, table: Any) -> Any:
    """The same with something wrong."""
    kind = int(rng.integers(0, 22))
    flat = table.reshape(-1)
    if kind == 0 and flat.size:
        flat[rng.integers(flat.size, size=max(1, flat.size // 50))] = number(rng)
    elif kind == 1:
        return np.full_like(table, number(rng))
    elif kind == 2:
        return table.astype(rng.choice(["f2", "f4", "i1", "u1", "i8", "?", "c16", "S3", "U2", "M8[s]", "m8[ns]", ">f8", "longdouble"]))
    elif kind == 3:
        return table.astype(object)
    elif kind == 4:
        wrong = table.astype(object)
        if wrong.size:
            wrong.flat[int(rng.integers(wrong.size))] = rng.choice(np.array([None, "x", {}, [1, 2], 10**400, 1j], dtype=object))
        return wrong
    elif kind == 5:
        return table[:, : table.shape[1] - 1] if table.ndim == 2 else table[:-1]
    elif kind == 6:
        return table.T
    elif kind == 7:
        return table[..., None]
    elif kind == 8:
        return table[::-1] if rng.random() < 0.5 else table[::2]
    elif kind == 9:
        return np.asfortranarray(table)
    elif kind == 10:
        return np.broadcast_to(table[:1], (50, *table.shape[1:])) if len(table) else table
    elif kind == 11:
        return table.tolist()
    elif kind == 12:
        return [row.tolist() for row in table] + [[1.0]]
    elif kind == 13:
        return rng.choice(np.array([None, 3, "abc", b"abc", {}, object(), float("nan")], dtype=object))
    elif kind == 14:
        return np.ma.masked_array(table, mask=rng.random(table.shape) < 0.2)
    elif kind == 15:
        return np.zeros((0,) * int(rng.integers(0, 4)))
    elif kind == 16:
        return np.zeros((int(rng.integers(0, 4)),) * int(rng.integers(3, 6)))
    elif kind == 17:
        given: Any = np.ascontiguousarray(table)
        return memoryview(given)
    elif kind == 18:
        return np.lib.stride_tricks.as_strided(table, strides=(0,) * table.ndim) if table.size else table
    elif kind == 19:
        return np.array(table.tolist() + [np.zeros((2, 2))], dtype=object)
    elif kind == 20:
        return np.concatenate([table, table[: len(table) // 2]])
    return table


def times(rng: np.random.Generator, count: int) -> Any:
    """Times that would do, or not."""
    t = np.arange(count) / rng.choice([0.01, 1.0, 100.0, 1e4, 1e9])
    kind = int(rng.integers(0, 14))
    if kind == 0:
        return t[::-1]
    if kind == 1:
        return t * 0.0
    if kind == 2:
        return t + rng.choice([1.7e9, 1.7e18, -1e308, 1e308])
    if kind == 3:
        return rng.permutation(t)
    if kind == 4:
        return t[: count // 2]
    if kind == 5 and count:
        return np.where(rng.random(count) < 0.1, number(rng), t)
    if kind == 6:
        return np.repeat(t, 2)[:count]
    if kind == 7:
        return spoilt(rng, t)
    if kind == 8:
        return t * 10.0 ** rng.integers(-300, 300)
    if kind == 9:
        return np.cumsum(np.abs(rng.standard_cauchy(count)))
    if kind == 10:
        return None
    return t


def option(rng: np.random.Generator) -> Any:
    return number(rng) if rng.random() < 0.7 else rng.choice(np.array([None, "1", TEXTS[-2], True, [], 0, -1, 2**70], dtype=object))


def array_call(rng: np.random.Generator, calibration: cb.Calibration) -> Call:
    """A call with hostile arrays."""

    def table(columns: int = 3) -> Any:
        good = base(rng, columns)
        return spoilt(rng, good) if rng.random() < 0.6 else good

    def like(of: Any) -> int:
        try:
            return len(of)
        except TypeError:
            return 10

    kind = int(rng.integers(0, 12))
    if kind <= 3:
        force = table()
        given: dict[str, Any] = {"accelerometer": force}
        if rng.random() < 0.4:
            given["gyroscope"] = table() if rng.random() < 0.3 else np.zeros((like(force), 3))
            if rng.random() < 0.3:
                given["gyroscope_t_s"] = times(rng, like(given["gyroscope"]))
        if rng.random() < 0.2:
            given["temperature_c"] = times(rng, like(force))
        if rng.random() < 0.2:
            given["rate_hz"] = option(rng)
        if rng.random() < 0.2:
            given["accelerometer_unit"] = rng.choice(["g", "mg", "counts", "", "V", "rad/s"])
        t = times(rng, like(force))
        experiment = rng.choice(["auto", "auto", "static-poses", "imu", "faces"])
        gravity = 9.81 if rng.random() < 0.7 else option(rng)
        return lambda: cb.calibrate(cb.recording(t, **given), str(experiment), gravity_mps2=gravity)
    if kind == 4:
        force, rate = table(), table()
        celsius = times(rng, like(force)) if rng.random() < 0.3 else None
        return lambda: calibration.correct(force, rate if rng.random() < 0.7 else None, temperature_c=celsius)
    if kind == 5:
        force = table()
        t, hold = times(rng, like(force)), None if rng.random() < 0.5 else (option(rng), option(rng))
        gain = None if rng.random() < 0.5 else (option(rng) if rng.random() < 0.5 else table())
        return lambda: cb.noise(cb.recording(t, force), hold_s=hold, gain=gain)
    if kind == 6:
        nodes = table(int(rng.choice([1, 3])))
        t = times(rng, like(nodes))
        return lambda: cb.assess("stage", cb.Motion(t, nodes), starts=1, certificate=False)
    if kind == 7:
        place, turn = table(), table(4)
        t = times(rng, like(place))
        if rng.random() < 0.3:
            return lambda: cb.inspect(cb.Poses(t, place, turn))
        return lambda: cb.simulate("mocap", motion=cb.Poses(t, place, turn))
    if kind == 8:
        angle = spoilt(rng, base(rng, 1).reshape(-1)) if rng.random() < 0.6 else base(rng, 1).reshape(-1)
        t = times(rng, like(angle))
        step = None if rng.random() < 0.5 else option(rng)
        name = "turn" if rng.random() < 0.7 else str(rng.choice(TEXTS[:8]))

        def log() -> cb.Joints:
            return cb.Joints(t, {name: angle}, knot_step_s=step)

        if rng.random() < 0.3:
            return lambda: cb.inspect(log())
        return lambda: cb.simulate("rate-table", motion=log())
    if kind == 9:
        directions = table()
        return lambda: cb.assess_poses("static-poses", directions)
    if kind == 10:
        directions = table()
        return lambda: cb.simulate("static-poses", poses=directions)
    values = spoilt(rng, base(rng, 1).reshape(-1)[:3])
    return lambda: cb.sweep("stage", str(rng.choice(["duration", "rate", "noise", "", "x"])), values, starts=1, certificate=False)


def junk(rng: np.random.Generator, depth: int = 0) -> Any:
    """A value that nobody expects."""
    kind = int(rng.integers(0, 12))
    if kind <= 3:
        return number(rng)
    if kind == 4:
        return int(rng.choice([0, -1, 1, 7, 10**6, 2**31, 2**62])) * (1 if rng.random() < 0.8 else 2**20)
    if kind <= 6:
        return str(rng.choice(np.array(TEXTS, dtype=object)))
    if kind == 7:
        return [junk(rng, depth + 1) for _ in range(int(rng.integers(0, 4)))] if depth < 3 else []
    if kind == 8:
        return {str(rng.choice(np.array(TEXTS, dtype=object))): junk(rng, depth + 1) for _ in range(2)} if depth < 3 else {}
    if kind == 9:
        return rng.choice(np.array([True, False, None], dtype=object))
    if kind == 10:
        return rng.normal(size=int(rng.integers(0, 4)))
    return rng.choice(np.array([object(), b"x", 1j, {1, 2}, np.datetime64("2026-01-01"), lambda: 1], dtype=object))


PRESETS = sorted(cb.presets())


def leaves(table: dict[str, Any], path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """The keys of nested dicts that are no dicts, with their values."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from leaves(value, (*path, key))
        else:
            yield (*path, key), value


def off(rng: np.random.Generator, value: Any) -> Any:
    """A value of the same kind that is far from it."""
    if isinstance(value, bool) or not isinstance(value, (int, float, list)):
        return junk(rng)
    if isinstance(value, list):
        kind = int(rng.integers(0, 3))
        return [off(rng, of) for of in value] if kind == 0 else value[: int(rng.integers(0, 3))] if kind == 1 else value + value
    factor = float(rng.choice([0.0, -1.0, 0.1, 0.5, 2.0, 10.0, 1e3, 1e6, 1e12, 1e-3, 1e-9]))
    return int(value * factor) if isinstance(value, int) else value * factor


def nearly(rng: np.random.Generator, name: str) -> dict[str, Any]:
    """Sections that change some values of a preset."""
    listed = list(leaves({k: v for k, v in cb.Experiment.preset(name).to_dict().items() if k != "schema"}))
    sections: dict[str, Any] = {}
    for _ in range(int(rng.integers(1, 4))):
        path, value = listed[int(rng.integers(len(listed)))]
        place = sections
        for key in path[:-1]:
            place = place.setdefault(key, {})
        place[path[-1]] = off(rng, value)
    return sections


def nonsense(rng: np.random.Generator, name: str) -> dict[str, Any]:
    """Sections and keys that a preset has or not, with anything in them."""
    known: dict[str, Any] = cb.Experiment.preset(name).to_dict()
    known.pop("schema", None)
    others = ["holds", "motion", "machine", "limits", "accept", "design", "known", "temperature", "columns", "study", "x"]
    sections: dict[str, Any] = {}
    for _ in range(int(rng.integers(1, 4))):
        section = str(rng.choice([*known, *others]))
        keys = [*(known[section] if isinstance(known.get(section), dict) else {}), "poses", "duration_s", "rate_hz", "x"]
        inner = {str(rng.choice(keys)): junk(rng) for _ in range(int(rng.integers(1, 3)))}
        kind = rng.random()
        sections[section] = junk(rng) if kind < 0.1 else {str(rng.choice(keys)): inner} if kind < 0.2 else inner
    return sections


def experiment_call(rng: np.random.Generator) -> Call:
    """An experiment as dicts of which some make no sense; where it can be read, it is used."""
    name = str(rng.choice(PRESETS))
    sections = nearly(rng, name) if rng.random() < 0.6 else nonsense(rng, name)
    build, use = rng.random(), rng.random()

    def call() -> None:
        made = cb.Experiment(**sections) if build < 0.1 else cb.Experiment.preset(name, **sections)
        made.to_dict()
        if use < 0.3 and made.kind == "motion":
            cb.design(made, starts=1, certificate=False)
        elif use < 0.3 and made.kind == "holds":
            cb.design_poses(made, starts=1)
        else:
            simulated = cb.simulate(made)
            if use < 0.7 and len(simulated.recording) < 20_000:
                cb.calibrate(simulated.recording, made, motion=simulated.motion, log=simulated.log)

    return call


def hostile(arrays: int, experiments: int, seed: int) -> tuple[collections.Counter[str], list[str]]:
    """How many calls ended with which class; and what failed."""
    classes: collections.Counter[str] = collections.Counter()
    failed: list[str] = []
    calibration = cb.calibrate(cb.simulate("imu").recording, "imu")
    for what, count in (("array", arrays), ("experiment", experiments)):
        for case in range(count):
            rng = np.random.default_rng([seed, case, len(what)])
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                call = array_call(rng, calibration) if what == "array" else experiment_call(rng)
                found = outcome(call, may_be_long=what == "experiment")
            if found.startswith("FAILED"):
                failed.append(f"{what} {case} of seed {seed}: {found}")
                found = "FAILED"
            classes[f"{what}: {found}"] += 1
    return classes, failed


def main() -> int:
    given = [int(of) for of in sys.argv[1:]]
    arrays, experiments, seed = given + [2000, 500, 1][len(given) :]
    classes, failed = hostile(arrays, experiments, seed)
    for name, count in sorted(classes.items()):
        print(f"{count:6} {name}")
    for line in failed:
        print(line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
