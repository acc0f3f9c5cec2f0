# SPDX-License-Identifier: Apache-2.0
"""Runs the cases of a campaign, several at a time, each in its own process and folder, and writes the evidence."""

from __future__ import annotations

import datetime
import json
import os
import platform
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.campaign.case import Case, Selection
from mamori_tools.campaign.result import CampaignResult, CaseResult
from mamori_tools.campaign.subject import Subject, load_subject
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import write_text

DEFAULT_TIMEOUT_S = 120.0
"""Wall time after which a run is ended; a run takes about a second."""

_POLL_S = 0.01
_REASON_CHARACTERS_MAX = 300
_CASE_FOLDER = re.compile(r"[a-z][a-z0-9_]*-\d+")

Progress = Callable[[CaseResult, int, int], None]
"""Told of each judged case: the result, how many are done, how many there are."""


@dataclass
class _Job:
    """A case that is running."""

    index: int
    case: Case
    command: tuple[str, ...]
    folder: Path
    process: subprocess.Popen[bytes]
    started_s: float


def run_campaign(
    selection: Selection,
    *,
    program: Path,
    files: Mapping[str, Path],
    evidence: Path,
    jobs: int | None = None,
    timeout_s: float = DEFAULT_TIMEOUT_S,
    environment: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> CampaignResult:
    """Runs and judges all cases, writes `campaign/` and `junit/campaign.xml` below `evidence`.

    Evidence of an earlier campaign is removed first, so a campaign that does not end leaves none. `jobs`: processes at a
    time, None for one per usable core. `environment`: None for evidence/environment.json, or what this process knows; its
    commit is handed on to the program as MAMORI_COMMIT, so that each run names it.
    A case whose program fails, hangs or writes no whole run.json is a failed case. On any exception, KeyboardInterrupt
    among them, the running processes are ended.
    Raises InputError: program or model missing, a bad number, an instant that the motion does not have, no room to write.
    """
    _check_setting(program, jobs, timeout_s)
    subject = load_subject(selection.plan.subject)
    expansion = subject.expand(selection, files)
    cases = expansion.cases
    folder = evidence / "campaign"
    _clear(evidence, cases)
    for name, content in expansion.inputs.items():
        write_text(folder / name, content.decode("utf-8"))
    # A bare name would be searched in PATH, not here.
    program = program.absolute()
    commands = [subject.command(case, program, folder, folder / case.id) for case in cases]
    known = find_environment(evidence) if environment is None else environment
    variables = dict(os.environ)
    if isinstance(known.get("commit"), str):
        variables["MAMORI_COMMIT"] = known["commit"]
    queue = _Queue(subject, cases, commands, folder, variables, timeout_s, progress)
    results = queue.run(jobs or len(os.sched_getaffinity(0)))
    result = CampaignResult(tuple(results), known)
    result.write(evidence)
    return result


def find_environment(evidence: Path) -> dict[str, Any]:
    """What evidence/environment.json says; without it, what this process knows of its machine."""
    try:
        content = json.loads((evidence / "environment.json").read_text(encoding="utf-8"))
        if isinstance(content, dict):
            return content
    except (OSError, ValueError):
        pass
    return {
        "schema": "mamori.environment/1",
        "date_utc": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "os": platform.platform(),
        "cores": os.cpu_count() or 1,
        "python": platform.python_version(),
    }


class _Queue:
    """Keeps up to `jobs` processes busy until every case is judged."""

    def __init__(self, subject: Subject, cases: Sequence[Case], commands: Sequence[tuple[str, ...]], folder: Path,
                 variables: Mapping[str, str], timeout_s: float, progress: Progress | None) -> None:  # fmt: skip
        self._subject = subject
        self._waiting = list(enumerate(zip(cases, commands, strict=True)))[::-1]
        self._folder = folder
        self._variables = variables
        self._timeout_s = timeout_s
        self._progress = progress
        self._running: list[_Job] = []
        self._results: dict[int, CaseResult] = {}
        self._total = len(cases)

    def run(self, jobs: int) -> list[CaseResult]:
        try:
            while self._waiting or self._running:
                while self._waiting and len(self._running) < jobs:
                    index, (case, command) = self._waiting.pop()
                    self._running.append(_start(index, case, command, self._folder / case.id, self._variables))
                self._collect()
                time.sleep(_POLL_S)
        finally:
            for job in self._running:
                _end(job.process)
        return [self._results[index] for index in sorted(self._results)]

    def _collect(self) -> None:
        for job in list(self._running):
            late = time.monotonic() - job.started_s > self._timeout_s
            if job.process.poll() is None and not late:
                continue
            problem = ""
            if job.process.poll() is None:
                _end(job.process)
                problem = f"no end after {self._timeout_s:g} s; the process was ended"
            self._running.remove(job)
            self._results[job.index] = _conclude(self._subject, job, problem)
            if self._progress is not None:
                self._progress(self._results[job.index], len(self._results), self._total)


def _check_setting(program: Path, jobs: int | None, timeout_s: float) -> None:
    if not program.is_file() or not os.access(program, os.X_OK):
        raise InputError("no program that can be run; build it first", program)
    if jobs is not None and jobs < 1:
        raise InputError(f"{jobs} jobs; write 1 or more")
    if not timeout_s > 0.0:
        raise InputError(f"time-out of {timeout_s:g} s; write a number above 0")


def _clear(evidence: Path, cases: Sequence[Case]) -> None:
    """Removes the evidence of an earlier campaign and makes the folders of this one."""
    folder = evidence / "campaign"
    try:
        (evidence / "junit").mkdir(parents=True, exist_ok=True)
        folder.mkdir(exist_ok=True)
        (evidence / "junit" / "campaign.xml").unlink(missing_ok=True)
        (folder / "campaign.json").unlink(missing_ok=True)
        for old in folder.iterdir():
            if _CASE_FOLDER.fullmatch(old.name) and old.is_dir() and not old.is_symlink():
                shutil.rmtree(old)
        for case in cases:
            (folder / case.id).mkdir()
    except OSError as error:
        raise InputError(f"evidence cannot be written: {error.strerror}; check the folder", evidence) from error


def _start(index: int, case: Case, command: tuple[str, ...], folder: Path, variables: Mapping[str, str]) -> _Job:
    try:
        with (folder / "program.log").open("wb") as log:
            # A session of its own: what the program starts ends with it, and Ctrl-C reaches this process only.
            process = subprocess.Popen(command, env=variables, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                       start_new_session=True)  # fmt: skip
    except OSError as error:
        raise InputError(f"cannot be started: {error.strerror}; build it again", command[0]) from error
    return _Job(index, case, command, folder, process, time.monotonic())


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends a process and what it started; does nothing to one that has ended."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _conclude(subject: Subject, job: _Job, problem: str) -> CaseResult:
    status = job.process.returncode
    if not problem and status != 0:
        how = f"exit status {status}" if status > 0 else f"signal {-status}"
        problem = f"program ended with {how}: {_last_words(job.folder / 'program.log')}"
    evaluation = subject.evaluate(job.case, job.folder, problem)
    return CaseResult(job.case, evaluation, job.command, time.monotonic() - job.started_s, subject.describe(job.case))


def _last_words(log: Path) -> str:
    """The last line that the program wrote, shortened."""
    with log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - 4096))
        lines = file.read().decode("utf-8", errors="replace").split("\n")
    spoken = [line.strip() for line in lines if line.strip()]
    return spoken[-1][:_REASON_CHARACTERS_MAX] if spoken else "it said nothing"
