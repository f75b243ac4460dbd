"""The Python of the README, as it stands there."""

import pathlib
import re
import shutil
from typing import Any, Callable

import pytest

README = pathlib.Path(__file__).resolve().parents[2] / "README.md"


def test_python_of_the_readme_runs(
    simulated: Callable[[str], pathlib.Path], tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a simulated IMU; the fleet has one sensor."""
    pytest.importorskip("matplotlib").use("agg")
    pytest.importorskip("pyarrow")
    (text,) = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.S)
    recording = simulated("imu") / "recording.csv"
    (tmp_path / "line").mkdir()
    for copy in ("recording.csv", "line/A17.csv"):
        shutil.copy(recording, tmp_path / copy)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(text, str(README), "exec"), names)
    assert len(names["true"]) == len(names["rec"].accelerometer.values)
    assert "ax_sd_mps2" in names["true"].columns
    assert 0 <= names["best"].gap <= 0.01
    assert (tmp_path / "report.html").exists()
    assert len(list((tmp_path / "results").rglob("*.parquet"))) == 1
