"""Where items and parts are: paths, and URLs that pyarrow or fsspec open."""

from __future__ import annotations

import fnmatch
import glob
import os
import uuid
from typing import TYPE_CHECKING, Any, Mapping

from .._exceptions import experiment_error
from .._frames import is_frame
from .._page import written_to

if TYPE_CHECKING:
    import pyarrow as pa

# a file in an object store is there when it is whole
_OBJECT_STORES = {"s3", "gcs", "abfs"}


def anywhere(path: Any) -> Any:
    """A path as another process finds it; a URL, or what is no path, as it is."""
    if path == "":
        raise experiment_error("a path is empty", "give a path or a URL")
    is_path = isinstance(path, (str, os.PathLike)) and "://" not in os.fspath(path)
    return os.path.abspath(path) if is_path else path


def filesystem(url: str, options: Mapping[str, Any]) -> tuple[Any, str]:
    """The file system of a URL or a path, and the path in it."""
    try:
        import pyarrow as pa
        import pyarrow.fs as fs
    except ImportError:
        raise experiment_error("a fleet needs pyarrow", "install it, as with calibrant[fleet]") from None

    if options.get("filesystem") is not None:
        return options["filesystem"], url.split("://", 1)[-1]
    if "://" not in url:
        return fs.LocalFileSystem(), os.path.abspath(url)
    if not options:
        try:
            system, path = fs.FileSystem.from_uri(url)
            return system, path
        except (pa.ArrowInvalid, pa.ArrowNotImplementedError):
            pass
    try:
        import fsspec.core

        system, path = fsspec.core.url_to_fs(url, **options)
    except (ImportError, ValueError) as error:
        raise experiment_error(f"{url} cannot be opened: {error}", "give a URL that pyarrow or fsspec opens") from error
    return fs.PyFileSystem(fs.FSSpecHandler(system)), path


def listed(items: Any, options: Mapping[str, Any]) -> list[str]:
    """The names of items: paths, a pattern, or the column `file` of a frame. A path that is not a URL is absolute, since a worker may be elsewhere."""
    if isinstance(items, (str, os.PathLike)):
        text = os.fspath(items)
        is_pattern = any(sign in text for sign in "*?[") and not os.path.exists(text)
        found = _matching(text, options) if is_pattern else [text]
        if not found:
            raise experiment_error(f"nothing matches {text!r}", "check the pattern", code="file-unreadable")
    elif is_frame(items):
        import narwhals as nw

        read = nw.from_native(items, eager_only=True)
        if "file" not in read.columns:
            raise experiment_error("the frame has no column `file`", "name the paths `file`", code="column-missing")
        found = [str(item) for item in read["file"].to_list()]
    else:
        try:
            found = [os.fspath(item) for item in items]
        except TypeError as error:
            raise experiment_error(f"`items` makes no sense: {error}", "give paths, a pattern, or a frame") from None
    return sorted({anywhere(item) for item in found})


def _matching(pattern: str, options: Mapping[str, Any]) -> list[str]:
    if "://" not in pattern:
        return glob.glob(pattern, recursive=True)
    import pyarrow.fs as fs

    fixed = pattern[: min(pattern.index(sign) for sign in "*?[" if sign in pattern)].rsplit("/", 1)[0]
    system, folder = filesystem(fixed, options)
    begin = fixed.removesuffix(folder) if fixed.endswith(folder) else fixed.split("://", 1)[0] + "://"
    wanted = pattern.removeprefix(begin)
    is_deep = "**" in wanted
    shape = wanted.replace("**/", "*")

    def suits(path: str) -> bool:
        return fnmatch.fnmatchcase(path, shape) and (is_deep or path.count("/") == wanted.count("/"))

    files = system.get_file_info(fs.FileSelector(folder, recursive=True, allow_not_found=True))
    return [begin + of.path for of in files if of.is_file and suits(of.path)]


def content(url: str, options: Mapping[str, Any]) -> bytes | None:
    """What is at a URL, or in a file; ``None`` where it cannot be read."""
    system, path = filesystem(url, options)
    try:
        with system.open_input_stream(path) as stream:
            read: bytes = stream.read()
            return read
    except OSError:
        return None


def parts(system: Any, path: str) -> list[str]:
    """The parts of a data set, by their names."""
    import pyarrow.fs as fs

    found = system.get_file_info(fs.FileSelector(path, allow_not_found=True))
    return sorted(of.path for of in found if of.base_name.startswith("part-") and of.base_name.endswith(".parquet"))


def write_part(table: pa.Table, place: str, name: str, options: Mapping[str, Any]) -> None:
    """Write a part: it is whole or absent."""
    import pyarrow.parquet as pq

    system, path = filesystem(place, options)
    target = f"{path}/part-{name}.parquet"
    beside = target if system.type_name in _OBJECT_STORES else f"{path}/.part-{name}.{uuid.uuid4().hex}.tmp"
    with written_to(target):
        try:
            with system.open_output_stream(beside) as stream:
                pq.write_table(table, stream, compression="zstd")
            if beside != target:
                system.move(beside, target)
        except BaseException:
            if beside != target and system.get_file_info(beside).is_file:
                system.delete_file(beside)
            raise
