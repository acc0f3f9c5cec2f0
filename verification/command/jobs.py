# SPDX-License-Identifier: Apache-2.0
"""What the commands do: check the input, run a table of steps, end with one screen that says how it went.

@satisfies SWR-CLI-006, SWR-CLI-011      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import textwrap
from collections.abc import Sequence
from pathlib import Path

from mamori.profiles.input_error import nearest_names
from mamori.verification.command import plans
from mamori.verification.command.campaign_step import CampaignRequest
from mamori.verification.command.campaign_table import summarise_campaign
from mamori.verification.command.environment import write_environment
from mamori.verification.command.errors import EXIT_FAILED, EXIT_OK, UsageError
from mamori.verification.command.full_run import FILE, record_full_run
from mamori.verification.command.project import RELEASE, ROOT, SANITIZED, Project
from mamori.verification.command.steps import FAILURES_SHOWN, Context, Outcome, Tier, all_passed, run_steps, total

FAILURE_LENGTH = 2000  # characters of a failed result in the closing lines
SHOWN_WIDTH = 110  # characters of a line of names

def demo(jobs: int, motion: Path | None, scenarios: tuple[str, ...], instants: int | None) -> int:
    """The main job. @return exit status."""
    project = Project(ROOT)
    request = CampaignRequest(motion or project.motion, scenarios, instants)
    notes = request.check(project)
    context = begin(project, jobs, (RELEASE,))
    for note in notes:
        context.screen.say(f"note: {request.motion.name}: {note}")
    plan = plans.demo_plan(request.run)
    outcomes = run_steps(plan, context)
    show_campaign(context)
    show_not_run(plans.find_not_run(plan, plans.test_plan(project, request.run, Tier.GATE)), context)
    return finish(outcomes, context)


def test(jobs: int, tier: Tier) -> int:
    """The steps of `tier`. @return exit status."""
    project = Project(ROOT)
    request = CampaignRequest(project.motion)
    request.check(project)
    context = begin(project, jobs, (RELEASE, SANITIZED))
    outcomes = run_steps(plans.test_plan(project, request.run, tier), context)
    show_steps(outcomes, context)
    if tier == Tier.ALL:
        record_full_run(project, outcomes)
        context.screen.say(f"recorded in {FILE}: add it to the commit")
    return finish(outcomes, context)


def build(jobs: int, folder: Path | None, preset: str) -> int:
    """Builds the shipped project, and then the one in `folder` against its package. @return exit status."""
    check_preset(preset)
    project = Project(check_folder(folder) if folder else ROOT, preset)
    outcomes = run_steps(plans.build_plan(project), Context(project, jobs))
    if not all_passed(outcomes):
        return EXIT_FAILED
    print(f"built: {project.build}")
    return EXIT_OK


def verify(jobs: int, folder: Path | None) -> int:
    """Tests, campaign, trace check and report of the shipped project or of the one in `folder`. @return exit status."""
    if folder is None:
        return verify_own(jobs)
    project = Project(check_folder(folder))
    if not (project.root / "requirements").is_dir():
        raise UsageError(f"'{folder}' has no folder requirements/; verify judges a project by its requirements, build builds it")
    context = begin(project, jobs, (RELEASE,))
    outcomes = run_steps(plans.verify_plan(project), context)
    show_steps(outcomes, context)
    return finish(outcomes, context)


def verify_own(jobs: int) -> int:
    """Tests, campaign, trace check and report of the shipped project. @return exit status."""
    project = Project(ROOT)
    request = CampaignRequest(project.motion)
    request.check(project)
    context = begin(project, jobs, (RELEASE,))
    outcomes = run_steps(plans.verify_own_plan(request.run), context)
    show_campaign(context)
    return finish(outcomes, context)


def begin(project: Project, jobs: int, presets: Sequence[str]) -> Context:
    """Throws the evidence of earlier runs away, so that none of it can count for this one, and records the environment.

    @raise UsageError when the report could not be written at the end.
    """
    check_report_folder(project.report.parent)
    for preset in presets:
        evidence = Project(project.root, preset).evidence
        if evidence.exists():
            shutil.rmtree(evidence)
    project.junit.mkdir(parents=True)
    write_environment(project, ["./mamori", *sys.argv[1:]])
    return Context(project, jobs)


def check_folder(folder: Path) -> Path:
    """@return the absolute path of a project folder. @raise UsageError when it is none."""
    if not (folder / "CMakeLists.txt").is_file():
        raise UsageError(f"'{folder}' has no CMakeLists.txt; give the folder of a project that calls find_package(mamori)")
    return folder.resolve()


def check_report_folder(folder: Path) -> None:
    """@raise UsageError when no file can be written there: better known before the work than after it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise UsageError(f"{folder}: the report cannot be written there ({error.strerror}); make it a folder that you may "
                         "write to, or remove it") from error


def check_preset(preset: str) -> None:
    """@raise UsageError when CMakePresets.json has no such configuration."""
    presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
    names = [entry["name"] for entry in presets if not entry.get("hidden")]
    if preset not in names:
        raise UsageError(f"there is no preset '{preset}'; {nearest_names(preset, names)}")


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
    """The failed results of a step with all that they say: where only the end of the screen is kept, it must be there."""
    for text in outcome.failures[:FAILURES_SHOWN]:
        context.screen.say(f"{outcome.name}: {text[:FAILURE_LENGTH]}")


def show_campaign(context: Context) -> None:
    """The table of all scenarios; nothing when no campaign was run."""
    path = context.project.evidence / "campaign" / "campaign.json"
    if not path.exists():
        return
    context.screen.say()
    context.screen.print_table(*summarise_campaign(json.loads(path.read_text(encoding="utf-8"))))


def show_not_run(names: Sequence[str], context: Context) -> None:
    """What `./mamori test` does more than this run."""
    context.screen.say()
    context.screen.say("not run (./mamori test runs these as well):")
    for line in textwrap.wrap(", ".join(names), width=SHOWN_WIDTH, break_long_words=False, break_on_hyphens=False):
        context.screen.say(f"  {line}")


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
