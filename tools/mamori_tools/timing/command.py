# SPDX-License-Identifier: Apache-2.0
"""`./mamori timing SYSTEM`: check, build, run, read, analyse, show.

@satisfies SWR-TIM-011, SWR-TIM-024, SWR-TIM-025, SWR-TIM-029, SWR-TIM-045      Design: docs/design/timing.md#run
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.host.arguments import DIGITS_MAX, Command, add_jobs, at_least_one
from mamori_tools.host.console import Screen
from mamori_tools.host.environment import collect_environment
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_INTERRUPTED
from mamori_tools.host.plans import build_plan
from mamori_tools.host.process import read_tail
from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Context, Step, all_passed, run_steps
from mamori_tools.timing.baseline import Baseline, check_ratios, check_table, list_ratios, load_baseline, write_baseline
from mamori_tools.timing.environment import collect_setting, collect_state
from mamori_tools.timing.reader import FILES, SWITCH_FILES, Measurement, read_measurement
from mamori_tools.timing.report import NO_LIMITS, Limits, Report, make_record, make_report, write_record
from mamori_tools.timing.request_shift import check_requests
from mamori_tools.timing.run import Ending, check_load, make_load, run_program, undisturbed
from mamori_tools.timing.system import System, find_system
from mamori_tools.timing.text import make_text
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import write_text

CYCLES = 60_000
PICTURES = ("release_lateness", "execution_time", "chain_latency", "over_time")
RESULTS = ("timing.json", "timing.txt", "timing.perfetto-trace", *(f"{name}{suffix}" for name in PICTURES for suffix in (".svg", ".png")))
PROBE_S = 20.0
"""If cycle plus start take longer, the program does not run in real time."""
TAIL_LINES = 10
PROGRAM_FAILED, PROGRAM_USAGE = 1, 2


@dataclass(frozen=True)
class Request:
    """The request of the user."""

    system: str
    cycles: int = CYCLES
    out: Path | None = None
    with_load: bool = False
    with_requests: bool = False
    check: Path | None = None
    accept: Path | None = None
    arguments: tuple[str, ...] = ()
    wants_json: bool = False
    limits: Limits = NO_LIMITS


@dataclass(frozen=True)
class Job:
    """A checked request. `folder` receives the results, `data` the files of the program."""

    request: Request
    system: System
    baseline: Baseline | None
    folder: Path
    context: Context

    @property
    def data(self) -> Path:
        return self.folder / "run"

    @property
    def log(self) -> Path:
        return self.folder / "program.log"

    def make_argv(self, cycles: int, folder: Path) -> list[str]:
        words = [*(("--requests",) if self.request.with_requests else ()), *self.system.arguments, *self.request.arguments]
        return [str(self.system.program), "timing", "--cycles", str(cycles), "--out", str(folder), *words]


def timing(request: Request, jobs: int) -> int:
    """@return exit status: 0, 1 (a finding), 4 (without real-time privileges) or 130 (stopped). @raise InputError."""
    job = check(request, jobs)
    _prepare_folder(job)
    if not build_system(job.system, job.context):
        return EXIT_FAILED
    if not os.access(job.system.program, os.X_OK):
        raise InputError(f"timing: '{job.system.program}' was not built; correct 'program' in {request.system}/timing.toml")
    expected_s = _probe(job)
    if expected_s is None:
        return EXIT_FAILED
    host: dict[str, Any] = {"setting": collect_setting(), "before": collect_state()}
    ending, problems = _measure(job, expected_s)
    host["after"] = collect_state()
    with undisturbed():
        return _conclude(job, ending, problems, host)


def check(request: Request, jobs: int) -> Job:
    """All checks that are possible before work begins. @raise InputError."""
    project = Project(ROOT)
    if request.check is not None and request.accept is not None:
        raise InputError("timing: --check and --accept exclude each other; use --check first, then --accept")
    system = find_system(request.system, project)
    baseline = None if request.check is None else load_baseline(request.check, system.name)
    if request.with_load:
        check_load()
    folder = (request.out or system.project.evidence / "timing" / system.name).absolute()
    check_folder(folder)
    if request.accept is not None:
        if request.accept.is_dir():
            raise InputError(f"timing: '{request.accept}' is a folder; specify a file for the baseline")
        check_folder(request.accept.absolute().parent)
    return Job(request, system, baseline, folder, Context(system.project, jobs, Screen(to_stderr=True)))


def check_folder(folder: Path, command: str = "timing") -> None:
    """@param command name of the command, for the message. @raise InputError if no file can be written there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"{command}: {folder}: not writable ({error.strerror}); specify a writable folder") from error


