# SPDX-License-Identifier: Apache-2.0
"""Runs a table of steps. Each step is timed, logged and evaluated; a failed step stops only the steps that require it.

@satisfies SWR-CLI-006, SWR-CLI-007      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

import os
import resource
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import TextIO

from mamori_tools.host.console import Screen
from mamori_tools.host.junit import Counts, count_results, list_failures
from mamori_tools.host.process import Tick, read_tail, run_logged
from mamori_tools.host.project import Project
from mamori_trace.base.errors import InputError, WorkError

TAIL_LINES = 20
FAILURES_SHOWN = 10
FAILURE_LENGTH = 200
INCONCLUSIVE = "inconclusive"


class Tier(IntEnum):
    """The three variants of `./mamori test`. Each includes all steps of the previous one."""

    QUICK = 0
    GATE = 1
    ALL = 2


@dataclass(frozen=True)
class Context:
    """The data of the run that are available to its steps."""

    project: Project
    jobs: int
    screen: Screen = field(default_factory=Screen)
    outcomes: dict[str, Outcome] = field(default_factory=dict)  # of completed steps


Action = Callable[[Context, Tick, TextIO], None]
"""The work of a step without a program: receives the run, a function for screen messages, and the open log. @raise WorkError to fail."""


@dataclass(frozen=True)
class Step:
    """One row of a table of steps: `commands` run in order in the project folder, followed by `function`.

    In a command, `{root}`, `{build}`, `{evidence}`, `{junit}`, `{python}`, `{jobs}` are replaced by their values, and `{result}` by a
    temporary name. That file becomes `<evidence>/junit/<result>` when the command has ended. An argument that is a key of `lists`
    (`{files}`) is replaced by several arguments.
    """

    name: str
    commands: tuple[tuple[str, ...], ...] = ()
    function: Action | None = None
    needs: tuple[str, ...] = ()
    lists: dict[str, list[str]] = field(default_factory=dict)
    result: str = ""
    junit: str = ""  # folder of its new JUnit result files, relative to the root; default: that of the evidence
    produces: str = ""  # file, relative to the root, that the step must write
    accepted: tuple[int, ...] = (0,)  # exit statuses of a command that completed its work
    inconclusive: tuple[int, ...] = ()  # exit statuses of a command that is inconclusive on this host
    tier: Tier = Tier.GATE  # the smallest run with this step


@dataclass(frozen=True)
class Outcome:
    """The outcome of one step."""

    name: str
    verdict: str  # passed, failed or skipped
    seconds: float  # wall time
    cpu_s: float  # user and system time of the child processes
    counts: Counts
    log: Path
    reason: str = ""
    failures: tuple[str, ...] = ()


def run_steps(steps: Sequence[Step], context: Context) -> list[Outcome]:
    """Runs all `steps` in order. @return one outcome per step."""
    context.project.logs.mkdir(parents=True, exist_ok=True)
    outcomes = context.outcomes
    for number, step in enumerate(steps, start=1):
        missing = [name for name in step.needs if name in outcomes and outcomes[name].verdict != "passed"]
        if missing:
            reason = f"needs: {', '.join(missing)}"
            outcome = Outcome(step.name, "skipped", 0.0, 0.0, Counts(skipped=1), _get_log(step, context), reason)
        else:
            with context.screen.show_work(f"[{number}/{len(steps)}] {step.name}") as tick:
                outcome = _run_step(step, context, tick)
        outcomes[step.name] = outcome
        _show(outcome, number, len(steps), context)
    return list(outcomes.values())


def total(outcomes: Sequence[Outcome]) -> Counts:
    """All results of all steps."""
    counts = Counts()
    for outcome in outcomes:
        counts += outcome.counts
    return counts


def all_passed(outcomes: Sequence[Outcome]) -> bool:
    """True if every step ran and passed; a skipped step is not a pass."""
    return all(outcome.verdict == "passed" for outcome in outcomes)


def _get_log(step: Step, context: Context) -> Path:
    return context.project.logs / f"{step.name.replace(' ', '-').replace('+', 'x').replace('/', '')}.log"


def _run_step(step: Step, context: Context, tick: Tick) -> Outcome:
    log = _get_log(step, context)
    log.write_text("", encoding="utf-8")
    folder = context.project.root / step.junit if step.junit else context.project.junit
    product = context.project.root / step.produces
    before = {path: _get_stamp(path) for path in (*folder.glob("*.xml"), product)}
    start, cpu_start = time.monotonic(), _get_children_cpu_s()
    reason = _do_work(step, context, log, tick)
    if reason.startswith(INCONCLUSIVE):
        return Outcome(step.name, "passed", time.monotonic() - start, _get_children_cpu_s() - cpu_start, Counts(skipped=1), log, reason)
    if not reason and step.produces and _get_stamp(product) in (None, before[product]):
        reason = f"{step.produces} was not written"
    files = [path for path in sorted(folder.glob("*.xml")) if _get_stamp(path) != before.get(path)]
    counts = count_results(files)
    if not reason and counts.failed:
        reason = f"{counts.failed} results failed"
    if reason and not counts.failed:
        counts += Counts(failed=1)  # the step failed without a failed result
    elif counts.total == 0:
        counts = Counts(passed=1)  # a step without results counts as one result
    verdict = "failed" if reason else "passed"
    failures = tuple(list_failures(files)) if counts.failed else ()
    cpu_s = _get_children_cpu_s() - cpu_start
    return Outcome(step.name, verdict, time.monotonic() - start, cpu_s, counts, log, reason, failures)


def _get_children_cpu_s() -> float:
    """User and system time of all ended child processes and of their ended children, in seconds."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _get_stamp(path: Path) -> tuple[int, int, int] | None:
    """Values that change when a file is written or replaced; empty if there is no file. Times are not sufficient: two files that are
    written within one tick of the file system clock have equal times."""
    if not path.is_file():
        return None
    status = path.stat()
    return status.st_ino, status.st_size, status.st_mtime_ns


