# SPDX-License-Identifier: Apache-2.0
"""Reads `@satisfies` tags and `@pytest.mark.verifies(...)` marks from Python sources.

Only docstrings, comments and decorators count, so a test may contain tags in its strings.

@satisfies SWR-TRC-002, SWR-TRC-003      Design: docs/design/trace.md#code-tags
"""

from __future__ import annotations

import ast
import io
import tokenize
from pathlib import Path

from mamori_trace.base.files import UNREADABLE, is_test_file, read_text, walk_sources
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.code import CodeBase, Scope
from mamori_trace.model.evidence import CodeTag, SourceTest
from mamori_trace.readers.python_functions import Definition, list_definitions, make_functions
from mamori_trace.readers.tag_text import FILE_SYMBOL, ID_PATTERN, find_verified, has_mark, make_tags


def read_python(
    root: Path, problems: list[Problem], code: CodeBase | None = None, id_pattern: str = ID_PATTERN
) -> tuple[list[CodeTag], list[SourceTest]]:
    """Tags of all Python files except tests, and markers of the tests. @param code receives the functions of all files except tests."""
    tags: list[CodeTag] = []
    tests: list[SourceTest] = []
    for path, shown in walk_sources(root, (".py",), problems):
        in_test = is_test_file(shown)
        text = read_text(path, shown, problems)
        if "verifies" not in text and not has_mark(text) if in_test else code is None and not has_mark(text):
            continue
        try:
            tree = ast.parse(text)
        except (SyntaxError, ValueError, RecursionError) as error:
            line = getattr(error, "lineno", None) or 1
            problems.append(Problem(UNREADABLE, Place(shown, line), f"is not valid Python: {error}"))
            continue
        if in_test:
            tests.extend(_find_marks(tree, shown))
            tests.extend(_find_tagged(tree, text, shown, id_pattern) if has_mark(text) else ())
            continue
        definitions = list_definitions(tree) if code is not None or has_mark(text) else []
        if code is not None:
            code.functions.extend(make_functions(definitions, shown))
        if has_mark(text):
            tags.extend(_find_tags(tree, definitions, text, shown, problems, code, id_pattern))
    return tags, tests


def _find_tags(
    tree: ast.Module, definitions: list[Definition], text: str, shown: str, problems: list[Problem],
    code: CodeBase | None, id_pattern: str,
) -> list[CodeTag]:  # fmt: skip
    lines = text.splitlines()
    tags: list[CodeTag] = []
    whole = Definition(tree, "", 0, 0)
    for one in [whole, *definitions]:
        first = one.node.body[0] if one.node.body else None
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str):
            for number in range(first.lineno, (first.end_lineno or first.lineno) + 1):
                tags += _add_tags(lines[number - 1], Place(shown, number), one, problems, code, id_pattern)
    starts = {one.first: one for one in definitions}
    comments = _list_comments(text)
    for number, comment in comments.items():
        if has_mark(comment):
            below = number + 1
            while below in comments:
                below += 1
            tags += _add_tags(comment, Place(shown, number), starts.get(below, whole), problems, code, id_pattern)
    return sorted(tags, key=lambda tag: (tag.place, tag.requirement))


def _add_tags(
    line: str, place: Place, owner: Definition, problems: list[Problem], code: CodeBase | None, id_pattern: str
) -> list[CodeTag]:
    """Tags of one line; their scope is added to `code`."""
    tags = make_tags(line, place, owner.name.rpartition("::")[2] or FILE_SYMBOL, problems, id_pattern)
    if tags and code is not None:
        code.scopes.append(Scope(place.file, owner.name, owner.first, owner.last, tuple(tag.requirement for tag in tags)))
    return tags


def _list_comments(text: str) -> dict[int, str]:
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return {token.start[0]: token.string for token in tokens if token.type == tokenize.COMMENT}


def _find_marks(tree: ast.Module, shown: str) -> list[SourceTest]:
    """Markers of test functions, also inside one class; a marker on a class counts for each of its tests."""
    module = shown.rpartition("/")[2].removesuffix(".py")
    tests: list[SourceTest] = []
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            inherited = [mark for mark in map(_read_mark, node.decorator_list) if mark]
            for inner in node.body:
                tests.extend(_make_tests(inner, f"{module}.{node.name}", inherited, shown))
        else:
            tests.extend(_make_tests(node, module, [], shown))
    return tests


def _find_tagged(tree: ast.Module, text: str, shown: str, id_pattern: str) -> list[SourceTest]:
    """Tests for which their docstring, or a comment above, names an id."""
    module = shown.rpartition("/")[2].removesuffix(".py")
    lines = text.splitlines()
    comments = _list_comments(text)
    tests: list[SourceTest] = []
    for one in list_definitions(tree):
        name = one.name.rpartition("::")[2]
        if one.inner or isinstance(one.node, ast.ClassDef) or not name.startswith("test"):
            continue
        suite = ".".join([module, *one.name.split("::")[:-1]])
        chosen = one.first - 1
        while chosen in comments and lines[chosen - 1].lstrip().startswith("#"):
            chosen -= 1
        body = one.node.body[0]
        last = (body.end_lineno or body.lineno) if ast.get_docstring(one.node) is not None else one.first - 1
        for number in (*range(chosen + 1, one.first), *range(body.lineno, last + 1)):
            tests += [
                SourceTest(word, suite, name, "requirements_based", "nominal", Place(shown, number), by_comment=True)
                for _, word in find_verified(lines[number - 1], id_pattern)
            ]
    return tests


def _make_tests(node: ast.stmt, suite: str, inherited: list[tuple[str, str, str]], shown: str) -> list[SourceTest]:
    if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or not node.name.startswith("test"):
        return []
    marks = [mark for mark in map(_read_mark, node.decorator_list) if mark] or inherited
    place = Place(shown, node.lineno)
    return [SourceTest(requirement, suite, node.name, technique, polarity, place)
            for requirement, technique, polarity in marks]  # fmt: skip


def _read_mark(node: ast.expr) -> tuple[str, str, str] | None:
    """(requirement, technique, polarity) of `@pytest.mark.verifies("ID", technique="...", polarity="...")`."""
    if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "verifies"):
        return None
    values = {"requirement": "", "technique": "requirements_based", "polarity": "nominal"}
    named = [*zip(values, node.args, strict=False), *((keyword.arg, keyword.value) for keyword in node.keywords)]
    for name, value in named:
        if name in values and isinstance(value, ast.Constant):
            values[name] = str(value.value)
    return (values["requirement"], values["technique"], values["polarity"])
