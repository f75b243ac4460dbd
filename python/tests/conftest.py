"""What the tests share: simulated recordings, and the command line of the same package."""

from __future__ import annotations

import pathlib
import subprocess
import sys
from typing import Any, Callable

import pytest

import calibrant as cb


def _cli(*arguments: object, status: int | None = 0) -> subprocess.CompletedProcess[str]:
    call = [sys.executable, "-m", "calibrant", *(str(argument) for argument in arguments)]
    done = subprocess.run(call, capture_output=True, encoding="utf-8")
    assert status is None or done.returncode == status, done.stderr
    return done


@pytest.fixture(scope="session")
def cli() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs the command line that is in the package."""
    return _cli


@pytest.fixture(scope="session")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], pathlib.Path]:
    """A folder with experiment.toml and the files of `calibrant simulate`, for a preset."""
    made: dict[str, pathlib.Path] = {}

    def of(preset: str) -> pathlib.Path:
        if preset not in made:
            folder = tmp_path_factory.mktemp(preset)
            experiment = cb.Experiment.preset(preset)
            (folder / "experiment.toml").write_text(experiment.to_toml(), encoding="utf-8")
            cb.simulate(experiment).save(folder)
            made[preset] = folder
        return made[preset]

    return of


def log_of(folder: pathlib.Path) -> dict[str, Any]:
    """The motion of a simulated folder, as keyword arguments of `calibrate`."""
    for name, argument in (("motion.csv", "motion"), ("joints.csv", "log"), ("poses.csv", "log")):
        if (folder / name).exists():
            return {argument: folder / name}
    return {}
