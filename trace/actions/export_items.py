# SPDX-License-Identifier: Apache-2.0
"""`mamori trace export FORMAT --out FILE`.

@satisfies SWR-TRC-050      Design: docs/design/trace_formats.md#export
"""

from __future__ import annotations

import argparse
from pathlib import Path

from mamori.trace.actions.common import EXIT_CLEAN, add_root
from mamori.trace.actions.foreign import check_format
from mamori.trace.formats.own import make_neutral
from mamori.trace.formats.registry import read_format
from mamori.trace.formats.writers import WRITERS
from mamori.trace.model.finding import Problem
from mamori.trace.readers.files import InputError
from mamori.trace.readers.project import read_requirements
from mamori.trace.write import write_whole

HELP = "write the requirements in the format of another tool"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    parser.add_argument("target", choices=sorted(WRITERS), metavar="FORMAT", help=", ".join(sorted(WRITERS)))
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="the file to write")
    parser.add_argument("--format", nargs=2, metavar=("FORMAT", "PATH"), help="take the items from another tool's files instead")


def run(arguments: argparse.Namespace) -> int:
    problems: list[Problem] = []
    if arguments.format:
        name, path = arguments.format
        check_format(name)
        neutral = read_format(name, Path(path), arguments.root, problems)
    else:
        project = read_requirements(arguments.root)
        problems = project.problems
        neutral = make_neutral(project)
    if problems:
        raise InputError(f"{problems[0].place}: {problems[0].message}; mend it before the export")
    write_whole(arguments.out, WRITERS[arguments.target](neutral))
    print(f"{len(neutral.items)} items written to {arguments.out}")
    return EXIT_CLEAN
