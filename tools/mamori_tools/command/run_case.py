# SPDX-License-Identifier: Apache-2.0
"""`mamori run`: one case of the example arm with its plots, and the end state according to the fault plan.

The most similar scenario of the plan provides omitted values and the expected end state. Campaign, motion reader and report are imported on
use, because they load large libraries.

@satisfies SWR-CLI-013      Design: docs/design/launcher.md#one-case
"""

from __future__ import annotations

import argparse
import math
import shutil
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mamori_tools.host import plans
from mamori_tools.host.arguments import Command, add_jobs
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Context, all_passed, run_steps
from mamori_trace.base.errors import InputError

if TYPE_CHECKING:
    from mamori_tools.campaign import CaseResult, Plan, Selection
    from mamori_tools.campaign.arm.plan import ArmScenario
    from mamori_tools.motion import Motion

FAULT_HELP = """KIND[,key=value...]; default: none
  encoder_freeze    joint=1..7|fastest channel=a|b|both
  encoder_bit_flip  joint channel magnitude=BIT, 0 to 31
  encoder_bias      joint channel magnitude=RAD, -10 to 10, not 0
  encoder_drift     joint channel magnitude=RAD/S, -10 to 10, not 0
  torque_runaway    joint magnitude=FRACTION of the torque limit, -1 to 1, not 0
  message_late      magnitude=SECONDS, above 0 to 10
  message_damaged   magnitude=BIT of each message, 0 to 65535
  controller_wrong  magnitude=NUMBER of a wrong controller, 0 to 1e9
  clock_wrong       magnitude=RATE of the processor clock, 0.1 to 10, not 1
  brake_creep       joint magnitude=RAD/S, above 0 to 1
  emergency_stop, protective_stop, enabling_released: channel
  message_lost, power_loss, controller_hang, supervisor_hang, processor_stops,
  enabling_squeezed, run_released, reduced_speed, hold_to_run, none
Each kind except none takes at=SECONDS of the motion, before its end, and duration=SECONDS; default: to the end.
A second fault that shows nothing by itself: latent=brake_stuck_open:JOINT,
brake_fade:JOINT, brakes_stuck_open, sto_ignored, relay_stuck,
start_stuck, reset_stuck, or since power-up the mode reduced_speed or hold_to_run"""
KEYS = ("joint", "channel", "magnitude", "at", "duration", "latent")
REJECTED_INPUT = 2
"""Exit status of the program for rejected input."""


def run_case(jobs: int, motion_file: Path | None, fault: str | None) -> int:
    """Builds the program, runs one case, shows it and writes its page. @return exit status. @raise InputError."""
    from mamori_tools.campaign import Settings, load_plan, run_campaign
    from mamori_tools.campaign.arm.selection import resolve
    from mamori_tools.motion import load_limits, read_motion

    project = Project(ROOT)
    files = {"model": project.model, "motion": motion_file or project.motion}
    motion = read_motion(files["motion"], load_limits(project.model))
    selection = select_case(load_plan(project.campaign_plan), motion, fault)
    case = resolve(selection, motion)[0]
    context = Context(project, jobs)
    if not all_passed(run_steps((plans.build_step(project.preset, targets=(plans.EXAMPLE_TARGET,)),), context)):
        return EXIT_FAILED
    folder = project.root / "build" / "run" / case.scenario
    _make_empty(folder)
    result = run_campaign(selection, Settings(project.safe_arm, files, folder, jobs=1, restart=True)).cases[0]
    log = folder / "campaign" / case.id / "program.log"
    if not result.run and f"exit status {REJECTED_INPUT}" in result.failure:
        raise InputError("run: " + log.read_text(encoding="utf-8").strip().splitlines()[-1].removeprefix("safe_arm: "))
    for note in motion.notes:
        context.screen.say(f"note: {motion.source_name}: {note}")
    for line in summarise(result):
        context.screen.say(line)
    for line in _write_page(result, folder):
        context.screen.say(line)
    reached = result.run.get("final_state") == case.expected.state
    context.screen.say(f"end state {'as expected' if reached else 'NOT as expected'}", style="" if reached else "bold red")
    return EXIT_OK if reached else EXIT_FAILED


def _make_empty(folder: Path) -> None:
    try:
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
    except OSError as error:
        raise InputError(f"run: {folder}: nothing can be written there ({error.strerror}); make it a folder that you may write to") from error


