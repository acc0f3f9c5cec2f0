# SPDX-License-Identifier: Apache-2.0
"""Builds the benchmark programs and runs them. Omits a reference implementation that cannot be built, and reports why.

@satisfies SWR-BEN-002      Design: docs/design/bench.md#peers
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from mamori_tools.host.process import Tick, run_logged
from mamori_tools.host.project import Project
from mamori_trace.base.errors import WorkError

ICEORYX2 = "iceoryx2 local"
CARGO_MIN = (1, 89)
"""Oldest cargo version that builds the iceoryx2 version in iceoryx2/Cargo.toml."""


@dataclass(frozen=True)
class Effort:
    """Extent of a measurement."""

    rounds: int
    batches: int
    batch_ns: int
    grid_cycles: int  # wake-ups of each program in a round; each takes a millisecond


# A batch is much shorter than the time slice of a scheduler, so that most batches are not interrupted.
NORMAL = Effort(rounds=15, batches=21, batch_ns=400_000, grid_cycles=1000)
QUICK = Effort(rounds=5, batches=11, batch_ns=100_000, grid_cycles=250)


@dataclass(frozen=True)
class Programs:
    """Build folders of the programs of a project."""

    project: Project

    @property
    def bench(self) -> Path:
        return self.project.build / "verification" / "bench" / "mamori_bench"

    @property
    def exact(self) -> Path:
        return self.project.build / "verification" / "bench" / "mamori_exact"

    @property
    def crate(self) -> Path:
        return self.project.root / "verification" / "bench" / "iceoryx2"

    @property
    def cargo_folder(self) -> Path:
        return self.project.root / "build" / "bench-iceoryx2"

    @property
    def iceoryx2_library(self) -> Path:
        return self.cargo_folder / "release" / "libmamori_bench_iceoryx2.a"


def build_iceoryx2(programs: Programs, tick: Tick, log: TextIO) -> str:
    """Builds the reference implementation with cargo. @return why it is missing, or an empty string."""
    reason = _check_cargo()
    if not reason:
        log.flush()
        argv = ["cargo", "build", "--release", "--locked", "--manifest-path", str(programs.crate / "Cargo.toml"),
                "--target-dir", str(programs.cargo_folder)]  # fmt: skip
        if run_logged(argv, Path(log.name), programs.project.root, tick) != 0:
            reason = f"cargo could not build it; its words are in {log.name}"
    if reason:
        programs.iceoryx2_library.unlink(missing_ok=True)
        print(f"{ICEORYX2}: {reason}", file=log)
    return reason


def _check_cargo() -> str:
    """@return why cargo on this host is unsuitable, or an empty string."""
    needed = ".".join(map(str, CARGO_MIN))
    if shutil.which("cargo") is None:
        return f"cargo is not installed; iceoryx2 needs cargo {needed} or newer, which Debian 12 does not package (rustup does)"
    said = subprocess.run(["cargo", "--version"], capture_output=True, text=True, check=False).stdout
    found = re.match(r"cargo (\d+)\.(\d+)", said)
    if found is None or tuple(map(int, found.groups())) < CARGO_MIN:
        return f"'{said.strip() or 'cargo --version'}' is too old; iceoryx2 needs cargo {needed} or newer (rustup has it)"
    return ""


def build_programs(programs: Programs, targets: Sequence[str], jobs: int, tick: Tick, log: TextIO) -> None:
    """Configures and builds `targets`. @raise WorkError if that fails."""
    project = programs.project
    log.flush()
    for argv in (
        ["cmake", "-S", str(project.root), "--preset", project.preset,
         f"-DMAMORI_BENCH_ICEORYX2_LIBRARY={programs.iceoryx2_library}"],
        ["cmake", "--build", str(project.build), "--target", *targets, "--parallel", str(jobs)],
    ):  # fmt: skip
        status = run_logged(argv, Path(log.name), project.root, tick)
        if status != 0:
            raise WorkError(f"{argv[0]} ended with status {status}")


def run_bench(programs: Programs, metrics: Sequence[str], effort: Effort, out: Path, tick: Tick, log: TextIO) -> None:
    """Measures `metrics` and writes the samples to `out`. @raise WorkError if that fails."""
    log.flush()
    argv = [str(programs.bench), "--out", str(out), "--rounds", str(effort.rounds), "--batches", str(effort.batches),
            "--batch-ns", str(effort.batch_ns), "--only", *metrics]  # fmt: skip
    status = run_logged(argv, Path(log.name), programs.project.root, tick)
    if status != 0:
        raise WorkError(f"{programs.bench.name} ended with status {status}")