def _prepare_folder(job: Job) -> None:
    """Removes earlier results, so that none of them counts for this run. @raise InputError."""
    try:
        for path in [*(job.folder / name for name in RESULTS), job.log, *(job.data / name for name in (*FILES, *SWITCH_FILES))]:
            path.unlink(missing_ok=True)
        job.data.mkdir(exist_ok=True)
        job.log.write_text("", encoding="utf-8")
    except OSError as error:
        raise InputError(f"timing: '{error.filename}' prevents the output of a result: {error.strerror}; specify another folder") from error


def build_system(system: System, context: Context) -> bool:
    """Builds `system` if necessary. @return whether its program exists; errors were already shown."""
    if not system.target:
        return True
    project = context.project
    if project.root != ROOT:
        return all_passed(run_steps(build_plan(project, system.target), context))
    step = Step(
        name=f"build {system.target}",
        commands=(
            ("cmake", "-S", str(project.root), "--preset", project.preset),
            ("cmake", "--build", str(project.build), "--target", system.target, "--parallel", str(context.jobs)),
        ),
    )
    return all_passed(run_steps((step,), context))


def _probe(job: Job) -> float | None:
    """Runs one cycle. Checks the files of the program, its table against that of the baseline, and the duration of a cycle.

    @return duration of all cycles [s]; None if the program failed, after an error message. @raise InputError.
    """
    with tempfile.TemporaryDirectory(prefix="mamori-timing-") as scratch:
        ending = run_program(job.make_argv(1, Path(scratch)), job.log, PROBE_S, lambda _: None)
        if ending.was_interrupted:
            raise KeyboardInterrupt
        if ending.status == PROGRAM_USAGE:
            raise InputError(f"timing: {job.system.program.name} rejects its arguments: {_get_last_line(job.log)}")
        if ending.reason:
            show_failure(job.context.screen, ending.reason, job.log)
            return None
        run = read_measurement(Path(scratch))
    if job.baseline is not None:
        check_table(job.baseline, run.table)
    if job.request.with_requests:
        check_requests(run, job.request.cycles)
    return job.request.cycles * run.table.frame_ns / 1e9


def _measure(job: Job, expected_s: float) -> tuple[Ending, list[str]]:
    screen, name = job.context.screen, job.system.name
    screen.say(f"measuring {name}: {job.request.cycles} cycles, {expected_s:.0f} s{' with stress-ng' if job.request.with_load else ''}")
    with make_load(job.request.with_load, expected_s, job.folder / "load.log") as problems, screen.show_work(f"measure {name}") as tick:
        ending = run_program(job.make_argv(job.request.cycles, job.data), job.log, expected_s,
                             lambda passed: tick(f"of {expected_s:.0f} s"))  # fmt: skip
    return ending, problems


def _conclude(job: Job, ending: Ending, problems: Sequence[str], host: dict[str, Any]) -> int:
    """@return exit status."""
    findings = [*([ending.reason] if ending.reason else []), *problems]
    try:
        run = read_measurement(job.data)
        if run.cycles_asked != job.request.cycles:
            raise InputError(f"contains {run.cycles_asked} cycles, {job.request.cycles} were requested", job.data / "run.json")
    except InputError as error:
        if not ending.reason and not ending.was_stopped:
            raise
        show_failure(job.context.screen, ending.reason or "stopped before there were results", job.log)
        job.context.screen.say(f"nothing to analyse: {error}")
        return EXIT_INTERRUPTED if ending.was_stopped else EXIT_FAILED
    report = make_report(job.system.name, run, host, job.request.with_load, ending.was_stopped, [*findings, *_check_baseline(job, run)],
                         job.request.limits)  # fmt: skip
    return show(job, report)


def _check_baseline(job: Job, run: Measurement) -> list[str]:
    """Findings of --check."""
    if job.baseline is None:
        return []
    check_table(job.baseline, run.table)
    from mamori_tools.timing.analysis import list_components

    return check_ratios(job.baseline, list_ratios(list_components(run), run.reference_ns))


def show(job: Job, report: Report) -> int:
    """Writes all results, figures first and pictures last, and prints one screen. @return exit status."""
    screen = job.context.screen
    environment = collect_environment(job.context.project, ["./mamori", *sys.argv[1:]])
    record = make_record(report, environment)
    paths = [write_record(record, job.folder), job.folder / "timing.txt"]
    write_text(paths[-1], make_text(report, is_whole=True))
    print_result(make_text(report, is_whole=False), record if job.request.wants_json else None)
    from mamori_tools.timing.picture import draw_report

    paths += draw_report(report, job.folder)
    from mamori_tools.timing.trace_file import FILE, write_trace

    paths.append(write_trace(job.folder / FILE, report.system, report.run, report.misses))
    screen.say(f"results: {job.folder}: {', '.join(path.name for path in paths)}")
    if job.request.accept is not None:
        _accept(job, report, job.request.accept)
    return report.status


