# SPDX-License-Identifier: Apache-2.0
"""Runs the safe arm repeatedly, compiled by several compilers, and compares the port-trace hashes.

@satisfies SWR-PRF-005      Design: docs/design/launcher.md#determinism-proof
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError

HASH = re.compile(r"[0-9a-f]{16}")
RUN_TIMEOUT_S = 120


@dataclass(frozen=True)
class Variant:
    """A configuration of compiler and options."""

    name: str
    compiler: str
    flags: str


# In addition to g++ -O2 (host-release) and clang++ -O0 (host-asan), which the proof runs as built.
VARIANTS = (
    Variant("gcc-O0", "g++", "-O0"),
    Variant("clang-O2", "clang++-19", "-O2"),
)


@dataclass(frozen=True)
class Inputs:
    """All inputs that may determine the trace hash, except the commit."""

    model: Path
    motion: Path
    fault: str
    seed: int
    frames: int

    def arguments(self) -> list[str]:
        return ["--model", str(self.model), "--motion", str(self.motion), "--fault", self.fault,
                "--seed", str(self.seed), "--frames", str(self.frames)]  # fmt: skip


def build_variant(
    root: Path, build: Path, variant: Variant, target: str, jobs: int, options: Sequence[str] = ("-DMAMORI_BUILD_TESTS=OFF",)
) -> None:
    """Configures and builds only `target`; tests are disabled unless `options` enable them."""
    configure = ["cmake", "-S", str(root), "-B", str(build), "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={variant.compiler}",
                 f"-DCMAKE_CXX_FLAGS={variant.flags}", *options]  # fmt: skip
    for argv in (configure, ["cmake", "--build", str(build), "--parallel", str(jobs), "--target", target]):
        done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            raise WorkError(f"{variant.name}: {' '.join(argv)} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


def get_trace_hash(binary: Path, inputs: Inputs, out: Path) -> str:
    """One run. @return the hash in its run.json, which must be new, complete, and of the requested number of frames."""
    if not binary.is_file():
        raise WorkError(f"{binary} is missing; run ./mamori build")
    argv = [str(binary), "run", *inputs.arguments(), "--out", str(out)]
    done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                          timeout=RUN_TIMEOUT_S)  # fmt: skip
    if done.returncode != 0:
        raise WorkError(f"{' '.join(argv)} ended with status {done.returncode}: {done.stderr.strip()}")
    try:
        record = json.loads((out / "run.json").read_text(encoding="utf-8"))
        trace_hash, frames = record["trace_hash"], record["frames"]
    except (OSError, ValueError, KeyError) as error:
        raise WorkError(f"{out / 'run.json'}: no whole record: {error!r}") from error
    if not HASH.fullmatch(str(trace_hash)):
        raise WorkError(f"{out / 'run.json'}: '{trace_hash}' is no trace hash of 16 hexadecimal digits")
    if frames != inputs.frames:
        raise WorkError(f"{out / 'run.json'}: {frames} frames were run, {inputs.frames} were asked for")
    return str(trace_hash)


def find_differences(wanted: str, hashes: Mapping[str, str] | Sequence[str]) -> list[str]:
    """One line for each hash that differs from `wanted`, with its name or number."""
    named = hashes.items() if isinstance(hashes, Mapping) else enumerate(hashes, start=1)
    return [f"{name}: {found} instead of {wanted}" for name, found in named if found != wanted]
