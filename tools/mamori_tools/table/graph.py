# SPDX-License-Identifier: Apache-2.0
"""The data flow of a system table: components as boxes, grouped by core, partition and window; connections as edges. Graphviz computes the
layout.

@satisfies SWR-TAB-006      Design: docs/design/cost.md#graph
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from mamori_tools.table.document import Connection, Table
from mamori_tools.table.dot import draw, quote
from mamori_tools.table.svg import COLOURS, calc_width
from mamori_tools.table.words import format_modes, format_time

PLAIN_FROM = 400
"""From this number of connections on, edges are straight, because the search for curves would take minutes."""
LABELS_MAX = 40
"""Up to this number of connections, labels within a window are part of the layout; dot fails for much larger numbers."""
LABEL_SIZE = 9
GAP_MAX = 4.0
"""Maximum distance of two columns [inch], for any length of port names."""
MODES_LENGTH_MAX = 24
"""Maximum letters of mode names next to a connection. If they are longer, only the count is shown, and a tooltip names the modes."""
EDGE_STYLES = {
    "same_window": 'color="#1b1b1b", constraint=false',
    "later_window": 'color="#0072b2", constraint=false',
    # If these edges run in parallel, a label in the middle would be ambiguous: it is above the edge, near the source.
    "next_frame": 'color="#0072b2", style=dashed, labeldistance=6, labelangle=-18, constraint=false',
    "crossing": 'color="#d55e00", penwidth=2, constraint=false',
    "queue": 'color="#009e73", penwidth=2, arrowhead=normalnormal, constraint=false',
}
LEGEND = "black: same window · blue: later window · blue, dashed: next frame · orange: crossing · green: queue"
MODES_LEGEND = " · circle: only in some modes"


def make_graph(table: Table) -> str:
    """The picture as SVG. Raises InputError if graphviz is missing or fails."""
    return draw(make_dot(table), "graph")


def make_dot(table: Table) -> str:
    """The graph in the language of graphviz."""
    return "\n".join(_make_lines(table)) + "\n"


def _make_lines(table: Table) -> Iterator[str]:
    splines = "true" if len(table.connections) < PLAIN_FROM else "line"
    # Labels are placed after the layout: the gap between two columns fits the longest label.
    lines = (line for connection in table.connections for line in _make_label(table, connection))
    gap = max([calc_width(line, LABEL_SIZE) for line in lines], default=0.0) / 72 + 0.5
    yield "digraph table {"
    yield f'graph [rankdir=LR, splines={splines}, nodesep=0.35, ranksep={min(gap, GAP_MAX):.2f}, fontname="DejaVu Sans", fontsize=12, newrank=true,'
    yield f'  labelloc=b, label={quote(LEGEND + (MODES_LEGEND if table.modes else ""))}, tooltip="data flow"];'
    yield 'node [shape=box, style="rounded,filled", fillcolor=white, fontname="DejaVu Sans", fontsize=12, margin="0.15,0.08"];'
    yield f'edge [fontname="DejaVu Sans", fontsize={LABEL_SIZE}, fontcolor="#5f6368", arrowsize=0.7];'
    for core in table.cores():
        yield from _make_core(table, core)
    for index, component in enumerate(table.components):
        if component.window is None:
            yield _make_node(table, index)
    for connection in table.connections:
        yield from _make_edge(table, connection)
    yield "}"


def _make_core(table: Table, core: int) -> Iterator[str]:
    windows = table.windows_of(core)
    yield f"subgraph cluster_core_{core} {{ label={quote(table.core_title(core))}; labelloc=t; labeljust=l; color=\"#5f6368\"; bgcolor=\"#f8f9fa\";"
    partitions = sorted({table.windows[index].partition for index in windows})
    for number, partition in enumerate(partitions):
        if partition:
            yield f"subgraph cluster_partition_{core}_{number} {{ label={quote(f'partition {partition}')}; labelloc=t; style=dashed; color=\"#5f6368\";"
        for index in windows:
            if table.windows[index].partition == partition:
                yield from _make_window(table, index, COLOURS[windows.index(index) % len(COLOURS)])
        if partition:
            yield "}"
    # Windows from left to right, ordered by first start.
    columns = [name for index in windows if table.components_of(index) for name in _name_columns(table, index)]
    for earlier, later in itertools.pairwise(columns):
        yield f"{earlier} -> {later} [style=invis, weight=100];"
    yield "}"


def _make_window(table: Table, index: int, colours: tuple[str, str]) -> Iterator[str]:
    """Box of the window, in its colours of the time line."""
    window = table.windows[index]
    label = f"{window.name}, every {format_time(window.period_ns)}"
    yield f'subgraph cluster_window_{index} {{ label={quote(label)}; labelloc=t; style="filled,solid"; bgcolor="{colours[0]}"; ' \
          f'fillcolor="{colours[0]}"; color="{colours[1]}";'  # fmt: skip
    for name in _name_columns(table, index)[:-1]:
        yield f'{name} [shape=point, style=invis, width=0.01, height=0.01, label=""];'
    for component in table.components_of(index):
        yield _make_node(table, component)
    # Components from top to bottom in execution order.
    components = table.components_of(index)
    yield f"{{ rank=same; {'; '.join(f'c{component}' for component in components)} }}"
    for earlier, later in itertools.pairwise(components):
        yield f"c{later} -> c{earlier} [style=invis];"  # dot stacks upwards
    yield "}"


def _name_columns(table: Table, index: int) -> list[str]:
    """The columns of a window from left to right, each represented by one of its nodes; the last column contains the components.

    A connection that passes a component between its ends bends to the left. dot does not include the bend in the box of the window, but it
    includes an empty column.
    """
    components = table.components_of(index)
    is_past_another = any(
        connection.way == "same_window" and connection.source.component in components and connection.sink.component in components
        and abs(components.index(connection.source.component) - components.index(connection.sink.component)) > 1
        for connection in table.connections)  # fmt: skip
    return [*([f"bow_{index}"] if is_past_another else []), f"c{components[0]}"]


def _make_node(table: Table, index: int) -> str:
    component = table.components[index]
    worst_case = f", worst case {format_time(component.worst_case_ns)}" if component.worst_case_ns is not None else ""
    return f"c{index} [label={quote(component.name)}, tooltip={quote(component.name + worst_case)}];"


def _make_edge(table: Table, connection: Connection) -> Iterator[str]:
    ends = (connection.source, connection.sink)
    source, sink = ends[0].component, ends[1].component
    if source is None or sink is None:
        return  # a finding reports it
    age = "" if connection.fresh_within_ns is None else f", fresh within {format_time(connection.fresh_within_ns)}"
    modes = format_modes(table, connection.modes)
    hint = " → ".join(f"{table.component_name(end.component)}.{end.port}" for end in ends) + age + (f", in {modes}" if modes else "")
    # Within a window, the edge is declared from bottom to top, because dot stacks upwards; it is drawn from top to bottom.
    pair, is_back = (f"c{sink} -> c{source}", True) if connection.way == "same_window" else (f"c{source} -> c{sink}", False)
    # A vertical edge starts and ends at a side without other edges; otherwise dot would draw it twice.
    is_straight = connection.way in ("crossing", "queue") and _calc_column(table, source) == _calc_column(table, sink)
    ports = ", tailport=w, headport=w" if is_straight else ""
    # A circle at the source marks modes; dot names the end of a reversed edge its head.
    marks = {False: "dir=back" if is_back else "dir=forward", True: f"dir=both, arrow{'head' if is_back else 'tail'}=odot"}[bool(modes)]
    place = {"same_window": "label" if len(table.connections) <= LABELS_MAX else "xlabel", "next_frame": "taillabel"}.get(connection.way, "xlabel")
    yield f"{pair} [{marks}, {place}={quote(*_make_label(table, connection))}, tooltip={quote(hint)}, {EDGE_STYLES[connection.way]}{ports}];"


def _make_label(table: Table, connection: Connection) -> list[str]:
    """Lines of the label: the ports, and the modes if the connection does not work in all."""
    out, into = connection.source.port, connection.sink.port
    modes = format_modes(table, connection.modes)
    if len(modes) > MODES_LENGTH_MAX:
        modes = f"{len(connection.modes)} of {len(table.modes)} modes"
    return [out if out == into else f"{out} → {into}", *([f"[{modes}]"] if modes else [])]


def _calc_column(table: Table, component: int) -> int:
    """Index of the window of the component among the windows of its core."""
    index = table.components[component].window
    return -1 if index is None else table.windows_of(table.windows[index].core).index(index)
