# SPDX-License-Identifier: Apache-2.0
"""`./mamori hil`: runs the arm as three processes on an LCM network and compares the verdicts with those in virtual time.

@satisfies SWR-HIL-008, SWR-HIL-014      Design: docs/design/safe_arm.md#hardware-in-the-loop
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from mamori_tools.campaign.arm.run_record import load_run
from mamori_tools.campaign.case import Verdict, conclude
from mamori_tools.hil import network
from mamori_tools.hil.processes import Programs, Run, RunFacts
from mamori_tools.hil.scenario import HilCase, choose, list_cases, list_kills
from mamori_tools.hil.verdict import HilResult, evaluate, judge_case, name_error
from mamori_tools.host.arguments import Command, at_least_one
from mamori_tools.host.console import Screen
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK, EXIT_UNFINISHED
from mamori_tools.host.project import ROOT, Project
from mamori_tools.motion import canonical_text, load_limits, read_motion
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.text_file import write_text

REPEATS = 2
"""An inconclusive run is repeated at most this number of times (ADR 0027)."""
SCHEMA = "mamori.hil/1"
REACH = "reach.txt"
OWN = ("plant", "kernel", "controller")


def run(arguments: argparse.Namespace) -> int:
    """@return exit status. @raise InputError, MissingError."""
    project = Project(ROOT)
    motion = read_motion(arguments.motion or project.motion.with_name(REACH), load_limits(project.model))
    cases = list_cases(project.campaign_plan, motion)
    if arguments.list:
        print("\n".join(f"{case.id:<32}{case.arm.title}" for case in cases))
        return EXIT_OK
    chosen = choose(cases, arguments.fault) if arguments.fault else cases[: arguments.scenarios or (0 if arguments.kills else 1)]
    if arguments.scenarios is not None and arguments.scenarios > len(cases):
        raise InputError(f"hil: argument --scenarios: {arguments.scenarios} is more than {len(cases)}; specify a smaller number")
    chosen = (*chosen, *list_kills(project.campaign_plan, motion, arguments.kills, arguments.seed)) if arguments.kills else chosen
    out = (arguments.out or project.root / "build" / "hil").absolute()
    own = {name: getattr(arguments, name) for name in OWN if getattr(arguments, name) is not None}
    programs = Programs(project.safe_arm.parent, project.model, out / "motion.txt", own)
    programs.check()
    if out.exists() and not (out.is_dir() and (programs.motion.exists() or not any(out.iterdir()))):
        raise InputError("hil: is not a folder of an earlier run; specify a new one with --out", out)
    network.check_tools()
    _make_empty(out)
    write_text(programs.motion, canonical_text(motion))
    network.enter_own_network()
    screen = Screen()
    screen.say(f"hil: cases: {len(chosen)}, on {network.URL} in a network namespace of their own")
    screen.say(f"hil: to join it, as root: nsenter --net=/proc/{os.getpid()}/ns/net lcm-spy")
    results = [_run_case(case, programs, out, number, len(chosen), screen) for number, case in enumerate(chosen, start=1)]
    return _report(results, out, screen)


def _run_case(case: HilCase, programs: Programs, out: Path, number: int, count: int, screen: Screen) -> HilResult:
    virtual = None if case.kill or programs.own else _judge_virtually(case, programs, out / "virtual" / case.id)
    for attempt in range(1 + REPEATS):
        folder = out / case.id
        _make_empty(folder)
        try:
            facts = Run(programs, case, folder).run()
        except WorkError as error:
            facts = RunFacts(str(error), 0.0, 0.0)
        result = evaluate(case, facts, folder, virtual, programs.own)
        if result.verdict != "inconclusive":
            break
        screen.say(f"hil: {case.id}: inconclusive, since the host disturbed it ({result.figure}); attempt {attempt + 1} of {1 + REPEATS}")
    reason = f": {result.difference}" if result.verdict != "passed" else ""
    screen.say_verdict(result.verdict, f"[{number}/{count}] {case.id}  {case.arm.title}{reason}")
    return result


def _judge_virtually(case: HilCase, programs: Programs, folder: Path) -> Verdict:
    """The same case in one process, with the same messages and checks."""
    command = [str(programs.get_shipped("virtual")), *programs.make_command("plant", case, folder)[1:]]
    done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    problem = "" if done.returncode == 0 else f"hil_virtual ended with status {done.returncode}: {done.stderr.strip()}"
    try:
        run = {} if problem else name_error(case, load_run(folder / "run.json"))
    except WorkError as error:
        run, problem = {}, str(error)
    return conclude(judge_case(case, run, problem))


def _report(results: Sequence[HilResult], out: Path, screen: Screen) -> int:
    screen.say()
    rows: list[tuple[str, ...]] = [(one.case.id, one.virtual or "-", one.verdict, one.difference or "-", one.figure or "-") for one in results]
    screen.print_table(("scenario", "virtual time", "hil", "difference", "figure of the host"), rows)
    content = {"schema": SCHEMA, "cases": [_to_json(one) for one in results]}
    write_text(out / "hil.json", json.dumps(content, indent=1, allow_nan=False) + "\n")
    counts = {verdict: sum(one.verdict == verdict for one in results) for verdict in ("passed", "failed", "inconclusive")}
    differing = [one.case.id for one in results if one.virtual is not None and one.verdict != "inconclusive" and one.verdict != one.virtual]
    screen.say(f"{', '.join(f'{number} {verdict}' for verdict, number in counts.items())}; {len(differing)} verdicts differ from virtual time")
    screen.say(f"records: {out}")
    if counts["failed"] or differing:
        return EXIT_FAILED
    return EXIT_UNFINISHED if counts["inconclusive"] else EXIT_OK


def _to_json(one: HilResult) -> dict[str, object]:
    return {"id": one.case.id, "title": one.case.arm.title, "link": one.case.link, "error": one.case.error, "kill": one.case.kill,
            "kill_at_s": one.case.kill_at_s, "virtual": one.virtual, "verdict": one.verdict, "figure": one.figure,
            "checks": [{"name": check.name, "wanted": check.wanted, "measured": check.measured, "passed": check.passed} for check in one.checks],
            "wall_s": one.facts.wall_s, "steal_s": one.facts.steal_s, "run": dict(one.run)}  # fmt: skip


def _make_empty(folder: Path) -> None:
    try:
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
    except OSError as error:
        raise InputError(f"hil: {folder}: nothing can be written there ({error.strerror}); specify another folder with --out") from error


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scenarios", type=at_least_one, metavar="N", help="run the first N cases of --list; default: 1, the motion without a fault")
    parser.add_argument("--fault", action="append", default=[], metavar="NAME", help="run this case or scenario of --list; may be repeated")
    parser.add_argument("--kills", type=at_least_one, metavar="N", help="kill each of the three processes N times at random instants, in runs of their own")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="seed of the instants of --kills; default: %(default)s")
    parser.add_argument("--motion", type=Path, metavar="FILE", help="motion that the arm follows; default: examples/safe_arm/motions/reach.txt, 1 s")
    for name in OWN:
        parser.add_argument(f"--{name}", metavar="COMMAND", help=f"command that replaces the {name}; it opens the URL of LCM_DEFAULT_URL")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the records, new or of an earlier run; default: build/hil")
    parser.add_argument("--list", action="store_true", help="list all cases; run nothing")


COMMAND = Command(
    add_arguments, run, "run plant, kernel and controller as three processes on an LCM network",
    "Hardware in the loop: runs the simulated arm, its safety components and its controller as three processes that exchange LCM messages at 1 kHz "
    "in a network namespace of their own. Injects faults of the campaign and communication errors, or kills processes, and compares each verdict "
    "with that in virtual time. lcm-logger records each run. Needs root.",
    {1: "a case failed, or its verdict differs from that in virtual time", 3: "a tool is missing, or not root",
     4: "no case failed, but some are inconclusive because the host disturbed them"},
    examples=("hil", "hil --scenarios 20", "hil --fault power_loss --fault corruption_drive", "hil --kills 5",
              "hil --controller 'python3 my_controller.py'"))  # fmt: skip