def select_case(plan: Plan, motion: Motion, fault: str | None) -> Selection:
    """The case that `fault` (KIND[,key=value...]) specifies; None: no fault. @raise InputError with the valid words."""
    from mamori_tools.campaign import Selection
    from mamori_tools.campaign.arm.plan import ArmScenario

    kind, *pairs = ("none" if fault is None else fault).removeprefix("kind=").split(",")
    known = [each for each in plan.scenarios if isinstance(each, ArmScenario)]
    scenarios = [each for each in known if each.fault.kind == kind]
    if not scenarios:
        raise InputError(f"run: --fault: unknown kind '{kind}'; known: {_join(each.fault.kind for each in known)}")
    given = _read_pairs(pairs, scenarios[0], motion)
    scenarios = [each for each in scenarios if each.fault.latent == given.get("latent", "")] or scenarios
    # Scenarios in the order of the plan, except that a scenario with all given values comes first.
    scenario = max(scenarios, key=lambda each: sum(getattr(each.fault, _FIELDS[key]) == value
                                                   for key, value in given.items() if key in _FIELDS))  # fmt: skip
    spec = replace(scenario.fault, **{_FIELDS[key]: value for key, value in given.items() if key in _FIELDS})
    if given:
        scenario = replace(scenario, title=f"{kind} as given on the command line")
    if "at" in given:
        scenario = replace(scenario, instants=(given["at"],), in_seconds=True)
        spec = replace(spec, min_speed_rad_s=None)
    return Selection(plan, (replace(scenario, fault=spec),), 1 if scenario.instants else None)


_FIELDS = {"joint": "joint", "channel": "channel", "magnitude": "magnitude", "duration": "duration_s", "latent": "latent"}
"""Key of a fault on the command line -> field of the plan."""


def _read_pairs(pairs: Iterable[str], scenario: ArmScenario, motion: Motion) -> dict[str, Any]:
    from mamori_tools.campaign.arm.fault import KINDS

    kind = scenario.fault.kind
    uses = KINDS[kind]
    timed = kind != "none"
    valid = [key for key, used in zip(KEYS, (uses.joint, uses.channel, uses.magnitude, timed, timed, True), strict=True) if used]
    given: dict[str, Any] = {}
    for pair in pairs:
        key, equal, text = pair.partition("=")
        if not equal or key not in valid:
            known = f"{kind} takes {_join(valid)}" if valid else f"{kind} takes no key"
            raise InputError(f"run: --fault: '{pair}' is not key=value with a known key; {known}")
        if key in given:
            raise InputError(f"run: --fault: {key} is given twice; {kind} takes {_join(valid)}")
        given[key] = _read_value(key, text, motion)
    return given


def _read_value(key: str, text: str, motion: Motion) -> int | float | str:
    from mamori_tools.campaign.arm.fault import CHANNELS, FASTEST, LATENT_KINDS

    joints = len(motion.joint_names)
    if key == "channel":
        return _demand(text in CHANNELS, text, key, text, _join(CHANNELS))
    if key == "latent":
        return _demand(text.partition(":")[0] in LATENT_KINDS, text, key, text, _join(LATENT_KINDS))
    if key == "joint" and text == FASTEST:
        return FASTEST
    if key == "joint":
        number = int(text) if text.isdecimal() and len(text) < 4 else 0
        return _demand(1 <= number <= joints, number, key, text, f"1 to {joints} or {FASTEST}")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if key == "at":
        return _demand(0.0 <= value < motion.duration_s, value, key, text, f"seconds of the motion, from 0 to below its end at {motion.duration_s:.3f}")
    if key == "duration":
        return _demand(0.0 < value < math.inf, value, key, text, "seconds above 0")
    return _demand(math.isfinite(value), value, key, text, "a finite number; ./mamori run --help lists the ranges")


def _demand(met: bool, value: Any, key: str, text: str, valid: str) -> Any:
    if not met:
        raise InputError(f"run: --fault: {key} is '{text}'; valid: {valid}")
    return value


def _join(words: Iterable[str]) -> str:
    return ", ".join(dict.fromkeys(words))


