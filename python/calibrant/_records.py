"""The records: calibrations over the years, in an SQLite database."""

from __future__ import annotations

import json
import os
from typing import Any, Iterable, Literal

from . import _native
from ._arrays import Path
from ._calibration import Calibration
from ._exceptions import experiment_error
from ._frames import frame, library_of


class Records:
    """The calibrations of a line over the years. The file is made where there is none.

    Examples
    --------
    >>> import calibrant as cb, os, tempfile
    >>> cal = cb.calibrate(cb.simulate("static-poses").recording, sensor="A17")
    >>> with cb.Records(os.path.join(tempfile.mkdtemp(), "line.db")) as records:
    ...     records.add(cal)
    ...     records.to_frame()["id"].tolist()
    1
    [1]
    """

    def __init__(self, path: Path) -> None:
        self.path = os.fspath(path)
        self._native = _native.Records(self.path)

    def add(self, *calibrations: Calibration | Iterable[Calibration]) -> int:
        """Add calibrations; returns how many are new. One of the same recording replaces the earlier one."""
        texts: list[str] = []
        for given in calibrations:
            several = [given] if isinstance(given, (Calibration, str)) else given
            for calibration in several:
                if not isinstance(calibration, Calibration):
                    message = f"{type(calibration).__name__} is no calibration"
                    raise experiment_error(message, "give calibrations: `Calibration.load(path)`")
                texts.append(calibration.to_json())
        return self._native.add(texts)

    def list(
        self,
        *,
        sensor: str | None = None,
        station: str | None = None,
        verdict: Literal["ok", "doubtful", "bad"] | None = None,
        latest: bool = False,
    ) -> Any:
        """The calibrations of a sensor, a station, a verdict; `latest`: the last of each sensor. As ``calibrant records list --json``."""
        return json.loads(self._native.list(sensor, station, verdict, latest))

    def __getitem__(self, number: int) -> dict[str, Any]:
        found = self._native.get(number)
        if found is None:
            raise KeyError(number)
        data: dict[str, Any] = json.loads(found)
        return data

    def __len__(self) -> int:
        return self._native.count()

    def drift(self, sensor: str | None = None) -> Any:
        """What changes from calibration to calibration, of one sensor or of all. As ``calibrant records drift --json``."""
        return json.loads(self._native.drift(sensor))

    def fleet(self) -> Any:
        """How the parameters differ from sensor to sensor. As ``calibrant records fleet --json``."""
        return json.loads(self._native.fleet())

    def remove(self, *numbers: int) -> None:
        """Remove calibrations."""
        self._native.remove(list(numbers))

    def export(
        self,
        path: Path,
        *,
        sensor: str | None = None,
        station: str | None = None,
        verdict: Literal["ok", "doubtful", "bad"] | None = None,
        latest: bool = False,
    ) -> int:
        """Write them, or those that :meth:`list` would give, as CSV or Parquet, as the ending says; returns the number of rows."""
        return self._native.export(os.fspath(path), sensor, station, verdict, latest)

    def to_frame(self, like: Any = None) -> Any:
        """A row for each calibration with its parameters, as a frame."""
        import csv
        import tempfile

        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "records.csv")
            self.export(path)
            with open(path, newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
        names, body = rows[0], rows[1:]
        columns = {name: _typed(name, [row[k] for row in body]) for k, name in enumerate(names)}
        return frame(columns, None if like is None else library_of(like))

    def __enter__(self) -> Records:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing is left open: each call opens and closes the file."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (Records, (os.path.abspath(self.path),))

    def __repr__(self) -> str:
        return f"Records({self.path!r})"


def _typed(name: str, cells: Any) -> Any:
    # a parameter is of a sensor: `accelerometer.bias.x_mps2`. Serial numbers and hashes are texts, also where they look like numbers
    kind: Any = int if name == "id" else float if "." in name else str
    return [kind(cell) if cell else None for cell in cells]
