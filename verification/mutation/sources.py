# SPDX-License-Identifier: Apache-2.0
"""What the kernel and its tests consist of, and how each file is compiled; CMake is asked, so nothing is said twice.

@satisfies SWR-VER-005      Design: docs/design/test_strength.md#mutants-that-count
"""

from __future__ import annotations

import json
import shlex
import subprocess
from dataclasses import dataclass
from pathlib import Path

COMPILER = "clang++-19"
LAYER = "kernel"


class MutationError(Exception):
    """The run cannot be made: what is wrong, where, and how to mend it."""


@dataclass(frozen=True)
class Unit:
    """One file that is compiled: `path` relative to the layer's folder, and flags that decide what it means."""

    path: str
    flags: tuple[str, ...]

    @property
    def is_test(self) -> bool:
        return self.path.startswith("tests/")

    @property
    def stem(self) -> str:
        return Path(self.path).stem


@dataclass(frozen=True)
class Sources:
    """A layer below `root`, its units, and the header that all its tests begin with."""

    root: Path
    units: tuple[Unit, ...]
    layer: str = LAYER
    prefix_header: str = "mamori/verification/verifies.hpp"

    @property
    def folder(self) -> Path:
        return self.root / self.layer

    def list_files(self) -> list[str]:
        """Files that are mutated, relative to the root: headers and sources, no tests."""
        paths = [*self.folder.glob("include/**/*.hpp"), *self.folder.glob("src/**/*.hpp"), *self.folder.glob("src/**/*.cpp")]
        return sorted(path.relative_to(self.root).as_posix() for path in paths)


def read_sources(root: Path, build: Path) -> Sources:
    """Configures the project in `build`, which compiles nothing. @raise MutationError."""
    argv = ("cmake", "-S", str(root), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DMAMORI_WITH_SIMBODY_SIM=OFF",
            "-DMAMORI_BUILD_EXAMPLES=OFF")  # fmt: skip
    done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise MutationError(f"cmake could not configure {root}:\n{done.stderr.strip()}")
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    folder = root / LAYER
    units = [
        Unit(Path(entry["file"]).relative_to(folder).as_posix(), keep_flags(shlex.split(entry["command"])))
        for entry in entries
        if Path(entry["file"]).is_relative_to(folder)
    ]
    if not any(unit.is_test for unit in units):
        raise MutationError(f"{folder} has no test that CMake knows; nothing could be killed")
    return Sources(root, tuple(sorted(units, key=lambda unit: unit.path)))


def keep_flags(command: list[str]) -> tuple[str, ...]:
    """Language, folders and definitions. Warnings, optimisation and names of files are the workbench's own affair: a mutant
    that only a warning would refuse must be found by a test."""
    flags: list[str] = []
    words = iter(command)
    for word in words:
        if word in ("-I", "-isystem", "-D", "-include"):
            flags += [word, next(words)]
        elif word.startswith(("-I", "-isystem", "-D", "-U", "-std=", "-f")):
            flags.append(word)
    return tuple(flags)
