# SPDX-License-Identifier: Apache-2.0
"""`mamori trace review ID ... | --all`."""

from __future__ import annotations

import argparse
import datetime
from pathlib import Path

from mamori_trace.actions.common import EXIT_CLEAN, add_root, find_item
from mamori_trace.actions.foreign import check_format
from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import Place
from mamori_trace.checks import list_rule_ids
from mamori_trace.formats.in_place import LOCK_NAME, ForeignInput, read_in_place
from mamori_trace.model.ids import FormerId
from mamori_trace.model.lock import ReviewLock
from mamori_trace.model.project import Project
from mamori_trace.readers.git import read_title, read_user
from mamori_trace.readers.ids import IDS_PATH, write_ids
from mamori_trace.readers.lock import LOCK_PATH, write_lock
from mamori_trace.readers.project import read_requirements

HELP = f"record in {LOCK_PATH} that links were reviewed"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_root(parser)
    parser.add_argument("items", nargs="*", metavar="ID", help="items whose links, up and down, were reviewed, or that no longer exist")
    parser.add_argument("--all", action="store_true", help="every link was reviewed")
    parser.add_argument("--format", nargs=2, metavar=("FORMAT", "PATH"), help=f"a project of another tool; its record is {LOCK_NAME} beside PATH")
    parser.add_argument("--schema", type=Path, metavar="FILE", help="meaning of the values and levels of that project")
    parser.add_argument("--by", default="", metavar="NAME", help="the reviewer (default: the user name in the git configuration)")


def run(arguments: argparse.Namespace) -> int:
    if arguments.all == bool(arguments.items):
        raise InputError("review: name the items that were looked at, or --all")
    project, lock_path = _read(arguments)
    if project.problems:
        first = project.problems[0]
        raise InputError(f"{first.place}: {first.message}; mend it before reviewing")
    reviewer = arguments.by.strip() or read_user(arguments.root)
    if not reviewer:
        raise InputError("review: nobody is named; add --by NAME")
    if not reviewer.isprintable():
        raise InputError(f"review: {reviewer!r} is no name; the record has one line for each link, with tabs between its columns")
    gone = list_gone(project)
    named = [name for name in arguments.items if name not in gone]
    chosen = set(project.items) if arguments.all else {find_item(project, name).id for name in named}
    date = datetime.date.today().isoformat()
    give_up_ids(project, gone, date)
    count = review_links(project, chosen, date, reviewer)
    write_ids(project.root, project.former_ids)  # first, because the lock is about to drop these ids
    write_lock(arguments.root, project.lock or ReviewLock(), lock_path)
    print(f"{count} links recorded as reviewed by {reviewer} in {lock_path or LOCK_PATH}")
    if gone:
        print(f"ids given up for good, in {IDS_PATH}: {', '.join(sorted(gone))}")
    return EXIT_CLEAN


def _read(arguments: argparse.Namespace) -> tuple[Project, Path | None]:
    """The project, and the path of its review lock if it is not the default."""
    if not arguments.format:
        return read_requirements(arguments.root), None
    name, path = arguments.format
    check_format(name)
    given = ForeignInput(name, Path(path), arguments.root, schema=arguments.schema, allow_missing=True)
    return read_in_place(given, list_rule_ids()), given.folder / LOCK_NAME


def list_gone(project: Project) -> dict[str, str]:
    """Ids without an item that reviewed links name, each with the fingerprint of its last review."""
    gone: dict[str, str] = {}
    for each in project.lock.reviews.values() if project.lock is not None else ():
        for name, fingerprint in ((each.child, each.child_fingerprint), (each.parent, each.parent_fingerprint)):
            if name not in project.items:
                gone[name] = fingerprint
    return gone


def give_up_ids(project: Project, gone: dict[str, str], date: str) -> None:
    """Adds retired ids to the ledger. An id that is already there keeps its first entry."""
    for name, fingerprint in gone.items():
        former = FormerId(name, fingerprint, date, read_title(project.root, name), Place(IDS_PATH, 1))
        project.former_ids.setdefault(name, former)


def review_links(project: Project, chosen: set[str], date: str, reviewer: str) -> int:
    """Records a review of each suspect link that has an end in `chosen`, and removes links that no longer exist.

    An unchanged link keeps its date and its reviewer. @return number of recorded links.
    """
    lock = project.lock = project.lock or ReviewLock()
    live = {
        (child.id, parent): (child, project.items[parent])
        for child in project.live_items
        for parent in child.parents
        if parent in project.items
    }
    lock.reviews = {key: review for key, review in lock.reviews.items() if key in live}
    count = 0
    for key, (child, parent) in live.items():
        if chosen & set(key) and lock.describe_suspicion(*key, project.fingerprints):
            lock.record(child, parent, date, reviewer)
            count += 1
    return count
