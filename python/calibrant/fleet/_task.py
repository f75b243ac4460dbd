"""What the items of a fleet share: what is done with each. A task can be pickled, and runs anywhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, Sequence, Union

from .._exceptions import CalibrantError, as_json, of_json
from .._experiment import Experiment

if TYPE_CHECKING:
    import pyarrow as pa

# a name: a path, a URL, a number. Or a name with what it stands for
Item = Union[str, "tuple[str, Experiment]"]


class Task(Protocol):
    """What is done with each item of a chunk."""

    @property
    def storage_options(self) -> dict[str, Any]:
        """For paths that are URLs."""

    @property
    def what(self) -> str:
        """What the items are, for the progress."""

    @property
    def most(self) -> int:
        """Items of a chunk, where nobody says it: so few that a killed worker loses seconds, so many that the engine's own share is small."""

    def schema(self) -> pa.Schema:
        """The columns of the data set."""

    def opened(self, items: Sequence[Item]) -> list[Any]:
        """The content of each item, or where it is."""

    def keys(self, items: Sequence[Item], opened: Sequence[Any]) -> list[str | None]:
        """What each result depends on, as one SHA-256. ``None`` where an item cannot be read."""

    def rows(self, items: Sequence[Item], opened: Sequence[Any], threads: int | None) -> list[dict[str, Any]]:
        """The columns of each item, without its key and its name. An error is a row, too."""


def name_of(item: Item) -> str:
    """The name of an item."""
    return item if isinstance(item, str) else item[0]


def failure(error: str | CalibrantError | None) -> dict[str, Any]:
    """The columns of an error, or of its JSON; they are empty where there is none."""
    if error is None:
        return {"code": None, "error": None, "error_json": None}
    found = error if isinstance(error, CalibrantError) else of_json(error)
    return {"code": found.code, "error": str(found), "error_json": as_json(found)}


def schema_of(kind: str, columns: Sequence[tuple[str, Any]]) -> pa.Schema:
    """A schema that begins with the item, and ends with its error."""
    import pyarrow as pa

    text = pa.string()
    first = [("key", text), ("file", text), ("experiment", text), ("experiment_sha256", text), ("program", text)]
    last = [("code", text), ("error", text), ("error_json", text)]
    return pa.schema([*first, *columns, *last], metadata={"calibrant": f"fleet.{kind} 1"})
