"""Results for people: as text, and as HTML for notebooks."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING, Any, Iterable, Sequence

if TYPE_CHECKING:
    from ._calibration import Calibration


def significant(value: float, digits: int = 4) -> str:
    """A number with so many significant digits."""
    if not math.isfinite(value):
        return "–"
    return f"{value:.{digits}g}"


def with_sd(value: float, sd: float) -> str:
    """A value to the second digit of its standard deviation: ``1.00234 ± 0.00012``."""
    if not (math.isfinite(sd) and sd > 0.0):
        return significant(value, 8)
    decimals = max(0, 1 - math.floor(math.log10(sd)))
    if decimals > 12:
        return f"{value:.8g} ± {sd:.2g}"
    # a zero has no sign
    return f"{round(value, decimals) + 0.0:.{decimals}f} ± {sd:.{decimals}f}"


def table_text(head: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> str:
    """A table as text; the first `left` columns begin at the left."""
    all_rows = [list(head), *(list(row) for row in rows)]
    widths = [max(len(row[k]) for row in all_rows) for k in range(len(head))]

    def line(row: Sequence[str]) -> str:
        cells = [
            cell.ljust(width) if k < left else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(row, widths))
        ]
        return "  ".join(cells).rstrip()

    rule = "─" * (sum(widths) + 2 * (len(widths) - 1))
    return "\n".join([line(all_rows[0]), rule, *(line(row) for row in all_rows[1:])])


def table_html(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table as HTML; the first and the last column begin at the left."""

    def line(kind: str, row: Sequence[str]) -> str:
        sides = ["left", *["right"] * (len(row) - 2), "left"]
        return "".join(f"<{kind} style='text-align:{side}'>{escape(cell)}</{kind}>" for side, cell in zip(sides, row))

    body = "".join(f"<tr>{line('td', row)}</tr>" for row in rows)
    return f"<table><thead><tr>{line('th', head)}</tr></thead><tbody>{body}</tbody></table>"


def page_html(page: str) -> str:
    """A whole page within another: its styles stay its own."""
    style = "width:100%;height:36em;border:1px solid #d8dee4;resize:vertical"
    return f'<iframe srcdoc="{escape(page)}" style="{style}"></iframe>'


_HEAD = ("parameter", "value", "sd", "unit")
_MOST_FILES = 4


def _facts(calibration: Calibration) -> list[tuple[str, str]]:
    data = calibration.data
    fit: dict[str, Any] = data.get("fit") or {}
    facts = [("verdict", calibration.verdict)]
    codes = (data.get("verdict") or {}).get("codes") or []
    if codes:
        facts[0] = ("verdict", f"{calibration.verdict}: {', '.join(codes)}")
    if calibration.sensor:
        facts.append(("sensor", calibration.sensor))
    inputs = data.get("inputs") or []
    if len(inputs) > _MOST_FILES:
        facts.append(("recordings", f"{len(inputs)}: {inputs[0].get('file')} … {inputs[-1].get('file')}"))
    elif inputs:
        facts.append(("recording", ", ".join(str(of.get("file")) for of in inputs)))
        facts.append(("samples", ", ".join(f"{of['samples']} at {of['rate_hz']:g} Hz" for of in inputs if "samples" in of)))
    if data.get("status"):
        iterations = data.get("iterations")
        facts.append(("estimation", str(data["status"]) + ("" if iterations is None else f" in {iterations} iterations")))
    if fit.get("chi2") is not None:
        text = f"{significant(fit['chi2'])} for {fit.get('degrees_of_freedom')} degrees of freedom"
        if fit.get("p_value") is not None:
            text += f", p = {significant(fit['p_value'], 2)}"
        facts.append(("χ²", text))
    if data.get("direction"):
        facts.append(("direction", str(data["direction"])))
    if data.get("frame"):
        facts.append(("true frame", str(data["frame"])))
    return facts


def _rows(calibration: Calibration) -> list[tuple[str, str, str, str]]:
    rows = []
    for parameter in calibration.parameters:
        value, _, sd = with_sd(parameter.value, parameter.sd).partition(" ± ")
        rows.append((parameter.name, value, sd, parameter.unit))
    return rows


def calibration_text(calibration: Calibration) -> str:
    """A calibration as text."""
    facts = _facts(calibration)
    width = max(len(label) for label, _ in facts)
    lines = ["Calibration", "", *(f"{label.ljust(width)}  {text}" for label, text in facts), ""]
    lines.append(table_text(_HEAD, _rows(calibration)))
    found = [str(of) for of in calibration.diagnostics if of.severity != "note"]
    return "\n".join(lines + ([""] + found if found else []))


def calibration_html(calibration: Calibration) -> str:
    """A calibration as HTML."""
    facts = "".join(
        f"<tr><th style='text-align:left'>{escape(label)}</th><td style='text-align:left'>{escape(text)}</td></tr>"
        for label, text in _facts(calibration)
    )
    found = "".join(f"<li>{escape(str(of))}</li>" for of in calibration.diagnostics if of.severity != "note")
    notes = f"<ul>{found}</ul>" if found else ""
    return f"<div><table style='margin-bottom:1em'>{facts}</table>{table_html(_HEAD, _rows(calibration))}{notes}</div>"
