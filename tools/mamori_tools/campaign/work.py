# SPDX-License-Identifier: Apache-2.0
"""Runs the program under test on this host, one process per case. Local campaigns and Dask workers use it.

@satisfies SWR-CMP-004, SWR-CMP-010      Design: docs/design/simulation.md#campaign-runs
"""

from __future__ import annotations

import functools
import hashlib
import os
import signal
import subprocess
import time
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import InputError, WorkError

LOG = "program.log"
_POLL_S = 0.01
_REASON_CHARACTERS_MAX = 300


@dataclass(frozen=True)
class Program:
    """The program under test: its absolute path, and the SHA-256 of its content at the start of the campaign."""

    path: Path
    sha256: str


@dataclass(frozen=True)
class Work:
    """One run. `command` and `folder` are relative to the folder with the inputs; `variables` extend the environment."""

    case: str
    program: Program
    command: tuple[str, ...]
    folder: Path
    variables: Mapping[str, str]
    timeout_s: float


@dataclass(frozen=True)
class Outcome:
    """A finished run. `problem` is empty, or states in one line why the run does not count. `wall_s` [s]."""

    case: str
    problem: str
    wall_s: float


def read_program(path: Path) -> Program:
    """Raises InputError if the file is not a program."""
    if not path.is_file() or not os.access(path, os.X_OK):
        raise InputError("no program that can be run; build it first (./mamori build) or give its path", path)
    path = path.absolute()
    return Program(path, _hash(path, _get_stamp(path)))


def check_program(program: Program) -> None:
    """Raises WorkError unless the file at the path of the program is still that of the start of the campaign."""
    if not program.path.is_file() or not os.access(program.path, os.X_OK):
        raise WorkError(f"{program.path}: no program that can be run; copy it there from the computer that starts the campaign")
    if _hash(program.path, _get_stamp(program.path)) != program.sha256:
        raise WorkError(f"{program.path}: another program than at the start of the campaign; copy it again or run the campaign again")


def _get_stamp(path: Path) -> tuple[int, int, int]:
    state = path.stat()
    return state.st_ino, state.st_size, state.st_mtime_ns


@functools.lru_cache(maxsize=16)
def _hash(path: Path, _stamp: tuple[int, int, int]) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@dataclass
class _Job:
    """A run in progress."""

    work: Work
    process: subprocess.Popen[bytes]
    started_s: float


def run_local(works: Sequence[Work], root: Path, jobs: int) -> Generator[Outcome]:
    """Keeps up to `jobs` processes busy and yields each run when it has ended, with its files in `root / work.folder`.

    A run that exceeds its time limit is killed with its children. Closing the iterator ends all runs. Raises InputError if the program
    cannot be started, WorkError if it has changed.
    """
    waiting = list(works)[::-1]
    running: list[_Job] = []
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                running.append(_start(waiting.pop(), root))
            for job in list(running):
                late = time.monotonic() - job.started_s > job.work.timeout_s
                if job.process.poll() is None and not late:
                    continue
                running.remove(job)
                yield _conclude(job, root)
            time.sleep(_POLL_S)
    finally:
        for job in running:
            _end(job.process)


def _start(work: Work, root: Path) -> _Job:
    check_program(work.program)
    folder = root / work.folder
    folder.mkdir(parents=True)
    try:
        with (folder / LOG).open("wb") as log:
            # A separate session: processes that the program starts end with it, and Ctrl-C reaches only this process.
            process = subprocess.Popen(work.command, cwd=root, env={**os.environ, **work.variables}, stdin=subprocess.DEVNULL,
                                       stdout=log, stderr=subprocess.STDOUT, start_new_session=True)  # fmt: skip
    except OSError as error:
        raise InputError(f"cannot be started: {error.strerror}; build it again", work.program.path) from error
    return _Job(work, process, time.monotonic())


def _conclude(job: _Job, root: Path) -> Outcome:
    problem = ""
    if job.process.poll() is None:
        _end(job.process)
        problem = f"no end after {job.work.timeout_s:g} s; the process was ended"
    elif status := job.process.returncode:
        how = f"exit status {status}" if status > 0 else f"signal {-status}"
        problem = f"program ended with {how}: {_last_words(root / job.work.folder / LOG)}"
    return Outcome(job.work.case, problem, time.monotonic() - job.started_s)


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends a process and its children; has no effect if it has already ended."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _last_words(log: Path) -> str:
    """The last output line of the program, shortened."""
    with log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - 4096))
        lines = file.read().decode("utf-8", errors="replace").split("\n")
    spoken = [line.strip() for line in lines if line.strip()]
    return spoken[-1][:_REASON_CHARACTERS_MAX] if spoken else "it said nothing"
