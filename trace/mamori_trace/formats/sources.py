# SPDX-License-Identifier: Apache-2.0
"""Reads tags in code and tests of an external project, with ids of any form, and binds them to functions and tests.

@satisfies SWR-TRC-047      Design: docs/design/trace_formats.md#tags-of-other-tools
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from pathlib import Path

import tree_sitter
import tree_sitter_cpp

from mamori_trace.base.files import get_shown_path, is_test_file, walk_sources
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_whole
from mamori_trace.model.code import CodeBase
from mamori_trace.model.evidence import CodeTag, SourceTest
from mamori_trace.readers.cpp_heads import list_cpp_heads
from mamori_trace.readers.cpp_plain import Plain, find_dead_lines
from mamori_trace.readers.cpp_tags import FILE_SYMBOL, parse_cpp_tags
from mamori_trace.readers.tag_text import ANY_ID, VERIFIES, TagWord, find_words, has_mark
from mamori_trace.readers.test_heads import find_head, list_heads

_CPP = (".c", ".h", ".hpp", ".hh", ".hxx", ".cpp", ".cc", ".cxx", ".ipp")
_PYTHON = (".py",)
_OTHERS = (".rs", ".java", ".kt", ".go", ".js", ".ts", ".cs", ".swift", ".sh", ".cmake", "CMakeLists.txt", ".lua", ".sql",
           ".scala", ".groovy", ".rb", ".pl", ".pm", ".php", ".m", ".mm", ".cu", ".ino", ".inl", ".adb", ".ads", ".vhd", ".sv", ".proto",
           ".tsx", ".jsx")  # fmt: skip
SUFFIXES = (*_CPP, *_PYTHON, *_OTHERS)
_LEADER = re.compile(r"^\s*(?://|/\*|\*|#|--|;|%)|//|/\*")
_CPP_CALL = re.compile(r"""\b(?:verifies\(\s*|RecordProperty\(\s*"(?:requirement|\w*[Vv]erifies)"\s*,\s*)"([^"]+)"([^;]*);""")
_PYTHON_MARK = re.compile(r"""^[ \t]*@pytest\.mark\.verifies\(\s*["']([^"']+)["']""", re.MULTILINE)
_POLARITY = re.compile(r"k?(Violation|violation)\b")

Numbered = tuple[int, TagWord]
"""A word with the number of its line."""


def read_sources(
    folder: Path, root: Path, problems: list[Problem], code: CodeBase | None = None
) -> tuple[list[CodeTag], list[SourceTest]]:
    """Tags and tests of all source files below `folder`; adds the functions of C and C++ files to `code`."""
    parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))
    tags: list[CodeTag] = []
    tests: list[SourceTest] = []
    for path, relative in walk_sources(folder, SUFFIXES, problems):
        shown = get_shown_path(path, root)
        text = read_whole(path, shown, problems)
        in_test = is_test_file(relative)
        listed = code is not None and not in_test and relative.endswith(_CPP)
        if text is None or not (listed or has_mark(text) or "verifies" in text.lower()):
            continue
        dead = find_dead_lines(text) if relative.endswith(_CPP) else frozenset()
        lines = enumerate(text.splitlines(), start=1)
        words = [(number, word) for number, line in lines if number not in dead for word in find_words(line, ANY_ID)]
        tests += _read_tests(text, shown, [(number, word) for number, word in words if in_test or word.role == VERIFIES])
        if not in_test:
            chosen = [(number, word) for number, word in words if word.role != VERIFIES]
            tags += _read_tags(text, shown, chosen, parser, code if listed else None)
    return tags, tests


def _read_tags(text: str, shown: str, words: list[Numbered], parser: tree_sitter.Parser, code: CodeBase | None) -> list[CodeTag]:
    if not words and code is None:
        return []
    if shown.endswith(_CPP):
        return parse_cpp_tags(text, shown, parser, [], code, ANY_ID)
    symbols = _name_python_lines(text) if shown.endswith(_PYTHON) else _list_comment_lines(text)
    return [CodeTag(word.requirement, Place(shown, number), FILE_SYMBOL if word.of_file else symbols[number])
            for number, word in words if number in symbols]  # fmt: skip


