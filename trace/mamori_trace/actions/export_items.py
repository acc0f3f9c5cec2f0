# SPDX-License-Identifier: Apache-2.0
"""`mamori trace export FORMAT --out FILE`.

@satisfies SWR-TRC-050      Design: docs/design/trace_formats.md#export
"""

from __future__ import annotations

import argparse
from pathlib import Path

from mamori_trace.actions.common import EXIT_CLEAN, add_root
from mamori_trace.actions.foreign import check_format
from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.write import write_folder, write_whole
from mamori_trace.formats.model import ForeignProject
from mamori_trace.formats.own import make_neutral
from mamori_trace.formats.registry import read_format
from mamori_trace.formats.writers import FOLDER_WRITERS, WRITERS
from mamori_trace.readers.project import read_requirements

HELP = "write the requirements in the format of another tool"
_TARGETS = sorted({*WRITERS, *FOLDER_WRITERS})


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    parser.add_argument("target", choices=_TARGETS, metavar="FORMAT", help=", ".join(_TARGETS))
    parser.add_argument("--out", type=Path, required=True, metavar="FILE",
                        help=f"the file to write; for {', '.join(FOLDER_WRITERS)} a folder, which must not be there yet")  # fmt: skip
    parser.add_argument("--format", nargs=2, metavar=("FORMAT", "PATH"), help="export the items in the files of another tool")


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
    _demand_single(neutral)
    if arguments.target in FOLDER_WRITERS:
        write_folder(arguments.out, FOLDER_WRITERS[arguments.target](neutral))
    else:
        write_whole(arguments.out, WRITERS[arguments.target](neutral))
    print(f"{len(neutral.items)} items written to {arguments.out}")
    return EXIT_CLEAN


def _demand_single(project: ForeignProject) -> None:
    """Raises InputError if two items have one id: a format that stores items by id would lose one."""
    first: dict[str, Place] = {}
    for item in project.items:
        if item.id in first:
            raise InputError(f"{item.place}: {item.id} is defined at {first[item.id]}, too; mend it before the export")
        first[item.id] = item.place
