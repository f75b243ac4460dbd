"""Many recordings of one experiment, into one data set: in the process, on a pool, or on a cluster.

State lives in the data set, never in the engine. Each part is written beside its place and then renamed, so it is whole or absent. A call that is run
again leaves out what the data set has, so nothing is lost and nothing is there twice.
"""

from ._calibrate import Result, calibrate
from ._chunk import run_chunk

__all__ = ["Result", "calibrate", "run_chunk"]
