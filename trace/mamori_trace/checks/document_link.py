# SPDX-License-Identifier: Apache-2.0
"""Safety documents that name missing ids or tests.

@satisfies SWR-TRC-082      Design: docs/design/trace.md#documents
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator

from mamori_trace.base.files import list_paths, read_text
from mamori_trace.base.finding import ERROR, Place, Problem, Rule
from mamori_trace.model.project import Project

RULE = Rule("document-link", ERROR, "Ids and tests that a document of docs/manual/safety names exist, and the ids are not retired.")

FOLDER = "docs/manual/safety"
_TEST = re.compile(r"\b(test_\w+\.py)::(test_\w+)")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    ids = re.compile(rf"(?<![\w-])(?:{'|'.join(map(re.escape, sorted(project.schema.levels)))})(?:-[A-Z0-9]+)*-\d+(?![\w-])")
    tests = {(test.place.file.rpartition("/")[2], test.name) for test in project.tests}
    problems: list[Problem] = []
    paths = list_paths(project.root / FOLDER, "*.md", project.root, problems)
    texts = [(f"{FOLDER}/{path.name}", read_text(path, f"{FOLDER}/{path.name}", problems)) for path in paths]
    yield from ((problem.place, problem.message, "") for problem in problems)
    for shown, text in texts:
        for number, line in enumerate(text.splitlines(), start=1):
            place = Place(shown, number)
            for named in dict.fromkeys(ids.findall(line)):
                message = _judge_id(project, named)
                if message:
                    yield place, message, named
            for file, name in dict.fromkeys(_TEST.findall(line)):
                if (file, name) not in tests:
                    yield place, f"names the test {file}::{name}, which verifies nothing or does not exist{_hint(name, tests)}", ""


def _judge_id(project: Project, named: str) -> str:
    item = project.items.get(named)
    if item is None:
        near = ", ".join(project.suggest(named))
        return f"names {named}, which nothing defines" + (f"; nearest: {near}" if near else "")
    return f"names {named}, which is retired ({item.place})" if item.retired else ""


def _hint(name: str, tests: set[tuple[str, str]]) -> str:
    near = difflib.get_close_matches(name, sorted({each for _, each in tests}), n=1, cutoff=0.7)
    return f"; nearest: {near[0]}" if near else ""
