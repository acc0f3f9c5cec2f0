# SPDX-License-Identifier: Apache-2.0
"""`mamori trace impact REV`."""

from __future__ import annotations

import argparse
from pathlib import Path

from mamori_trace.actions.common import EXIT_CLEAN, add_output, add_root

HELP = "show the functions, requirements and hazards that a change touches, the tests to run and the links to review again"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    add_output(parser)
    parser.add_argument("revision", metavar="REV", help="the older side: a commit, branch or tag")
    parser.add_argument("--to", default="worktree", metavar="REV2", help="the newer side (default: worktree, the files as they are)")
    parser.add_argument("--evidence", type=Path, metavar="DIR", help="where the campaign cases are (default: as for check)")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.readers.impact import read_impact
    from mamori_trace.reports.impact import format_json, format_text

    impact, project = read_impact(arguments.root, arguments.revision, arguments.to, arguments.evidence)
    if arguments.output == "json":
        print(format_json(impact, project, arguments.revision, arguments.to), end="")
    else:
        print(format_text(impact, project, f"{arguments.revision} .. {arguments.to}"), end="")
    return EXIT_CLEAN
