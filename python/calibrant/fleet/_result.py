"""The data set of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Sequence

from ._storage import filesystem, parts

if TYPE_CHECKING:
    import pyarrow as pa


class Result:
    """The data set of a fleet, after a call.

    Attributes
    ----------
    done, failed, earlier : int
        Items that this call has a result of, those that gave an error, and those that were there already.
    calibrated : int
        The same as `done`.
    output : str
        Where the data set is.
    """

    def __init__(
        self, output: str, schema: pa.Schema, counts: tuple[int, int, int], storage_options: Mapping[str, Any]
    ) -> None:
        self.output = output
        self.done, self.failed, self.earlier = counts
        self._schema, self._storage = schema, dict(storage_options)

    @property
    def calibrated(self) -> int:
        """Items that this call has a result of."""
        return self.done

    def scan(self) -> Any:
        """The data set as a relation of DuckDB where that is installed, or else as a lazy frame of polars, or as a table of pyarrow."""
        system, path = filesystem(self.output, self._storage)
        files = parts(system, path)
        if system.type_name == "local" and files:
            try:
                import duckdb

                return duckdb.read_parquet(files)
            except ImportError:
                pass
            try:
                import polars as pl

                return pl.scan_parquet(files)
            except ImportError:
                pass
        return self.to_table()

    def to_table(self, columns: Sequence[str] | None = None) -> pa.Table:
        """The data set as a table of pyarrow, in the order of the items.

        Parameters
        ----------
        columns : list of str, optional
            The columns that are wanted; all by default.
        """
        import pyarrow as pa
        import pyarrow.parquet as pq

        system, path = filesystem(self.output, self._storage)
        wanted = None if columns is None else [*dict.fromkeys(["file", "key", *columns])]
        tables = [pq.read_table(file, columns=wanted, filesystem=system) for file in parts(system, path)]
        empty = self._schema.empty_table() if wanted is None else self._schema.empty_table().select(wanted)
        table = pa.concat_tables([empty, *tables]).sort_by([("file", "ascending"), ("key", "ascending")])
        return table if columns is None else table.select(list(columns))

    def to_frame(self) -> Any:
        """The data set as a frame of pandas or polars, or else as a table of pyarrow."""
        table = self.to_table()
        try:
            return table.to_pandas()
        except ImportError:
            pass
        try:
            import polars as pl

            return pl.from_arrow(table)
        except ImportError:
            return table

    def copies(self) -> list[list[str]]:
        """Items with the same bytes, over all chunks and calls: nobody knows which sensor they are of."""
        import pyarrow.compute as pc

        if "recording_sha256" not in self._schema.names:
            return []
        table = self.to_table(["file", "recording_sha256"])
        table = table.filter(pc.is_valid(table["recording_sha256"]))
        groups = table.group_by("recording_sha256").aggregate([("file", "distinct")])["file_distinct"]
        return sorted(sorted(files) for files in groups.to_pylist() if len(files) > 1)

    def __repr__(self) -> str:
        return f"Result({self.done} done, {self.failed} failed, {self.earlier} earlier: {self.output})"
