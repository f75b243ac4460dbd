"""calibrant: calibrate accelerometers, gyroscopes and IMUs with an honest covariance, and design the best motion to record.

Everything is SI; the direction of a calibration is true → raw, ``y = S s + b``. Names, units and numbers are those of ``calibration.json``, and
the same input gives the same bits as the command line.
"""

from __future__ import annotations

from . import fleet
from ._calibrate import calibrate
from ._calibration import Calibration, Converted, Parameter, ResidualSeries
from ._campaign import CampaignDesign, SimulatedCampaign, Soak, design_campaign, simulate_campaign
from ._compare import Comparison, compare
from ._design import Design, assess, design
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
from ._explain import Explanation, codes, explain
from ._inspect import inspect
from ._motion import Joints, Motion, Poses
from ._native import program as _program
from ._noise import Noise, SensorNoise, noise
from ._page import Page
from ._pose_design import PoseDesign, assess_poses, design_poses
from ._recording import Inspection, Recording, Samples, read_recording, recording
from ._records import Records
from ._simulate import Simulation, Truth, simulate
from ._study import Study, study
from ._sweep import Sweep, sweep
from ._trajectory import (
    TrajectoryAssessment,
    TrajectoryDesign,
    assess_trajectory,
    design_trajectory,
)

__version__ = _program().split()[-1]

__all__ = [
    "Answer",
    "BadCalibration",
    "CalibrantError",
    "Calibration",
    "CalibrationWarning",
    "CampaignDesign",
    "Comparison",
    "Converted",
    "Design",
    "Diagnostic",
    "Experiment",
    "ExperimentError",
    "Explanation",
    "Infeasible",
    "Inspection",
    "Joints",
    "Motion",
    "Noise",
    "NotIdentifiable",
    "OutputError",
    "Page",
    "Parameter",
    "PoseDesign",
    "Poses",
    "Recording",
    "RecordingError",
    "Records",
    "ResidualSeries",
    "Samples",
    "SensorNoise",
    "SimulatedCampaign",
    "Simulation",
    "Soak",
    "Study",
    "Sweep",
    "TrajectoryAssessment",
    "TrajectoryDesign",
    "Truth",
    "UndeterminedGroup",
    "assess",
    "assess_poses",
    "assess_trajectory",
    "calibrate",
    "codes",
    "compare",
    "design",
    "design_campaign",
    "design_poses",
    "design_trajectory",
    "explain",
    "fleet",
    "inspect",
    "noise",
    "presets",
    "read_recording",
    "recording",
    "simulate",
    "simulate_campaign",
    "study",
    "sweep",
]

# tracebacks and pages name what users import
for _name in __all__:
    _of = globals()[_name]
    if getattr(_of, "__module__", "").startswith("calibrant._"):
        _of.__module__ = "calibrant"
del _name, _of