def summarise(result: CaseResult) -> list[str]:
    """One screen: fault, reaction, stopping figures, expected and actual end state."""
    from mamori_tools.campaign.arm.judge import describe_faults
    from mamori_tools.campaign.arm.selection import ArmCase

    case, run = result.case, result.run
    assert isinstance(case, ArmCase)
    physics = run.get("physics", {})
    begin = (run.get("fault") or {}).get("at_s")
    travel = max(physics.get("stop_travel_rad", []), default=None)
    rows = [
        ("case", case.title),
        ("fault", describe_faults(case)),
        ("detected", _show_event(run.get("detected_fault"), run.get("detected_at_s"), begin)),
        ("reaction", _show_event(run.get("reaction"), run.get("reacted_at_s"), begin)),
        ("allowed", "no reaction" if case.expected.within_s is None
         else f"{' or '.join(case.expected.reactions)} within {1e3 * case.expected.within_s:.0f} ms"),
        ("standstill", _show_event("reached", run.get("standstill_at_s"), begin) if run.get("standstill_at_s") is not None else "not reached"),
    ]  # fmt: skip
    if run.get("standstill_at_s") is not None:
        rows += [("stop travel", _show(travel, "rad")), ("hold drift", _show(physics.get("hold_drift_rad"), "rad"))]
    rows += [("tracking error", _show(physics.get("max_tracking_error_rad"), "rad")), ("end state", run.get("final_state", "none")),
             ("expected", f"{case.expected.state} (scenario {case.scenario} of the fault plan)")]  # fmt: skip
    failed = [check for check in result.checks if not check.passed]
    lines = ["", *(f"  {name:<16}{value}" for name, value in rows),
             f"  {'checks':<16}{len(result.checks) - len(failed)} passed, {len(failed)} failed"]  # fmt: skip
    return [*lines, *(f"    {check.name}: expected {check.wanted}, measured {check.measured}" for check in failed)]


def _show_event(name: str | None, at_s: float | None, begin_s: float | None) -> str:
    if name is None or at_s is None:
        return "none"
    after = "" if begin_s is None else f", {1e3 * (at_s - begin_s):.1f} ms after the fault"
    return f"{name} at {at_s:.3f} s{after}"


def _show(value: float | None, unit: str) -> str:
    return "unknown" if value is None else f"{value:.4f} {unit}"


def _write_page(result: CaseResult, folder: Path) -> list[str]:
    """Writes the page with the plots. @return the states of the run and the path of the page."""
    if not result.run:
        return [f"log: {folder / 'campaign' / result.case.id / 'program.log'}"]
    from mamori_trace.readers.campaign import make_case
    from mamori_trace.readers.series import read_series
    from mamori_trace.reports.case_page import write_case_page
    from mamori_trace.reports.plots import list_bands

    page = folder / "case.html"
    try:
        view = write_case_page(make_case(result.to_json()), folder / "campaign", page)
    except OSError as error:
        raise InputError(f"run: {page}: the page cannot be written ({error.strerror}); make room or remove it") from error
    if view.plot_problem:
        return [f"  no plots: {view.plot_problem}"]
    bands = list_bands(read_series(folder / "campaign" / result.case.id / "series.csv"))
    return [f"  {'states':<16}{', '.join(f'{state} from {begin_s:.3f} s' for state, begin_s, _ in bands)}", f"  {'plots':<16}{page}"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--motion", type=Path, metavar="FILE",
                        help="BodyMotion YAML file or table (time and joints) to follow; default: the shipped motion")  # fmt: skip
    parser.add_argument("--fault", metavar="FAULT", help=FAULT_HELP)
    add_jobs(parser, "of the build")


def run(arguments: argparse.Namespace) -> int:
    """@return exit status."""
    return run_case(arguments.jobs, arguments.motion, arguments.fault)


COMMAND = Command(
    add_arguments, run, "run one case of the example arm with a fault of your choice; show its reaction and plots",
    "Builds the example arm and runs one case. Shows the states, the reaction, the stopping figures, and the expected and actual end state. "
    "Writes the plots to build/run/SCENARIO/case.html. Omitted keys come from the most similar scenario of the fault plan.",
    {0: "the end state is as expected", 1: "the end state differs, or the program failed"},
    examples=("run --fault encoder_freeze,joint=2,at=1.5", "run --motion my_motion.yaml --fault none"))  # fmt: skip
