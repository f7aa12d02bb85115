"""A run's hands as CSV or LaTeX."""

from __future__ import annotations

import io
from collections.abc import Sequence

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv
import pyarrow.types as types

from fpcad.errors import StoreError
from fpcad.look.run import Run
from fpcad.spec.faults import near_miss

SPECIAL = {
    "\\": r"\textbackslash{}",
    **{c: f"\\{c}" for c in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


def hands(run: Run, columns: Sequence[str] = (), front: bool = False) -> pa.Table:
    """Design, metrics and scores of all hands, or of the front; the best mean score first.

    Args:
        columns: names to keep, in this order; all of them by default.
        front: whether to keep the Pareto front only.
    """
    table = run.table.filter(pa.array(run.front)) if front else run.table
    if "mean_score" in table.column_names:
        table = table.sort_by([("mean_score", "descending"), ("id", "ascending")])
    for name in columns:
        if name not in table.column_names:
            hint = near_miss(table.column_names, name)
            raise StoreError(f'{run.folder}: no column "{name}"{hint}')
    return table.select(list(columns)) if columns else table


def csv_text(table: pa.Table) -> str:
    """Rows as CSV with a head; numbers keep all their digits, a missing one is empty."""
    sink = io.BytesIO()
    numbers = [
        pc.if_else(pc.is_finite(column), column, None)  # pyright: ignore[reportAttributeAccessIssue]
        if types.is_floating(column.type)
        else column
        for column in table.columns
    ]
    pyarrow.csv.write_csv(pa.table(numbers, names=table.column_names), sink)
    return sink.getvalue().decode("utf-8")


def latex_text(table: pa.Table, digits: int = 1) -> str:
    """Rows as a LaTeX `tabular` for the package booktabs."""
    numeric = [
        types.is_floating(column.type) or types.is_integer(column.type) for column in table.columns
    ]
    head = " & ".join(latex_escaped(name) for name in table.column_names)
    lines = [
        f"\\begin{{tabular}}{{{''.join('r' if is_number else 'l' for is_number in numeric)}}}",
        "\\toprule",
        f"{head} \\\\",
        "\\midrule",
    ]
    for row in table.to_pylist():
        lines.append(" & ".join(_latex_value(value, digits) for value in row.values()) + " \\\\")
    return "\n".join([*lines, "\\bottomrule", "\\end{tabular}", ""])


def latex_escaped(text: str) -> str:
    """Text with the characters that LaTeX takes for commands."""
    return "".join(SPECIAL.get(character, character) for character in text)


def _latex_value(value: object, digits: int) -> str:
    if value is None or value != value:
        return "--"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.{digits}f}".replace("-", "$-$")
    return latex_escaped(str(value))
