"""Many calibrations, simulated sensors or designs, into one data set: in the process, on a pool, or on a cluster.

State lives in the data set, never in the engine. Each part is written beside its place and then renamed, so it is whole or absent. A call that is run
again leaves out what the data set has, so nothing is lost and nothing is there twice.
"""

from ._calibrate import CalibrationTask, calibrate
from ._design import DesignTask, design
from ._result import Result
from ._run import run_chunk
from ._study import StudyTask, study

__all__ = ["CalibrationTask", "DesignTask", "Result", "StudyTask", "calibrate", "design", "run_chunk", "study"]
