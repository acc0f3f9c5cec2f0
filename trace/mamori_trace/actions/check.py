# SPDX-License-Identifier: Apache-2.0
"""`mamori trace check`."""

from __future__ import annotations

import argparse

from mamori_trace.actions.common import SARIF, add_input, add_output, get_status, print_outcome, read_input

HELP = "check every requirement, link and result; report each finding with rule, file and line, and end with status 1 for an error"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser, SARIF)
    parser.add_argument("--no-cache", action="store_true", help="read everything, also when nothing changed since the last check")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.checks import run_checks
    from mamori_trace.model.verdict import calc_verdicts

    project = read_input(arguments)
    findings = run_checks(project)
    print_outcome(arguments, project, findings, calc_verdicts(project))
    return get_status(findings)
