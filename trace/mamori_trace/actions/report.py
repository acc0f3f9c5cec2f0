# SPDX-License-Identifier: Apache-2.0
"""`mamori trace report`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from mamori_trace.actions.common import SARIF, add_input, add_output, get_status, print_outcome, read_input
from mamori_trace.base.errors import InputError

HELP = "write one offline HTML file from the present evidence, and on request a PDF"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser, SARIF)
    parser.add_argument("--out", type=Path, default=None, metavar="FILE", help="default: report/index.html in the project")
    parser.add_argument("--pdf", type=Path, default=None, metavar="FILE", help="also print to this PDF file (needs chromium)")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.base.errors import WorkError
    from mamori_trace.reports.chromium import find_chromium
    from mamori_trace.reports.html import write_report
    from mamori_trace.reports.pdf import print_page

    out = arguments.out or arguments.root / "report" / "index.html"
    pdf: Path | None = arguments.pdf
    if pdf is not None and os.path.realpath(pdf) == os.path.realpath(out):
        raise InputError(f"{pdf}: is the file of the page, too; give --pdf and --out two names")
    try:
        if pdf is not None:
            find_chromium()  # before the slow reading
        project = read_input(arguments)
        findings, verdicts = write_report(project, out, None if pdf is None else lambda page: print_page(page, pdf))
    except WorkError as error:
        raise InputError(f"{pdf}: not written: {error}") from error
    print_outcome(arguments, project, findings, verdicts)
    stream = sys.stdout if arguments.output == "text" else sys.stderr
    for file in filter(None, (out, pdf)):
        print(f"report: {file}", file=stream)
    return get_status(findings)
