# SPDX-License-Identifier: Apache-2.0
"""`mamori trace query EXPR`."""

from __future__ import annotations

import argparse
import json
import sys
from typing import TYPE_CHECKING

from mamori_trace.actions.common import EXIT_CLEAN, add_input, add_output, read_input
from mamori_trace.base.errors import InputError

if TYPE_CHECKING:
    from mamori_trace.model.project import Project

HELP = "list the items for which an expression holds, for example: level=SWR and sil>=2 and verdict!=verified"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser)
    parser.add_argument("expression", metavar="EXPR", help="comparisons joined by and, or, not and brackets (docs/manual/trace.md)")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--ids", action="store_true", help="print the ids only")
    form.add_argument("--count", action="store_true", help="print the number only")
    form.add_argument("--markdown", action="store_true", help="print a Markdown table, for documents")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.base.errors import FormatError
    from mamori_trace.model.query import Query
    from mamori_trace.model.verdict import calc_verdicts
    from mamori_trace.reports.json_report import make_item
    from mamori_trace.reports.query import format_markdown, format_table
    from mamori_trace.reports.text import Paint

    project = read_input(arguments)
    verdicts = calc_verdicts(project)
    try:
        items = Query(arguments.expression, project, verdicts, lambda: _group_rules(project)).select()
    except FormatError as error:
        raise InputError(f"query: {error}") from None
    if arguments.output == "json":
        rows = [] if arguments.count else [item.id if arguments.ids else make_item(project, item, verdicts) for item in items]
        content = {"schema": "mamori.query/1", "expression": arguments.expression, "count": len(items), "items": rows}
        print(json.dumps(content, indent=1, ensure_ascii=False))
    elif arguments.count:
        print(len(items))
    elif arguments.ids:
        print("".join(f"{item.id}\n" for item in items), end="")
    elif arguments.markdown:
        print(format_markdown(items), end="")
    else:
        print(format_table(items, verdicts, Paint(sys.stdout)), end="")
    return EXIT_CLEAN


def _group_rules(project: Project) -> dict[str, set[str]]:
    from mamori_trace.checks import run_checks

    rules: dict[str, set[str]] = {}
    for finding in run_checks(project):
        rules.setdefault(finding.item, set()).add(finding.rule)
    return rules
