# SPDX-License-Identifier: Apache-2.0
"""`mamori trace import FORMAT PATH --into requirements/FOLDER`.

@satisfies SWR-TRC-049      Design: docs/design/trace_formats.md#import
"""

from __future__ import annotations

import argparse
from pathlib import Path

from mamori_trace.actions.common import EXIT_CLEAN, add_root, warn_of_gap
from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import Problem
from mamori_trace.formats.mapping import read_mapping
from mamori_trace.formats.registry import FORMATS, read_format
from mamori_trace.formats.take_over import Takeover, find_earlier, take_back, take_over, write_takeover
from mamori_trace.model.lock import ReviewLock
from mamori_trace.readers.history import read_texts
from mamori_trace.readers.lock import write_lock
from mamori_trace.readers.project import read_requirements

HELP = "import requirements of another tool as Markdown items"
MAP_NAME = "import_map.csv"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    parser.add_argument("source", choices=list(FORMATS), metavar="FORMAT", help=", ".join(FORMATS))
    parser.add_argument("path", type=Path, metavar="PATH", help="file or folder of the other tool")
    parser.add_argument("--into", type=Path, required=True, metavar="FOLDER", help="folder below requirements/; nothing in it is overwritten")
    parser.add_argument("--area", default="IMP", metavar="WORD", help="area of new ids: SWR-WORD-001, or the next free number (default: IMP)")
    parser.add_argument("--schema", type=Path, metavar="FILE", help="meaning of the values and levels of the project")


def run(arguments: argparse.Namespace) -> int:
    project = read_requirements(arguments.root)
    folder = arguments.root / arguments.into
    if not folder.resolve().is_relative_to((arguments.root / "requirements").resolve()):
        raise InputError(f"--into {arguments.into}: is not below requirements/, where items are looked for")
    problems: list[Problem] = []
    foreign = read_format(arguments.source, arguments.path, arguments.root, problems)
    unread = [problem for problem in problems if problem.rule == "unreadable-input"]
    if unread:
        raise InputError(f"{unread[0].place}: {unread[0].message}; nothing was taken over")
    mapping = read_mapping(arguments.source, arguments.schema)
    outcome = take_over(foreign, mapping, project.schema, arguments.area, list(read_texts(arguments.root)), problems)
    earlier = find_earlier(outcome, _read_maps(arguments.root))
    if earlier:
        raise InputError(f"{earlier}; nothing was taken over")
    taken = sorted(set(outcome.ids.values()) & set(project.items))
    if taken:
        raise InputError(f"{project.items[taken[0]].place}: {taken[0]} is there already, and ids are never reused; nothing was taken over")
    written = write_takeover(outcome, folder, MAP_NAME)
    if outcome.reviews:
        lock = project.lock or ReviewLock()
        lock.reviews.update({(each.child, each.parent): each for each in outcome.reviews})
        try:
            write_lock(arguments.root, lock)
        except InputError:
            take_back(written)
            raise
    if any(old != new for old, new in outcome.ids.items()):
        warn_of_gap(arguments.root)
    _tell(outcome, written, problems)
    return EXIT_CLEAN


def _read_maps(root: Path) -> dict[str, str]:
    """The maps of earlier imports, by the path that the user specified."""
    paths = (path for path in (root / "requirements").rglob(MAP_NAME) if path.is_file())
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8", errors="replace") for path in paths}


def _tell(outcome: Takeover, written: list[Path], problems: list[Problem]) -> None:
    """All parts that were not imported, ordered by file and line, then the imported parts."""
    rows = [(loss.place, loss.what) for loss in outcome.losses] + [(problem.place, problem.message) for problem in problems]
    for place, what in sorted(set(rows)):
        print(f"{place}: not taken over: {what}")
    print(f"{len(outcome.ids)} items in {len(written) - 1} files; new ids in {next(path for path in written if path.name == MAP_NAME)}; "
          f"{len(set(rows))} things not taken over")  # fmt: skip
