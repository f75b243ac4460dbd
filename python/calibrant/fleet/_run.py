"""Runs the items of a fleet in chunks. Each chunk is one task of the engine, and one part of the data set."""

from __future__ import annotations

import hashlib
import os
from typing import TYPE_CHECKING, Any, Collection, Iterable, Iterator, Literal, Mapping, Sequence

from .._arrays import Path
from .._exceptions import experiment_error, of_json
from .._page import written_to
from .._progress import Progress, Told
from ._engines import engine_of
from ._hash import sha256
from ._result import Result
from ._storage import anywhere, filesystem, parts, write_part
from ._task import Item, Task, name_of

if TYPE_CHECKING:
    import pyarrow as pa

# name and key of a row
_Known = Collection["tuple[str, str]"]
_Call = tuple[Sequence[Item], Task, _Known, str]
# done, failed, earlier, the first error
_Counts = tuple[int, int, int, "str | None"]


def run_chunk(items: Sequence[Item], task: Task, *, threads: int | None = 1) -> pa.Table:
    """Do a task with each item: a pure function, which any engine may call. An error is a row.

    Parameters
    ----------
    items : list of str
        Paths, or URLs that pyarrow or fsspec open.
    task : CalibrationTask, StudyTask or DesignTask
        What is done with each.
    threads : int, optional
        Threads of this chunk; ``None`` for all cores.

    Returns
    -------
    pyarrow.Table
        A row for each item.
    """
    opened = task.opened(items)
    return _table(items, opened, _keys(items, opened, task), task, threads)


def _keys(items: Sequence[Item], opened: Sequence[Any], task: Task) -> list[str]:
    """The key of each item. One that cannot be read has a key too: its row is there once, until it can be read."""
    named = ((key, name_of(item)) for item, key in zip(items, task.keys(items, opened)))
    return [sha256("cannot be read", name).hex() if key is None else key for key, name in named]


def _table(items: Sequence[Item], opened: Sequence[Any], keys: Sequence[str], task: Task, threads: int | None) -> pa.Table:
    import pyarrow as pa

    found = task.rows(items, opened, threads)
    rows = [{**row, "key": key, "file": name_of(item)} for item, key, row in zip(items, keys, found)]
    return pa.Table.from_pylist(rows, schema=task.schema())


def work(chunk: Sequence[Item], task: Task, known: _Known, output: str, threads: int | None = 1) -> _Counts:
    """Do what a data set lacks of a chunk, and write its part."""
    opened = task.opened(chunk)
    keys = _keys(chunk, opened, task)
    new = [k for k, (item, key) in enumerate(zip(chunk, keys)) if (name_of(item), key) not in known]
    earlier = len(chunk) - len(new)
    if not new:
        return 0, 0, earlier, None
    items, keys = [chunk[k] for k in new], [keys[k] for k in new]
    table = _table(items, [opened[k] for k in new], keys, task, threads)
    named = sorted(f"{name_of(item)} {key}" for item, key in zip(items, keys))
    write_part(table, output, hashlib.sha256("\n".join(named).encode()).hexdigest()[:32], task.storage_options)
    errors = [error for error in table["error_json"].to_pylist() if error is not None]
    return len(items) - len(errors), len(errors), earlier, errors[0] if errors else None


def run(
    task: Task,
    items: Sequence[Item],
    output: Path,
    *,
    client: Any,
    per_task: int | Literal["auto"],
    on_error: Literal["row", "raise"],
    resume: bool,
    progress: Progress,
) -> Result:
    """Do a task with each item, into a data set. `items` are sorted by their names."""
    if on_error not in ("row", "raise"):
        raise experiment_error(f"`on_error` is {on_error!r}", "give 'row' or 'raise'")
    size = _size(per_task, len(items), client, task)
    # what all items share is read here: an error in it is not one of a worker
    task.keys([], [])
    place = os.fspath(anywhere(output))
    system, path = filesystem(place, task.storage_options)
    with written_to(place):
        system.create_dir(path, recursive=True)
    schema = task.schema()
    if not resume and parts(system, path):
        raise experiment_error(f"{place} has results already", "give another `output`, or leave `resume=False` away")
    known = _known(system, path, schema)
    chunks = (items[at : at + size] for at in range(0, len(items), size))
    calls = ((chunk, task, _of_chunk(known, chunk), place) for chunk in chunks)
    counts = [0, 0, 0]
    with Told(progress) as told:
        for *found, error in _results(client, calls):
            counts = [a + b for a, b in zip(counts, found)]
            if told is not None:
                told(sum(counts), len(items), task.what)
            if error is not None and on_error == "raise":
                raise of_json(error)
    return Result(place, schema, (counts[0], counts[1], counts[2]), task.storage_options)



def _results(client: Any, calls: Iterable[_Call]) -> Iterator[_Counts]:
    if client is None:
        # chunks one after the other, each on all cores
        return (work(*call, threads=None) for call in calls)
    return engine_of(client)(work, calls)


def _known(system: Any, path: str, schema: pa.Schema) -> dict[str, str]:
    """The keys that the data set has, by the names of the items; with blanks between several."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    known: dict[str, str] = {}
    for part in parts(system, path):
        try:
            with system.open_input_file(part) as file:
                opened = pq.ParquetFile(file)
                _check(part, opened.schema_arrow, schema)
                columns = opened.read(columns=["file", "key"])
        except (pa.ArrowException, OSError) as error:
            raise experiment_error(f"{part} cannot be read: {error}", "delete it, and run the call again", code="file-damaged") from None
        for name, key in zip(columns["file"].to_pylist(), columns["key"].to_pylist()):
            known[name] = f"{known[name]} {key}" if name in known else key
    return known


def _check(part: str, found: pa.Schema, wanted: pa.Schema) -> None:
    kinds = [(of.metadata or {}).get(b"calibrant", b"another program").decode() for of in (found, wanted)]
    if kinds[0] != kinds[1]:
        raise experiment_error(f"{part} is of {kinds[0]}, not of {kinds[1]}", "give another `output`")


def _of_chunk(known: Mapping[str, str], chunk: Sequence[Item]) -> frozenset[tuple[str, str]]:
    names = (name_of(item) for item in chunk)
    return frozenset((name, key) for name in names for key in known.get(name, "").split())


def _size(per_task: int | Literal["auto"], count: int, client: Any, task: Task) -> int:
    if per_task == "auto":
        return task.most if client is None else max(1, min(task.most, -(-count // 20)))
    if not isinstance(per_task, int) or per_task < 1:
        raise experiment_error(f"`per_task` is {per_task!r}", "give a number from 1, or 'auto'")
    return per_task
