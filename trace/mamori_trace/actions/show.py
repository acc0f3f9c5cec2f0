# SPDX-License-Identifier: Apache-2.0
"""`mamori trace show ID`."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict

from mamori_trace.actions.common import EXIT_CLEAN, add_input, add_output, find_item, read_input
from mamori_trace.base.errors import InputError
from mamori_trace.model.verdict import calc_verdicts
from mamori_trace.reports.json_report import make_item
from mamori_trace.reports.text import Paint, format_item

HELP = "show one item with its chain from hazard to result; with --history the commits that changed it"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser)
    parser.add_argument("item", metavar="ID", help="id of the item")
    parser.add_argument("--history", action="store_true", help="also the commits that changed the item, newest first")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.readers.history import describe_gap, read_events
    from mamori_trace.reports.chain import format_chain, format_history, make_chain

    project = read_input(arguments)
    item = find_item(project, arguments.item)
    verdicts = calc_verdicts(project)
    gap = describe_gap(arguments.root) if arguments.history else ""
    events = read_events(arguments.root, project.schema, item.id) if arguments.history else []
    if gap and not events:
        raise InputError(f"{arguments.root}: {gap}; leave --history out")
    if arguments.output == "json":
        content = {**make_item(project, item, verdicts), **make_chain(project, item, verdicts)}
        if arguments.history:
            content |= {"history": [asdict(event) for event in events], "history_gap": gap}
        print(json.dumps(content, indent=1, ensure_ascii=False))
        return EXIT_CLEAN
    paint = Paint(sys.stdout)
    print(format_item(project, item, verdicts, paint) + format_chain(project, item, verdicts, paint), end="")
    if arguments.history:
        print(format_history(events, gap), end="")
    return EXIT_CLEAN
