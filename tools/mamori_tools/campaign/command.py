# SPDX-License-Identifier: Apache-2.0
"""`mamori campaign`: runs a fault campaign, continues a stopped one, or repeats one of its cases.

@satisfies SWR-CMP-012, SWR-CMP-013      Design: docs/design/simulation.md#campaign-runs
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from mamori_tools.campaign.case import Plan, Selection, select
from mamori_tools.campaign.result import CampaignResult, CaseResult
from mamori_tools.campaign.runner import DEFAULT_TIMEOUT_S, Replay, Settings, replay_case, run_campaign
from mamori_tools.campaign.subject import load_plan, load_subject
from mamori_tools.host.arguments import Command, at_least_one
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError, WorkError


def run(options: argparse.Namespace) -> int:
    """@return exit status."""
    plan = load_plan(options.plan)
    selection = select(plan, options.scenario, options.instants)
    if options.list:
        print(_list_scenarios(selection, options.json))
        return EXIT_OK
    settings = _make_settings(plan, options)
    try:
        return _replay(selection, settings, options) if options.replay else _run_all(selection, settings, options)
    except WorkError as error:
        print(f"mamori: campaign: {error}", file=sys.stderr)
        return EXIT_FAILED


def _make_settings(plan: Plan, options: argparse.Namespace) -> Settings:
    project = Project(ROOT)
    subject = load_subject(plan.subject)
    files = dict(subject.get_files(project))
    for name in ("model", "motion"):
        given: Path | None = getattr(options, name)
        if given is not None and name not in files:
            raise InputError(f"campaign: --{name}: the subject {subject.name} uses no {name}; remove the option")
        if given is not None:
            files[name] = given
    if options.jobs is not None and options.dask not in (None, "local"):
        raise InputError("campaign: --jobs: the cluster decides how many cases run at a time; remove the option, or write --dask local")
    return Settings(
        program=options.program or subject.get_program(project),
        files=files,
        evidence=options.out or project.root / "build" / "campaign" / plan.path.stem,
        jobs=options.jobs,
        timeout_s=options.timeout,
        dask=options.dask,
        restart=options.restart,
    )


def _run_all(selection: Selection, settings: Settings, options: argparse.Namespace) -> int:
    result = run_campaign(selection, settings, _show_progress)
    for note in result.notes:
        print(f"note: {note}", file=sys.stderr)
    print(_to_json(_describe_all(result, settings)) if options.json else "\n".join(_sum_up(result, settings)))
    return EXIT_FAILED if result.failed_cases else EXIT_OK


def _replay(selection: Selection, settings: Settings, options: argparse.Namespace) -> int:
    replay = replay_case(selection, settings, options.replay)
    print(_to_json(_describe_replay(replay)) if options.json else "\n".join(_show_replay(replay)))
    return EXIT_FAILED if replay.result.verdict == "failed" else EXIT_OK


def _show_progress(result: CaseResult, done: int, total: int) -> None:
    print(f"[{done}/{total}] {result.verdict:<12} {result.case.id:<28} {result.case.title}", file=sys.stderr, flush=True)


def _list_scenarios(selection: Selection, as_json: bool) -> str:
    rows = [{"name": each.name, "cases": min(each.case_count, selection.instants or each.case_count), "title": each.title}
            for each in selection.scenarios]  # fmt: skip
    return _to_json(rows) if as_json else "\n".join(f"{row['name']:<24}{row['cases']:>3} x  {row['title']}" for row in rows)


def _sum_up(result: CampaignResult, settings: Settings) -> list[str]:
    """The failed cases, and one closing line."""
    kept = f", {result.kept} of them by an earlier call" if result.kept else ""
    return [
        *(line for each in result.failed_cases for line in (f"{each.case.id}: {each.failure}", f"    {each.reproduction}")),
        f"results: {settings.evidence / 'campaign' / 'campaign.parquet'}",
        f"result hash: {result.result_hash}",
        f"{result.count('passed')} passed, {result.count('failed')} failed, {result.count('inconclusive')} inconclusive{kept}",
    ]


def _describe_all(result: CampaignResult, settings: Settings) -> dict[str, Any]:
    return {
        "schema": "mamori.campaign_summary/1",
        "passed": result.count("passed"),
        "failed": result.count("failed"),
        "inconclusive": result.count("inconclusive"),
        "kept": result.kept,
        "result_hash": result.result_hash,
        "results": str(settings.evidence / "campaign" / "campaign.parquet"),
        "cases": [{"id": each.case.id, "verdict": each.verdict, "failure": each.failure} for each in result.cases],
    }


def _show_replay(replay: Replay) -> list[str]:
    result = replay.result
    width = max(len(check.name) for check in result.checks)
    words = {None: "no stored result of the same campaign to compare with", True: "equals the stored result", False: "DIFFERS from the stored result"}
    return [
        f"{result.case.id}: {result.case.title}",
        *(f"  {'passed' if check.passed else 'FAILED':<8}{check.name:<{width}}  expected {check.wanted}, measured {check.measured}"
          for check in result.checks),
        f"{result.verdict}; {words[replay.is_equal]}",
    ]  # fmt: skip


def _describe_replay(replay: Replay) -> dict[str, Any]:
    return {"schema": "mamori.campaign_replay/1", "equals_stored": replay.is_equal, "case": replay.result.to_json()}


def _to_json(content: object) -> str:
    return json.dumps(content, indent=1, allow_nan=False)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("plan", type=Path, metavar="PLAN", help="fault plan, for example examples/safe_arm/faults.yaml")
    parser.add_argument("--program", type=Path, metavar="FILE", help="program under test; default: the program of the subject in build/host-release")
    parser.add_argument("--model", type=Path, metavar="FILE", help="model of the arm; default: the shipped model")
    parser.add_argument("--motion", type=Path, metavar="FILE", help="motion that the arm follows; default: the shipped motion")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder of the results; default: build/campaign/ and the name of the plan")
    parser.add_argument("--scenario", action="append", default=[], metavar="NAME", help="run only this scenario; may be repeated")
    parser.add_argument("--instants", type=at_least_one, metavar="N", help="run only the first N cases of each scenario")
    parser.add_argument("--jobs", type=at_least_one, metavar="N", help="cases that run at the same time; default: number of usable processors")
    parser.add_argument("--timeout", type=float, default=DEFAULT_TIMEOUT_S, metavar="S", help="wall time after which a case is ended; default: %(default)g s")
    parser.add_argument("--dask", metavar="ADDRESS",
                        help="run the cases on a Dask cluster: local, or the address of a scheduler, for example tcp://host:8786; "
                             "an address that does not answer within 10 s: status 2")  # fmt: skip
    parser.add_argument("--restart", action="store_true", help="discard the stored results in the folder first")
    parser.add_argument("--list", action="store_true", help="list the scenarios of the plan and their number of cases; run nothing")
    parser.add_argument("--replay", metavar="CASE", help="run one case again, show its checks and compare it with the stored result")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


COMMAND = Command(
    add_arguments, run, "run a fault campaign, continue a stopped one, or run one of its cases again",
    "Injects the faults of PLAN into a program, one run per case, and evaluates each run. Each finished case is stored at once. The same "
    "command continues a stopped campaign: stored cases are not repeated.",
    {0: "no case failed; inconclusive cases are counted", 1: "a case failed, or a worker or the scheduler was lost",
     3: "a package is missing, or another campaign writes to the folder"},
    examples=("campaign examples/safe_arm/faults.yaml", "campaign examples/safe_arm/faults.yaml --replay power_loss-1",
              "campaign examples/safe_arm/faults.yaml --dask local --jobs 2"))  # fmt: skip
