# SPDX-License-Identifier: Apache-2.0
"""Runs the cases of a campaign, stores each result once its case has finished, and writes the evidence after the last one.

@satisfies SWR-CMP-005, SWR-CMP-006, SWR-CMP-007, SWR-CMP-009      Design: docs/design/simulation.md#campaign-runs
"""

from __future__ import annotations

import contextlib
import datetime
import hashlib
import json
import os
import platform
import re
import shlex
import shutil
import tempfile
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.campaign.case import Case, Evaluation, Selection
from mamori_tools.campaign.result import CampaignResult, CaseResult
from mamori_tools.campaign.store import SELECTION, Key, Store, calc_result_hash, write_durably
from mamori_tools.campaign.subject import Expansion, Subject, load_subject
from mamori_tools.campaign.work import Outcome, Program, Work, read_program, run_local
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

DEFAULT_TIMEOUT_S = 120.0
"""Wall time after which a run is killed [s]; a run takes about a second."""

_CASE_FOLDER = re.compile(r"[a-z][a-z0-9_]*-\d+")
_ATTEMPT = ".attempt-"
_COMMIT = "MAMORI_COMMIT"

Progress = Callable[[CaseResult, int, int], None]
"""Called for each evaluated case: the result, number of finished cases, number of all cases."""


@dataclass(frozen=True)
class Settings:
    """How a campaign is run. `jobs`: number of parallel processes, None: one per usable core. `dask`: `local` or an address; None: no
    cluster."""

    program: Path
    files: Mapping[str, Path]
    evidence: Path
    jobs: int | None = None
    timeout_s: float = DEFAULT_TIMEOUT_S
    dask: str | None = None
    restart: bool = False
    environment: Mapping[str, Any] | None = None


def run_campaign(selection: Selection, settings: Settings, progress: Progress | None = None) -> CampaignResult:
    """Runs and evaluates all cases, writes `campaign/` and `junit/campaign.xml` below `settings.evidence`.

    Finished cases of an earlier call with the same plan, program, inputs and settings are kept. campaign.json of an earlier campaign is
    removed first, so that an aborted campaign leaves none. `environment`: None for evidence/environment.json, or the data of this process.
    Its commit is passed to the program as MAMORI_COMMIT, so that each run names it.
    A case whose program fails, hangs or writes no complete record is a failed case. On any exception, including KeyboardInterrupt, the
    running processes are ended.
    Raises InputError: program or model missing, an invalid number, an instant that the motion lacks, no disk space, results of another
    campaign; MissingError: no Dask; WorkError: the program changed, or the cluster was lost.
    """
    campaign = _Campaign(selection, settings)
    folder = settings.evidence / "campaign"
    with contextlib.closing(Store(folder)) as store:
        store.begin(campaign.key, settings.restart)
        stored = store.read_results()
        _clear(settings.evidence, set(stored))
        campaign.write_inputs(folder)
        results = {case.id: campaign.make_result(case, *stored[case.id]) for case in campaign.cases if case.id in stored}
        with contextlib.closing(campaign.run({case.id for case in campaign.cases} - set(stored), folder)) as finished:
            for result in finished:
                store.add(result)
                results[result.case.id] = result
                if progress is not None:
                    progress(result, len(results), len(campaign.cases))
        ordered = tuple(results[case.id] for case in campaign.cases)
        store.merge(ordered)
        result_hash = calc_result_hash([(each.case, each.evaluation) for each in ordered])
        whole = CampaignResult(ordered, campaign.environment, result_hash, len(stored), campaign.notes)
        whole.write(settings.evidence)
    return whole


@dataclass(frozen=True)
class Replay:
    """A repeated case. `stored` is its earlier result; None if the same campaign has none."""

    result: CaseResult
    stored: Evaluation | None

    @property
    def is_equal(self) -> bool | None:
        """Whether verdict, checks and record equal those of the stored result; None if there is none."""
        if self.stored is None:
            return None
        return calc_result_hash([(self.result.case, self.result.evaluation)]) == calc_result_hash([(self.result.case, self.stored)])


def replay_case(selection: Selection, settings: Settings, name: str) -> Replay:
    """Repeats one case in the new folder `campaign/replay/<case id>`. Raises like `run_campaign`; InputError for an unknown case."""
    campaign = _Campaign(selection, settings)
    campaign.find_case(name)
    folder = settings.evidence / "campaign"
    with contextlib.closing(Store(folder)) as store:
        stored = store.find_result(campaign.key, name)
        with _guard_folder(folder):
            shutil.rmtree(folder / "replay", ignore_errors=True)
            (folder / "replay").mkdir()
        campaign.write_inputs(folder / "replay")
        [result] = campaign.run({name}, folder / "replay")
    return Replay(result, stored)


