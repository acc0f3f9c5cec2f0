# SPDX-License-Identifier: Apache-2.0
"""Modes, transitions, parameters and configuration sets of a system table as rows of text.

@satisfies SWR-TAB-011      Design: docs/design/cost.md#text
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_tools.table.document import Table
from mamori_tools.table.mode_rows import Assignment, Parameter
from mamori_tools.table.words import format_reference, format_values

Row = tuple[str, ...]
WIDTH_MAX = 120
"""Maximum letters in a line of the matrix; further modes form a separate matrix."""
RUNS, RESTS = "x", "-"
SET_ROW = "(configuration set)"


def make_title(table: Table) -> str:
    """`4 modes, first idle, safe halt`"""
    marks = [("first", [mode.name for mode in table.modes if mode.initial]), ("safe", [mode.name for mode in table.modes if mode.safe])]
    count = f"{len(table.modes)} mode{'' if len(table.modes) == 1 else 's'}"
    return ", ".join([count, *(f"{mark} {' and '.join(names) or 'none'}" for mark, names in marks)])


def make_matrices(table: Table) -> Iterator[list[Row]]:
    """Components by modes, headings first; each matrix has as many modes as fit on a line."""
    rows = [("component", *(mode.name for mode in table.modes))]
    for index, component in enumerate(table.components):
        rows.append((component.name, *(RUNS if index in mode.components else RESTS for mode in table.modes)))
    if any(None in mode.components for mode in table.modes):
        rows.append(("?", *(RUNS if None in mode.components else RESTS for mode in table.modes)))
    if any(mode.set is not None for mode in table.modes):
        rows.append((SET_ROW, *(format_reference(mode.set) or RESTS for mode in table.modes)))
    widths = [2 + max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    first = 1
    while first < len(widths):
        last = first + 1
        while last < len(widths) and widths[0] + sum(widths[first : last + 1]) <= WIDTH_MAX:
            last += 1
        yield [(row[0], *row[first:last]) for row in rows]
        first = last


def make_transitions(table: Table) -> list[Row]:
    rows = ((format_reference(row.source), row.event_name, format_reference(row.target)) for row in table.transitions)
    return [("from", "event", "to"), *rows]


def make_parameters(table: Table) -> list[Row]:
    rows = ((_name_parameter(row), _format_type(row), format_values(row.values), row.constraint) for row in table.parameters)
    return [("parameter", "type", "value", "constraint"), *rows]


def make_sets(table: Table) -> list[Row]:
    rows: list[Row] = [("set", "parameter", "value")]
    for group in table.sets:
        if group.assignments is None:
            rows.append((group.name, "?", "?"))
        else:
            rows += ((group.name, _name_assigned(table, row), format_values(row.values)) for row in group.assignments)
            rows += [] if group.assignments else [(group.name, "none", "")]
    return rows


def _name_parameter(parameter: Parameter) -> str:
    return f"{format_reference(parameter.owner)}.{parameter.name}"


def _name_assigned(table: Table, assignment: Assignment) -> str:
    index = assignment.parameter.index
    return f"?.{assignment.parameter.name}" if index is None else _name_parameter(table.parameters[index])


def _format_type(parameter: Parameter) -> str:
    if parameter.type is None:
        return "?"
    count = 0 if parameter.values is None else len(parameter.values)
    return parameter.type if count == 1 else f"{parameter.type}[{count}]"
