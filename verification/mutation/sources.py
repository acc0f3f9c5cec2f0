# SPDX-License-Identifier: Apache-2.0
"""Files of the layers and their tests, and the compiler options that CMake reports for each file.

@satisfies SWR-VER-005      Design: docs/design/test_strength.md#counted-mutants
"""

from __future__ import annotations

import json
import re
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mamori_trace.base.errors import WorkError

COMPILER = "clang++-19"


@dataclass(frozen=True)
class Layer:
    """A layer whose own tests must find its faults: the required share of faults, the layers and libraries that it or its tests use, the
    target that generates the headers of its tests, and programs that are left out, because they compile sources again with options of their
    own, or need more than the layer. An example also has the files to mutate, its program, which runs the fault plan `faults.yaml`, and the
    share of faults that this campaign must find."""

    name: str
    bar: float
    below: tuple[str, ...] = ()
    libraries: tuple[str, ...] = ()
    generated: str = ""
    special: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    program: str = ""
    campaign_bar: float = 0.0

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
    Layer("ports/virtual_time", 0.90, (*TARGET_LAYERS, "ports/conformance"), special=("call_chain_test",)),
)

# Only on request: a change of the example makes no stored result invalid.
EXAMPLE = Layer(
    "examples/safe_arm", 0.98, (*TARGET_LAYERS, "ports/posix_rt", "ports/virtual_time", "simbody_sim", "tools/probe/table_dump", "tools/probe/timing"),
    ("-lSimTKsimbody", "-lSimTKmath", "-lSimTKcommon", "-lyaml-cpp", "-lorocos-kdl"),
    special=("safe_arm_controllers_test", "safe_arm_hil", "safe_arm_hil_test", "hil_plant", "hil_kernel", "hil_controller", "hil_virtual", "hil_types"),
    files=("arm_assumptions.hpp", "arm_faults.hpp", "arm_limits.hpp", "arm_reader.cpp", "arm_safety.hpp", "arm_self_check.hpp", "command_link.hpp",
           "drive_gate.cpp", "joint_monitor.cpp", "joint_monitor.hpp", "machine.cpp", "messages.hpp", "operator_panel.cpp",
           "operator_panel.hpp", "safe_arm_system.cpp", "safe_arm_system.hpp", "safety_supervisor.cpp", "safety_supervisor.hpp",
           "start_up_check.cpp", "start_up_check.hpp", "stop_loop.hpp"),
    program="safe_arm", campaign_bar=0.60)  # fmt: skip
ALL_LAYERS = (*LAYERS, EXAMPLE)
PLAN = "faults.yaml"
PROGRAM_UNIT = "main.cpp"
PROGRAM = "./program"  # of the mutant, in the folder in which a test runs


def get_layer(file: str) -> Layer:
    """@param file relative to the root, of one of ALL_LAYERS."""
    return next(layer for layer in ALL_LAYERS if file.startswith(f"{layer.name}/"))


def list_files(root: Path, layers: Sequence[Layer] = LAYERS) -> list[str]:
    """Files to mutate, relative to the root: headers and sources of `layers`, without tests."""
    default = ("include/**/*.hpp", "src/**/*.hpp", "src/**/*.cpp")
    found = {path for layer in layers for pattern in layer.files or default for path in (root / layer.name).glob(pattern)}
    return sorted(path.relative_to(root).as_posix() for path in found)


@dataclass(frozen=True)
class Unit:
    """One compiled file: `path` relative to the folder of its layer, and flags that affect its meaning."""

    path: str
    flags: tuple[str, ...]

    @property
    def is_test(self) -> bool:
        return self.path.startswith("tests/")

    @property
    def case(self) -> str:
        """Id of the case, if this is a test of a campaign, which has no file."""
        return self.path.removeprefix("campaign/") if self.path.startswith("campaign/") else ""

    @property
    def runs_program(self) -> bool:
        return bool(self.case) or any(PROGRAM in flag for flag in self.flags)

    @property
    def stem(self) -> str:
        return Path(self.path).stem


@dataclass(frozen=True)
class Sources:
    """A layer below `root`, its units, the sources (relative to `root`) of the layers that it uses, its libraries, and the headers that all
    its tests include first: in an example, all units. The program of an example is linked from all units without tests."""

    root: Path
    units: tuple[Unit, ...]
    layer: str = LAYERS[0].name
    below: tuple[Unit, ...] = ()
    libraries: tuple[str, ...] = ()
    is_enclosed: bool = False  # the tests have processes of their own, and a mutant must not reach any others
    prefix_headers: tuple[str, ...] = ('"mamori/trace/verifies.hpp"',)
    has_campaign: bool = False

    @property
    def folder(self) -> Path:
        return self.root / self.layer


def read_sources(root: Path, build: Path, layer: Layer, jobs: int = 1) -> Sources:
    """Configures the project in `build`, and generates the headers of the tests. @raise WorkError."""
    argv = ("cmake", "-S", str(root), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
            *(f"-D{option}={'ON' if layer.program else 'OFF'}" for option in ("MAMORI_WITH_SIMBODY_SIM", "MAMORI_BUILD_EXAMPLES")))  # fmt: skip
    _run_cmake(argv)
    if layer.generated:
        _run_cmake(("cmake", "--build", str(build), "--target", layer.generated, "--parallel", str(jobs)))
    entries = drop_programs(json.loads((build / "compile_commands.json").read_text(encoding="utf-8")), layer.special)
    units = _select_units(entries, root / layer.name, root / layer.name)
    if not any(unit.is_test for unit in units):
        raise WorkError(f"{root / layer.name} has no test that CMake knows; nothing could be killed")
    below = [unit for name in layer.below for unit in _select_units(entries, root / name / "src", root)]
    if layer.program:
        local = {str(build / layer.name / layer.program): PROGRAM, str(root / layer.name): layer.name}
        units = [replace(unit, flags=localise(unit.flags, (root / layer.name / unit.path).read_text(encoding="utf-8"), local)) for unit in units]
        return Sources(root, tuple(units), layer.name, tuple(below), layer.libraries, prefix_headers=_list_headers(root / layer.name), has_campaign=True)
    return Sources(root, tuple(units), layer.name, tuple(below), layer.libraries, layer.is_port)


def localise(flags: Sequence[str], text: str, local: Mapping[str, str]) -> tuple[str, ...]:
    """The flags of a unit with this text: without definitions that it does not use, and with paths relative to the folder in which a test
    runs, so that the objects of all copies are equal. @param local relative path of each absolute path."""
    kept = []
    for flag in flags:
        if flag.startswith("-D"):
            for absolute, relative in local.items():
                flag = flag.replace(absolute, relative)
            if flag[2:].partition("=")[0] not in text:
                continue
        kept.append(flag)
    return tuple(kept)


def _list_headers(folder: Path) -> tuple[str, ...]:
    """Headers of other layers and libraries that the layer includes."""
    texts = [path.read_text(encoding="utf-8") for pattern in ("*.?pp", "tests/*.?pp") for path in sorted(folder.glob(pattern))]
    return tuple(sorted({header for text in texts for header in re.findall(r'^#include (<[^>]+>|"mamori/[^"]+")', text, re.MULTILINE)}))


def _run_cmake(argv: Sequence[str]) -> None:
    done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise WorkError(f"'{' '.join(argv)}' failed:\n{(done.stdout + done.stderr).strip()[-2000:]}")


def drop_programs(entries: Sequence[dict[str, str]], programs: Sequence[str]) -> list[dict[str, str]]:
    """The entries without those of `programs`."""
    return [entry for entry in entries if not any(f"/{program}.dir/" in entry["command"] for program in programs)]


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
