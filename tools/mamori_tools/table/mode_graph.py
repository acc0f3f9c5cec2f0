# SPDX-License-Identifier: Apache-2.0
"""The mode machine of a system table: modes as boxes, transitions as arrows with their events. Graphviz computes the layout.

@satisfies SWR-TAB-012      Design: docs/design/cost.md#mode-machine
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_tools.table.document import Table
from mamori_tools.table.dot import draw, quote
from mamori_tools.table.mode_rows import Mode, Reference
from mamori_tools.table.words import format_reference

FONT = 'fontname="DejaVu Sans"'
INK, QUIET = "#1b1b1b", "#5f6368"
SAFE_FILL, SAFE_EDGE = "#c4e8dc", "#009e73"
LEGEND = "dot: the system starts here · green: safe mode"
ANY_MODE, WAY_OUT = "any mode", "failed switch or request"
BRIEF_FROM = 200
"""From this number of arrows on, the search for the best positions ends early, because it would take minutes."""
EMPTY = "The table has no modes: all of its components run."


def make_mode_graph(table: Table) -> str:
    """The picture as SVG. Raises InputError if graphviz is missing or fails."""
    return draw(make_mode_dot(table), "mode machine")


def make_mode_dot(table: Table) -> str:
    """The mode machine in the language of graphviz."""
    return "\n".join(_make_lines(table)) + "\n"


def _make_lines(table: Table) -> Iterator[str]:
    groups = _group_events(table)
    search = "nslimit=2, mclimit=0.3, " if len(groups) >= BRIEF_FROM else ""
    yield "digraph modes {"
    yield f"graph [{search}rankdir=LR, nodesep=0.5, ranksep=0.6, {FONT}, fontsize=12, labelloc=b, " \
          f'label={quote("", LEGEND if table.modes else EMPTY)}, tooltip="modes"];'  # fmt: skip
    yield f'node [shape=box, style="rounded,filled", fillcolor=white, color="{QUIET}", {FONT}, fontsize=12, margin="0.2,0.1"];'
    yield f'edge [{FONT}, fontsize=10, fontcolor="{INK}", color="{QUIET}", arrowsize=0.8];'
    for index, mode in enumerate(table.modes):
        yield _make_node(table, index, mode)
    yield from _make_unknown(table)
    for (source, target), events in groups.items():
        hint = f"{_name(table, source)} → {_name(table, target)}: {', '.join(events)}"
        yield f"{_make_id(source)} -> {_make_id(target)} [label={quote(*events)}, tooltip={quote(hint)}];"
    yield "}"


def _make_node(table: Table, index: int, mode: Mode) -> str:
    running = [number for number in mode.components if number is not None]
    lines = [mode.name, *(["safe mode"] if mode.safe else []), f"{len(running)} of {len(table.components)} components"]
    if mode.set is not None:
        lines.append(f"set {format_reference(mode.set)}")
    safe = f', peripheries=2, fillcolor="{SAFE_FILL}", color="{SAFE_EDGE}"' if mode.safe else ""
    hint = "runs " + (", ".join(table.component_name(number) for number in mode.components) or "nothing")
    start = f'start{index} [shape=circle, style=filled, fillcolor="{INK}", label="", width=0.15, tooltip="start"]; ' \
            f"start{index} -> m{index};" if mode.initial else ""  # fmt: skip
    # No row of the table leads to the safe mode: the kernel enters it without a transition.
    way_out = f"any{index} [label={quote(ANY_MODE)}, shape=plaintext, style=solid]; " \
              f"any{index} -> m{index} [label={quote(WAY_OUT)}, style=dashed];" if mode.safe else ""  # fmt: skip
    return f"m{index} [label={quote(*lines)}, tooltip={quote(hint)}{safe}]; {start} {way_out}"


def _make_unknown(table: Table) -> Iterator[str]:
    """One box for each end that is not a mode of the table."""
    ends = {end: None for row in table.transitions for end in (row.source, row.target) if end.index is None}
    for end in ends:
        yield f"{_make_id(end)} [label={quote(format_reference(end))}, style=dashed, tooltip={quote('no mode of the table')}];"


def _group_events(table: Table) -> dict[tuple[Reference, Reference], list[str]]:
    """One arrow from a mode to another, for any number of events."""
    groups: dict[tuple[Reference, Reference], list[str]] = {}
    for row in table.transitions:
        groups.setdefault((row.source, row.target), []).append(row.event_name)
    return groups


def _make_id(reference: Reference) -> str:
    return quote(f"unknown {reference.name}") if reference.index is None else f"m{reference.index}"


def _name(table: Table, reference: Reference) -> str:
    return format_reference(reference) if reference.index is None else table.modes[reference.index].name
