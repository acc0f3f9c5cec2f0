# SPDX-License-Identifier: Apache-2.0
"""Start and end of a command that runs steps: earlier evidence is removed first; a final screen states the results.

@satisfies SWR-CLI-006      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from mamori_tools.host import plans
from mamori_tools.host.environment import write_environment
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.project import Project
from mamori_tools.host.steps import FAILURES_SHOWN, Context, Outcome, all_passed, total
from mamori_trace.base.errors import InputError

FAILURE_LENGTH = 2000  # characters of a failed result in the closing lines


def begin(project: Project, jobs: int, presets: Sequence[str]) -> Context:
    """Removes the evidence of earlier runs, so that none of it counts for this run, and records the environment.

    @raise InputError if writing the report at the end would fail.
    """
    check_report_folder(project.report.parent)
    for preset in presets:
        evidence = Project(project.root, preset).evidence
        if evidence.exists():
            shutil.rmtree(evidence)
    project.junit.mkdir(parents=True)
    write_environment(project, ["./mamori", *sys.argv[1:]])
    return Context(project, jobs)


def check_report_folder(folder: Path) -> None:
    """@raise InputError if no file can be written there; checked before the work."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InputError(f"{folder}: the report cannot be written there ({error.strerror}); make it a folder that you may "
                         "write to, or remove it") from error


def show_steps(outcomes: Sequence[Outcome], context: Context) -> None:
    """The table of all steps."""
    context.screen.say()
    rows = []
    for one in outcomes:
        numbers = (str(number) for number in (one.counts.passed, one.counts.failed, one.counts.skipped))
        rows.append((one.name, one.verdict, f"{one.seconds:.1f} s", f"{one.cpu_s:.0f} s", *numbers))
    context.screen.print_table(("step", "result", "time", "CPU", "passed", "failed", "skipped"), rows)
    context.screen.say(f"CPU time of all steps: {sum(one.cpu_s for one in outcomes):.0f} s")
    context.screen.say(f"logs: {context.project.logs}")


def show_failures(outcome: Outcome, context: Context) -> None:
    """The failed results of a step with complete messages, because some systems store only the end of the output."""
    for text in outcome.failures[:FAILURES_SHOWN]:
        context.screen.say(f"{outcome.name}: {text[:FAILURE_LENGTH]}")


def finish(outcomes: Sequence[Outcome], context: Context) -> int:
    """The closing lines. @return the exit status."""
    context.screen.say()
    if any(one.name == plans.REPORT and one.verdict == "passed" for one in outcomes):
        context.screen.say(f"report: {context.project.report}")
    failed = [one for one in outcomes if one.verdict == "failed"]
    for one in failed:
        show_failures(one, context)
    if failed:
        context.screen.say(f"failed: {', '.join(one.name for one in failed)}", style="bold red")
    context.screen.say(str(total(outcomes)))
    return EXIT_OK if all_passed(outcomes) else EXIT_FAILED
