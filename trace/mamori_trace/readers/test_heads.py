# SPDX-License-Identifier: Apache-2.0
"""Finds the heads of tests in sources of any language, under the names that their results use.

@satisfies SWR-TRC-047, SWR-TRC-104      Design: docs/design/trace_formats.md#tags-of-other-tools
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right

from mamori_trace.model.evidence import ANY_SUITE
from mamori_trace.readers.cpp_heads import list_cpp_heads
from mamori_trace.readers.cpp_plain import Plain, find_body

Head = tuple[int, str, str]
"""Line, suite and name of a test."""

_PYTHON = ".py"
_JVM = (".java", ".kt")
_GO = ".go"
_RUST = ".rs"
_RUST_PART = re.compile(r"^[ \t]*(?:pub[ \t]+)?(?:mod[ \t]+(?P<mod>\w+)[ \t]*\{|(?P<mark>#\[(?:\w+::)*(?:test|rstest)\b[^\n]*\])|"
                        r"(?:async[ \t]+)?fn[ \t]+(?P<name>\w+))", re.MULTILINE)  # fmt: skip
_CPP = (".c", ".h", ".hpp", ".hh", ".hxx", ".cpp", ".cc", ".cxx", ".ipp")
_PYTHON_TEST = re.compile(r"^(?P<indent>[ \t]*)(?:async[ \t]+)?def[ \t]+(?P<name>test\w*)|^class[ \t]+(?P<group>\w+)", re.MULTILINE)
_JVM_CLASS = re.compile(r"(?:^|\s)(?:class|record|object)\s+(\w+)")
_JVM_METHOD = re.compile(r"(?:^|\s)(?:void|fun)\s+(?:(\w+)|`([^`]+)`)\s*\(")
_JVM_MARK = re.compile(r"^@\w*Test\w*\b")
_GO_TEST = re.compile(r"^func[ \t]+(Test\w*)\s*\(", re.MULTILINE)
_COMMENT = ("//", "*", "/*")


def list_heads(text: str, shown: str) -> list[Head]:
    """All tests of one file, in order. An unknown language has none."""
    if shown.endswith(_PYTHON):
        return _list_python(text, shown)
    if shown.endswith(_JVM):
        return _list_jvm(text)
    if shown.endswith(_GO):
        return _list_go(text, shown)
    if shown.endswith(_RUST):
        return _list_rust(text)
    if shown.endswith(_CPP):
        return [(_count_line(text, head.start), head.suite, head.name) for head in list_cpp_heads(Plain(text), shown).heads]
    return []


def _count_line(text: str, offset: int) -> int:
    return text.count("\n", 0, offset) + 1


def _list_python(text: str, shown: str) -> list[Head]:
    module = shown.rpartition("/")[2].removesuffix(".py")
    heads, group = [], ""
    for match in _PYTHON_TEST.finditer(text):
        if match["group"]:
            group = match["group"]
        else:
            suite = f"{module}.{group}" if group and match["indent"] else module
            heads.append((_count_line(text, match.start("name")), suite, match["name"]))
    return heads


def _list_jvm(text: str) -> list[Head]:
    """Methods that an annotation such as @Test or @ParameterizedTest, or their name, marks as tests; helpers leave no result."""
    heads, group, marked = [], "", False
    for number, line in enumerate(text.splitlines(), start=1):
        bare = line.strip()
        if bare.startswith(_COMMENT):
            continue
        marked = marked or _JVM_MARK.match(bare) is not None
        around, method = _JVM_CLASS.search(line), _JVM_METHOD.search(line)
        if around:
            group = around[1]
        if method:
            name = method[1] or method[2]
            heads += [(number, group, name)] if marked or name.startswith("test") else []
            marked = False
    return heads


def _list_go(text: str, shown: str) -> list[Head]:
    """Go results name the package, which is the folder of the file."""
    package = shown.rpartition("/")[0].rpartition("/")[2]
    return [(_count_line(text, match.start(1)), package, match[1]) for match in _GO_TEST.finditer(text)]


def _list_rust(text: str) -> list[Head]:
    """Functions with the attribute `#[test]`. Their results name all enclosing modules; the last one is used."""
    shape = Plain(text).shape
    heads, modules, marked = [], [], False
    for part in _RUST_PART.finditer(shape):
        if part["mod"]:
            modules.append((part["mod"], find_body(shape, part.start())[1]))
        elif part["mark"]:
            marked = True
        elif marked:
            around = [name for name, end in modules if part.start() < end]
            heads.append((_count_line(text, part.start("name")), around[-1] if around else ANY_SUITE, part["name"]))
            marked = False
    return heads


def find_head(line: int, lines: list[str], heads: list[Head]) -> tuple[str, str] | None:
    """Suite and name of the test below `line` if only comments and attributes are in between; otherwise of the test above."""
    starts = [each[0] for each in heads]
    above = bisect_left(starts, line)
    if above < len(heads) and all(_is_lead(each) for each in lines[line - 1 : starts[above] - 1]):
        return heads[above][1:]
    index = bisect_right(starts, line) - 1
    return heads[index][1:] if index >= 0 and not _is_outside(line, lines, starts[index]) else None


def _is_outside(line: int, lines: list[str], start: int) -> bool:
    """Whether the tag at `line` is indented at most as far as the head of the test above: it is then outside that test."""
    return _indent(lines[line - 1]) <= _indent(lines[start - 1])


def _indent(text: str) -> int:
    return len(text) - len(text.lstrip())


def _is_lead(line: str) -> bool:
    """Whether a line is permitted between a tag and the test below: a comment, a decorator, or an attribute."""
    return line.lstrip().startswith(("//", "/*", "*", "#", "@", '"""')) if line.strip() else False
