"""calibrant: calibrate accelerometers, gyroscopes and IMUs with an honest covariance, and design the best motion to record.

Everything is SI; the direction of a calibration is true → raw, ``y = S s + b``. Names, units and numbers are those of ``calibration.json``, and
the same input gives the same bits as the command line.
"""

from __future__ import annotations

from . import fleet
from ._calibrate import calibrate
from ._calibration import Calibration, Parameter, ResidualSeries
from ._compare import Comparison, compare
from ._design import (
    Design,
    PoseDesign,
    TrajectoryDesign,
    assess,
    assess_poses,
    design,
    design_poses,
    design_trajectory,
)
from ._diagnostic import Diagnostic
from ._exceptions import (
    Answer,
    BadCalibration,
    CalibrantError,
    CalibrationWarning,
    ExperimentError,
    Infeasible,
    NotIdentifiable,
    OutputError,
    RecordingError,
    UndeterminedGroup,
)
from ._experiment import Experiment, presets
from ._motion import Joints, Motion, Poses
from ._native import program as _program
from ._noise import Noise, SensorNoise, noise
from ._recording import Inspection, Recording, Samples, read_recording, recording
from ._records import Records
from ._simulate import Simulation, Truth, simulate
from ._study import Study, study

__version__ = _program().split()[-1]

__all__ = [
    "Answer",
    "BadCalibration",
    "CalibrantError",
    "Calibration",
    "CalibrationWarning",
    "Comparison",
    "Design",
    "Diagnostic",
    "Experiment",
    "ExperimentError",
    "Infeasible",
    "Inspection",
    "Joints",
    "Motion",
    "Noise",
    "NotIdentifiable",
    "OutputError",
    "Parameter",
    "PoseDesign",
    "Poses",
    "Recording",
    "RecordingError",
    "Records",
    "ResidualSeries",
    "Samples",
    "SensorNoise",
    "Simulation",
    "Study",
    "TrajectoryDesign",
    "Truth",
    "UndeterminedGroup",
    "assess",
    "assess_poses",
    "calibrate",
    "compare",
    "design",
    "design_poses",
    "design_trajectory",
    "fleet",
    "noise",
    "presets",
    "read_recording",
    "recording",
    "simulate",
    "study",
]

# tracebacks and pages name what users import
for _name in __all__:
    _of = globals()[_name]
    if getattr(_of, "__module__", "").startswith("calibrant._"):
        _of.__module__ = "calibrant"
del _name, _of
