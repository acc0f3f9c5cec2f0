# SPDX-License-Identifier: Apache-2.0
"""What one command takes: CPU time of it and all its children, wall time, largest memory of one process."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_POLL_S = 0.02
_KIB = 1024


@dataclass(frozen=True, slots=True)
class Usage:
    """`cpu_s` is user and system time of the process and what it waited for. `ended` False: stopped at the limit, so all are lower bounds."""

    status: int
    cpu_s: float
    wall_s: float
    peak_bytes: int
    ended: bool = True


def run_measured(command: Sequence[str], log: Path, limit_s: float, folder: Path | None = None) -> Usage:
    """Runs `command` with its output in `log`. What is not done after `limit_s` is ended with all its children."""
    log.parent.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    with log.open("wb") as output:
        process = subprocess.Popen(
            list(command), stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, cwd=folder, start_new_session=True
        )
        ended = True
        while True:
            done, status, used = os.wait4(process.pid, os.WNOHANG)
            if done:
                break
            if ended and time.monotonic() - started > limit_s:
                ended = False
                os.killpg(process.pid, signal.SIGKILL)
            time.sleep(_POLL_S)
    process.returncode = os.waitstatus_to_exitcode(status)  # already waited for: Popen must not do it again
    wall_s = time.monotonic() - started
    return Usage(process.returncode, used.ru_utime + used.ru_stime, wall_s, used.ru_maxrss * _KIB, ended)


def take_median(usages: Sequence[Usage]) -> Usage:
    """The one of median CPU time, so that its figures belong together; the lower one of an even number."""
    return sorted(usages, key=lambda usage: usage.cpu_s)[(len(usages) - 1) // 2]
