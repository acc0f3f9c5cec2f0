# SPDX-License-Identifier: Apache-2.0
"""Resource usage of one command: CPU time including all its children, wall time, maximum memory of one process."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_CHILD = Path(__file__).with_name("measured_child.py")


@dataclass(frozen=True, slots=True)
class Usage:
    """`cpu_s` is the user and system time of the process and its finished children. `ended` False: stopped at the limit; all values are
    lower bounds."""

    status: int
    cpu_s: float
    wall_s: float
    peak_bytes: int
    ended: bool = True


def run_measured(command: Sequence[str], log: Path, limit_s: float) -> Usage:
    """Runs `command` with its output in `log`. After `limit_s`, ends it and all its children."""
    log.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, log.open("wb") as output:
        result = Path(folder) / "usage.json"
        line = [sys.executable, "-I", "-S", str(_CHILD), str(result), str(limit_s), *command]
        subprocess.run(line, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, check=True)
        return Usage(*json.loads(result.read_text(encoding="utf-8")))


def take_median(usages: Sequence[Usage]) -> Usage:
    """The run with the median CPU time, so that its figures belong together; the lower of two middle runs."""
    return sorted(usages, key=lambda usage: usage.cpu_s)[(len(usages) - 1) // 2]
