# SPDX-License-Identifier: Apache-2.0
"""Reads from the git history every version of the texts in requirements/, and the commits that changed one item.

@satisfies SWR-TRC-078, SWR-TRC-081      Design: docs/design/trace.md#new-items
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.files import walk_whole
from mamori_trace.base.finding import Problem
from mamori_trace.base.git_run import run_git
from mamori_trace.model.impact import compare_items
from mamori_trace.model.item import Item, Schema
from mamori_trace.readers.git_changes import is_shallow, read_blobs
from mamori_trace.readers.markdown_items import parse_items

_FOLDER = "requirements"


@dataclass(frozen=True, slots=True)
class Event:
    """One commit that added, changed, moved or removed an item."""

    commit: str
    date: str
    author: str
    subject: str
    what: str


def describe_gap(root: Path) -> str:
    """Why the history is incomplete, or an empty text."""
    if run_git(root, ["rev-parse", "--git-dir"]) is None:
        return "there is no history of git at hand"
    return "the clone is shallow, older history is not at hand" if is_shallow(root) else ""


def read_texts(root: Path) -> Iterator[str]:
    """Every version of each text below requirements/: of all available branches, and of the current files.

    Raises OSError, because an unreadable file may contain an id.
    """
    for folder, _, files in walk_whole(root / _FOLDER):
        for path in (Path(folder, name) for name in files):
            if path.is_file():
                yield path.read_text(encoding="utf-8", errors="replace")
    listing = run_git(root, ["rev-list", "--all", "--objects", "--", _FOLDER]) or b""
    entries = []
    for line in listing.splitlines():
        name, _, stored = line.partition(b" ")
        if stored.endswith((b".md", b".lock")):
            entries.append((os.fsdecode(stored), name))
    for _, data in read_blobs(root, entries):
        yield data.decode("utf-8", errors="replace")


def read_events(root: Path, schema: Schema, item_id: str) -> list[Event]:
    """Ancestors of the checked-out commit that changed the item, newest first."""
    form = "--format=%x01%H%x1f%as%x1f%an%x1f%s"
    options = ["--first-parent", "--diff-merges=first-parent", "--raw", "-z", "--no-renames", "--abbrev=40", "--reverse", "--relative"]
    steps = _parse_log(run_git(root, ["log", *options, form, "--", _FOLDER]) or b"")
    names = {blob for _, changes in steps for _, blob in changes if blob}
    versions = _read_versions(root, schema, item_id, names)
    places: dict[str, Item] = {}
    events: list[Event] = []
    for head, changes in steps:
        before = _first(places)
        for path, blob in changes:
            places.pop(path, None)
            if blob in versions:
                places[path] = versions[blob]
        what = _describe(before, _first(places))
        if what:
            events.append(Event(*head, what))
    return events[::-1]


def _parse_log(data: bytes) -> list[tuple[tuple[str, str, str, str], list[tuple[str, str]]]]:
    """For each commit its text, and (path, blob) of each changed Markdown file; a removed file has no blob."""
    steps: list[tuple[tuple[str, str, str, str], list[tuple[str, str]]]] = []
    words = iter(data.split(b"\0"))
    for word in words:
        word = word.lstrip(b"\n")
        if word.startswith(b"\x01"):
            hash_, date, author, subject = word[1:].decode("utf-8", errors="replace").rstrip("\n").split("\x1f", 3)
            steps.append(((hash_, date, author, subject), []))
        elif word.startswith(b":") and steps:
            parts = word.split()
            path = os.fsdecode(next(words, b""))
            if path.endswith(".md"):
                steps[-1][1].append((path, "" if parts[4] == b"D" else parts[3].decode()))
    return steps


def _read_versions(root: Path, schema: Schema, item_id: str, names: set[str]) -> dict[str, Item]:
    """The item in each blob."""
    versions: dict[str, Item] = {}
    head = f"## {item_id} ".encode()
    for name, data in read_blobs(root, [(name, name.encode()) for name in sorted(names)]):
        if head in data:
            problems: list[Problem] = []
            items = parse_items(data.decode("utf-8", errors="replace"), name, schema, problems)
            versions.update((name, item) for item in items if item.id == item_id)
    return versions


def _first(places: dict[str, Item]) -> Item | None:
    return places[min(places)] if places else None


def _describe(before: Item | None, after: Item | None) -> str:
    old = {"": before} if before else {}
    new = {"": after} if after else {}
    changes = compare_items(old, new)
    if not changes:
        return ""
    return changes[0].state + (f": {', '.join(changes[0].fields)}" if changes[0].fields else "")
