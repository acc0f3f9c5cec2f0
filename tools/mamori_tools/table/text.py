# SPDX-License-Identifier: Apache-2.0
"""A system table as text: windows per core, connections, reactions, findings.

@satisfies SWR-TAB-004, SWR-TAB-011      Design: docs/design/cost.md#text
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_tools.table.document import Connection, Reaction, Table
from mamori_tools.table.mode_text import make_matrices, make_parameters, make_sets, make_title, make_transitions
from mamori_tools.table.safety_text import Section, format_id, make_fault_cells, make_safety_sections
from mamori_tools.table.words import WAY_TEXTS, format_kind, format_modes, format_rate, format_time

Row = tuple[str, ...]
Line = tuple[str, str]
"""A line and its style: a heading, a finding, or neither."""
HEADING, FINDING, PLAIN = "bold", "bold red", ""
WINDOW_COLUMNS = ("window", "offset", "length", "period", "budget", "rate", "kind", "partition", "components (worst case)")
RIGHT = frozenset({"offset", "length", "period", "budget", "within", "fresh within"})


def make_lines(table: Table) -> Iterator[Line]:
    """The complete text, line by line, without line ends."""
    yield make_headline(table), HEADING
    for title, rows in make_sections(table):
        yield PLAIN, PLAIN
        if title:
            yield title, HEADING
        yield from _align(rows)
    yield PLAIN, PLAIN
    yield from make_findings(table)


def make_headline(table: Table) -> str:
    return f"frame {format_time(table.frame_ns)}, {_count(_list_processors(table), 'core')}, {_count(table.windows, 'window')}, " \
           f"{_count(table.components, 'component')}, {_count(table.connections, 'connection')}"  # fmt: skip


def make_sections(table: Table) -> Iterator[Section]:
    """All rows of the table, equal in text and page. A section without a title continues the section before."""
    for core in table.cores():
        load = sum(table.windows[index].budget_ns / max(1, table.windows[index].period_ns) for index in table.windows_of(core))
        rows = [_window_cells(table, index) for index in table.windows_of(core)]
        yield f"{table.core_title(core)}, budgets take {100 * load:.1f} %", [WINDOW_COLUMNS, *rows]
    if table.connections:
        rows = [_connection_cells(table, connection) for connection in table.connections]
        yield "connections", [("from", "to", "arrives", "fresh within", "works in", "declared for"), *rows]
    if table.modes:
        for number, matrix in enumerate(make_matrices(table)):
            yield _plain(make_title(table)) if number == 0 else "", matrix
    for title, rows in (("transitions", make_transitions(table)), ("parameters", make_parameters(table)),
                        ("configuration sets", make_sets(table))):  # fmt: skip
        if len(rows) > 1:
            yield title, rows
    if table.faults or table.reactions:
        heads = ("id", "fault", "reaction", "within", *(["holds in"] if table.modes else []), "raised by", "latched after", "healed after")
        yield "faults and reactions", [heads, *_reaction_cells(table)]
    yield from ((title, rows) for title, rows in make_safety_sections(table) if len(rows) > 1)


def _list_processors(table: Table) -> list[int]:
    return sorted({window.core if window.background_of is None else window.background_of for window in table.windows})


def make_text(table: Table) -> str:
    return "".join(f"{line}\n" for line, _ in make_lines(table))


def _count(rows: tuple[object, ...] | list[int], name: str) -> str:
    return f"{len(rows)} {name}{'' if len(rows) == 1 else 's'}"


def _window_cells(table: Table, index: int) -> Row:
    window = table.windows[index]
    names = []
    for component in (table.components[number] for number in table.components_of(index)):
        worst_case = f" ({format_time(component.worst_case_ns)})" if component.worst_case_ns is not None else ""
        names.append(_plain(component.name) + worst_case)
    return (_plain(window.name), format_time(window.offset_ns), format_time(window.length_ns), format_time(window.period_ns),
            format_time(window.budget_ns), format_rate(window), format_kind(window), _plain(window.partition), ", ".join(names))  # fmt: skip


def _connection_cells(table: Table, connection: Connection) -> Row:
    source, sink = (_plain(f"{table.component_name(end.component)}.{end.port}") for end in (connection.source, connection.sink))
    only_in = ", ".join(table.mode_name(mode) for mode in connection.only_in or ())
    return (source, sink, WAY_TEXTS[connection.way], format_time(connection.fresh_within_ns),
            format_modes(table, connection.modes), only_in)  # fmt: skip


def _reaction_cells(table: Table) -> Iterator[Row]:
    for number, name in table.faults.items():
        rows = [row for row in table.reactions if row.fault == number]
        for row in rows:
            yield _fault_cells(table, number, name, _answer_cells(table, row))
        if not rows:
            yield _fault_cells(table, number, name, ("none", "", "")[: 3 if table.modes else 2])
    for row in table.reactions:
        if row.fault not in table.faults:
            yield _fault_cells(table, row.fault, f"{row.fault}, not declared", _answer_cells(table, row))


def _fault_cells(table: Table, number: int, name: str, answer: Row) -> Row:
    return (format_id(number) if table.safety else "", _plain(name), *answer, *make_fault_cells(table, number))


def _answer_cells(table: Table, row: Reaction) -> Row:
    modes = (format_modes(table, row.modes) or "all modes",) if table.modes else ()
    return _plain(row.reaction), format_time(row.within_ns), *modes


def make_findings(table: Table) -> Iterator[Line]:
    if not table.findings:
        yield "the table keeps every rule", HEADING
        return
    yield f"the table breaks {_count(table.findings, 'rule')}; Executive::initialize() refuses it", HEADING
    for finding in table.findings:
        yield f"  {_plain(finding)}", FINDING


def _plain(name: str) -> str:
    """A name without characters that would control the terminal or end the line."""
    return "".join(letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in name)


def select_columns(rows: list[Row]) -> list[Row]:
    """The rows without columns that have a heading only."""
    rows = [tuple(_plain(cell) for cell in row) for row in rows]
    kept = [column for column in range(len(rows[0])) if any(row[column] for row in rows[1:])]
    return [tuple(row[column] for column in kept) for row in rows]


def _align(rows: list[Row]) -> Iterator[Line]:
    """Columns as wide as their contents."""
    rows = select_columns(rows)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for number, row in enumerate(rows):
        cells = (cell.rjust(width) if head in RIGHT else cell.ljust(width) for cell, width, head in zip(row, widths, rows[0], strict=True))
        yield ("  " + "  ".join(cells)).rstrip(), "underline" if number == 0 else PLAIN