def _list_comment_lines(text: str) -> dict[int, str]:
    return {number: FILE_SYMBOL for number, line in enumerate(text.splitlines(), start=1) if _LEADER.search(line)}


def _name_python_lines(text: str) -> dict[int, str]:
    """The symbol of each comment or docstring line: the enclosing definition, or the next one."""
    try:
        tree = ast.parse(text)
        tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    except (SyntaxError, ValueError, RecursionError, tokenize.TokenError):
        return _list_comment_lines(text)
    comments = {token.start[0] for token in tokens if token.type == tokenize.COMMENT}
    symbols = {}
    definitions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)]
    starts = {min([node.lineno, *(each.lineno for each in node.decorator_list)]): node.name for node in definitions}
    for number in comments:
        below = number + 1
        while below in comments:
            below += 1
        around = [node for node in definitions if node.lineno <= number <= (node.end_lineno or node.lineno)]
        inner = max(around, key=lambda node: node.lineno).name if around else FILE_SYMBOL
        symbols[number] = starts.get(below, inner)
    for node in [tree, *definitions]:
        first = node.body[0] if node.body else None
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str):
            name = getattr(node, "name", FILE_SYMBOL)
            symbols.update(dict.fromkeys(range(first.lineno, (first.end_lineno or first.lineno) + 1), name))
    return symbols


def _read_tests(text: str, shown: str, words: list[Numbered]) -> list[SourceTest]:
    """A tag belongs to the test below its comment, or to the test that contains it; without either, the test name is empty."""
    if shown.endswith(_CPP):
        return _read_cpp_tests(text, shown, words)
    heads = list_heads(text, shown)
    named = [(number, word.requirement, "nominal") for number, word in words]
    pattern = _PYTHON_MARK if shown.endswith(_PYTHON) else _CPP_CALL
    for match in pattern.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        polarity = "violation" if match.lastindex == 2 and _POLARITY.search(match[2]) else "nominal"
        named += [(line, word.strip(), polarity) for word in match[1].split(",")]
    lines = text.splitlines()
    tests = []
    for line, requirement, polarity in sorted(set(named)):
        suite, name = find_head(line, lines, heads) or (shown, "")
        tests.append(SourceTest(requirement, suite, name, "requirements_based", polarity, Place(shown, line)))
    return tests


def _read_cpp_tests(text: str, shown: str, words: list[Numbered]) -> list[SourceTest]:
    """Like `_read_tests`, for C and C++: the test that contains the tag or the call, or the declaration below the tag."""
    plain = Plain(text)
    heads = list_cpp_heads(plain, shown)
    ends = {}
    for comment in plain.comments:
        first = text.count("\n", 0, comment.start()) + 1
        ends.update(dict.fromkeys(range(first, first + comment[0].count("\n") + 1), comment))
    named = []
    for number, word in words:
        tagged = ends.get(number)
        head = (heads.find_around(tagged.start()) or heads.find_below(tagged.end())) if tagged is not None else None
        named.append((number, word.requirement, "nominal", head))
    for match in _CPP_CALL.finditer(plain.code):
        if plain.shape[match.start()] != " ":
            line = text.count("\n", 0, match.start()) + 1
            polarity = "violation" if _POLARITY.search(match[2]) else "nominal"
            named += [(line, word.strip(), polarity, heads.find_around(match.start())) for word in match[1].split(",")]
    return [SourceTest(requirement, *((head.suite, head.name) if head else (shown, "")), "requirements_based", polarity, Place(shown, line))
            for line, requirement, polarity, head in dict.fromkeys(sorted(named, key=lambda row: row[:3]))]  # fmt: skip
