# SPDX-License-Identifier: Apache-2.0
"""Files of the layers and their tests, and the compiler options that CMake reports for each file.

@satisfies SWR-VER-005      Design: docs/design/test_strength.md#counted-mutants
"""

from __future__ import annotations

import json
import shlex
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError

COMPILER = "clang++-19"


@dataclass(frozen=True)
class Layer:
    """A layer whose own tests must find its faults: the required share of faults, the layers and libraries that it or its tests use, the
    target that generates the headers of its tests, and a program that compiles sources again with options of its own, whose tests are
    left out."""

    name: str
    bar: float
    below: tuple[str, ...] = ()
    libraries: tuple[str, ...] = ()
    generated: str = ""
    special: str = ""

    @property
    def is_port(self) -> bool:
        return self.name.startswith("ports/")


TARGET_LAYERS = ("kernel", "safety")
LAYERS = (
    Layer("kernel", 0.90),
    Layer("safety", 0.95, ("kernel",)),
    Layer("ports/conformance", 0.90, TARGET_LAYERS),
    Layer("ports/lcm", 0.90, TARGET_LAYERS, ("-llcm",), "lcm_official_test"),
    Layer("ports/posix_rt", 0.90, (*TARGET_LAYERS, "ports/conformance")),
    Layer("ports/virtual_time", 0.90, (*TARGET_LAYERS, "ports/conformance"), special="call_chain_test"),
)


def get_layer(file: str) -> Layer:
    """@param file relative to the root, of one of LAYERS."""
    return next(layer for layer in LAYERS if file.startswith(f"{layer.name}/"))


def list_files(root: Path, layers: Sequence[Layer] = LAYERS) -> list[str]:
    """Files to mutate, relative to the root: headers and sources of `layers`, without tests."""
    folders = [root / layer.name for layer in layers]
    patterns = ("include/**/*.hpp", "src/**/*.hpp", "src/**/*.cpp")
    return sorted(path.relative_to(root).as_posix() for folder in folders for pattern in patterns for path in folder.glob(pattern))


@dataclass(frozen=True)
class Unit:
    """One compiled file: `path` relative to the folder of its layer, and flags that affect its meaning."""

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
    """A layer below `root`, its units, the sources (relative to `root`) of the layers that it uses, its libraries, and the header that all
    its tests include first."""

    root: Path
    units: tuple[Unit, ...]
    layer: str = LAYERS[0].name
    below: tuple[Unit, ...] = ()
    libraries: tuple[str, ...] = ()
    is_enclosed: bool = False  # the tests have processes of their own, and a mutant must not reach any others
    prefix_header: str = "mamori/trace/verifies.hpp"

    @property
    def folder(self) -> Path:
        return self.root / self.layer


def read_sources(root: Path, build: Path, layer: Layer, jobs: int = 1) -> Sources:
    """Configures the project in `build`, and generates the headers of the tests. @raise WorkError."""
    argv = ("cmake", "-S", str(root), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DMAMORI_WITH_SIMBODY_SIM=OFF",
            "-DMAMORI_BUILD_EXAMPLES=OFF")  # fmt: skip
    _run_cmake(argv)
    if layer.generated:
        _run_cmake(("cmake", "--build", str(build), "--target", layer.generated, "--parallel", str(jobs)))
    entries = drop_program(json.loads((build / "compile_commands.json").read_text(encoding="utf-8")), layer.special)
    units = _select_units(entries, root / layer.name, root / layer.name)
    if not any(unit.is_test for unit in units):
        raise WorkError(f"{root / layer.name} has no test that CMake knows; nothing could be killed")
    below = [unit for name in layer.below for unit in _select_units(entries, root / name / "src", root)]
    return Sources(root, tuple(units), layer.name, tuple(below), layer.libraries, layer.is_port)


def _run_cmake(argv: Sequence[str]) -> None:
    done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise WorkError(f"'{' '.join(argv)}' failed:\n{(done.stdout + done.stderr).strip()[-2000:]}")


def drop_program(entries: Sequence[dict[str, str]], program: str) -> list[dict[str, str]]:
    """The entries without those of `program`."""
    return [entry for entry in entries if f"/{program}.dir/" not in entry["command"]]


def _select_units(entries: Sequence[dict[str, str]], folder: Path, base: Path) -> list[Unit]:
    """Units below `folder`, with paths relative to `base`. Each unit occurs once, even if several programs compile it: as
    the library does, whose entries come first."""
    units = {
        path: Unit(path.relative_to(base).as_posix(), keep_flags(shlex.split(entry["command"])))
        for entry in reversed(entries)
        if (path := Path(entry["file"])).is_relative_to(folder)
    }
    return [units[path] for path in sorted(units)]


def keep_flags(command: list[str]) -> tuple[str, ...]:
    """Language, folders and definitions. The workbench itself sets warnings, optimisation and file names: a test must find a mutant that
    only a compiler warning would reject."""
    flags: list[str] = []
    words = iter(command)
    for word in words:
        if word in ("-I", "-isystem", "-D", "-include"):
            flags += [word, next(words)]
        elif word.startswith(("-I", "-isystem", "-D", "-U", "-std=", "-f")):
            flags.append(word)
    return tuple(flags)
