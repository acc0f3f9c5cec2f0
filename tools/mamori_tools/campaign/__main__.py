# SPDX-License-Identifier: Apache-2.0
"""`python -m mamori_tools.campaign`: runs a fault-injection campaign and shows the verdicts."""

from __future__ import annotations

import argparse
import signal
import sys
from pathlib import Path
from typing import NoReturn

from mamori_tools.campaign import CampaignResult, CaseResult, Plan, load_plan, run_campaign, select
from mamori_tools.campaign.runner import DEFAULT_TIMEOUT_S
from mamori_trace.base.errors import InputError

EXIT_OK = 0
EXIT_FAILED = 1
EXIT_USAGE = 2
EXIT_INTERRUPTED = 130


def main(arguments: list[str] | None = None) -> int:
    """Returns 0 all cases passed, 1 a case failed, 2 bad input (one line on standard error), 130 interrupted."""
    options = _parse(arguments)
    # An end from outside takes the same way as Ctrl-C: the runs are ended, and no half campaign is written.
    signal.signal(signal.SIGTERM, _interrupt)
    try:
        plan = load_plan(options.plan)
        if options.list:
            print(_list_scenarios(plan))
            return EXIT_OK
        missing = [name for name in ("program", "model", "motion", "evidence") if getattr(options, name) is None]
        if missing:
            raise InputError("give " + ", ".join(f"--{name}" for name in missing))
        selection = select(plan, options.scenario, options.instants)
        result = run_campaign(selection, program=options.program, files={"model": options.model, "motion": options.motion},
                              evidence=options.evidence, jobs=options.jobs, timeout_s=options.timeout,
                              progress=_show_progress)  # fmt: skip
    except InputError as error:
        print(error, file=sys.stderr)
        return EXIT_USAGE
    except KeyboardInterrupt:
        print("interrupted; the runs were ended and no campaign was written", file=sys.stderr)
        return EXIT_INTERRUPTED
    print(_sum_up(result))
    return EXIT_OK if result.passed else EXIT_FAILED


def _parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m mamori_tools.campaign",
        description="Injects the faults of a plan into a program, one run per fault and instant, and judges each run.",
        epilog="exit status: 0 all cases passed, 1 a case failed, 2 bad input, 130 interrupted",
    )
    parser.add_argument("--plan", type=Path, default=Path("examples/safe_arm/faults.yaml"),
                        help="fault plan (default: %(default)s)")  # fmt: skip
    parser.add_argument("--program", type=Path, help="program under test, for example safe_arm")
    parser.add_argument("--model", type=Path, help="model file of the arm")
    parser.add_argument("--motion", type=Path, help="BodyMotion YAML or whitespace table")
    parser.add_argument("--evidence", type=Path, help="folder for campaign/ and junit/campaign.xml")
    parser.add_argument("--scenario", action="append", default=[], metavar="NAME",
                        help="only this scenario; may be given several times")  # fmt: skip
    parser.add_argument("--instants", type=int, metavar="N", help="only the first N instants of each scenario")
    parser.add_argument("--jobs", type=int, metavar="N", help="runs at a time (default: one per core)")
    parser.add_argument("--timeout", type=float, default=DEFAULT_TIMEOUT_S, metavar="S",
                        help="wall time after which a run is ended (default: %(default)g s)")  # fmt: skip
    parser.add_argument("--list", action="store_true", help="list the scenarios of the plan and end")
    return parser.parse_args(arguments)


def _interrupt(*_: object) -> NoReturn:
    raise KeyboardInterrupt


def _list_scenarios(plan: Plan) -> str:
    return "\n".join(f"{each.name:<24}{each.case_count:>2} x  {each.title}" for each in plan.scenarios)


def _show_progress(result: CaseResult, done: int, total: int) -> None:
    print(f"[{done}/{total}] {'pass' if result.passed else 'FAIL'}  {result.case.id:<28} {result.case.title}", flush=True)


def _sum_up(result: CampaignResult) -> str:
    lines = [f"{each.case.id}: {each.failure}\n    {each.reproduction}" for each in result.failed_cases]
    lines.append(f"{len(result.cases) - len(result.failed_cases)} passed, {len(result.failed_cases)} failed")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