def _accept(job: Job, report: Report, path: Path) -> None:
    if report.run.is_partial or report.findings:
        job.context.screen.say(f"not accepted: {path} is unchanged, because the run {'was stopped' if report.run.is_partial else 'has findings'}")
        return
    write_baseline(path, report.system, report.run.table, list_ratios(report.components, report.run.reference_ns))
    job.context.screen.say(f"accepted: {path} contains the ratios of this run; state the reason of the change in the commit")


def print_result(text: str, record: dict[str, Any] | None) -> None:
    """Prints the requested output to standard output: `record` as JSON, or `text`. All other output goes to standard error."""
    if record is not None:
        print(json.dumps(record, indent=1))
        return
    out = Screen()
    for line in text.splitlines():
        out.say(line, style="bold red" if line.startswith(("***", "finding:")) else "")


def show_failure(screen: Screen, reason: str, log: Path) -> None:
    """The reason, the last output lines of the program, and the path of the complete output."""
    screen.say(f"failed: {reason}", style="bold red")
    for line in read_tail(log, TAIL_LINES):
        screen.say(f"  | {line}")
    screen.say(f"log: {log}")


def _get_last_line(log: Path) -> str:
    return (read_tail(log, 1) or [f"see {log}"])[0]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("system", metavar="SYSTEM",
                        help="a folder with a timing.toml, for example examples/safe_arm or a folder of your project that calls "
                             "find_package(mamori); or a program")  # fmt: skip
    parser.add_argument("--cycles", type=at_least_one, default=CYCLES, metavar="N", help="major frames to run (at least 1); default: %(default)s")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for the results; default: build/host-release/evidence/timing/NAME")
    parser.add_argument("--load", action="store_true", help="keep all processors busy with stress-ng during the run")
    parser.add_argument("--requests", action="store_true",
                        help="measure how far introspection requests from outside shift the start of each window; the program must support them")  # fmt: skip
    parser.add_argument("--check", type=Path, metavar="BASELINE",
                        help="end with status 1 if the ratio of a component to the reference work exceeds the limit in this file")  # fmt: skip
    parser.add_argument("--accept", type=Path, metavar="BASELINE",
                        help="write the ratios of this run to this file, if there are no findings; not together with --check")  # fmt: skip
    parser.add_argument("--max-missed", type=_missed, metavar="N",
                        help="end with status 1 if more than N windows were skipped or overran, from any cause")  # fmt: skip
    parser.add_argument("--max-late", type=_microseconds, metavar="US",
                        help="end with status 1 if a window started more than this many microseconds late, from any cause")  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print the record as JSON instead of text")
    add_jobs(parser, "of the build")


def _missed(text: str) -> int:
    """Type of --max-missed."""
    if not (text.isascii() and text.isdecimal()) or len(text) > DIGITS_MAX:
        raise argparse.ArgumentTypeError(f"'{text[:DIGITS_MAX]}' is not an integer of at least 0 with at most {DIGITS_MAX} digits")
    return int(text)


def _microseconds(text: str) -> int:
    """Type of --max-late. @return [ns]."""
    match = re.fullmatch(r"\d{1,12}(\.\d{1,3})?", text, re.ASCII)
    value = round(float(text) * 1000) if match else 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"'{text[:20]}' is not a positive number of microseconds with at most three decimals")
    return value


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    request = Request(arguments.system, arguments.cycles, arguments.out, arguments.load, arguments.requests, arguments.check,
                      arguments.accept, arguments.passed_on, arguments.json, Limits(arguments.max_missed, arguments.max_late))  # fmt: skip
    return timing(request, arguments.jobs)


COMMAND = Command(
    add_arguments, run, "run a system in real time: lateness, execution times, latencies and the responsible component",
    "Runs a system in real time. Shows release lateness, execution time and end-to-end latency for each window, component and event chain, "
    "next to the values in virtual time. Shows each overrun and skipped window with its cycle and its cause (a component, another thread of "
    "the program, or outside), and the margins of budgets. Writes timing.json, timing.txt and pictures. ARGUMENTS are forwarded to the program.",
    {0: "measured", 1: "a finding (overrun, declared worst case exceeded, --requests, --check, --max-missed, --max-late, program failed)",
     4: "measured without all real-time privileges", 130: "stopped by Ctrl-C; the measurements so far are kept and marked partial"},
    usage_end="[-- ARGUMENTS]",
    examples=("timing examples/safe_arm --cycles 10000 --load",))  # fmt: skip
