# SPDX-License-Identifier: Apache-2.0
"""A system table in the form of the eight tables of RTMSafety, in C99.

Names and columns are those of the public code generator; docs/manual/rtmsafety.md names the source of each rule. Rows have one form: their
columns in order without inner braces, because the row types are not public.

@satisfies SWR-CIF-013, SWR-CIF-014      Design: docs/design/cost.md#rtmsafety
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from mamori_tools.table.document import Component, End, Table, Window
from mamori_tools.table.words import format_time
from mamori_trace.base.errors import InputError

PORTS_MAX = 16  # of a component
COMPONENTS_MAX = 16  # of a context
ADDRESSEES = 10  # of the alive notification
TEMPLATE_BYTES = 12  # length of each connection in the template
CONTEXTS = ("DATAPORT_CONCT_MNG", "RTC_LIFE_CYCLE_MNT", "RTC_LIFE_CYCLE_SND", "RECEIVE_EC")
"""Built-in contexts, in MinorTimeWindows 0 to 3. A system window with the name of a context in small letters is this context."""
FIRST_MINOR = 5  # of the contexts of components; the template omits 4
SYSTEM_SHARE, SHARE = 1, 5  # third column of the awaking table, whose meaning is not decidable: the constants of the template
KEY_NONE, KEY_ALIVE = "OBJECTKEY_EMPTY", "OBJECTKEY_RTC_LIFE_CYCLE_MNT"
DIFFERENCES = "differences.txt"


@dataclass(frozen=True)
class TableFile:
    """One of the eight tables: file, declaration and header of the row type."""

    name: str
    declaration: str
    header: str
    columns: str


FILES = (
    TableFile("RtcCreateTbl.c", "const RtcCreate_t gsRtcCreates[RTC_NUM]", "RtObject.h", "create function, index, reserve, 16 data ports (0: none)"),
    TableFile("DataPortCreateTbl.c", "const DataPortCreate_t gsDataPortCreates[DATAPORT_NUM]", "DataPort.h", "index"),
    TableFile("DataPortConctTbl.c", "const DataPortConctSetting_t gsDataPortConctSettingTbl[DATAPORT_CONNECT_NUM]", "DataPortConctMng.h",
              "in-port, out-port, length in bytes, reserve"),
    TableFile("RtcEcCreateTbl.c", "const RtcEcCreate_t gsRtcEcCreate[RTCEC_NUM]", "RtcEc.h", "index, reserve, task, 16 components (0: none)"),
    TableFile("EcAwakingTbl.c", "const EcAwakingSetting_t gsEcAwakingSettingTbl[EC_AWAKE_SET_NUM]", "EcAwaking.h",
              "multiple of MajorTimeWindow, MinorTimeWindow, share (not decidable), context"),
    TableFile("SafetyMntMngTbl.c", "const SafetyMntSetting_t gsSafetyMntSettingTbl[RTC_MNT_NUM]", "SafetyMntMng.h", "supervised component"),
    TableFile("SafetySndMngTbl.c", "const SafetySndSetting_t gsSafetySndSettingTbl", "SafetySndMng.h", "Bridge, 10 addressees"),
    TableFile("FaultDiagnosisMngTbl.c", "const FaultDiagnosisMng_t gsDiagnosisMng[RTC_SELF_DIAGNOS]", "SelfDiagnostic.h", "check function, error handler"),
)  # fmt: skip
COMMON_HEADERS = ("UserCommon.h", "UserConfig.h", "MyObjectKey.h", "SystemTbls.h")


@dataclass
class Names:
    """Identifiers of the tables, and what each stands for."""

    owners: dict[str, str | None] = field(default_factory=lambda: dict.fromkeys((*(f"EC_INDEX_{name}" for name in CONTEXTS), KEY_NONE, KEY_ALIVE)))
    """None: a reserved name."""

    def add(self, prefix: str, owner: str, *parts: str) -> str:
        """@return the identifier of a new object. @raise InputError if another object has it."""
        identifier = prefix + "_".join(_to_capitals(part) for part in parts)
        if identifier in self.owners:
            if (other := self.owners[identifier]) is None:
                raise InputError(f"table: {owner}: '{identifier}' is a reserved name; rename it")
            raise InputError(f"table: {owner} and {other} have the same name '{identifier}' in C; rename one")
        self.owners[identifier] = owner
        return identifier


@dataclass(frozen=True)
class PortNames:
    index: str
    key: str
    payload_bytes: int | None
    owner: str


def get_file_names() -> list[str]:
    return [*(file.name for file in FILES), DIFFERENCES]


def make_files(table: Table) -> dict[str, str]:
    """Name and text of each file. @raise InputError, which names what RTMSafety cannot express."""
    return _Export(table).make_files()


class _Export:
    def __init__(self, table: Table) -> None:
        self.table = table
        self.names = Names()
        self.system = _find_system_windows(table)
        self.components = [index for index, each in enumerate(table.components) if each.window not in self.system]
        _check(table, [table.components[index] for index in self.components])
        self.windows = [index for index, _ in enumerate(table.windows) if index not in self.system]
        self.windows.sort(key=lambda index: (table.windows[index].offset_ns, index))
        self.base_ns = math.gcd(*(window.period_ns for window in table.windows))
        self.functions, self.indexes, self.keys = dict[int, str](), dict[int, str](), dict[int, str]()
        self.ports: dict[tuple[int, str], PortNames] = {}
        for index in self.components:
            component = table.components[index]
            self.functions[index] = _name_function(component)
            self.indexes[index], self.keys[index] = (self.names.add(prefix, _spell(component), component.name) for prefix in ("RTC_INDEX_", "OBJECTKEY_"))
            for port in component.ports:
                owner = f"port '{port.name}' of {_spell(component)}"
                names = [self.names.add(prefix, owner, component.name, port.name) for prefix in ("DATAPORT_INDEX_", "OBJECTKEY_")]
                self.ports[index, port.name] = PortNames(names[0], names[1], port.payload_bytes, owner)
        self.contexts = {index: self.names.add("EC_INDEX_", f"window '{table.windows[index].name}'", table.windows[index].name) for index in self.windows}

    def make_files(self) -> dict[str, str]:
        rows = (self._make_components(), self._make_ports(), self._make_connections(), self._make_contexts(), self._make_awaking(),
                [[self.keys[index]] for index in self.components], [[KEY_NONE, KEY_ALIVE] + [KEY_NONE] * (ADDRESSEES - 1)], [["0", "0"]])  # fmt: skip
        files = {file.name: self._make_file(file, each) for file, each in zip(FILES, rows, strict=True)}
        sizes = [(match[1], len(each)) for file, each in zip(FILES, rows, strict=True) if (match := re.search(r"\[(\w+)\]", file.declaration))]
        return {**files, DIFFERENCES: "".join(f"{line}\n" for line in self._list_differences({**dict(sizes), "RTC_SND_NUM": ADDRESSEES}))}

    def _make_file(self, file: TableFile, rows: list[list[str]]) -> str:
        own = [f"{function.removesuffix('_create')}.h" for function in self.functions.values()] if file == FILES[0] else []
        includes = "".join(f'#include "{name}"\n' for name in (*COMMON_HEADERS, file.header, *own))
        body = "".join(f"    {{{', '.join(row)}}},\n" for row in rows) if "[" in file.declaration else f"    {', '.join(rows[0])}\n"
        return (f"/* {file.name}: written by `mamori table --as rtmsafety`. {DIFFERENCES} lists the differences from the template.\n"
                f" * Columns: {file.columns}. */\n{includes}\n{file.declaration} = {{\n{body}}};\n")  # fmt: skip

    def _make_components(self) -> list[list[str]]:
        rows = []
        for index in self.components:
            ports = [self.ports[index, port.name].index for port in self.table.components[index].ports]
            rows.append([self.functions[index], self.indexes[index], "0", *_fill(ports, PORTS_MAX)])
        return rows

    def _make_ports(self) -> list[list[str]]:
        return [[port.index] for port in self.ports.values()] or [["0"]]

    def _make_connections(self) -> list[list[str]]:
        rows = []
        for connection in self.table.connections:
            source, sink = self._find_port(connection.source), self._find_port(connection.sink)
            if source.payload_bytes is None:
                raise InputError(f"table: {source.owner}: the table has no length for values of 64 KiB or more; use a shorter type")
            rows.append([sink.key, source.key, str(source.payload_bytes), "0"])
        return rows or [[KEY_NONE, KEY_NONE, "0", "0"]]

    def _find_port(self, end: End) -> PortNames:
        if end.component is None or (port := self.ports.get((end.component, end.port))) is None:
            if end.component is not None and (component := self.table.components[end.component]).window in self.system:
                name = self.table.windows[component.window].name
                raise InputError(f"table: {_spell(component)} runs in the built-in context '{name}', which has no ports; use a window with another name")
            raise InputError(f"table: a connection has the port '{end.port}', which is a port of no component; write the table again")
        return port

    def _make_contexts(self) -> list[list[str]]:
        return [[self.contexts[window], "0", "0", *_fill([self.indexes[index] for index in self.table.components_of(window)], COMPONENTS_MAX)]
                for window in self.windows]  # fmt: skip

    def _make_awaking(self) -> list[list[str]]:
        rows = [["1", str(minor), str(SYSTEM_SHARE), f"EC_INDEX_{name}"] for minor, name in enumerate(CONTEXTS)]
        for minor, index in enumerate(self.windows, FIRST_MINOR):
            window = self.table.windows[index]
            if (end_ns := window.offset_ns + window.length_ns) > self.base_ns:
                raise InputError(f"table: window '{window.name}' ends {format_time(end_ns)} after the start of the frame, but RTMSafety has no"
                                 f" column for a window after the first MajorTimeWindow ({format_time(self.base_ns)}); move or shorten it")  # fmt: skip
            rows.append([str(window.period_ns // self.base_ns), str(minor), str(SHARE), self.contexts[index]])
        for index in self.system:
            if (window := self.table.windows[index]).period_ns != self.base_ns:
                raise InputError(f"table: system window '{window.name}' has the period {format_time(window.period_ns)}, but its context runs in each"
                                 f" MajorTimeWindow ({format_time(self.base_ns)}); give it this period")  # fmt: skip
        return rows

    def _list_differences(self, sizes: dict[str, int]) -> Iterator[str]:
        table = self.table
        yield "Differences from the rows of the public templates of RTMSafety"
        for row in self._make_connections() if table.connections else []:
            if int(row[2]) != TEMPLATE_BYTES:
                yield f"* DataPortConctTbl.c, {row[0]}: length {row[2]}; the template has always {TEMPLATE_BYTES}"
        if not table.connections or not self.ports:
            yield "* a table without rows has one empty row, because C99 has no empty array"
        yield "* RtcCreateTbl.c, DataPortCreateTbl.c: one index per port; the template has one per component"
        yield "* all tables: names of instances, rows in the order of the system table"
        for index in self.windows:
            names = [table.components[each].name for each in table.components_of(index)]
            if len(names) > 1:
                yield f"* RtcEcCreateTbl.c, {self.contexts[index]}: components {', '.join(names)}; the template has a context per component"
        for row in self._make_awaking():
            if row[0] != "1":
                yield f"* EcAwakingTbl.c, {row[3]}: multiple {row[0]}; the template has always 1"
        found = {CONTEXTS[_to_context(table.windows[index])] for index in self.system}
        for name in CONTEXTS:
            yield f"* EC_INDEX_{name}: {'system window ' + repr(name.lower()) if name in found else 'no system window; the row of the template'}"
        yield from self._list_omissions()
        yield ""
        yield "Constants that UserConfig.h and MyObjectKey.h define (0: none)"
        for name, size in sizes.items():
            yield f"{name} {size}"
        for prefix in ("RTC_INDEX_", "DATAPORT_INDEX_", "EC_INDEX_", "OBJECTKEY_"):
            own = [name for name in self.names.owners if name.startswith(prefix)]
            yield from (f"{name} {number}" for number, name in enumerate(own, 0 if prefix == "OBJECTKEY_" and own[0] == KEY_NONE else 1))

    def _list_omissions(self) -> Iterator[str]:
        """What the system table states and no column contains."""
        table = self.table
        yield f"* no column: MajorTimeWindow of {format_time(self.base_ns)}; offset, length and budget of each window; abort policy '{table.abort_policy}'"
        for window in table.windows:
            if window.partition:
                yield f"* no column: partition '{window.partition}' of window '{window.name}'"
            if window.slower_periods_ns:
                yield f"* no column: slower periods {', '.join(map(format_time, window.slower_periods_ns))} of window '{window.name}'"
        for index in self.components:
            if (worst_case_ns := table.components[index].worst_case_ns) is not None:
                yield f"* no column: worst case {format_time(worst_case_ns)} of {_spell(table.components[index])}"
            for port in table.components[index].ports:
                if port.mandatory:
                    yield f"* no column: {self.ports[index, port.name].key} is mandatory"
        for connection in table.connections:
            key = self._find_port(connection.sink).key
            if connection.way == "queue":
                yield f"* no column: {key} is a queue; whether RTMSafety keeps each value is not known"
            if connection.fresh_within_ns is not None:
                yield f"* no column: age limit {format_time(connection.fresh_within_ns)} of {key}"
        if table.faults or table.parameters:
            yield "* no column: faults with their reactions, parameters with their sets"
        yield "* reserve, task and diagnosis columns: 0; the values of the product are not public"


def _check(table: Table, components: list[Component]) -> None:
    """@raise InputError, which names the first part that RTMSafety cannot express."""
    if table.findings:
        raise InputError(f"table: violates a rule, first of {len(table.findings)}: {table.findings[0]}; correct the program")
    if not components:
        raise InputError("table: has no component outside the built-in contexts, and C99 has no empty array; add one to a window with another name")
    if table.modes:
        raise InputError("table: has modes, and RTMSafety has none; export a table for each mode")
    if len(table.cores()) > 1:
        cores = ", ".join(table.core_title(core) for core in table.cores())
        raise InputError(f"table: has windows on {cores}, and RTMSafety has no column for a core; export one core")
    for index, window in enumerate(table.windows):
        if window.kind not in ("periodic", "system"):
            raise InputError(f"table: window '{window.name}' is {window.kind}, and contexts of RTMSafety are periodic; use a periodic window")
        if (count := sum(component.window == index for component in components)) > COMPONENTS_MAX:
            raise InputError(f"table: window '{window.name}' has {count} components; a context of RTMSafety has at most {COMPONENTS_MAX}: use two windows")
    for component in components:
        if component.window is None:
            raise InputError(f"table: {_spell(component)} runs in no window; add it to a window")
        if (count := len(component.ports)) > PORTS_MAX:
            raise InputError(f"table: {_spell(component)} has {count} ports; a component of RTMSafety has at most {PORTS_MAX}: join values in a struct")


def _find_system_windows(table: Table) -> list[int]:
    """Indices of the system windows that are built-in contexts."""
    return [index for index, window in enumerate(table.windows) if window.kind == "system" and _to_context(window) < len(CONTEXTS)]


def _to_context(window: Window) -> int:
    return next((index for index, name in enumerate(CONTEXTS) if window.name == name.lower()), len(CONTEXTS))


def _name_function(component: Component) -> str:
    name = _to_capitals(component.name)
    if not "A" <= name[:1] <= "Z":
        raise InputError(f"table: {_spell(component)} does not begin with a letter of ASCII, as a function in C does; rename it")
    return f"{name}_create"


def _fill(values: list[str], size: int) -> list[str]:
    return values + ["0"] * (size - len(values))


def _spell(component: Component) -> str:
    return f"component '{component.name}'"


def _to_capitals(name: str) -> str:
    return re.sub(r"[^A-Z0-9]", "_", name.upper())
