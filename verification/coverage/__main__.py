# SPDX-License-Identifier: Apache-2.0
"""Measures line, branch and MC/DC coverage of kernel, safety and ports by their own tests, and compares the gaps with the list of accepted gaps.

    python -P -m verification.coverage [--jobs N]

Prints a table, then each gap that gaps.toml does not list and each row without a gap. Writes
build/host-release/evidence/coverage/coverage.json and .txt. Exit status 0 without such gaps and rows, 1 otherwise, 2 for wrong arguments.

@satisfies SWR-VER-001, SWR-VER-002      Design: docs/design/test_strength.md#coverage
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import Any

from mamori_tools.host.environment import collect_environment
from mamori_tools.host.project import ROOT, SANITIZED, Project
from mamori_tools.host.records import renew_records
from mamori_trace.base.errors import WorkError
from verification.coverage.gaps import LIST, Verdict, find_gaps, judge, read_list
from verification.coverage.measure import measure
from verification.coverage.reached import Function, read_functions
from verification.coverage.record import make_rows
from verification.coverage.report import Figures, count, make_table, write_evidence


def check_layers(project: Project, jobs: int) -> tuple[Verdict, str]:
    """Measures, evaluates and writes the evidence. @return the verdict and the table."""
    rows = read_list()
    functions: list[Function] = []
    files: list[Figures] = []
    record: list[dict[str, Any]] = []
    for exported in measure(project.root, jobs):
        reached = read_functions(exported, project.root)
        functions += reached
        files += count(exported, reached, project.root)
        record += make_rows(exported, reached, project.root)
    verdict = judge(find_gaps(functions), rows)
    table = make_table(files, verdict)
    folder = project.evidence / "coverage"
    write_evidence(folder, files, verdict, table, record)
    environment = collect_environment(Project(project.root, SANITIZED), ())
    renew_records(project, sorted(folder.glob("coverage.*")), environment["inputs"])
    return verdict, table


def describe(verdict: Verdict) -> list[str]:
    """One line for each fault to correct."""
    list_name = LIST.relative_to(ROOT)
    return [f"{gap} (test it, or list it in {list_name} with the reason)" for gap in verdict.unlisted] + [
        f"{list_name}: row names no gap any more, remove it: {row}" for row in verdict.unused
    ]


def main(argv: list[str] | None = None) -> int:
    """@return the exit status."""
    parser = argparse.ArgumentParser(prog="verification.coverage", allow_abbrev=False,
                                     description="Line, branch and MC/DC coverage of kernel, safety and ports by their own tests.")  # fmt: skip
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="parallel compilations")
    jobs = parser.parse_args(argv).jobs
    if jobs < 1:
        parser.error(f"--jobs {jobs}: give a number from 1 on")
    try:
        verdict, table = check_layers(Project(Path(ROOT)), jobs)
    except WorkError as error:
        print(error, file=sys.stderr)
        return 1
    print(table)
    for line in describe(verdict):
        print(line)
    print(f"coverage: {len(verdict.unlisted)} gaps without a reason, {len(verdict.unused)} rows without a gap")
    return 0 if verdict.passed else 1


if __name__ == "__main__":
    sys.exit(main())
