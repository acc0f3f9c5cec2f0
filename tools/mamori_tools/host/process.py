# SPDX-License-Identifier: Apache-2.0
"""Child processes: output to a log, progress while they run, and termination of all of them when the command is stopped.

@satisfies SWR-CLI-008, SWR-CLI-045      Design: docs/design/launcher.md#interrupt
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NoReturn

Tick = Callable[[str], None]

POLL_S = 0.1
AGAIN_S = 0.01
GRACE_S = 10.0  # a stopped timing run draws its pictures in 3 to 5 s
LOG_TAIL_BYTES = 4096
PR_SET_CHILD_SUBREAPER = 36  # linux/prctl.h


def run_logged(argv: Sequence[str], log: Path, cwd: Path, tick: Tick, env: Mapping[str, str] | None = None) -> int:
    """Runs `argv` in `cwd` and appends its output to `log`; calls `tick` with the newest log line. @return exit status; 127 if the program
    does not exist."""
    with log.open("a", encoding="utf-8") as out:
        print("$", *argv, file=out, flush=True)
        try:
            child = subprocess.Popen(
                argv, cwd=cwd, env={**(os.environ if env is None else env), "PWD": str(cwd)}, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT
            )
        except OSError as error:
            print(f"{argv[0]}: {error.strerror}", file=out)
            return 127
        while True:
            try:
                return child.wait(POLL_S)
            except subprocess.TimeoutExpired:
                tick(read_last_line(log))


def read_tail(log: Path, lines: int) -> list[str]:
    """The last non-empty `lines` of `log`; empty without a log."""
    if not log.exists():
        return []
    text = log.read_text(encoding="utf-8", errors="replace")
    return [line for line in text.splitlines() if line.strip()][-lines:]


def read_last_line(log: Path) -> str:
    """The latest line of a log that may be long and may still grow."""
    with log.open("rb") as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - LOG_TAIL_BYTES))
        lines = file.read().decode("utf-8", errors="replace").split("\n")
    return next((line.strip() for line in reversed(lines) if line.strip()), "")


def discard_output() -> None:
    """Redirects standard output to the null device after the reader has ended, so that Python prints no error at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def raise_on_signals() -> None:
    """SIGINT and SIGTERM both stop the command in order, even if a parent shell had set SIGINT to be ignored.

    If the same signal ends the parent of a grandchild first, the grandchild becomes a child of this process, not of init.
    """
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)

    def stop(number: int, _frame: object) -> NoReturn:
        raise KeyboardInterrupt(signal.Signals(number).name)

    def stop_later(dropped: sys.UnraisableHookArgs) -> None:
        if isinstance(dropped.exc_value, KeyboardInterrupt):  # the signal came in a destructor, which cannot raise; raised again afterwards
            signal.setitimer(signal.ITIMER_REAL, AGAIN_S)
        else:
            sys.__unraisablehook__(dropped)

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM):
        signal.signal(number, stop)
    sys.unraisablehook = stop_later
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM})  # the launcher starts Python with both blocked


def end_children() -> None:
    """Ends every descendant of this process: first by request, after GRACE_S by force."""
    import psutil  # imported here, because only a stopped command needs it

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    deadline = time.monotonic() + GRACE_S
    asked: set[psutil.Process] = set()
    is_any_left = True
    while is_any_left:
        is_any_left = False
        is_late = time.monotonic() >= deadline
        for child in psutil.Process().children(recursive=True):
            with contextlib.suppress(psutil.NoSuchProcess):  # the process ended by itself in the meantime
                if child.status() == psutil.STATUS_ZOMBIE:  # its parent has not yet read its exit status
                    continue
                is_any_left = True
                if is_late or child not in asked:
                    asked.add(child)
                    child.send_signal(signal.SIGKILL if is_late else signal.SIGTERM)
        if is_any_left:
            time.sleep(POLL_S)
