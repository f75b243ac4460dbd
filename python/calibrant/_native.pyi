"""What the native part offers. It takes and gives JSON and arrays; use the package above it."""

import os
from typing import Any, Callable, Sequence

# the bytes of f64, row by row
_Given = bytes
_Array = bytearray
_Progress = Callable[[int, int, str], object] | None
_Samples = tuple[_Array, _Array, str]
_Nodes = tuple[_Array, _Array]
_Log = tuple[str, list[str], _Array, _Array, _Array | None]

# the text of the JSON file, diagnostics as JSON, the sheet as text and as HTML
Page = tuple[str, str, str, str]
# the nodes of the best motion; its value, its bound, its gap, and whether the search was interrupted
Designed = tuple[Page, tuple[_Nodes, tuple[float, float | None, float | None, bool]] | None]
# directions
Posed = tuple[Page, _Array]
# names, times, positions, velocities
Knots = tuple[list[str], _Array, _Array, _Array]

def command_line(arguments: list[str]) -> int: ...
def program() -> str: ...
def preset_text(name: str) -> str: ...
def presets() -> list[tuple[str, str]]: ...
def merged(text: str, sections: str) -> str: ...
def sections_of(text: str) -> str: ...

class Experiment:
    def __init__(self, text: str, path: str | None = None) -> None: ...
    def about(self) -> str: ...

class Readings:
    @staticmethod
    def file(path: str) -> Readings: ...
    @staticmethod
    def bytes(name: str, bytes: Any) -> Readings: ...
    @staticmethod
    def columns(name: str, columns: list[tuple[str, _Given]]) -> Readings: ...
    @staticmethod
    def samples(
        name: str,
        sensors: Sequence[tuple[str, str, _Given, _Given]],
        axes: int,
        temperature_c: _Given | None = None,
        rate_sd_ppm: float | None = None,
    ) -> Readings: ...

class Source:
    def __init__(
        self,
        recording: Readings,
        gyroscope: Readings | None = None,
        further: list[Source] = ...,
        sections: str | None = None,
    ) -> None: ...

class Motion:
    @staticmethod
    def file(path: str) -> Motion: ...
    @staticmethod
    def commanded(times_s: _Given, acceleration_mps2: _Given) -> Motion: ...
    @staticmethod
    def joints(
        names: list[str],
        times_s: _Given,
        positions: _Given,
        velocities: _Given | None = None,
        knot_step_s: float | None = None,
    ) -> Motion: ...
    @staticmethod
    def poses(times_s: _Given, positions_m: _Given, quaternions_wxyz: _Given) -> Motion: ...
    def write(self, path: str, axes: int, rate_hz: float | None = None) -> None: ...
    def states(self) -> tuple[_Array, _Array]: ...

class Recording:
    def samples(self, sensor: str) -> _Samples | None: ...
    def temperature_c(self) -> _Array | None: ...
    def about(self) -> str: ...
    def readings(self, name: str) -> Readings: ...
    def inspect(self) -> Page: ...
    def write(self, path: str) -> None: ...

def read_recording(source: Source, reading: str) -> Recording: ...

class Outcome:
    def json(self) -> str: ...
    def notes(self) -> str: ...
    def html(self) -> str: ...
    def text(self, width: int) -> str: ...
    def residuals(self) -> list[tuple[tuple[str, str, str | None, str], list[_Array]]]: ...

def calibrate(
    experiment: Experiment,
    source: Source,
    options: str,
    *,
    motion: Motion | None = None,
    validate: Source | None = None,
    validate_motion: Motion | None = None,
    threads: int | None = None,
    progress: _Progress = None,
) -> Outcome: ...

def calibrate_campaign(
    experiment: Experiment,
    sources: Sequence[Source],
    options: str,
    *,
    validate: Source | None = None,
    threads: int | None = None,
    progress: _Progress = None,
) -> Outcome: ...
def calibrate_soaks(
    experiment: Experiment, soaks: list[tuple[str, str]], options: str, *, validate: Source | None = None
) -> Outcome: ...

class Correction:
    def __init__(self, text: str) -> None: ...
    def unit(self, sensor: str) -> str | None: ...
    def apply(
        self,
        accelerometer: _Given | None = None,
        gyroscope: _Given | None = None,
        temperature_c: _Given | None = None,
        with_sd: bool = False,
    ) -> list[_Array | None]: ...

def read_calibration(path: str, options: str) -> tuple[str, str]: ...
def convert_calibration(text: str, path: str, options: str) -> tuple[list[os.PathLike[str]], str]: ...
def compare(a: tuple[str, str], b: tuple[str, str]) -> Page: ...
def explained() -> list[tuple[str, str, str, str | None, str]]: ...
def is_log(path: str, time_unit: str | None = None, topic: str | None = None) -> bool: ...
def inspect_log(motion: Motion, time_unit: str | None = None, topic: str | None = None) -> Page: ...
def inspect_machine(path: str, base: str | None = None, tip: str | None = None, packages: list[str] = ...) -> Page: ...

