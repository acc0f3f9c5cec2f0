# SPDX-License-Identifier: Apache-2.0
"""Stack of linked functions that the project compiler did not compile (libgcc, C library), from their disassembly.

Upper bound: the sum of all stack-pointer decrements of a function, plus that of the deepest function to which it branches.

@satisfies SWR-PRF-023      Design: docs/design/proofs.md#outside-functions
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from mamori_trace.base.errors import WorkError
from verification.proofs.depth import find_groups
from verification.proofs.toolchain import CORTEX_M4, run_tool

HEADER = re.compile(r"^(?P<address>[0-9a-f]+) <(?P<name>[^>]+)>:$")
INSTRUCTION = re.compile(r"^\s*[0-9a-f]+:\s+(?P<name>[a-z][\w.]*)\s*(?P<operands>[^;@]*)")
PUSH = re.compile(r"\{(?P<registers>[^}]+)\}")
SUBTRACT = re.compile(r"(?:sp, )?sp, #(?P<bytes>\d+)")
STORE = re.compile(r"\[sp, #-(?P<bytes>\d+)\]!")
BRANCH = re.compile(r"(?:[0-9a-f]+) <(?P<name>[^>+]+)(?:\+0x[0-9a-f]+)?>")
ENDS = ("b", "bx", "udf")
FILL = ("nop", "movs r0, r0")
"""Instructions that fill the gap after a function (the second: two zero bytes); they never use stack."""


@dataclass
class Region:
    """Code from one symbol to the next."""

    bytes: int = 0
    targets: set[str] = field(default_factory=set)
    ends: bool = False  # its last instruction does not continue at the next symbol


def calc_library_bounds(image: Path, functions: list[str]) -> dict[str, int]:
    """Upper bound of each function [bytes]. @raise WorkError if a function is not in the image or uses an unknown amount of stack."""
    prefix = CORTEX_M4.prefix
    addresses: dict[str, int] = {}
    for line in run_tool([f"{prefix}nm", "--format=posix", str(image)]).splitlines():
        name, _, value = line.split(" ")[:3]
        addresses[name] = int(value, 16) & ~1
    regions, places = _read_regions(run_tool([f"{prefix}objdump", "-d", "--no-show-raw-insn", str(image)]))
    bounds = _calc_bounds(regions)
    missing = [name for name in functions if addresses.get(name, -1) not in places]
    if missing:
        raise WorkError(f"{image} has no code of: {', '.join(missing)}")
    return {name: bounds[places[addresses[name]]] for name in functions}


def _read_regions(text: str) -> tuple[dict[str, Region], dict[int, str]]:
    regions: dict[str, Region] = {}
    places: dict[int, str] = {}
    current, name = Region(ends=True), ""
    for line in text.splitlines():
        if match := HEADER.match(line):
            if not current.ends:
                current.targets.add(match["name"])
            name = match["name"]
            current = regions.setdefault(name, Region())
            places[int(match["address"], 16)] = name
        elif match := INSTRUCTION.match(line):
            _read_instruction(current, name, match["name"], match["operands"].strip())
    return regions, places


def _read_instruction(region: Region, symbol: str, name: str, operands: str) -> None:
    stem = name.partition(".")[0]
    if f"{stem} {operands}".strip() in FILL:
        return
    loads_pc = (stem == "pop" or stem.startswith("ldm")) and "pc}" in operands
    region.ends = stem in ENDS or loads_pc or (stem == "ldr" and operands.startswith("pc,"))
    if stem in ("push", "vpush") or (stem == "stmdb" and operands.startswith("sp!")):
        region.bytes += _count_bytes(operands)
    elif (stem in ("sub", "subw") and (match := SUBTRACT.match(operands))) or (match := STORE.search(operands)):
        region.bytes += int(match["bytes"])
    elif operands.startswith("sp,") and not stem.startswith(("st", "ld", "add", "cmp")):
        raise WorkError(f"{symbol}: '{name} {operands}' changes the stack pointer by an amount that is not in the code")
    if (match := BRANCH.search(operands)) and match["name"] != symbol:
        region.targets.add(match["name"])


def _count_bytes(operands: str) -> int:
    total = 0
    registers = PUSH.search(operands)
    for word in (registers["registers"] if registers else "").split(","):
        first, _, last = word.strip().partition("-")
        count = int(last[1:]) - int(first[1:]) + 1 if last else 1
        total += count * (8 if first.startswith("d") else 4)
    return total


def _calc_bounds(regions: dict[str, Region]) -> dict[str, int]:
    """Regions that branch into each other use at most the sum of their stacks."""
    bounds: dict[str, int] = {}
    calls = {name: {target for target in region.targets if target in regions} for name, region in regions.items()}
    for group in find_groups(calls):
        below = [bounds[target] for name in group for target in calls[name] if target not in group]
        total = sum(regions[name].bytes for name in group) + max(below, default=0)
        bounds.update(dict.fromkeys(group, total))
    return bounds
