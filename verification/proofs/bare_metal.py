# SPDX-License-Identifier: Apache-2.0
"""Compiles target code for a Cortex-M4 without an operating system.

@satisfies SWR-PRF-003      Design: docs/design/launcher.md#bare-metal-proof
"""

from __future__ import annotations

import subprocess
from pathlib import Path

TOOL_PREFIX = "arm-none-eabi-"
EIGEN = Path("/usr/include/eigen3")
FLAGS = ("-std=c++17", "-mcpu=cortex-m4", "-mthumb", "-O2", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics",
         "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")  # fmt: skip


def compile_for_controller(source: Path, includes: list[Path], result: Path) -> str:
    """Compiles `source` to `result`. @return the compiler messages; empty if there are none."""
    argv = [f"{TOOL_PREFIX}g++", *FLAGS, *(f"-I{path}" for path in includes), "-isystem", str(EIGEN),
            "-c", str(source), "-o", str(result)]  # fmt: skip
    done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    return "" if done.returncode == 0 else done.stderr or f"exit status {done.returncode}"
