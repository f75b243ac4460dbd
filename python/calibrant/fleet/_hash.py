"""Hashes: what a result depends on, and the seed of an item."""

from __future__ import annotations

import hashlib

from .._experiment import Experiment
from ._storage import content


def sha256(*parts: str | bytes) -> bytes:
    """The SHA-256 of texts, each with its length before it."""
    found = hashlib.sha256()
    for part in parts:
        content = part.encode() if isinstance(part, str) else part
        found.update(len(content).to_bytes(8, "little") + content)
    return found.digest()


def hash_of_files(experiment: Experiment) -> bytes:
    """The SHA-256 of the files that an experiment names, a machine's URDF file, SRDF file and limits of joints; not of its meshes."""
    return sha256(*(content(path, {}) or b"" for path in experiment._files))


def seed_of(seed: int, item: str) -> int:
    """The first 8 bytes, the highest first, of the SHA-256 of ``"seed/item"``: the same for any chunk."""
    return int.from_bytes(hashlib.sha256(f"{seed}/{item}".encode()).digest()[:8], "big")
