# SPDX-License-Identifier: Apache-2.0
"""`./mamori cost SYSTEM`: check, build, count, time, evaluate, show.

@satisfies SWR-TIM-036, SWR-TIM-039      Design: docs/design/cost.md#cost
"""

from __future__ import annotations

import argparse
import dataclasses
import os
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.cost.baseline import Baseline, check_origin, judge_growth, load_baseline, write_baseline
from mamori_tools.cost.classes import CostPlan, InputClass, choose, read_plan
from mamori_tools.cost.report import Report, make_record, make_report, make_text, write_results
from mamori_tools.cost.run import ClassRun, run_class
from mamori_tools.host.arguments import Command, add_jobs
from mamori_tools.host.console import Screen
from mamori_tools.host.environment import collect_environment
from mamori_tools.host.exit_status import EXIT_FAILED
from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Context
from mamori_tools.timing.command import build_system, check_folder, print_result, show_failure
from mamori_tools.timing.environment import collect_setting, collect_state
from mamori_tools.timing.run import undisturbed
from mamori_tools.timing.system import FILE, System, find_system
from mamori_trace.base.errors import InputError, WorkError

RESULTS = ("cost.json", "cost.txt")
TOOL = "valgrind"


@dataclass(frozen=True)
class Request:
    """The request of the user. Without classes: all classes."""

    system: str
    classes: tuple[str, ...] = ()
    out: Path | None = None
    check: Path | None = None
    accept: Path | None = None
    wants_json: bool = False


@dataclass(frozen=True)
class Job:
    """A checked request."""

    request: Request
    system: System
    plan: CostPlan
    classes: tuple[InputClass, ...]
    baseline: Baseline | None
    folder: Path
    context: Context

    @property
    def log(self) -> Path:
        return self.folder / "program.log"


def cost(request: Request, jobs: int) -> int:
    """@return exit status: 0 or 1 (a finding, or the program failed). @raise InputError, KeyboardInterrupt."""
    job = check(request, jobs)
    _prepare_folder(job)
    if not build_system(job.system, job.context):
        return EXIT_FAILED
    if not os.access(job.system.program, os.X_OK):
        raise InputError(f"cost: '{job.system.program}' was not built; correct 'program' in {request.system}/{FILE}")
    host: dict[str, Any] = {"setting": collect_setting(), "before": collect_state()}
    try:
        runs = _count(job)
    except WorkError as error:
        show_failure(job.context.screen, str(error), job.log)
        return EXIT_FAILED
    host["after"] = collect_state()
    with undisturbed():
        return _conclude(job, runs, host)


def check(request: Request, jobs: int) -> Job:
    """All checks that are possible before work begins. @raise InputError."""
    project = Project(ROOT)
    if request.check is not None and request.accept is not None:
        raise InputError("cost: --check and --accept exclude each other; check first, accept what you want to keep")
    if request.classes and request.accept is not None:
        raise InputError("cost: --accept takes all classes of inputs; leave --class out")
    system = find_system(request.system, project, "cost")
    plan = read_plan(system, system.project)
    classes = choose(plan, request.classes)
    baseline = None if request.check is None else load_baseline(request.check, system.name, plan.classes)
    if baseline is not None:
        names = {one.name for one in classes}
        baseline = dataclasses.replace(baseline, maxima={key: count for key, count in baseline.maxima.items() if key[0] in names})
    if shutil.which(TOOL) is None:
        raise InputError(f"cost: {TOOL} is missing, which counts the instructions; install the package {TOOL}")
    folder = (request.out or system.project.evidence / "cost" / system.name).absolute()
    check_folder(folder, "cost")
    if request.accept is not None:
        if request.accept.is_dir():
            raise InputError(f"cost: '{request.accept}' is a folder; name the file that the baseline is to be written to")
        check_folder(request.accept.absolute().parent, "cost")
    return Job(request, system, plan, classes, baseline, folder, Context(system.project, jobs, Screen(to_stderr=True)))


