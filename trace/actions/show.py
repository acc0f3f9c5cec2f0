# SPDX-License-Identifier: Apache-2.0
"""`mamori trace show ID`."""

from __future__ import annotations

import argparse
import json
import sys

from mamori.trace.actions.common import EXIT_CLEAN, add_input, add_output, find_item, read_input
from mamori.trace.model.verdict import calc_verdicts
from mamori.trace.reports.json_report import make_item
from mamori.trace.reports.text import Paint, format_item

HELP = "show one item with its chain"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser)
    parser.add_argument("item", metavar="ID")


def run(arguments: argparse.Namespace) -> int:
    project = read_input(arguments)
    item = find_item(project, arguments.item)
    verdicts = calc_verdicts(project)
    if arguments.output == "json":
        print(json.dumps(make_item(project, item, verdicts), indent=1, ensure_ascii=False))
    else:
        print(format_item(project, item, verdicts, Paint(sys.stdout)), end="")
    return EXIT_CLEAN
