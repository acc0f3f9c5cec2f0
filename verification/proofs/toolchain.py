# SPDX-License-Identifier: Apache-2.0
"""The compilers whose code is proven, and the compiler output that the proofs read.

@satisfies SWR-PRF-020      Design: docs/design/proofs.md#stack
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from mamori_trace.base.errors import WorkError

# The language subset of the target layers. One section per function, so that every call to another function needs a relocation.
SUBSET = ("-std=c++17", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-ffp-contract=off", "-UNDEBUG",
          "-ffunction-sections", "-fdata-sections")  # fmt: skip


@dataclass(frozen=True)
class Toolchain:
    """A compiler and its options, in the notation of g++ and its binutils."""

    name: str
    prefix: str
    flags: tuple[str, ...]
    word_bytes: int
    branch_relocations: frozenset[str]
    branch_addend: int = 0  # addend in the relocation of a branch to the begin of a function
    red_zone_bytes: int = 0  # below the stack pointer; a leaf function may use it without a frame

    @property
    def compiler(self) -> str:
        return f"{self.prefix}g++"


CORTEX_M4 = Toolchain(
    name="cortex-m4",
    prefix="arm-none-eabi-",
    flags=("-mcpu=cortex-m4", "-mthumb", "-Os"),
    word_bytes=4,
    branch_relocations=frozenset({"R_ARM_THM_CALL", "R_ARM_THM_JUMP24", "R_ARM_THM_JUMP19", "R_ARM_CALL", "R_ARM_JUMP24"}),
)
# No position-independent code, so that taking the address of a function is never confused with a call.
HOST = Toolchain(
    name="x86-64",
    prefix="",
    flags=("-O2", "-fno-pie"),
    word_bytes=8,
    branch_relocations=frozenset({"R_X86_64_PLT32"}),
    branch_addend=-4,
    red_zone_bytes=128,
)
# Without inlining and tail-call jumps, a recursion in the source is also a recursion in the code.
HOST_AS_WRITTEN = replace(HOST, name="x86-64 as written", flags=("-O0", "-fno-pie"))


@dataclass(frozen=True)
class Unit:
    """One compiled source and the compiler output for it."""

    source: str  # as passed to the compiler, relative to the root
    object: Path
    call_graph: Path
    virtual_calls: Path
    classes: Path


def compile_units(
    toolchain: Toolchain, root: Path, sources: Sequence[str], includes: Sequence[str], folder: Path
) -> list[Unit]:
    """Compiles `sources`, relative to `root` so that locations are equal on all hosts. @raise WorkError"""
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda source: _compile(toolchain, root, source, includes, folder), sources))


def run_tool(argv: Sequence[str], cwd: Path | None = None) -> str:
    """@return the output of the program. @raise WorkError if it failed."""
    try:
        done = subprocess.run(argv, cwd=cwd, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    except FileNotFoundError as error:
        raise WorkError(f"{argv[0]} is missing; ./mamori test installs it") from error
    if done.returncode != 0:
        raise WorkError(f"{' '.join(argv)} ended with status {done.returncode}:\n{done.stderr[-4000:]}")
    return done.stdout


def _compile(toolchain: Toolchain, root: Path, source: str, includes: Sequence[str], folder: Path) -> Unit:
    stem = folder / source.replace("/", "_").removesuffix(".cpp")
    unit = Unit(source, *(stem.with_name(stem.name + suffix) for suffix in (".o", ".ci", ".calls", ".classes")))
    run_tool(
        [toolchain.compiler, *SUBSET, *toolchain.flags, *(f"-I{path}" for path in includes),
         "-fstack-usage", "-fcallgraph-info=su,da", f"-fdump-tree-optimized-lineno-asmname={unit.virtual_calls}",
         f"-fdump-lang-class={unit.classes}", "-c", source, "-o", str(unit.object)],
        cwd=root,
    )  # fmt: skip
    return unit