class Simulation:
    def samples(self, sensor: str) -> _Samples | None: ...
    def temperature_c(self) -> _Array | None: ...
    def truth(self) -> str: ...
    def motion(self) -> _Nodes | None: ...
    def log(self) -> _Log | None: ...
    def about(self) -> str: ...
    def write(self, directory: str) -> None: ...

def simulate(
    experiment: Experiment,
    *,
    motion: Motion | None = None,
    poses: _Given | None = None,
    seed: int | None = None,
    recording: int = 1,
    force: bool = False,
) -> Simulation: ...
def noise(
    source: Source,
    reading: str,
    *,
    read: Recording | None = None,
    sensor: str | None = None,
    hold_s: tuple[float, float] | None = None,
    gain: list[float] | None = None,
    gyroscope_gain: list[float] | None = None,
    threads: int | None = None,
) -> Page: ...
def study(
    experiment: Experiment,
    *,
    motion: Motion | None = None,
    sensors: int | None = None,
    starts: int | None = None,
    seed: int | None = None,
    force: bool = False,
    threads: int | None = None,
    progress: _Progress = None,
) -> Page: ...
def design(
    experiment: Experiment, choice: str, *, threads: int | None = None, progress: _Progress = None
) -> Designed: ...
def assess(
    experiment: Experiment, motion: Motion, choice: str, *, threads: int | None = None, progress: _Progress = None
) -> Designed: ...
def design_poses(
    experiment: Experiment,
    poses: int | None,
    choice: str,
    *,
    threads: int | None = None,
    progress: _Progress = None,
) -> Posed: ...
def design_campaign(
    experiment: Experiment, known: list[str], *, add_min: float | None = None, threads: int | None = None
) -> Page: ...
def sweep_campaign(
    experiment: Experiment,
    known: list[str],
    budgets_min: list[float],
    *,
    threads: int | None = None,
    progress: _Progress = None,
) -> Page: ...

class CampaignSimulation:
    def samples(self, soak: int, sensor: str) -> _Samples | None: ...
    def temperature_c(self, soak: int) -> _Array | None: ...
    def truth(self) -> str: ...
    def about(self) -> str: ...
    def write(self, directory: str) -> None: ...

def simulate_campaign(experiment: Experiment, soaks: str, *, seed: int | None = None) -> CampaignSimulation: ...
def assess_poses(
    experiment: Experiment,
    choice: str,
    *,
    directions: _Given | None = None,
    source: Source | None = None,
    reading: str = "{}",
    threads: int | None = None,
) -> Posed: ...
def sweep(
    experiment: Experiment,
    quantity: str,
    values: list[float],
    choice: str,
    *,
    threads: int | None = None,
    progress: _Progress = None,
) -> Page: ...

class Trajectory:
    def interrupted(self) -> bool: ...
    def knots(self) -> Knots: ...
    def plain(self) -> Knots | None: ...
    def log(self) -> tuple[_Log, float]: ...
    def write(self, directory: str) -> list[os.PathLike[str]]: ...

def design_trajectory(
    experiment: Experiment,
    choice: str,
    *,
    slow: float | None = None,
    threads: int | None = None,
    progress: _Progress = None,
) -> tuple[Page, Trajectory]: ...
def assess_trajectory(
    experiment: Experiment, motion: Motion, choice: str, *, threads: int | None = None, progress: _Progress = None
) -> tuple[Page, bool, Knots | None]: ...

class Records:
    def __init__(self, path: str) -> None: ...
    def add(self, texts: Sequence[str]) -> int: ...
    def list(
        self,
        sensor: str | None = None,
        station: str | None = None,
        verdict: str | None = None,
        latest: bool = False,
    ) -> str: ...
    def get(self, id: int) -> str | None: ...
    def drift(self, sensor: str | None = None) -> str: ...
    def fleet(self) -> str: ...
    def count(self) -> int: ...
    def remove(self, ids: Sequence[int]) -> None: ...
    def export(
        self,
        path: str,
        sensor: str | None = None,
        station: str | None = None,
        verdict: str | None = None,
        latest: bool = False,
    ) -> int: ...

# a row of a data set, and an error, as JSON
_Row = tuple[str | None, str | None]

def calibrate_each(
    experiment: Experiment,
    sources: Sequence[Source],
    options: str,
    *,
    motion: Motion | None = None,
    threads: int | None = None,
) -> list[_Row]: ...
def study_each(
    experiment: Experiment,
    sensors: list[tuple[str, int]],
    options: str,
    *,
    motion: Motion | None = None,
    threads: int | None = None,
) -> list[_Row]: ...
def keys(
    experiment: Experiment, sources: Sequence[Source], options: str, *, motion: Motion | None = None
) -> list[str | None]: ...
def hashes(sources: Sequence[Source]) -> list[str | None]: ...
