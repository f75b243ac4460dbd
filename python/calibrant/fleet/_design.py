"""Designs for many experiments, a row for each."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Mapping, Sequence

import numpy as np

from .. import _native
from .._arrays import Path
from .._calibration import Calibration
from .._choice import choice
from .._design import Design
from .._exceptions import CalibrantError, experiment_error
from .._experiment import Experiment
from .._pose_design import PoseDesign
from .._progress import Progress
from .._trajectory import TrajectoryDesign
from ._hash import hash_of_files, sha256
from ._result import Result
from ._run import run
from ._storage import content, listed
from ._task import Item, failure, name_of, schema_of

if TYPE_CHECKING:
    import pyarrow as pa


@dataclass(frozen=True)
class DesignTask:
    """Find the best motion, poses or trajectory of each experiment.

    Attributes
    ----------
    choice : str
        What is chosen beside the experiment, as JSON.
    storage_options : dict
        For paths that are URLs.
    """

    choice: str
    storage_options: dict[str, Any] = field(default_factory=dict)
    what = "designs"
    most = 1

    def schema(self) -> pa.Schema:
        """The columns of the data set."""
        import pyarrow as pa

        text, number = pa.string(), pa.float64()
        numbers = pa.list_(number)
        columns = [("plan", text), ("status", text), ("value", number), ("bound", number), ("gap", number)]
        of_motion = [("t_s", numbers), ("axes", pa.list_(text)), ("track", numbers)]
        return schema_of("design", [*columns, *of_motion, ("design", text)])

    def opened(self, items: Sequence[Item]) -> list[Any]:
        """The experiments; the error of one that cannot be read."""
        return [_opened(item, self.storage_options) for item in items]

    def keys(self, items: Sequence[Item], opened: Sequence[Any]) -> list[str | None]:
        """SHA-256 of program, options, and experiment with the files that it names."""
        return [self._key(of) if isinstance(of, Experiment) else None for of in opened]

    def _key(self, experiment: Experiment) -> str:
        return sha256(_native.program(), self.choice, experiment.to_toml(), hash_of_files(experiment)).hex()

    def rows(self, items: Sequence[Item], opened: Sequence[Any], threads: int | None) -> list[dict[str, Any]]:
        """The columns of each design."""
        return [{"program": _native.program(), **self._row(of, threads)} for of in opened]

    def _row(self, experiment: Any, threads: int | None) -> dict[str, Any]:
        if not isinstance(experiment, Experiment):
            return failure(experiment)
        begin = {"experiment_sha256": experiment.sha256, "plan": experiment.kind}
        try:
            return {**begin, **_designed(experiment, self.choice, threads)}
        except CalibrantError as error:
            return {**begin, **failure(error)}


def _designed(experiment: Experiment, choice: str, threads: int | None) -> dict[str, Any]:
    found: Design | PoseDesign | TrajectoryDesign
    times: Any = None
    if experiment._is_campaign:
        message = "campaigns over temperature are designed one by one"
        raise experiment_error(message, "use `design_campaign(…)`", code="experiment-unsuited")
    if experiment.kind == "machine":
        found = TrajectoryDesign(*_native.design_trajectory(experiment._native, choice, threads=threads))
        times, axes, track = found.joints.t_s, list(found.joints.names), found.joints.positions
    elif experiment.kind == "holds":
        found = PoseDesign(_native.design_poses(experiment._native, None, choice, threads=threads))
        axes, track = ["x", "y", "z"], found.directions
    else:
        found = Design(_native.design(experiment._native, choice, threads=threads))
        assert found.motion is not None
        times, axes, track = found.motion.t_s, ["ax_mps2", "ay_mps2", "az_mps2"], found.motion.acceleration_mps2
    bound = found.data.get("certificate") or {}
    return {
        "status": found.data.get("status"),
        "value": (found.data.get("optimal") or {}).get("value"),
        "bound": bound.get("lower_bound"),
        "gap": bound.get("gap"),
        "t_s": times,
        "axes": axes,
        "track": np.ravel(track),
        "design": found.to_json(),
    }


def design(
    items: Any,
    output: Path,
    *,
    client: Any = None,
    known: Sequence[Calibration] = (),
    criterion: str | None = None,
    gap: float | None = None,
    starts: int | None = None,
    seed: int | None = 1,
    certificate: bool = True,
    force: bool = False,
    per_task: int | Literal["auto"] = "auto",
    on_error: Literal["row", "raise"] = "row",
    resume: bool = True,
    storage_options: Mapping[str, Any] | None = None,
    progress: Progress = False,
) -> Result:
    """Find the best motion, poses or trajectory of many experiments. Run it again to continue.

    A row has `plan`, `status`, `value`, `bound` and `gap`, the text of ``design.json``, and what to do: `axes` names the columns of `track`, which stands row by row,
    at the times `t_s`. Those are accelerations at the nodes of a motion, directions of poses, or positions of joints at waypoints.

    Parameters
    ----------
    items : paths, glob, frame or dict
        Experiment files or their URLs; a pattern such as ``"stages/*.toml"``; a frame with a column ``file``; or a dict of :class:`Experiment` by name.
    output : path
        Folder of the data set, or its URL.
    known, criterion, gap, starts, seed, certificate, force
        As in :func:`calibrant.design`.
    client, per_task, on_error, resume, storage_options, progress
        As in :func:`calibrate`. A chunk has one item by default: a design takes seconds or minutes.

    Returns
    -------
    Result

    Raises
    ------
    ExperimentError
        Where an argument makes no sense.
    """
    storage = dict(storage_options or {})
    chosen = choice(
        known=known,
        criterion=criterion,
        gap=gap,
        starts=starts,
        seed=seed,
        certificate=certificate,
        force=force,
    )
    task = DesignTask(chosen, storage)
    named: list[Item]
    if isinstance(items, Mapping):
        named = sorted(items.items())
        for name, experiment in items.items():
            if not isinstance(experiment, Experiment):
                raise experiment_error(f"{name!r} is {type(experiment).__name__}", "give an Experiment")
    else:
        named = list(listed(items, storage))
    return run(
        task, named, output, client=client, per_task=per_task, on_error=on_error, resume=resume, progress=progress
    )


def _opened(item: Item, storage: Mapping[str, Any]) -> Experiment | CalibrantError:
    if not isinstance(item, str):
        return item[1]
    try:
        if "://" not in item:
            return Experiment.from_toml(item)
        read = content(item, storage)
        if read is None:
            raise experiment_error(f"{item} cannot be read", "check its name", code="file-unreadable")
        return Experiment.from_toml(read)
    except CalibrantError as error:
        return error