class _Campaign:
    """The work of one call: cases, program, inputs, and the key under which its results are stored."""

    def __init__(self, selection: Selection, settings: Settings) -> None:
        if settings.jobs is not None and settings.jobs < 1:
            raise InputError(f"{settings.jobs} jobs; write 1 or more")
        if not settings.timeout_s > 0.0:
            raise InputError(f"time-out of {settings.timeout_s:g} s; write a number above 0")
        self._settings = settings
        self._selection = selection
        self._subject: Subject = load_subject(selection.plan.subject)
        self._program: Program = read_program(settings.program)
        self._expansion: Expansion = self._subject.expand(selection, settings.files)
        self.environment = find_environment(settings.evidence) if settings.environment is None else settings.environment
        commit = self.environment.get("commit", os.environ.get(_COMMIT))
        self._variables = {_COMMIT: commit} if isinstance(commit, str) else {}

    @property
    def cases(self) -> tuple[Case, ...]:
        return self._expansion.cases

    @property
    def notes(self) -> tuple[str, ...]:
        return self._expansion.notes

    @property
    def key(self) -> Key:
        """All inputs that determine the results."""
        plan = self._selection.plan
        inputs = {name: hashlib.sha256(content).hexdigest() for name, content in self._expansion.inputs.items()}
        return {
            "subject": plan.subject,
            "plan": hashlib.sha256(plan.path.read_bytes()).hexdigest(),
            "program": self._program.sha256,
            **inputs,
            SELECTION: " ".join(case.id for case in self.cases),
            "seed": str(plan.seed),
            "timeout": f"{self._settings.timeout_s:g} s",
            "commit": self._variables.get(_COMMIT, ""),
        }

    def find_case(self, name: str) -> Case:
        """Raises InputError for an unknown case."""
        names = [case.id for case in self.cases]
        if name not in names:
            raise InputError(f"unknown case '{name}'; {nearest_names(name, names)}; --list shows the scenarios")
        return self.cases[names.index(name)]

    def write_inputs(self, folder: Path) -> None:
        with _guard_folder(folder):
            for name, content in self._expansion.inputs.items():
                write_durably(folder / name, content)

    def run(self, names: set[str], folder: Path) -> Generator[CaseResult]:
        """Runs the cases `names`; yields each with its files in the folder with its id."""
        with _guard_folder(folder):
            attempt = Path(tempfile.mkdtemp(prefix=_ATTEMPT, dir=folder))
        try:
            works = [self._make_work(case, Path(attempt.name, case.id)) for case in self.cases if case.id in names]
            with contextlib.closing(self._start(works, folder)) as outcomes:
                for outcome in outcomes:
                    place = folder / outcome.case
                    with _guard_folder(place):
                        shutil.rmtree(place, ignore_errors=True)
                        (attempt / outcome.case).rename(place)
                    case = self.find_case(outcome.case)
                    yield self.make_result(case, self._subject.evaluate(case, place, outcome.problem), outcome.wall_s)
        finally:
            shutil.rmtree(attempt, ignore_errors=True)

    def make_result(self, case: Case, evaluation: Evaluation, wall_s: float) -> CaseResult:
        folder = (self._settings.evidence / "campaign").absolute()
        command = self._subject.command(case, self._program.path, folder, folder / case.id)
        return CaseResult(case, evaluation, command, wall_s, self._subject.describe(case), self._make_reproduction(case, evaluation, command))

    def _make_reproduction(self, case: Case, evaluation: Evaluation, command: tuple[str, ...]) -> str:
        """The tested commit, and one command that repeats the case: program, configuration, fault plan, seed."""
        plan = self._selection.plan
        if all(scenario in plan.scenarios for scenario in self._selection.scenarios):
            files = [word for option, path in self._settings.files.items() for word in (f"--{option}", str(path.absolute()))]
            command = ("./mamori", "campaign", str(plan.path.absolute()), "--replay", case.id, "--program", str(self._program.path), *files,
                       "--out", str(self._settings.evidence.absolute()), "--timeout", f"{self._settings.timeout_s:g}")  # fmt: skip
        commit = evaluation.run.get("commit")
        return f"at commit {commit if isinstance(commit, str) else 'unknown'}: {shlex.join(command)}"

    def _make_work(self, case: Case, folder: Path) -> Work:
        command = self._subject.command(case, self._program.path, Path(), folder)
        return Work(case.id, self._program, command, folder, self._variables, self._settings.timeout_s)

    def _start(self, works: list[Work], folder: Path) -> Generator[Outcome]:
        jobs = self._settings.jobs or len(os.sched_getaffinity(0))
        at_once_max = self._subject.jobs_max
        if self._settings.dask is None or not works:
            return run_local(works, folder, min(jobs, at_once_max or jobs))
        from mamori_tools.campaign.dask_pool import run_on_dask

        return run_on_dask(works, self._expansion.inputs, folder, self._settings.dask, min(jobs, len(works)), at_once_max)


def find_environment(evidence: Path) -> dict[str, Any]:
    """Content of evidence/environment.json; without it, the data that this process has about its host."""
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


def _clear(evidence: Path, finished: set[str]) -> None:
    """Removes the evidence of an earlier campaign and the remains of a killed one, except the folders of the cases `finished`."""
    folder = evidence / "campaign"
    with _guard_folder(evidence):
        (evidence / "junit").mkdir(parents=True, exist_ok=True)
        for path in (evidence / "junit" / "campaign.xml", folder / "campaign.json", folder / "campaign.parquet"):
            path.unlink(missing_ok=True)
        for old in folder.iterdir():
            is_case = _CASE_FOLDER.fullmatch(old.name) and old.name not in finished
            if (is_case or old.name.startswith(_ATTEMPT)) and old.is_dir() and not old.is_symlink():
                # A program of a killed campaign may still write to this folder.
                shutil.rmtree(old, ignore_errors=not is_case)


@contextlib.contextmanager
def _guard_folder(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise InputError(f"evidence cannot be written: {error.strerror}; check the folder", folder) from error