def _do_work(step: Step, context: Context, log: Path, tick: Tick) -> str:
    """@return why the step failed; empty if it passed."""
    project = context.project
    part = project.junit / f".{step.result}.part"
    values = {"root": str(project.root), "build": str(project.build), "evidence": str(project.evidence),
              "junit": str(project.junit), "python": sys.executable, "jobs": str(context.jobs), "result": str(part)}
    try:
        reason = _run_commands(step, values, part, context, log, tick)
    finally:
        part.unlink(missing_ok=True)
    if reason and not reason.startswith(INCONCLUSIVE):
        return reason
    if step.function is not None:
        with log.open("a", encoding="utf-8") as out:
            try:
                step.function(context, tick, out)
            except (WorkError, InputError, OSError) as error:
                print(error, file=out)
                return str(error)
    return reason


def _run_commands(step: Step, values: dict[str, str], part: Path, context: Context, log: Path, tick: Tick) -> str:
    """@return which command failed; empty if none did."""
    for command in step.commands:
        argv = [word for template in command for word in _expand(template, step.lists, values)]
        status = run_logged(argv, log, context.project.root, tick)
        if step.result and part.exists():
            os.replace(part, context.project.junit / step.result)
        if status in step.inconclusive:
            return f"{INCONCLUSIVE}: {Path(argv[0]).name} ended with status {status}; the log has the figure"
        if status not in step.accepted:
            return f"{Path(argv[0]).name} ended with status {status}"
    return ""


def _expand(template: str, lists: dict[str, list[str]], values: dict[str, str]) -> list[str]:
    return lists[template] if template in lists else [template.format(**values)]


def _show(outcome: Outcome, number: int, count: int, context: Context) -> None:
    line = f"[{number}/{count}] {outcome.name}  {outcome.seconds:.1f} s"
    if outcome.counts.total > 1:
        line += f"  ({outcome.counts})"
    context.screen.say_verdict(outcome.verdict, f"{line}  {outcome.reason}".rstrip())
    if outcome.verdict == "failed":
        for text in outcome.failures[:FAILURES_SHOWN]:
            context.screen.say(f"           * {text[:FAILURE_LENGTH]}")
        for text in read_tail(outcome.log, TAIL_LINES):
            context.screen.say(f"           | {text}")
        context.screen.say(f"           log: {outcome.log}")