def _prepare_folder(job: Job) -> None:
    """Removes earlier results, so that none of them counts for this run. @raise InputError."""
    try:
        for name in RESULTS:
            (job.folder / name).unlink(missing_ok=True)
        job.log.write_text("", encoding="utf-8")
    except OSError as error:
        raise InputError(f"cost: '{error.filename}' is in the way of a result: {error.strerror}; name another folder") from error


def _count(job: Job) -> list[ClassRun]:
    """@raise WorkError, InputError, KeyboardInterrupt."""
    runs: list[ClassRun] = []
    screen = job.context.screen
    for one in job.classes:
        with screen.show_work(f"count {job.system.name}, class {one.name}") as tick:
            runs.append(run_class(job.system, one, job.log, tick))
        if job.baseline is not None:
            check_origin(job.baseline, runs[0].table, runs[0].facts.build)
        if runs[-1].table != runs[0].table:
            raise WorkError(f"class '{one.name}' has another table than '{job.classes[0].name}'; one system has one table")
    if not any(len(run.steps) for run in runs):
        raise WorkError("no step was counted in any class; count other cycles")
    return runs


def _conclude(job: Job, runs: list[ClassRun], host: dict[str, Any]) -> int:
    """@return exit status."""
    screen, request = job.context.screen, job.request
    report = make_report(job.system.name, job.plan, runs, host)
    if job.baseline is not None:
        growth = judge_growth(job.baseline, report.steps, job.plan.growth_percent)
        report = dataclasses.replace(report, findings=[*report.findings, *growth])
    environment = collect_environment(job.context.project, ["./mamori", *sys.argv[1:]])
    paths = write_results(report, environment, job.folder)
    print_result(make_text(report), make_record(report, environment) if request.wants_json else None)
    screen.say(f"results: {job.folder}: {', '.join(path.name for path in paths)}")
    if request.accept is not None:
        _accept(job, report, request.accept)
    return report.status


def _accept(job: Job, report: Report, path: Path) -> None:
    if report.findings:
        job.context.screen.say(f"not accepted: {path} is as it was, since there are findings")
        return
    write_baseline(path, report.system, report.runs[0].table, job.plan.classes, report.build, report.steps)
    job.context.screen.say(f"accepted: {path} holds the maxima of this run; say in the commit why they changed")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("system", metavar="SYSTEM",
                        help="a folder with a timing.toml that has a [cost], for example examples/safe_arm or a folder of a project of yours")  # fmt: skip
    parser.add_argument("--class", nargs="+", default=[], metavar="NAME", action="extend", dest="classes",
                        help="only these classes of inputs; default: all")  # fmt: skip
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the results; default: build/host-release/evidence/cost/NAME")
    parser.add_argument("--check", type=Path, metavar="BASELINE",
                        help="end with status 1 when a maximum count grew by more than [cost] allows; only for the same compiler")  # fmt: skip
    parser.add_argument("--accept", type=Path, metavar="BASELINE",
                        help="write the maximum counts to this file, if there are no findings; not together with --check")  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print the record as JSON instead of text")
    add_jobs(parser, "of the build")


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    request = Request(arguments.system, tuple(arguments.classes), arguments.out, arguments.check, arguments.accept, arguments.json)
    return cost(request, arguments.jobs)


COMMAND = Command(
    add_arguments, run, "exact instruction counts of each step of each component, compared with its budgets",
    "Counts the instructions of each step of each component exactly (callgrind), for each class of inputs that SYSTEM declares. Shows minimum, "
    "median and maximum, and the cycle of the maximum. Converts counts to times by a ratio that it measures on this host. Adds the "
    "declared margin to these times, and compares the sums with the window budgets and the declared worst cases of components. "
    "Writes cost.json and cost.txt.",
    {0: "counted", 1: "a finding (limit below the maximum and its margin, --check, program failed)",
     130: "stopped by Ctrl-C; no result is written"},
    examples=("cost examples/safe_arm --json",))  # fmt: skip
