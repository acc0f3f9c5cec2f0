# SPDX-License-Identifier: Apache-2.0
"""Finds the heads of tests in the sources of a foreign project, under the names by which their results are known.

@satisfies SWR-TRC-047      Design: docs/design/trace_formats.md#tags-of-other-tools
"""

from __future__ import annotations

import re

Head = tuple[int, str, str]
"""Line, suite and name of a test."""

_PYTHON = ".py"
_JVM = (".java", ".kt")
_GO = ".go"
_CPP_TEST = re.compile(r"^[ \t]*(?:TYPED_)?TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
_PYTHON_TEST = re.compile(r"^(?P<indent>[ \t]*)(?:async[ \t]+)?def[ \t]+(?P<name>test\w*)|^class[ \t]+(?P<group>\w+)", re.MULTILINE)
_JVM_CLASS = re.compile(r"(?:^|\s)(?:class|record|object)\s+(\w+)")
_JVM_METHOD = re.compile(r"(?:^|\s)(?:void|fun)\s+(?:(\w+)|`([^`]+)`)\s*\(")
_JVM_MARK = re.compile(r"^@\w*Test\w*\b")
_GO_TEST = re.compile(r"^func[ \t]+(Test\w*)\s*\(", re.MULTILINE)
_COMMENT = ("//", "*", "/*")


def list_heads(text: str, shown: str) -> list[Head]:
    """All tests of one file, in order. Of a language that is not known here there are none."""
    if shown.endswith(_PYTHON):
        return _list_python(text, shown)
    if shown.endswith(_JVM):
        return _list_jvm(text)
    if shown.endswith(_GO):
        return _list_go(text, shown)
    return [(_count_line(text, match.start(1)), match[1], match[2]) for match in _CPP_TEST.finditer(text)]


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
    """Methods that an annotation such as @Test or @ParameterizedTest, or their name, makes a test; helpers beside them leave no result."""
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
    """Results of Go name the package, which is the folder of the file."""
    package = shown.rpartition("/")[0].rpartition("/")[2]
    return [(_count_line(text, match.start(1)), package, match[1]) for match in _GO_TEST.finditer(text)]
