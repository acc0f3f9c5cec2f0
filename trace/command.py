# SPDX-License-Identifier: Apache-2.0
"""`mamori trace check | report | show ID | review`.

Exit status: 0 clean, 1 findings of severity error, 2 wrong usage or input that could not be read.

@satisfies SWR-TRC-010, SWR-TRC-008      Design: docs/design/trace.md#command
"""

from __future__ import annotations

import argparse
import datetime
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from mamori.trace.checks import run_checks, unreadable_input
from mamori.trace.model.finding import ERROR, Finding
from mamori.trace.model.item import Item
from mamori.trace.model.lock import ReviewLock
from mamori.trace.model.project import Project
from mamori.trace.model.verdict import calc_verdicts
from mamori.trace.readers.files import InputError
from mamori.trace.readers.git import read_user
from mamori.trace.readers.lock import LOCK_PATH, write_lock
from mamori.trace.readers.project import read_project, read_requirements
from mamori.trace.reports.json_report import format_json, make_item
from mamori.trace.reports.text import Paint, format_findings, format_item, format_summary

EXIT_CLEAN = 0
EXIT_FINDINGS = 1
EXIT_INPUT = 2

_ABOUT = "Judge requirements by executed results, and show the chain from hazard to result."


def add_arguments(subparsers: argparse._SubParsersAction) -> None:
    """Adds the command `trace` to the sub-commands of the main command."""
    _add_actions(subparsers.add_parser("trace", help=_ABOUT, description=_ABOUT))


def run(arguments: argparse.Namespace) -> int:
    """Runs what `add_arguments` parsed. @return the exit status."""
    try:
        return _ACTIONS[arguments.trace_action](arguments)
    except (InputError, OSError) as error:
        print(f"mamori trace: {error}", file=sys.stderr)
        return EXIT_INPUT


def main(argv: Sequence[str] | None = None) -> int:
    """@return the exit status; argparse ends the process with 2 on wrong usage."""
    parser = argparse.ArgumentParser(prog="mamori trace", description=_ABOUT)
    _add_actions(parser)
    return run(parser.parse_args(argv))


def _add_actions(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="trace_action", required=True, metavar="check|report|show|review")
    check = actions.add_parser("check", help="report every finding, with rule, file and line")
    _add_input(check)
    report = actions.add_parser("report", help="write one offline HTML file")
    _add_input(report)
    report.add_argument("--out", type=Path, default=None, metavar="FILE", help="default: report/index.html in the project")
    show = actions.add_parser("show", help="show one item with its chain")
    _add_input(show)
    show.add_argument("item", metavar="ID")
    review = actions.add_parser("review", help=f"record in {LOCK_PATH} that links were looked at")
    review.add_argument("--root", type=Path, default=Path("."), metavar="DIR", help="project folder (default: here)")
    review.add_argument("items", nargs="*", metavar="ID", help="items whose links, up and down, were looked at")
    review.add_argument("--all", action="store_true", help="every link was looked at")
    review.add_argument("--by", default="", metavar="NAME", help="who looked (default: the user name that git knows)")


def _add_input(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--root", type=Path, default=Path("."), metavar="DIR", help="project folder (default: here)")
    parser.add_argument("--evidence", type=Path, metavar="DIR", help="default: build/host-release/evidence, or the only one")
    parser.add_argument("--allow-missing", action="store_true", help="results that are missing (not failing) are no errors")
    parser.add_argument("--format", choices=("text", "json"), default="text")


def _check(arguments: argparse.Namespace) -> int:
    project = read_project(arguments.root, arguments.evidence, arguments.allow_missing)
    findings = run_checks(project)
    _print_outcome(arguments, project, findings)
    return _get_status(findings)


def _report(arguments: argparse.Namespace) -> int:
    from mamori.trace.reports.html import write_report  # plots load matplotlib, which the other actions do not need

    project = read_project(arguments.root, arguments.evidence, arguments.allow_missing)
    out = arguments.out or arguments.root / "report" / "index.html"
    findings = write_report(project, out)
    _print_outcome(arguments, project, findings)
    print(f"report: {out}", file=sys.stderr if arguments.format == "json" else sys.stdout)
    return _get_status(findings)


def _show(arguments: argparse.Namespace) -> int:
    project = read_project(arguments.root, arguments.evidence, arguments.allow_missing)
    item = _find_item(project, arguments.item)
    verdicts = calc_verdicts(project)
    if arguments.format == "json":
        print(json.dumps(make_item(project, item, verdicts), indent=1, ensure_ascii=False))
    else:
        print(format_item(project, item, verdicts, Paint(sys.stdout)), end="")
    return EXIT_CLEAN


def _review(arguments: argparse.Namespace) -> int:
    if arguments.all == bool(arguments.items):
        raise InputError("review: name the items that were looked at, or --all")
    project = read_requirements(arguments.root)
    if project.problems:
        first = project.problems[0]
        raise InputError(f"{first.place}: {first.message}; mend it before reviewing")
    reviewer = arguments.by.strip() or read_user(arguments.root)
    if not reviewer:
        raise InputError("review: nobody is named; add --by NAME")
    chosen = set(project.items) if arguments.all else {_find_item(project, name).id for name in arguments.items}
    count = review_links(project, chosen, datetime.date.today().isoformat(), reviewer)
    write_lock(arguments.root, project.lock or ReviewLock())
    print(f"{count} links recorded as reviewed by {reviewer} in {LOCK_PATH}")
    return EXIT_CLEAN


def review_links(project: Project, chosen: set[str], date: str, reviewer: str) -> int:
    """Records a look at each suspect link with an end in `chosen`; forgets links that are no more.

    A link that is as it was keeps its date and its reviewer. @return how many were recorded.
    """
    lock = project.lock = project.lock or ReviewLock()
    live = {
        (child.id, parent): (child, project.items[parent])
        for child in project.live_items
        for parent in child.parents
        if parent in project.items
    }
    lock.reviews = {key: review for key, review in lock.reviews.items() if key in live}
    count = 0
    for key, (child, parent) in live.items():
        if chosen & set(key) and lock.describe_suspicion(child, parent):
            lock.record(child, parent, date, reviewer)
            count += 1
    return count


def _find_item(project: Project, name: str) -> Item:
    item = project.items.get(name)
    if item is None:
        near = ", ".join(project.suggest(name))
        raise InputError(f"no item has the id {name}" + (f"; nearest: {near}" if near else ""))
    return item


def _print_outcome(arguments: argparse.Namespace, project: Project, findings: list[Finding]) -> None:
    verdicts = calc_verdicts(project)
    if arguments.format == "json":
        print(format_json(project, findings, verdicts), end="")
        return
    paint = Paint(sys.stdout)
    print(format_findings(findings, paint) + format_summary(project, findings, verdicts, paint), end="")


def _get_status(findings: list[Finding]) -> int:
    if any(finding.rule == unreadable_input.RULE.id for finding in findings):
        return EXIT_INPUT
    return EXIT_FINDINGS if any(finding.severity == ERROR for finding in findings) else EXIT_CLEAN


_ACTIONS = {"check": _check, "report": _report, "show": _show, "review": _review}
