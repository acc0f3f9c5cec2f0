# SPDX-License-Identifier: Apache-2.0
"""Runs a fault campaign in real time and evaluates its course, or evaluates a stored course:

    python -P -m verification.faults {time,service,partition} ARGUMENT ... [--defect NAME] [--course FILE] [--build DIR]
    python -P -m verification.faults evaluate FILE

Prints the result as JSON. Exit status: 0 passed, 1 failed, 2 wrong arguments, 3 the program is missing, 4 inconclusive.

Design: docs/design/test_strength.md#courses
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_MISSING, EXIT_OK, EXIT_UNFINISHED, EXIT_USAGE
from mamori_tools.host.project import RELEASE, ROOT, Project
from mamori_trace.base.errors import InputError, MissingError, WorkError
from verification.faults.evaluation.evaluator import Result
from verification.faults.run import CAMPAIGNS, DEFECTS, evaluate_file, run_campaign

STATUS = {"passed": EXIT_OK, "failed": EXIT_FAILED, "inconclusive": EXIT_UNFINISHED}


def main(arguments: Sequence[str]) -> int:
    uses = "; ".join(campaign.usage for campaign in CAMPAIGNS.values())
    parser = argparse.ArgumentParser(prog="python -P -m verification.faults", description="Fault campaigns in real time.",
                                     epilog=f"Arguments: {uses}; evaluate FILE.")  # fmt: skip
    parser.add_argument("action", choices=[*CAMPAIGNS, "evaluate"])
    parser.add_argument("arguments", nargs="+", metavar="ARGUMENT")
    parser.add_argument("--defect", choices=DEFECTS, default="", help="seed a defect, for which the run must fail")
    parser.add_argument("--course", type=Path, metavar="FILE", help="keep the course of the run")
    parser.add_argument("--build", type=Path, default=Project(ROOT, RELEASE).build, metavar="DIR")
    try:
        result = _run(parser.parse_args(arguments))
    except InputError as error:
        return _report(str(error), EXIT_USAGE)
    except MissingError as error:
        return _report(str(error), EXIT_MISSING)
    except WorkError as error:
        return _report(str(error), EXIT_FAILED)
    print(json.dumps(result.to_json(), indent=1))
    if not result.has_priority:
        print("faults: without a fixed priority any thread of the host moves the windows; run as root or grant CAP_SYS_NICE", file=sys.stderr)
    return STATUS[result.finding.verdict]


def _run(given: argparse.Namespace) -> Result:
    if given.action != "evaluate":
        return run_campaign(CAMPAIGNS[given.action], given.build, given.arguments, defect=given.defect, course=given.course)
    if len(given.arguments) != 1 or given.defect or given.course:
        raise InputError("evaluate: expected one course file and no option")
    return evaluate_file(Path(given.arguments[0]))


def _report(text: str, status: int) -> int:
    print(f"faults: {text}", file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
