# SPDX-License-Identifier: Apache-2.0
"""Builds the tests of the measured layers with clang's coverage, runs the tests without counters, and exports the coverage of
each layer by its own tests.

@satisfies SWR-VER-001      Design: docs/design/test_strength.md#coverage
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Container, Sequence
from pathlib import Path
from typing import Any

from mamori_tools.host.project import LONG_LABEL, SANITIZED, Project
from mamori_trace.base.errors import WorkError

LAYERS = ("kernel", "safety", "ports/conformance", "ports/lcm", "ports/posix_rt", "ports/virtual_time")  # the tests of each layer must cover it
TEST_TIMEOUT_S = 600
BUILD_TIMEOUT_S = 3600


def measure(root: Path, jobs: int) -> list[dict[str, Any]]:
    """Builds all test programs of LAYERS, and runs those without counters. @return the llvm-cov export of each layer. @raise WorkError."""
    build = Project(root, SANITIZED).build
    run(("cmake", "-S", str(root), "--preset", SANITIZED))
    run(("cmake", "--build", str(build), "--target", *(f"{layer}/all" for layer in LAYERS), "--parallel", str(jobs)), BUILD_TIMEOUT_S)
    return [measure_layer(root, layer, build, jobs) for layer in LAYERS]


def measure_layer(root: Path, layer: str, build: Path, jobs: int) -> dict[str, Any]:
    """Runs the test programs of `layer`, a folder below `root`. Skips programs that `./mamori test` has run since the build: their counters are
    newer. @return the coverage of its sources. @raise WorkError."""
    folder, tests = root / layer, build / layer
    listing = json.loads(run(("ctest", "--test-dir", str(tests), "--show-only=json-v1")))
    programs = {test["name"]: Path(test["command"][0]) for test in listing["tests"] if LONG_LABEL not in list_labels(test)}
    if not programs:
        raise WorkError(f"{tests} has no test program; nothing was measured")
    profiles = build / "evidence" / "profiles" / folder.name
    missing = [name for name, program in programs.items() if not has_counters(profiles, name, program)]
    discard_counters(profiles, set(programs) - set(missing))
    if missing:
        run(("ctest", "--test-dir", str(tests), "--output-on-failure", "--parallel", str(jobs), "--tests-regex", f"^({'|'.join(missing)})$"))
    return export(list(programs.values()), profiles, (folder / "include", folder / "src"))


def list_labels(test: dict[str, Any]) -> list[str]:
    """@return the labels of `test`, one of ctest's list."""
    return [label for each in test["properties"] if each["name"] == "LABELS" for label in each["value"]]


def has_counters(profiles: Path, test: str, program: Path) -> bool:
    """True if `test` has written its counters since `program` was built."""
    built = program.stat().st_mtime
    return any(path.stat().st_mtime > built for path in profiles.glob(f"{test}-*.profraw"))


def discard_counters(profiles: Path, kept: Container[str]) -> None:
    """Removes the counters of all tests except those in `kept`: counters of earlier builds and of removed tests."""
    for path in profiles.glob("*.profraw"):
        if path.name.rpartition("-")[0] not in kept:
            path.unlink()


def export(programs: Sequence[Path], profiles: Path, sources: Sequence[Path]) -> dict[str, Any]:
    """Reads the counters of `programs` in the folder `profiles`, of `sources` only."""
    merged = profiles / "merged.profdata"
    run(("llvm-profdata-19", "merge", "-sparse", "-o", str(merged), *map(str, sorted(profiles.glob("*.profraw")))))
    whole = export_objects(programs, merged, sources)
    # If one program includes a function without calling it, llvm-cov may report that for all programs. Each program is therefore also
    # queried alone.
    alone = [export_objects((program,), merged, sources) for program in programs if len(programs) > 1]
    functions = [data["functions"] for each in alone for data in each["data"]]
    return {**whole, "data": [*whole["data"], *({"files": [], "functions": each} for each in functions)]}


def export_objects(programs: Sequence[Path], profile: Path, sources: Sequence[Path]) -> dict[str, Any]:
    """@return llvm-cov's result for `sources` in all of `programs` together."""
    first, *others = map(str, programs)
    objects = [word for other in others for word in ("-object", other)]
    return json.loads(run(("llvm-cov-19", "export", first, *objects, f"-instr-profile={profile}", *map(str, sources))))


def run(argv: Sequence[str], timeout_s: int = TEST_TIMEOUT_S, **settings: str) -> str:
    """@return standard output. @raise WorkError if the program is missing, fails, or does not end."""
    try:
        done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                              timeout=timeout_s, env={**os.environ, **settings})  # fmt: skip
    except FileNotFoundError as error:
        raise WorkError(f"'{argv[0]}' is not installed; ./mamori test installs it") from error
    except subprocess.TimeoutExpired as error:
        raise WorkError(f"'{' '.join(argv)}' did not end in {timeout_s} s") from error
    if done.returncode != 0:
        tail = "\n".join((done.stdout + done.stderr).splitlines()[-30:])
        raise WorkError(f"'{' '.join(argv)}' ended with status {done.returncode}:\n{tail}")
    return done.stdout
