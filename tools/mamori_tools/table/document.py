# SPDX-License-Identifier: Apache-2.0
"""The JSON of a system table as checked rows. In a `Table`, all keys and indices are valid.

@satisfies SWR-TAB-008      Design: docs/design/cost.md#schema
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.table.mode_rows import ConfigurationSet, Mode, Parameter, Transition, read_mode, read_parameter, read_set, read_transition
from mamori_tools.table.safety_rows import Safety, read_safety
from mamori_trace.base.errors import InputError
from mamori_trace.base.json_node import HOW_TO_FIX, JsonNode
from mamori_trace.base.text_file import read_text

SCHEMA = "mamori.table/5"
MAX_BYTES = 50_000_000
WAYS = ("same_window", "later_window", "next_frame", "crossing", "queue")
KINDS = ("periodic", "event_driven", "triggered", "system", "invalid")
ABORT_POLICIES = ("spec_only", "openrtm_compat")
DIRECTIONS = ("in", "out")


@dataclass(frozen=True)
class Window:
    name: str
    core: int
    """Number of the executive that runs it: the processor core, or a number of its own for the background windows of a core."""
    background_of: int | None
    """Processor core whose ordinary windows preempt it; None: an ordinary window."""
    partition: str
    kind: str
    offset_ns: int
    length_ns: int
    period_ns: int
    budget_ns: int
    rate_hz: float | None
    slower_periods_ns: tuple[int, ...]
    events_per_cycle: int | None


@dataclass(frozen=True)
class Port:
    name: str
    direction: str
    mandatory: bool
    payload_bytes: int | None
    """Size of one value in the memory of the program; None: 64 KiB or more."""


@dataclass(frozen=True)
class Component:
    name: str
    window: int | None
    worst_case_ns: int | None
    ports: tuple[Port, ...]


@dataclass(frozen=True)
class End:
    component: int | None
    port: str


@dataclass(frozen=True)
class Connection:
    source: End
    sink: End
    way: str
    fresh_within_ns: int | None
    only_in: tuple[int | None, ...] | None
    """Modes for which it was declared; None: all."""
    modes: tuple[int, ...]
    """Modes in which it works: both of its components run in them."""


@dataclass(frozen=True)
class Reaction:
    fault: int
    reaction: str
    within_ns: int
    modes: tuple[int, ...]
    """Empty in a system without modes."""


@dataclass(frozen=True)
class Table:
    frame_ns: int
    abort_policy: str
    windows: tuple[Window, ...]
    components: tuple[Component, ...]
    connections: tuple[Connection, ...]
    faults: dict[int, str]
    reactions: tuple[Reaction, ...]
    safety: Safety | None
    """None: a table of the kernel alone."""
    modes: tuple[Mode, ...]
    transitions: tuple[Transition, ...]
    parameters: tuple[Parameter, ...]
    sets: tuple[ConfigurationSet, ...]
    findings: tuple[str, ...]

    def cores(self) -> list[int]:
        """Numbers of the executives; background windows after the ordinary windows of their core."""
        keys = {(window.core if window.background_of is None else window.background_of, window.core) for window in self.windows}
        return [core for _, core in sorted(keys)]

    def core_title(self, core: int) -> str:
        background_of = next(window.background_of for window in self.windows if window.core == core)
        return f"core {core}" if background_of is None else f"background of core {background_of}"

    def windows_of(self, core: int) -> list[int]:
        """Indices of the windows of one core, sorted by their first start."""
        indices = [index for index, window in enumerate(self.windows) if window.core == core]
        return sorted(indices, key=lambda index: (self.windows[index].offset_ns, index))

    def components_of(self, window: int) -> list[int]:
        return [index for index, component in enumerate(self.components) if component.window == window]

    def component_name(self, index: int | None) -> str:
        return "?" if index is None else self.components[index].name

    def mode_name(self, index: int | None) -> str:
        return "?" if index is None else self.modes[index].name


def read_table(path: Path) -> Table:
    """Raises InputError, one line with the location, for an incomplete table or another schema."""
    source = read_text(path, "table", MAX_BYTES)
    try:
        value = json.loads(source.text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        line = error.lineno if isinstance(error, json.JSONDecodeError) else None
        what = error.msg if isinstance(error, json.JSONDecodeError) else str(error)
        raise InputError(f"is no whole JSON document: {what}; {HOW_TO_FIX}", path, line) from error
    root = JsonNode(path, "the table", value)
    schema = root.at("schema").text()
    if schema != SCHEMA:
        raise InputError(f"has the schema '{schema}', this command reads '{SCHEMA}'; use a command and a library of one version", path)
    windows = root.at("windows").items()
    components = root.at("components").items()
    modes = root.at("modes").items()
    parameters = root.at("parameters").items()
    sets = root.at("configuration_sets").items()
    table = Table(
        frame_ns=root.at("frame_ns").whole(),
        abort_policy=root.at("abort_policy").text(ABORT_POLICIES),
        windows=tuple(_read_window(node) for node in windows),
        components=tuple(_read_component(node, len(windows)) for node in components),
        connections=tuple(_read_connection(node, len(components), len(modes)) for node in root.at("connections").items()),
        faults={node.at("number").count(): node.at("name").text() for node in root.at("faults").items()},
        reactions=tuple(_read_reaction(node, len(modes)) for node in root.at("reactions").items()),
        safety=read_safety(root.at("safety"), len(components)),
        modes=tuple(read_mode(node, len(components), len(sets)) for node in modes),
        transitions=tuple(read_transition(node, len(modes)) for node in root.at("transitions").items()),
        parameters=tuple(read_parameter(node, len(components)) for node in parameters),
        sets=tuple(read_set(node, len(parameters)) for node in sets),
        findings=tuple(node.text() for node in root.at("findings").items()),
    )  # fmt: skip
    if not table.findings:
        _refuse_untold_times(root)
    return table


def _refuse_untold_times(root: JsonNode) -> None:
    """Rejects non-positive times in a document without findings: the kernel check reports such times, so this table was not checked."""
    times = [root.at("frame_ns")]
    times += [window.at(key) for window in root.at("windows").items() for key in ("length_ns", "period_ns", "budget_ns")]
    times += [reaction.at("within_ns") for reaction in root.at("reactions").items()]
    for time in times:
        if time.whole() <= 0:
            raise time.complain(f"is {time.whole()}, must be positive, and no finding says that it is not")


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")


def _read_window(node: JsonNode) -> Window:
    return Window(
        name=node.at("name").text(),
        core=node.at("core").count(),
        background_of=node.at("background_of").whole_or_none(),
        partition=node.at("partition").text(),
        kind=node.at("kind").text(KINDS),
        offset_ns=node.at("offset_ns").whole(),
        length_ns=node.at("length_ns").whole(),
        period_ns=node.at("period_ns").whole(),
        budget_ns=node.at("budget_ns").whole(),
        rate_hz=node.at("rate_hz").real_or_none(),
        slower_periods_ns=tuple(item.whole() for item in node.at("slower_periods_ns").items()),
        events_per_cycle=node.at("events_per_cycle").whole_or_none(),
    )


def _read_component(node: JsonNode, window_count: int) -> Component:
    ports = (Port(port.at("name").text(), port.at("direction").text(DIRECTIONS), port.at("mandatory").truth(),
                  port.at("payload_bytes").whole_or_none())
             for port in node.at("ports").items())  # fmt: skip
    return Component(node.at("name").text(), node.at("window").index_or_none(window_count),
                     node.at("worst_case_ns").whole_or_none(), tuple(ports))  # fmt: skip


def _read_reaction(node: JsonNode, mode_count: int) -> Reaction:
    return Reaction(node.at("fault").count(), node.at("reaction").text(), node.at("within_ns").whole(),
                    tuple(mode.index(mode_count) for mode in node.at("modes").items()))  # fmt: skip


def _read_connection(node: JsonNode, component_count: int, mode_count: int) -> Connection:
    source, sink = (End(end.at("component").index_or_none(component_count), end.at("port").text())
                    for end in (node.at("from"), node.at("to")))  # fmt: skip
    only_in = node.at("only_in").items_or_none()
    return Connection(source, sink, node.at("way").text(WAYS), node.at("fresh_within_ns").whole_or_none(),
                      None if only_in is None else tuple(mode.index_or_none(mode_count) for mode in only_in),
                      tuple(mode.index(mode_count) for mode in node.at("modes").items()))  # fmt: skip
