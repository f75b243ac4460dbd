"""The notebooks as they are committed: with their outputs, which `scripts/notebooks` stores and `scripts/python` compares."""

from __future__ import annotations

import json
import pathlib
import re

import pytest

NOTEBOOKS = sorted((pathlib.Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))
# what differs from run to run or from place to place
FOREIGN = re.compile(r"/tmp/|/home/|/Users/|/private/|[A-Z]:\\\\|0x[0-9a-f]{8}|iopub")


def test_the_notebooks_are_found() -> None:
    assert len(NOTEBOOKS) == 3


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_was_run_from_its_begin_and_is_small(path: pathlib.Path) -> None:
    text = path.read_text(encoding="utf-8")
    cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert len(outputs) >= len(cells) // 2
    assert all(output["output_type"] != "error" for output in outputs)
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert FOREIGN.findall(text) == []
    assert len(text) < 300_000
