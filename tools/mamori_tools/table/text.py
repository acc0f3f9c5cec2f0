# SPDX-License-Identifier: Apache-2.0
"""A system table as text: windows per core, connections, reactions, findings.

@satisfies SWR-TAB-004, SWR-TAB-011      Design: docs/design/cost.md#text
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_tools.table.document import Connection, Reaction, Table
from mamori_tools.table.mode_text import make_matrices, make_parameters, make_sets, make_title, make_transitions
from mamori_tools.table.words import WAY_TEXTS, format_kind, format_modes, format_rate, format_time

Line = tuple[str, str]
"""A line and its style: a heading, a finding, or neither."""
HEADING, FINDING, PLAIN = "bold", "bold red", ""
WINDOW_COLUMNS = ("window", "offset", "length", "period", "budget", "rate", "kind", "partition", "components (worst case)")
RIGHT = frozenset({"offset", "length", "period", "budget", "within", "fresh within"})


def make_lines(table: Table) -> Iterator[Line]:
    """The complete text, line by line, without line ends."""
    yield f"frame {format_time(table.frame_ns)}, {_count(_list_processors(table), 'core')}, {_count(table.windows, 'window')}, " \
          f"{_count(table.components, 'component')}, {_count(table.connections, 'connection')}", HEADING  # fmt: skip
    for core in table.cores():
        load = sum(table.windows[index].budget_ns / max(1, table.windows[index].period_ns) for index in table.windows_of(core))
        yield PLAIN, PLAIN
        yield f"{table.core_title(core)}, budgets take {100 * load:.1f} %", HEADING
        yield from _align([WINDOW_COLUMNS, *(_window_cells(table, index) for index in table.windows_of(core))])
    if table.connections:
        yield PLAIN, PLAIN
        yield "connections", HEADING
        rows = [_connection_cells(table, connection) for connection in table.connections]
        yield from _align([("from", "to", "arrives", "fresh within", "works in", "declared for"), *rows])
    yield from _make_modes(table)
    if table.faults or table.reactions:
        yield PLAIN, PLAIN
        yield "faults and reactions", HEADING
        yield from _align([("fault", "reaction", "within", *(["holds in"] if table.modes else [])), *_reaction_cells(table)])
    yield PLAIN, PLAIN
    yield from _findings(table)


def _list_processors(table: Table) -> list[int]:
    return sorted({window.core if window.background_of is None else window.background_of for window in table.windows})


def _make_modes(table: Table) -> Iterator[Line]:
    if table.modes:
        yield PLAIN, PLAIN
        yield _plain(make_title(table)), HEADING
        for number, matrix in enumerate(make_matrices(table)):
            if number > 0:
                yield PLAIN, PLAIN
            yield from _align(matrix)
    for title, rows in (("transitions", make_transitions(table)), ("parameters", make_parameters(table)),
                        ("configuration sets", make_sets(table))):  # fmt: skip
        if len(rows) > 1:
            yield PLAIN, PLAIN
            yield title, HEADING
            yield from _align(rows)


def make_text(table: Table) -> str:
    return "".join(f"{line}\n" for line, _ in make_lines(table))


def _count(rows: tuple[object, ...] | list[int], name: str) -> str:
    return f"{len(rows)} {name}{'' if len(rows) == 1 else 's'}"


def _window_cells(table: Table, index: int) -> tuple[str, ...]:
    window = table.windows[index]
    names = []
    for component in (table.components[number] for number in table.components_of(index)):
        worst_case = f" ({format_time(component.worst_case_ns)})" if component.worst_case_ns is not None else ""
        names.append(_plain(component.name) + worst_case)
    return (_plain(window.name), format_time(window.offset_ns), format_time(window.length_ns), format_time(window.period_ns),
            format_time(window.budget_ns), format_rate(window), format_kind(window), _plain(window.partition), ", ".join(names))  # fmt: skip


def _connection_cells(table: Table, connection: Connection) -> tuple[str, ...]:
    source, sink = (_plain(f"{table.component_name(end.component)}.{end.port}") for end in (connection.source, connection.sink))
    only_in = ", ".join(table.mode_name(mode) for mode in connection.only_in or ())
    return (source, sink, WAY_TEXTS[connection.way], format_time(connection.fresh_within_ns),
            format_modes(table, connection.modes), only_in)  # fmt: skip


def _reaction_cells(table: Table) -> Iterator[tuple[str, ...]]:
    for number, name in table.faults.items():
        rows = [row for row in table.reactions if row.fault == number]
        for row in rows:
            yield _plain(name), *_answer_cells(table, row)
        if not rows:
            yield (_plain(name), "none", "", "")[: 4 if table.modes else 3]
    for row in table.reactions:
        if row.fault not in table.faults:
            yield f"{row.fault}, not declared", *_answer_cells(table, row)


def _answer_cells(table: Table, row: Reaction) -> tuple[str, ...]:
    modes = (format_modes(table, row.modes) or "all modes",) if table.modes else ()
    return _plain(row.reaction), format_time(row.within_ns), *modes


def _findings(table: Table) -> Iterator[Line]:
    if not table.findings:
        yield "the table keeps every rule", HEADING
        return
    yield f"the table breaks {_count(table.findings, 'rule')}; Executive::initialize() refuses it", HEADING
    for finding in table.findings:
        yield f"  {_plain(finding)}", FINDING


def _plain(name: str) -> str:
    """A name without characters that would control the terminal or end the line."""
    return "".join(letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in name)


def _align(rows: list[tuple[str, ...]]) -> Iterator[Line]:
    """Columns as wide as their contents; a column without any content is omitted with its heading."""
    rows = [tuple(_plain(cell) for cell in row) for row in rows]
    kept = [column for column in range(len(rows[0])) if any(row[column] for row in rows[1:])]
    widths = {column: max(len(row[column]) for row in rows) for column in kept}
    for number, row in enumerate(rows):
        cells = (row[column].rjust(widths[column]) if rows[0][column] in RIGHT else row[column].ljust(widths[column])
                 for column in kept)  # fmt: skip
        yield ("  " + "  ".join(cells)).rstrip(), "underline" if number == 0 else PLAIN
