# SPDX-License-Identifier: Apache-2.0
"""`mamori trace new KIND`."""

from __future__ import annotations

import argparse
from pathlib import Path

from mamori_trace.actions.common import EXIT_CLEAN, add_root, demand_readable, warn_of_gap
from mamori_trace.base.errors import InputError

HELP = "allocate an id that was never used, and print or append the draft of an item"
_WORDS = ("title", "statement", "rationale", "sil", "verify", "polarity", "design")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    parser.add_argument("kind", metavar="KIND", help="level of the item, as requirements/schema/items.toml names it, for example SWR")
    parser.add_argument("--area", default="", metavar="AREA", help="area of a software requirement, for example SUP")
    parser.add_argument("--new-area", action="store_true", help="the area begins with this item")
    parser.add_argument("--parents", default="", metavar="ID,...", help="ids, comma separated")
    for word in _WORDS:
        parser.add_argument(f"--{word}", default="", metavar="TEXT", help=f"{word} of the item")
    parser.add_argument("--file", type=Path, metavar="FILE", help="append to this file of requirements/ (default: print)")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.base.errors import FormatError
    from mamori_trace.model.new_item import Wish, allocate, find_prefix, format_draft
    from mamori_trace.readers.history import read_texts
    from mamori_trace.readers.new_item import append_block, check_block, check_file
    from mamori_trace.readers.project import read_requirements

    project = read_requirements(arguments.root)
    demand_readable(project)
    parents = tuple(name.strip() for name in arguments.parents.split(",") if name.strip())
    wish = Wish(arguments.kind, arguments.area, arguments.new_area, parents=parents,
                **{word: getattr(arguments, word).strip() for word in _WORDS})  # fmt: skip
    if arguments.file is not None:
        check_file(arguments.root, arguments.file)
    try:
        level, prefix = find_prefix(project, wish)
        item_id = allocate(prefix, read_texts(arguments.root))
        block = format_draft(project, level, item_id, wish)
    except FormatError as error:
        raise InputError(f"new: {error}") from None
    check_block(block, item_id, project.schema)
    warn_of_gap(arguments.root)
    if arguments.file is None:
        print(block, end="")
    else:
        line = append_block(arguments.file, block, item_id)
        print(f"{item_id} in {arguments.file}:{line}")
    return EXIT_CLEAN
