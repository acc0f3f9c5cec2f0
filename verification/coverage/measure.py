# SPDX-License-Identifier: Apache-2.0
"""Builds the tests of the measured layers with clang's coverage, runs them, and exports what each layer's own tests reached.

@satisfies SWR-VER-001, SWR-VER-003      Design: docs/design/test_strength.md#coverage
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

COMPILER = "clang++-19"
FLAGS = ("-fprofile-instr-generate", "-fprofile-update=atomic", "-fcoverage-mapping", "-fcoverage-mcdc")
PRESET = "host-coverage"
LAYERS = ("kernel", "safety")  # each is to be shown by its own tests
FLUSH = Path(__file__).with_name("flush_on_death.cpp")
WRAPPED = "-Wl,--wrap=_exit,--wrap=_Exit"
TEST_TIMEOUT_S = 600
BUILD_TIMEOUT_S = 3600
# clang says this as a warning without a name, which -Werror leaves a warning.
UNMEASURED = "unsupported MC/DC boolean expression"


class CoverageError(Exception):
    """The measurement could not be made: what failed, and its last words."""


def measure(root: Path, jobs: int) -> list[dict[str, Any]]:
    """Builds and runs all test programs of LAYERS. @return the export of llvm-cov, one of each layer. @raise CoverageError."""
    build = root / "build" / PRESET
    build.mkdir(parents=True, exist_ok=True)
    flush = build / "flush_on_death.o"
    run((COMPILER, "-std=c++17", "-O1", "-c", str(FLUSH), "-o", str(flush)))
    run(("cmake", "-S", str(root), "--preset", PRESET, "-DMAMORI_WITH_SIMBODY_SIM=OFF", "-DMAMORI_BUILD_EXAMPLES=OFF", "-DMAMORI_BENCH_CYCLONEDDS=OFF",
         f"-DCMAKE_EXE_LINKER_FLAGS={flush} {WRAPPED}"))  # fmt: skip
    # From scratch: what clang cannot measure it tells while compiling, and only then.
    targets = [f"{layer}/all" for layer in LAYERS]
    refuse_unmeasured(run(("cmake", "--build", str(build), "--clean-first", "--target", *targets, "--parallel", str(jobs)),
                           BUILD_TIMEOUT_S))
    return [measure_layer(root / layer, build / layer) for layer in LAYERS]


def measure_layer(folder: Path, build: Path) -> dict[str, Any]:
    """Runs the test programs in `build`. @return what they reached of the sources in `folder`. @raise CoverageError."""
    listing = json.loads(run(("ctest", "--test-dir", str(build), "--show-only=json-v1")))
    programs = [Path(test["command"][0]) for test in listing["tests"]]
    if not programs:
        raise CoverageError(f"{build} has no test program; nothing was measured")
    return export(programs, build / "profiles", (folder / "include", folder / "src"))


def export(programs: Sequence[Path], profiles: Path, sources: Sequence[Path]) -> dict[str, Any]:
    """Runs `programs` and reads their counters, of `sources` only. Old profiles in `profiles` are thrown away first."""
    shutil.rmtree(profiles, ignore_errors=True)
    profiles.mkdir(parents=True)
    for program in programs:
        run((str(program),), LLVM_PROFILE_FILE=f"{profiles}/{program.name}-%m.profraw")
    merged = profiles / "merged.profdata"
    run(("llvm-profdata-19", "merge", "-sparse", "-o", str(merged), *map(str, sorted(profiles.glob("*.profraw")))))
    whole = export_objects(programs, merged, sources)
    # Where one program includes a function that it never calls, llvm-cov may take that for all: so each is asked alone, too.
    alone = [export_objects((program,), merged, sources) for program in programs if len(programs) > 1]
    functions = [data["functions"] for each in alone for data in each["data"]]
    return {**whole, "data": [*whole["data"], *({"files": [], "functions": each} for each in functions)]}


def export_objects(programs: Sequence[Path], profile: Path, sources: Sequence[Path]) -> dict[str, Any]:
    """@return what llvm-cov says of `sources` in all of `programs` together."""
    first, *others = map(str, programs)
    objects = [word for other in others for word in ("-object", other)]
    return json.loads(run(("llvm-cov-19", "export", first, *objects, f"-instr-profile={profile}", *map(str, sources))))


def refuse_unmeasured(words: str) -> None:
    """@param words output of a compiler. @raise CoverageError with the places of expressions that MC/DC leaves out."""
    places = [line for line in words.splitlines() if UNMEASURED in line]
    if places:
        raise CoverageError("write these expressions so that clang can measure them, with names for what is nested:\n" + "\n".join(places))


def run(argv: Sequence[str], timeout_s: int = TEST_TIMEOUT_S, **settings: str) -> str:
    """@return standard output. @raise CoverageError when the program is missing, fails, or does not end."""
    try:
        done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                              timeout=timeout_s, env={**os.environ, **settings})  # fmt: skip
    except FileNotFoundError as error:
        raise CoverageError(f"'{argv[0]}' is not installed; ./mamori test installs it") from error
    except subprocess.TimeoutExpired as error:
        raise CoverageError(f"'{' '.join(argv)}' did not end in {timeout_s} s") from error
    if done.returncode != 0:
        tail = "\n".join((done.stdout + done.stderr).splitlines()[-30:])
        raise CoverageError(f"'{' '.join(argv)}' ended with status {done.returncode}:\n{tail}")
    return done.stdout
