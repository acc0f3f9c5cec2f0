# SPDX-License-Identifier: Apache-2.0
"""Common parts of the actions: the arguments that select the input, the exit status, the printing of an outcome.

@satisfies SWR-TRC-108      Design: docs/design/trace.md#command
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from mamori_trace.actions.foreign import add_foreign, get_foreign
from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import ERROR, Finding
from mamori_trace.checks import list_rule_ids, unreadable_input
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import Verdict
from mamori_trace.readers.project import read_project
from mamori_trace.readers.toml_rows import is_date
from mamori_trace.reports.json_report import format_json
from mamori_trace.reports.text import Paint, format_findings, format_summary, format_waived

EXIT_CLEAN = 0
EXIT_FINDINGS = 1
EXIT_INPUT = 2

SARIF = "sarif"


def add_root(parser: argparse.ArgumentParser) -> None:
    """`--root`, an option of every action."""
    parser.add_argument("--root", type=Path, default=Path("."), metavar="DIR", help="project folder (default: here)")


def add_input(parser: argparse.ArgumentParser) -> None:
    """The input: project and evidence."""
    add_root(parser)
    parser.add_argument("--evidence", type=Path, metavar="DIR", help="default: build/host-release/evidence, or the only one")
    add_foreign(parser)
    parser.add_argument("--allow-missing", action="store_true", help="missing (not failing) results are not errors")
    parser.add_argument("--release", action="store_true", help="a result that this host cannot produce is also an error")
    parser.add_argument("--date", type=_parse_date, metavar="DAY",
                        help="day by which waivers expire, as 2026-11-30 (default: of the commit, or else of the evidence)")  # fmt: skip


def add_output(parser: argparse.ArgumentParser, *more: str) -> None:
    """The output format: text, JSON, or one of `more`."""
    parser.add_argument("--output", choices=("text", "json", *more), default="text", help="how to print (default: text)")
    parser.add_argument("--json", dest="output", action="store_const", const="json", help="the same as --output json")


def read_input(arguments: argparse.Namespace) -> Project:
    """The project that `add_input` chose. Raises InputError."""
    if arguments.release and arguments.allow_missing:
        raise InputError("--release and --allow-missing contradict each other; give one of them")
    foreign = get_foreign(arguments)
    if foreign is not None:
        from mamori_trace.formats.in_place import read_in_place  # loads much that a project in Mamori's own format does not need

        project = read_in_place(foreign, list_rule_ids())
    else:
        project = read_project(arguments.root, arguments.evidence, list_rule_ids(), arguments.allow_missing, arguments.date or "")
    project.release = arguments.release
    return project


def warn_of_gap(root: Path) -> None:
    """Reports on standard error the sources that could not be searched for used ids."""
    from mamori_trace.readers.history import describe_gap  # runs git, which most actions do not

    gap = describe_gap(root)
    if gap:
        print(f"mamori trace: {gap}; an id that only it knows could be allocated again", file=sys.stderr)


def find_item(project: Project, name: str) -> Item:
    """The item with this id. Raises InputError with the nearest ids."""
    item = project.items.get(name)
    if item is None:
        near = ", ".join(project.suggest(name))
        raise InputError(f"no item has the id '{name}'" + (f"; nearest: {near}" if near else ""))
    return item


def demand_readable(project: Project) -> None:
    """Raises InputError if a project file could not be read, because that file may contain ids and areas."""
    for problem in project.problems:
        if problem.rule == unreadable_input.RULE.id:
            raise InputError(f"{problem.place}: {problem.message}")


def print_outcome(arguments: argparse.Namespace, project: Project, findings: list[Finding], verdicts: dict[str, Verdict]) -> None:
    """Findings and summary in the form that `add_output` chose."""
    if arguments.output == "json":
        print(format_json(project, findings, verdicts), end="")
        return
    if arguments.output == SARIF:
        from mamori_trace.reports.sarif import format_sarif  # queries the version of the package, which is slow

        print(format_sarif(project, findings), end="")
        return
    paint = Paint(sys.stdout)
    listed = format_findings(findings, paint) + format_waived(project.waived, paint)
    print(listed + format_summary(project, findings, verdicts, paint), end="")


def _parse_date(text: str) -> str:
    if not is_date(text):
        raise argparse.ArgumentTypeError(f"'{text}' is no day of the form 2026-11-30")
    return text


def get_status(findings: list[Finding]) -> int:
    """Exit status that the findings require."""
    if any(finding.rule == unreadable_input.RULE.id for finding in findings):
        return EXIT_INPUT
    return EXIT_FINDINGS if any(finding.severity == ERROR for finding in findings) else EXIT_CLEAN
