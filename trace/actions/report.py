# SPDX-License-Identifier: Apache-2.0
"""`mamori trace report`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from mamori.trace.actions.common import SARIF, add_input, add_output, get_status, print_outcome, read_input

HELP = "write one offline HTML file"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser, SARIF)
    parser.add_argument("--out", type=Path, default=None, metavar="FILE", help="default: report/index.html in the project")


def run(arguments: argparse.Namespace) -> int:
    from mamori.trace.reports.html import write_report  # plots load matplotlib, which the other actions do not need

    project = read_input(arguments)
    out = arguments.out or arguments.root / "report" / "index.html"
    findings = write_report(project, out)
    print_outcome(arguments, project, findings)
    print(f"report: {out}", file=sys.stdout if arguments.output == "text" else sys.stderr)
    return get_status(findings)
