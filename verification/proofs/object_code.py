# SPDX-License-Identifier: Apache-2.0
"""Reads the compiler output for one unit (frames and calls, virtual calls, classes) and its object file.

Formats: VCG call graph of -fcallgraph-info, GIMPLE of -fdump-tree-optimized-lineno, class layouts of -fdump-lang-class, and ELF. Content
that this module does not understand is detected later, because each indirect call of the call graph must be resolved.

@satisfies SWR-PRF-020, SWR-PRF-021      Design: docs/design/proofs.md#indirect-calls
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

from elftools.elf.descriptions import describe_reloc_type
from elftools.elf.elffile import ELFFile
from elftools.elf.relocation import RelocationSection
from elftools.elf.sections import SymbolTableSection

from verification.proofs.toolchain import Toolchain, Unit

INDIRECT = "__indirect_call"
NODE = re.compile(r'node: \{ title: "(?P<title>[^"]+)" label: "(?P<label>[^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "(?P<source>[^"]+)" targetname: "(?P<target>[^"]+)"(?: label: "(?P<place>[^"]*)")?')
FRAME = re.compile(r"(?P<bytes>\d+) bytes \((?P<kind>[a-z,]+)\)")
GIMPLE_FUNCTION = re.compile(r"^;; Function .*?\((?P<symbol>[^\s,()]+), funcdef_no=")
GIMPLE_VIRTUAL = re.compile(  # the first location on the line belongs to the statement
    r"^\s*\[(?P<place>[^\]]+:\d+:\d+)\] .*"
    r"OBJ_TYPE_REF\([^;]*;\((?:const )?(?:volatile )?(?:struct|class) (?P<type>[^)]+)\)[^>]*->(?P<slot>\d+)B\)"
)
CLASS_VTABLE = re.compile(r"vptr=\(\(& .*?(?P<vtable>_ZTV\w+)\) \+ (?P<offset>\d+)\)")
CLASS_PRIMARY = re.compile(r"primary-for .* \((?P<address>0x\w+)\)")
CLASS_LINE = re.compile(r"^(?P<name>\S.*) \((?P<address>0x\w+)\) ")
NOT_LOADED = (".debug", ".eh_frame", ".ARM.ex", ".note", ".comment")
THUNK = re.compile(r"_ZTh[n]?\d+_(?P<rest>\w+)|_ZTv[n]?\d+_[n]?\d+_(?P<virtual>\w+)")


@dataclass(frozen=True)
class Frame:
    """One function with the frame that the compiler reports."""

    symbol: str
    place: str  # file:line:column
    bytes: int
    kind: str  # static; dynamic,bounded; dynamic
    is_virtual: bool = False


@dataclass(frozen=True)
class VirtualCall:
    """A call through the virtual table of a class, named without namespace and template arguments."""

    type: str
    slot: int


@dataclass
class Defined:
    """Where an object file defines a function."""

    section: str
    offset: int
    size: int
    is_local: bool


@dataclass
class UnitFacts:
    """Everything known about one unit. Symbols are mangled."""

    source: str
    frames: dict[str, Frame] = field(default_factory=dict)
    calls: set[tuple[str, str]] = field(default_factory=set)
    indirect: dict[tuple[str, str], int] = field(default_factory=lambda: defaultdict(int))  # (caller, place) -> calls
    virtual: dict[tuple[str, str], list[VirtualCall]] = field(default_factory=lambda: defaultdict(list))
    bases: dict[str, set[tuple[str, int]]] = field(default_factory=lambda: defaultdict(set))  # vtable -> (type, offset)
    defined: dict[str, Defined] = field(default_factory=dict)
    taken: set[tuple[str, str]] = field(default_factory=set)  # (where, function whose address is taken)
    vtables: dict[str, dict[int, str]] = field(default_factory=dict)  # vtable -> offset -> function


def read_unit(toolchain: Toolchain, unit: Unit) -> UnitFacts:
    """All facts of one unit."""
    facts = UnitFacts(unit.source)
    _read_object(toolchain, unit.object, facts)
    # A unit without functions or classes has no such file. A call that is unresolved because the file is missing becomes a finding.
    for path, read in ((unit.call_graph, _read_call_graph), (unit.virtual_calls, _read_virtual_calls),
                       (unit.classes, _read_classes)):  # fmt: skip
        if path.exists():
            read(path.read_text(encoding="utf-8"), facts)
    return facts


def get_type_name(qualified: str) -> str:
    """The name of a type without namespaces and template arguments: the common part of all compiler dumps."""
    previous, name = "", qualified
    while name != previous:
        previous, name = name, re.sub(r"<[^<>]*>", "", name)
    return name.rpartition("::")[2].strip()


def _get_symbol(title: str) -> str:
    """The title is the symbol; for a local function, the file name precedes it."""
    return title.rpartition(":")[2]


def _read_call_graph(text: str, facts: UnitFacts) -> None:
    for match in NODE.finditer(text):
        frame = FRAME.search(match["label"])
        if frame:
            symbol = _get_symbol(match["title"])
            lines = match["label"].split("\\n")
            facts.frames[symbol] = Frame(symbol, lines[1], int(frame["bytes"]), frame["kind"],
                                         lines[0].startswith("virtual "))  # fmt: skip
    for match in EDGE.finditer(text):
        caller, target = _get_symbol(match["source"]), _get_symbol(match["target"])
        if target == INDIRECT:
            facts.indirect[caller, match["place"] or "unknown place"] += 1
        else:
            facts.calls.add((caller, target))
    _add_thunks(facts)


def _add_thunks(facts: UnitFacts) -> None:
    """A thunk corrects the address of the object and jumps: it has no frame, and its jump needs no relocation."""
    for symbol in {*facts.frames, *facts.defined}:
        if thunk := THUNK.fullmatch(symbol):
            target = f"_Z{thunk['rest'] or thunk['virtual']}"
            place = facts.frames[target].place if target in facts.frames else facts.source
            facts.frames.setdefault(symbol, Frame(symbol, place, 0, "static"))
            facts.calls.add((symbol, target))


def _read_virtual_calls(text: str, facts: UnitFacts) -> None:
    function = ""
    for line in text.splitlines():
        begin = GIMPLE_FUNCTION.match(line)
        if begin:
            function = begin["symbol"]
        if match := GIMPLE_VIRTUAL.match(line):
            call = VirtualCall(get_type_name(match["type"]), int(match["slot"]))
            facts.virtual[function, match["place"]].append(call)


def _read_classes(text: str, facts: UnitFacts) -> None:
    """For each table: the base classes, and the offset at which the functions of each begin."""
    offsets: dict[str, tuple[str, int]] = {}  # address of a class in the dump -> its position in the table
    name = address = ""
    for line in text.splitlines():
        head = CLASS_LINE.match(line)
        if line.startswith("Class "):
            offsets = {}
        elif head:
            name, address = head["name"], head["address"]
        elif match := CLASS_VTABLE.search(line):
            offsets[address] = (match["vtable"], int(match["offset"]))
        elif (match := CLASS_PRIMARY.search(line)) and match["address"] in offsets:
            offsets[address] = offsets[match["address"]]
        if address in offsets and name:
            vtable, offset = offsets[address]
            facts.bases[vtable].add((get_type_name(name), offset))
            name = ""


def _read_object(toolchain: Toolchain, path: Path, facts: UnitFacts) -> None:
    relocations: list[tuple[str, int, str, str, int]] = []
    tables: dict[str, list[tuple[str, int]]] = defaultdict(list)  # section -> virtual tables in it
    with path.open("rb") as file:
        elf = ELFFile(file)
        sections = [section.name for section in elf.iter_sections()]
        symbols = [one for table in elf.iter_sections() if isinstance(table, SymbolTableSection) for one in table.iter_symbols()]
        for one in symbols:
            number, value, kind = one["st_shndx"], one["st_value"], one["st_info"]["type"]
            if not isinstance(number, int):  # undefined or absolute
                continue
            if kind == "STT_FUNC":
                facts.defined[one.name] = Defined(sections[number], value & ~1 if toolchain.word_bytes == 4 else value,
                                                  one["st_size"], one["st_info"]["bind"] == "STB_LOCAL")  # fmt: skip
            elif kind == "STT_OBJECT" and one.name.startswith("_ZTV"):
                tables[sections[number]].append((one.name, value))
                facts.vtables[one.name] = {}
        for rows in elf.iter_sections():
            for row in rows.iter_relocations() if isinstance(rows, RelocationSection) else ():
                aim = symbols[row["r_info_sym"]]
                name = aim.name or sections[aim["st_shndx"]]  # a section symbol has no name of its own
                addend = row["r_addend"] if row.is_RELA() else 0
                relocations.append((sections[rows["sh_info"]], row["r_offset"], describe_reloc_type(row["r_info_type"], elf), name, addend))
    by_section: dict[str, list[tuple[int, int, str]]] = defaultdict(list)
    for symbol, where in facts.defined.items():
        by_section[where.section].append((where.offset, where.size, symbol))
    for section, offset, kind, target, addend in relocations:
        if section.startswith(NOT_LOADED):
            continue
        is_branch = kind in toolchain.branch_relocations
        if target in by_section:  # a local function, identified by its section
            start = addend - (toolchain.branch_addend if is_branch else 0)
            target = next((name for begin, _, name in by_section[target] if begin == start), "")
        callers = [name for begin, size, name in by_section.get(section, ()) if begin <= offset < begin + max(size, 1)]
        if section in tables:
            table, begin = max((entry for entry in tables[section] if entry[1] <= offset), key=lambda entry: entry[1])
            facts.vtables[table][offset - begin] = target
        elif is_branch and callers:
            facts.calls.update((caller, target) for caller in callers if target)
        elif target:
            facts.taken.add((callers[0] if callers else section, target))
