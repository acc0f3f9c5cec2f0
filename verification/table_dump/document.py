# SPDX-License-Identifier: Apache-2.0
"""The JSON of a system table as checked rows. Whoever has a `Table` need not look whether a key or an index is there.

@satisfies SWR-TAB-008      Design: docs/design/table_dump.md#schema
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from mamori.profiles.input_error import InputError, nearest_names
from mamori.profiles.text_file import read_text

SCHEMA = "mamori.table/1"
MAX_BYTES = 50_000_000
WAYS = ("same_window", "later_window", "next_frame", "crossing", "queue")
KINDS = ("periodic", "event_driven", "triggered", "invalid")
ABORT_POLICIES = ("spec_only", "openrtm_compat")
DIRECTIONS = ("in", "out")
HOW_TO_MEND = "write it again with mamori::table_dump"


@dataclass(frozen=True)
class Window:
    name: str
    core: int
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


@dataclass(frozen=True)
class Reaction:
    fault: int
    reaction: str
    within_ns: int


@dataclass(frozen=True)
class Table:
    frame_ns: int
    abort_policy: str
    windows: tuple[Window, ...]
    components: tuple[Component, ...]
    connections: tuple[Connection, ...]
    faults: dict[int, str]
    reactions: tuple[Reaction, ...]
    findings: tuple[str, ...]

    def cores(self) -> list[int]:
        return sorted({window.core for window in self.windows})

    def windows_of(self, core: int) -> list[int]:
        """Indices of the windows of one core, by their first opening."""
        indices = [index for index, window in enumerate(self.windows) if window.core == core]
        return sorted(indices, key=lambda index: (self.windows[index].offset_ns, index))

    def components_of(self, window: int) -> list[int]:
        return [index for index, component in enumerate(self.components) if component.window == window]

    def component_name(self, index: int | None) -> str:
        return "?" if index is None else self.components[index].name


class _Node:
    """One JSON value with its place, which every complaint names."""

    def __init__(self, path: Path, place: str, value: object) -> None:
        self._path = path
        self._place = place
        self._value = value

    def complain(self, text: str) -> InputError:
        return InputError(f"{self._place} {text}; {HOW_TO_MEND}", self._path)

    def at(self, key: str) -> _Node:
        place = f"{self._place}.{key}" if self._place != "the table" else key
        if not isinstance(self._value, dict):
            raise self.complain("must be an object")
        if key not in self._value:
            raise self.complain(f"has no '{key}'")
        return _Node(self._path, place, self._value[key])

    def items(self) -> list[_Node]:
        if not isinstance(self._value, list):
            raise self.complain("must be a list")
        return [_Node(self._path, f"{self._place}[{index}]", value) for index, value in enumerate(self._value)]

    def text(self, known: tuple[str, ...] = ()) -> str:
        if not isinstance(self._value, str):
            raise self.complain("must be a text")
        if known and self._value not in known:
            raise self.complain(f"is '{self._value}'; {nearest_names(self._value, known)}")
        return self._value

    def truth(self) -> bool:
        if not isinstance(self._value, bool):
            raise self.complain("must be true or false")
        return self._value

    def whole(self) -> int:
        if not isinstance(self._value, int) or isinstance(self._value, bool) or abs(self._value) >= 2**64:
            raise self.complain("must be a whole number of 64 bits")
        return self._value

    def count(self) -> int:
        if self.whole() < 0:
            raise self.complain("must not be negative")
        return self.whole()

    def whole_or_none(self) -> int | None:
        return None if self._value is None else self.whole()

    def real_or_none(self) -> float | None:
        if self._value is None:
            return None
        if not isinstance(self._value, int | float) or isinstance(self._value, bool):
            raise self.complain("must be a number or null")
        return float(self._value)

    def index_or_none(self, size: int) -> int | None:
        if self._value is None:
            return None
        if not 0 <= self.whole() < size:
            raise self.complain(f"is {self._value}, beyond the {size} rows it points into")
        return self.whole()


def read_table(path: Path) -> Table:
    """Raises InputError, one line with the place, for anything that is no whole table of this schema."""
    source = read_text(path, "table", MAX_BYTES)
    try:
        value = json.loads(source.text, parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        line = error.lineno if isinstance(error, json.JSONDecodeError) else None
        what = error.msg if isinstance(error, json.JSONDecodeError) else str(error)
        raise InputError(f"is no whole JSON document: {what}; {HOW_TO_MEND}", path, line) from error
    root = _Node(path, "the table", value)
    schema = root.at("schema").text()
    if schema != SCHEMA:
        raise InputError(f"has the schema '{schema}', this command reads '{SCHEMA}'; use a command and a library of one version", path)
    windows = root.at("windows").items()
    components = root.at("components").items()
    return Table(
        frame_ns=root.at("frame_ns").whole(),
        abort_policy=root.at("abort_policy").text(ABORT_POLICIES),
        windows=tuple(_read_window(node) for node in windows),
        components=tuple(_read_component(node, len(windows)) for node in components),
        connections=tuple(_read_connection(node, len(components)) for node in root.at("connections").items()),
        faults={node.at("number").count(): node.at("name").text() for node in root.at("faults").items()},
        reactions=tuple(Reaction(node.at("fault").count(), node.at("reaction").text(), node.at("within_ns").whole())
                        for node in root.at("reactions").items()),
        findings=tuple(node.text() for node in root.at("findings").items()),
    )  # fmt: skip


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")


def _read_window(node: _Node) -> Window:
    return Window(
        name=node.at("name").text(),
        core=node.at("core").count(),
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


def _read_component(node: _Node, window_count: int) -> Component:
    ports = (Port(port.at("name").text(), port.at("direction").text(DIRECTIONS), port.at("mandatory").truth())
             for port in node.at("ports").items())  # fmt: skip
    return Component(node.at("name").text(), node.at("window").index_or_none(window_count),
                     node.at("worst_case_ns").whole_or_none(), tuple(ports))  # fmt: skip


def _read_connection(node: _Node, component_count: int) -> Connection:
    source, sink = (End(end.at("component").index_or_none(component_count), end.at("port").text())
                    for end in (node.at("from"), node.at("to")))  # fmt: skip
    return Connection(source, sink, node.at("way").text(WAYS), node.at("fresh_within_ns").whole_or_none())
