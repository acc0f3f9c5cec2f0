# SPDX-License-Identifier: Apache-2.0
"""Runs the system of 100 components in virtual time, compiled by several compilers and under load, and records the results.

@satisfies SWR-INS-006, SWR-INS-007      Design: docs/design/kernel.md#scale
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError
from mamori_trace.base.text_file import write_text
from verification.proofs.determinism import HASH, Variant

PROGRAM = Path("verification") / "integration" / "scale_run"
TARGET = PROGRAM.name
OPTIONS = ("-DMAMORI_BUILD_TESTS=ON", "-DMAMORI_BUILD_EXAMPLES=OFF", "-DMAMORI_WITH_SIMBODY_SIM=OFF")
RUN_TIMEOUT_S = 300

# In addition to the release build (g++ -O2): each compiler at each level.
VARIANTS = (
    Variant("gcc-O0", "g++", "-O0"),
    Variant("gcc-Os", "g++", "-Os"),
    Variant("clang-O0", "clang++-19", "-O0"),
    Variant("clang-O2", "clang++-19", "-O2"),
    Variant("clang-Os", "clang++-19", "-Os"),
)

# The load ends by itself, so that no process remains if the proof is killed.
BUSY = "import time\nend = time.monotonic() + 60\nwhile time.monotonic() < end:\n    pass"


@dataclass(frozen=True)
class Run:
    """Output of scale_run."""

    components: int
    cores: int
    cycles: int
    virtual_s: float
    wall_s: float
    overruns: int
    lost: int
    rows_read: int
    trace_hash: str

    @property
    def speed(self) -> float:
        """Seconds of virtual time per second of real time; 0 if the clock resolution was too coarse."""
        return self.virtual_s / self.wall_s if self.wall_s > 0.0 else 0.0


def run_scale(program: Path, cycles: int, *options: str) -> Run:
    """One run, which must have the requested number of cycles and no overrun."""
    if not program.is_file():
        raise WorkError(f"{program} is missing; run ./mamori build")
    argv = [str(program), "--cycles", str(cycles), *options]
    done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                          timeout=RUN_TIMEOUT_S)  # fmt: skip
    if done.returncode != 0:
        raise WorkError(f"{' '.join(argv)} ended with status {done.returncode}: {(done.stderr or done.stdout).strip()}")
    try:
        run = Run(**json.loads(done.stdout))
    except (ValueError, TypeError) as error:
        raise WorkError(f"{' '.join(argv)}: no whole record: {error}") from error
    if not HASH.fullmatch(run.trace_hash):
        raise WorkError(f"{' '.join(argv)}: '{run.trace_hash}' is no trace hash of 16 hexadecimal digits")
    if run.cycles != cycles:
        raise WorkError(f"{' '.join(argv)}: {run.cycles} cycles were run, {cycles} were asked for")
    return run


@contextmanager
def busy_machine() -> Iterator[None]:
    """Keeps all processors busy."""
    loops = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(os.cpu_count() or 1)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def write_record(path: Path, runs: Sequence[tuple[str, Run]]) -> None:
    """Writes the named runs and their speed atomically."""
    record = {"runs": [{"name": name, **asdict(run), "times_real_time": round(run.speed, 1)} for name, run in runs]}
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(record, indent=2) + "\n")
