# SPDX-License-Identifier: Apache-2.0
"""Runs the measured program, with additional load on request, and ends both in order.

@satisfies SWR-TIM-023, SWR-TIM-024      Design: docs/design/timing.md#run
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import InputError

POLL_S = 0.1
GRACE_S, GRACE_SHARE = 30.0, 0.05
"""How long a program may take to write its files after a stop request; depends on the number of cycles."""
OVERTIME_FACTOR = 1.5
OVERTIME_S = 30.0
"""Maximum run time beyond that of its cycles: the schedule of major frames is absolute, so a program cannot fall behind."""
INTERRUPTED = 130
LOAD_TOOL = "stress-ng"
LOAD_MARGIN_S = 60

Tick = Callable[[float], None]
"""Receives the seconds since the start of the program."""


@dataclass(frozen=True)
class Ending:
    """How a program ended. `status` follows Popen: negative for a signal."""

    status: int
    seconds: float
    was_interrupted: bool = False
    was_late: bool = False

    @property
    def was_stopped(self) -> bool:
        """Whether it was stopped by this command, or by a signal to the program itself."""
        return self.was_interrupted or (self.status == INTERRUPTED and not self.was_late)

    @property
    def reason(self) -> str:
        """The error of the program; empty without one."""
        if self.was_late:
            return f"the program did not end and was stopped after {self.seconds:.0f} s"
        if self.was_stopped or self.status == 0:
            return ""
        if self.status < 0:
            return f"the program was ended by {signal.Signals(-self.status).name}"
        return f"the program ended with status {self.status}"


def run_program(argv: Sequence[str], log: Path, expected_s: float, tick: Tick) -> Ending:
    """Runs `argv` and appends its output to `log`. Forwards Ctrl-C and SIGTERM as one SIGINT, then waits for the files of the program.
    @raise InputError if it cannot be run."""
    begin = time.monotonic()
    limit_s = expected_s * OVERTIME_FACTOR + OVERTIME_S
    grace_s = GRACE_S + expected_s * GRACE_SHARE
    with log.open("a", encoding="utf-8") as out:
        print("$", *argv, file=out, flush=True)
        try:
            # A separate process group: the Ctrl-C of a terminal reaches only this command, and the program gets it once.
            child = subprocess.Popen(argv, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, process_group=0)
        except OSError as error:
            raise InputError(f"timing: '{argv[0]}' cannot be run: {error.strerror}") from error
        try:
            while True:
                passed = time.monotonic() - begin
                try:
                    return Ending(child.wait(POLL_S), passed)
                except subprocess.TimeoutExpired:
                    tick(passed)
                if passed > limit_s:
                    return Ending(_stop(child, signal.SIGINT, grace_s), passed, was_late=True)
        except KeyboardInterrupt:
            return Ending(_stop(child, signal.SIGINT, grace_s), time.monotonic() - begin, was_interrupted=True)
        finally:
            _kill(child)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Ignores Ctrl-C and SIGTERM for the seconds in which results are written, because an interruption would lose the measurement."""
    handlers = {number: signal.signal(number, signal.SIG_IGN) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


def _stop(child: subprocess.Popen[bytes], number: signal.Signals, grace_s: float) -> int:
    """Sends a signal, waits, then kills. Ignores a second Ctrl-C, because it would lose the files that the first one requested.

    @return exit status.
    """
    with undisturbed():
        child.send_signal(number)
        try:
            return child.wait(grace_s)
        except subprocess.TimeoutExpired:
            _kill(child)
            return child.wait()


def _kill(child: subprocess.Popen[bytes]) -> None:
    """Ends the process group of the program while the program runs, also after an exception."""
    if child.poll() is None:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()


def check_load() -> None:
    """@raise InputError if no tool that creates load is installed."""
    if shutil.which(LOAD_TOOL) is None:
        raise InputError(f"timing: --load needs {LOAD_TOOL}; install the package {LOAD_TOOL}, or omit --load")


@contextmanager
def make_load(is_wanted: bool, expected_s: float, log: Path) -> Iterator[list[str]]:
    """Keeps all processors and some memory busy. The load stops by itself if this command cannot stop it.

    @return list of errors of the load, filled when the load ends.
    """
    problems: list[str] = []
    if not is_wanted:
        yield problems
        return
    seconds = int(expected_s * OVERTIME_FACTOR + OVERTIME_S) + LOAD_MARGIN_S
    argv = [LOAD_TOOL, "--cpu", str(os.cpu_count() or 1), "--vm", "1", "--vm-bytes", "64M", "--timeout", f"{seconds}s"]
    with log.open("a", encoding="utf-8") as out:
        print("$", *argv, file=out, flush=True)
        child = subprocess.Popen(argv, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, process_group=0)
        try:
            yield problems
            if child.poll() is not None:
                problems.append(f"the load ended before the run, with status {child.returncode}")
        finally:
            if child.poll() is None:
                _stop(child, signal.SIGTERM, GRACE_S)
