# SPDX-License-Identifier: Apache-2.0
"""Joins units into one call graph with resolved indirect calls. The classes and tables of the object files resolve virtual calls. The rows
of `stack.toml`, which are checked against the code, resolve calls through pointers.

@satisfies SWR-PRF-021      Design: docs/design/proofs.md#indirect-calls
"""

from __future__ import annotations

import re
import tomllib
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from verification.proofs.object_code import UnitFacts, VirtualCall
from verification.proofs.toolchain import Toolchain, run_tool

RULES = Path(__file__).with_name("stack.toml")
PURE = "__cxa_pure_virtual"  # never called: a call of a pure function is a contract violation and traps


@dataclass(frozen=True)
class PointerRow:
    """A call through a pointer: its location, and the parameters of its targets."""

    file: str
    call: str  # text of the line
    parameters: str  # regular expression
    reason: str


@dataclass(frozen=True)
class OutsideRow:
    """A function whose frame size the compiler does not report: assembler or library code."""

    toolchain: str
    function: str
    bytes: int
    reason: str


@dataclass(frozen=True)
class Rules:
    """The checked list: facts that the compiler does not provide."""

    pointers: tuple[PointerRow, ...] = ()
    outside: tuple[OutsideRow, ...] = ()


@dataclass
class Function:
    """A node. Copies of an inline function in several units are one node, with the largest frame."""

    name: str  # as written in C++
    place: str
    bytes: int


@dataclass(frozen=True)
class Finding:
    """A reason why the stack is unbounded."""

    rule: str
    place: str  # file:line:column, or a row of the checked list
    message: str  # names the function and the correction

    def __str__(self) -> str:
        return f"{self.place}: {self.rule}: {self.message}"


@dataclass(frozen=True)
class Resolved:
    """An indirect call and its possible targets."""

    caller: str
    place: str
    how: str
    targets: tuple[str, ...]


@dataclass
class CallGraph:
    """Functions by key: the symbol, preceded by the source for a local function."""

    functions: dict[str, Function] = field(default_factory=dict)
    calls: dict[str, set[str]] = field(default_factory=lambda: defaultdict(set))
    outside: dict[str, OutsideRow] = field(default_factory=dict)
    resolved: list[Resolved] = field(default_factory=list)
    tables: dict[str, dict[int, str]] = field(default_factory=dict)  # virtual table -> offset -> function
    bases: dict[str, set[tuple[str, int]]] = field(default_factory=dict)
    vectors: set[str] = field(default_factory=set)  # C functions whose address is taken: the processor may call them
    findings: list[Finding] = field(default_factory=list)


def read_rules(path: Path = RULES) -> Rules:
    """The rows of a checked list."""
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    return Rules(tuple(PointerRow(**row) for row in table.get("pointer", ())),
                 tuple(OutsideRow(**row) for row in table.get("outside", ())))  # fmt: skip


def make_call_graph(toolchain: Toolchain, root: Path, units: Sequence[UnitFacts], rules: Rules) -> CallGraph:
    """The graph of all `units`, including a finding for each uncertainty."""
    return _Joiner(toolchain, root, units, rules).join()


def split_signature(demangled: str) -> tuple[str, str | None]:
    """Name and parameters of a function in the notation of c++filt; no parameters for a C function."""
    text = re.sub(r" \[clone [^\]]*\]", "", demangled)
    text = re.sub(r"\)(?: (?:const|noexcept|&|&&))+$", ")", text)
    if not text.endswith(")"):
        return text, None
    depth = 0
    for index in range(len(text) - 1, -1, -1):
        depth += {")": 1, "(": -1}.get(text[index], 0)
        if depth == 0:
            return text[:index], text[index + 1 : -1]
    return text, None


