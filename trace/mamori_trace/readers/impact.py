# SPDX-License-Identifier: Apache-2.0
"""Reads both sides of a change for `mamori trace impact`: the old project, the new project, and the changed parts.

@satisfies SWR-TRC-070, SWR-TRC-073      Design: docs/design/trace.md#impact
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.files import is_test_file, read_text
from mamori_trace.model.impact import ADDED, CHANGED, REMOVED, WHOLE_FILE, Impact, Owners, Part, calc_impact
from mamori_trace.model.project import Project
from mamori_trace.readers.campaign import read_campaign
from mamori_trace.readers.changed_functions import CPP_SUFFIXES, Span, find_touched, list_spans
from mamori_trace.readers.cpp_tags import read_cpp_tags
from mamori_trace.readers.cpp_tests import read_cpp_tests
from mamori_trace.readers.git_changes import FileChange, list_changes, resolve_revision, write_tree
from mamori_trace.readers.headings import list_headings
from mamori_trace.readers.project import find_evidence, read_requirements
from mamori_trace.readers.python_sources import read_python
from mamori_trace.readers.script_tags import read_script_tags

WORKTREE = "worktree"
_SOURCES = (*CPP_SUFFIXES, ".py")


def read_impact(root: Path, revision: str, to: str, evidence: Path | None) -> tuple[Impact, Project]:
    """Impact of the change from `revision` to `to`, and the newer project. Raises InputError."""
    old_commit = resolve_revision(root, revision)
    new_commit = None if to == WORKTREE else resolve_revision(root, to)
    changes = list_changes(root, old_commit, new_commit)
    with tempfile.TemporaryDirectory(prefix="mamori-impact-") as folder:
        old_root, new_root = Path(folder, "old"), root
        changed = {change.old_path for change in changes}
        write_tree(root, old_commit, old_root, lambda path: path in changed or path.startswith("requirements/"))
        if new_commit is not None:
            new_root = Path(folder, "new")
            write_tree(root, new_commit, new_root, lambda path: True)
        old, new = _read_side(old_root, revision), _read_side(new_root, to)
        _read_cases(new, root, evidence)
        parts, headings, unattributed = _list_parts(changes, old, new)
        return calc_impact(old, new, parts, headings, unattributed), new


def _read_side(root: Path, name: str) -> Project:
    """Items, lock, tags and tests. `mamori trace check` reports problems of the texts."""
    if not (root / "requirements" / "schema" / "items.toml").is_file():
        raise InputError(f"revision '{name}' holds no requirements/schema/items.toml; choose one at which the project had requirements")
    try:
        project = read_requirements(root)
    except InputError as error:
        raise InputError(f"revision '{name}': {str(error).replace(str(root) + '/', '')}") from None
    project.tags = read_cpp_tags(root, project.problems) + read_script_tags(root, project.problems)
    project.tests = read_cpp_tests(root, project.problems)
    tags, tests = read_python(root, project.problems)
    project.tags += tags
    project.tests += tests
    return project


def _read_cases(project: Project, root: Path, evidence: Path | None) -> None:
    """Campaign cases of the available evidence; without evidence there are none, which the report states."""
    if evidence is not None and not evidence.is_dir():
        raise InputError(f"{evidence}: no such evidence folder; run the campaign first, or leave the option out")
    try:
        folder = evidence or find_evidence(root)
    except InputError:
        return
    project.evidence.folder = folder.as_posix()
    read_campaign(folder, root, project.evidence, project.problems)


def _list_parts(changes: list[FileChange], old: Project, new: Project) -> tuple[list[Part], list[Part], list[str]]:
    """Parts of sources and tests, design headings, and files that belong to no item."""
    owners = Owners([*old.tags, *new.tags])
    tagged = {tag.place.file for tag in (*old.tags, *new.tags)}
    parts: list[Part] = []
    headings: list[Part] = []
    unattributed: list[str] = []
    for change in changes:
        path = change.path
        if path.startswith("requirements/") and path.endswith((".md", "trace.lock")):
            continue  # compared separately by items and links
        if path.endswith(".md"):
            headings += _list_headings(change, old, new)
        elif is_test_file(path) and path.endswith(_SOURCES):
            found = _list_tests(change, old, new)
            parts += found
            unattributed += [] if found else [path]
        elif path.endswith(_SOURCES):
            parts += _list_functions(change, old, new, owners)
        elif {change.old_path, change.new_path} & tagged:
            names = [name for name in (change.old_path, change.new_path) if name in tagged]
            requirements = sorted({each for name in names for each in owners.find(name, WHOLE_FILE)})
            parts.append(Part(path, WHOLE_FILE, CHANGED, tuple(requirements)))
        else:
            unattributed.append(path)
    return parts, headings, unattributed


def _read_spans(project: Project, path: str) -> list[Span]:
    return list_spans(read_text(project.root / path, path, []), path) if path and (project.root / path).is_file() else []


def _list_states(change: FileChange, old: Project, new: Project) -> tuple[dict[str, tuple[str, bool]], bool]:
    """The name of each touched span, before and after the change, mapped to (state, whether it is a test); and whether a line
    outside all spans changed."""
    before, after = _read_spans(old, change.old_path), _read_spans(new, change.new_path)
    old_touched, old_outside = find_touched(before, change.old_ranges)
    new_touched, new_outside = find_touched(after, change.new_ranges)
    old_names, new_names = {span.name for span in before}, {span.name for span in after}
    states: dict[str, tuple[str, bool]] = {}
    for span in (*old_touched, *new_touched):
        state = REMOVED if span.name not in new_names else ADDED if span.name not in old_names else CHANGED
        states[span.name] = (state, span.is_test)
    return states, old_outside or new_outside


def _list_functions(change: FileChange, old: Project, new: Project, owners: Owners) -> list[Part]:
    states, outside = _list_states(change, old, new)
    files = sorted({change.old_path, change.new_path} - {""})
    if outside or not states:
        states[WHOLE_FILE] = (_get_file_state(change), False)
    return [
        Part(change.path, name, state, tuple(sorted({each for file in files for each in owners.find(file, name)})))
        for name, (state, _) in states.items()
    ]


def _get_file_state(change: FileChange) -> str:
    return ADDED if not change.old_path else REMOVED if not change.new_path else CHANGED


def _list_tests(change: FileChange, old: Project, new: Project) -> list[Part]:
    """Touched tests. A change outside all tests affects all tests of the file; a change of a helper file affects the tests of its
    folder."""
    states, outside = _list_states(change, old, new)
    names = {name: state for name, (state, is_test) in states.items() if is_test}
    if outside or len(names) < len(states) or not names:
        for span in _read_spans(new, change.new_path):
            if span.is_test:
                names.setdefault(span.name, CHANGED)
    parts = [Part(change.path, name, state, (), True) for name, state in names.items()]
    return parts or _list_neighbours(change, new)


def _list_neighbours(change: FileChange, new: Project) -> list[Part]:
    """Tests of the folder of a helper, and of its subfolders."""
    folder = change.path.rpartition("/")[0].removesuffix("/support") + "/"
    files = sorted({test.place.file for test in new.tests if test.place.file.startswith(folder)})
    return [Part(file, span.name, CHANGED, (), True) for file in files for span in _read_spans(new, file) if span.is_test]


def _list_headings(change: FileChange, old: Project, new: Project) -> list[Part]:
    """Touched headings, with the items whose design link names them."""
    sides = []
    for project, path, ranges in ((old, change.old_path, change.old_ranges), (new, change.new_path, change.new_ranges)):
        text = read_text(project.root / path, path, []) if path and (project.root / path).is_file() else ""
        sides.append((path, list_headings(text), ranges))
    known = [{anchor for anchor, _, _ in rows} for _, rows, _ in sides]
    touched = {anchor for _, rows, ranges in sides for anchor in _find_headings(rows, ranges)}
    parts = []
    for anchor in touched:
        links = {f"{path}#{anchor}" for path, _, _ in sides if path}
        items = {item.id for project in (old, new) for item in project.live_items if item.design in links}
        state = REMOVED if anchor not in known[1] else ADDED if anchor not in known[0] else CHANGED
        parts.append(Part(change.path, anchor, state, tuple(sorted(items))))
    return parts


def _find_headings(rows: list[tuple[str, int, int]], ranges: list[tuple[int, int]]) -> set[str]:
    """The heading above each touched line, and the headings that contain that heading."""
    touched: set[str] = set()
    for first, last in ranges:
        path: list[tuple[str, int]] = []
        for index, (anchor, depth, line) in enumerate(rows):
            if line > last:
                break
            path = [(name, level) for name, level in path if level < depth] + [(anchor, depth)]
            end = rows[index + 1][2] - 1 if index + 1 < len(rows) else last
            if end >= first:
                touched.update(name for name, _ in path)
    return touched