class _Joiner:
    """The work of make_call_graph, step by step."""

    def __init__(self, toolchain: Toolchain, root: Path, units: Sequence[UnitFacts], rules: Rules) -> None:
        self._toolchain = toolchain
        self._root = root
        self._units = units
        self._rules = rules
        self._graph = CallGraph()
        self._taken: dict[str, str] = {}  # function -> location where its address is taken
        self._known: set[str] = set()  # functions that a unit defines
        self._used_rows: set[PointerRow] = set()
        self._names: dict[str, str] = {}

    def join(self) -> CallGraph:
        self._demangle()
        for unit in self._units:
            self._known.update(self._get_key(unit, symbol) for symbol in unit.defined)
            self._add_functions(unit)
        for unit in self._units:
            self._add_calls(unit)
        for unit in self._units:
            self._resolve(unit)
        self._check_rows()
        self._check_taken()
        self._check_outside()
        return self._graph

    def _get_key(self, unit: UnitFacts, symbol: str) -> str:
        """Maps an alias or a cold part to the function for which the compiler reports a frame."""
        where = unit.defined.get(symbol)
        if where is None:
            return symbol
        base = symbol.removesuffix(".cold")
        if base not in unit.frames:
            twins = [name for name, other in unit.defined.items()
                     if (other.section, other.offset) == (where.section, where.offset) and name in unit.frames]  # fmt: skip
            base = min(twins, default=base)
        return f"{unit.source}:{base}" if unit.defined.get(base, where).is_local else base

    def _get_name(self, key: str) -> str:
        symbol = key.rpartition(":")[2]
        return self._names.get(symbol, symbol)

    def _demangle(self) -> None:
        symbols = sorted({symbol for unit in self._units for symbol in (*unit.defined, *unit.frames)})
        lines = run_tool(["c++filt", *symbols]).splitlines() if symbols else []
        self._names = dict(zip(symbols, lines, strict=True))

    def _add_functions(self, unit: UnitFacts) -> None:
        for symbol, frame in unit.frames.items():
            key = self._get_key(unit, symbol)
            function = Function(self._names[symbol], frame.place, frame.bytes)
            former = self._graph.functions.get(key)
            if former is None or former.bytes < function.bytes:
                self._graph.functions[key] = function
            if frame.kind == "dynamic":
                self._fail("frame", frame.place, f"{function.name}: its frame grows at run time (alloca or an array of variable "
                           "length); give the array a constant size")  # fmt: skip
        for table, entries in unit.vtables.items():
            self._graph.tables[table] = {offset: self._get_key(unit, symbol) for offset, symbol in entries.items()}
        for table, bases in unit.bases.items():
            self._graph.bases.setdefault(table, set()).update(bases)

    def _add_calls(self, unit: UnitFacts) -> None:
        for caller, target in unit.calls:
            source, sink = self._get_key(unit, caller), self._get_key(unit, target)
            if source != sink or caller == target:  # a function and its cold part are one
                self._graph.calls[source].add(sink)
        for where, target in unit.taken:
            key = self._get_key(unit, target)
            if key in self._known:
                self._taken.setdefault(key, f"{unit.source}: {self._names.get(where, where)}")

    def _resolve(self, unit: UnitFacts) -> None:
        for (caller, place), count in sorted(unit.indirect.items()):
            virtual = unit.virtual.get((caller, place), [])
            for call in sorted(set(virtual), key=str):
                self._resolve_virtual(self._get_key(unit, caller), place, call)
            if len(virtual) > count:
                self._fail("indirect call", place, f"{self._names[caller]}: the call graph has {count} indirect calls here, the "
                           f"compiler's dump {len(virtual)}; this compiler's output is not understood")  # fmt: skip
            elif len(virtual) < count:
                self._resolve_pointer(self._get_key(unit, caller), place, count - len(virtual))

    def _resolve_virtual(self, caller: str, place: str, call: VirtualCall) -> None:
        targets: set[str] = set()
        for table, bases in self._graph.bases.items():
            for name, offset in bases:
                if name == call.type and table in self._graph.tables:
                    entry = self._graph.tables[table].get(offset + call.slot * self._toolchain.word_bytes)
                    if entry is not None and entry != PURE:
                        targets.add(entry)
        if not targets:
            self._fail("indirect call", place, f"{self._get_name(caller)}: calls virtual function {call.slot} of {call.type}, "
                       "which no class of the image overrides; add the source of one that does")  # fmt: skip
        self._add_resolved(caller, place, f"virtual {call.slot} of {call.type}", targets)

    def _resolve_pointer(self, caller: str, place: str, count: int) -> None:
        file, line = [*place.split(":"), "0"][:2]
        path = self._root / file
        lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
        code = lines[int(line) - 1].strip() if 0 < int(line) <= len(lines) else ""
        rows = [row for row in self._rules.pointers if row.file == file and row.call in code]
        # Several calls at one location are compiler-made copies of one call, for example in an unrolled loop.
        if len(rows) != 1 or (count > 1 and code.count(rows[0].call) != 1):
            why = "no row tells" if not rows else "no one row for one call tells"
            self._fail("indirect call", place, f"{self._get_name(caller)}: '{code}' calls through a pointer, and {why} what it "
                       f"may call; give it a row [[pointer]] in {RULES.name}")  # fmt: skip
            return
        self._used_rows.add(rows[0])
        targets = {key for key in self._taken if self._does_fit(key, rows[0])}
        if not targets:
            self._fail("indirect call", place, f"{self._get_name(caller)}: the image takes the address of no function with the "
                       f"parameters '{rows[0].parameters}', as its row in {RULES.name} says")  # fmt: skip
        self._add_resolved(caller, place, f"pointer to ({rows[0].parameters})", targets)

    def _does_fit(self, key: str, row: PointerRow) -> bool:
        _, parameters = split_signature(self._get_name(key))
        return parameters is not None and re.fullmatch(row.parameters, parameters) is not None

    def _add_resolved(self, caller: str, place: str, how: str, targets: set[str]) -> None:
        self._graph.calls[caller].update(targets)
        self._graph.resolved.append(Resolved(caller, place, how, tuple(sorted(targets))))

    def _check_rows(self) -> None:
        for row in self._rules.pointers:
            if row not in self._used_rows:
                self._fail("unused row", RULES.name, f"{row.file}: no indirect call is in a line with '{row.call}'; remove it")

    def _check_taken(self) -> None:
        """Every function whose address is taken needs a caller: the tables, a row, or, for a C function, the processor."""
        called = {target for resolved in self._graph.resolved for target in resolved.targets}
        # The address of a virtual function occurs in tables, and in code that the compiler generates to guess the call target.
        called.update(self._get_key(unit, frame.symbol)
                      for unit in self._units for frame in unit.frames.values() if frame.is_virtual)  # fmt: skip
        called.update(entry for entries in self._graph.tables.values() for entry in entries.values())
        for key, where in sorted(self._taken.items()):
            if split_signature(self._get_name(key))[1] is None:
                self._graph.vectors.add(key)
            elif key not in called:
                self._fail("indirect call", where, f"takes the address of {self._get_name(key)}, which no row of {RULES.name} "
                           "calls; the row for the call through this pointer is missing or wrong")  # fmt: skip

    def _check_outside(self) -> None:
        rows = {row.function: row for row in self._rules.outside if row.toolchain == self._toolchain.name}
        wanted = {target for targets in self._graph.calls.values() for target in targets} | self._known
        unknown = sorted(wanted - self._graph.functions.keys())
        for key in unknown:
            name = key.rpartition(":")[2]
            if name in rows:
                self._graph.outside[key] = rows[name]
                continue
            callers = sorted(caller for caller, targets in self._graph.calls.items() if key in targets)
            function = next((self._graph.functions[caller] for caller in callers if caller in self._graph.functions), None)
            who = f"{function.name} calls {name}" if function else name
            self._fail("outside", function.place if function else key, f"{who}: the compiler knows no frame of it; give it a "
                       f"row [[outside]] for {self._toolchain.name} in {RULES.name}")  # fmt: skip
        for name in sorted(rows.keys() - {key.rpartition(":")[2] for key in unknown}):
            self._fail("unused row", RULES.name, f"{self._toolchain.name}: nothing calls {name}; remove it")
        for key, row in self._graph.outside.items():
            self._graph.functions[key] = Function(row.function, row.reason, row.bytes)

    def _fail(self, rule: str, place: str, message: str) -> None:
        self._graph.findings.append(Finding(rule, place, message))
