# SPDX-License-Identifier: Apache-2.0
"""Lists the functions of a C++ file from its syntax tree (tree-sitter), and finds the headers that declare them.

@satisfies SWR-TRC-030      Design: docs/design/trace.md#functions
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from os.path import commonprefix

import tree_sitter
import tree_sitter_cpp

from mamori_trace.model.code import CodeBase, Function

_LANGUAGE = tree_sitter.Language(tree_sitter_cpp.language())
_QUERY = tree_sitter.Query(_LANGUAGE, """
(comment) @comment
(function_definition) @function
(class_specifier) @class
(struct_specifier) @class
(union_specifier) @class
""")  # fmt: skip
_NAME_TYPES = ("identifier", "type_identifier", "field_identifier", "qualified_identifier", "operator_name",
               "destructor_name", "namespace_identifier")  # fmt: skip
_WRAPPED = ("template_declaration", "reference_declarator", "linkage_specification")
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<]([^">\n]+)[">]', re.MULTILINE)
_SOURCE_SUFFIXES = (".cpp", ".cc")
_BODIES = ("compound_statement", "try_statement")
_CLASS_TYPES = ("class_specifier", "struct_specifier", "union_specifier")
_DEPTH_MAX = 16
"""Maximum depth of a declarator; deeper ones do not occur in readable code."""


@dataclass(frozen=True, slots=True)
class Class:
    """A class with its lines; an unnamed class has an empty name."""

    name: str
    first: int
    last: int


@dataclass(slots=True)
class FileFunctions:
    """Functions and classes of one file, ordered by first line. A function inside a function is part of the outer one."""

    functions: list[Function]
    classes: list[Class]
    starts: list[int]

    def find_around(self, line: int) -> Function | None:
        """The function whose lines contain `line`."""
        index = bisect_right(self.starts, line) - 1
        function = self.functions[index] if index >= 0 else None
        return function if function is not None and line <= function.last else None

    def qualify(self, name: str, line: int) -> str:
        """`name` in the spelling of a separate definition: preceded by the classes that contain `line`."""
        plain = _strip_arguments(name)
        around = [one.name for one in self.classes if one.first < line <= one.last and one.name != plain]
        return "::".join([*around, plain])


Captures = dict[str, list[tree_sitter.Node]]


def capture(root: tree_sitter.Node) -> Captures:
    """Comments, functions and classes of a tree, found in one traversal, because traversal dominates the run time."""
    return tree_sitter.QueryCursor(_QUERY).captures(root)


def list_functions(captures: Captures, shown: str) -> FileFunctions:
    """All functions with a body, by their lines."""
    classes = list_classes(captures)
    functions = []
    for node, name in find_definitions(captures, classes, _BODIES):
        first = node.start_point.row + 1
        functions.append(Function(shown, name, first, node.end_point.row + 1, first))
    return FileFunctions(functions, classes, [function.first for function in functions])


def list_classes(captures: Captures) -> list[Class]:
    """Classes with a body, by their lines."""
    # Removes declarations without a body here, because a query that excludes them takes twice as long to compile, in each run.
    nodes = sorted(filter(has_body, captures.get("class", ())), key=lambda node: node.start_byte)
    return [Class(find_class_name(node), node.start_point.row + 1, node.end_point.row + 1) for node in nodes]


def has_body(node: tree_sitter.Node) -> bool:
    return node.child_by_field_name("body") is not None


def get_text(node: tree_sitter.Node) -> str:
    """The source text of the node."""
    assert node.text is not None  # a tree that was parsed from bytes has all its texts
    return node.text.decode(errors="replace")


def find_class_name(node: tree_sitter.Node) -> str:
    """Name of a class or enumeration; empty if it has none."""
    name = node.child_by_field_name("name")
    return _strip_arguments(get_text(name)) if name is not None else ""


def find_definitions(captures: Captures, classes: list[Class], bodies: tuple[str, ...] = ()) -> Iterator[tuple[tree_sitter.Node, str]]:
    """Functions outside other functions, each with its name and enclosing classes.

    @param bodies kinds of body that count. Default: also deleted and defaulted functions, and text that only resembles a function.
    """
    end = -1
    for node in sorted(captures.get("function", ()), key=lambda node: node.start_byte):
        body = node.child_by_field_name("body") if bodies else None
        if node.start_byte < end or (bodies and (body is None or body.type not in bodies)):
            continue
        name = find_function_name(node)
        if name:
            end = node.end_byte
            yield node, qualify(node, name, classes)


def qualify(node: tree_sitter.Node, name: str, classes: list[Class]) -> str:
    """`name`, preceded by the classes that contain the lines of `node`."""
    first, last = node.start_point.row + 1, node.end_point.row + 1
    own = (name, first, last) if node.type in _CLASS_TYPES else None
    around = [one.name for one in classes if one.name and one.first <= first and last <= one.last and (one.name, one.first, one.last) != own]
    return "::".join([*around, name])


def find_function_name(node: tree_sitter.Node) -> str:
    """Name in the declarator of a definition, including the classes in its spelling."""
    inner = node.child_by_field_name("declarator")
    for _ in range(_DEPTH_MAX):
        if inner is None:
            return ""
        if inner.type == "function_declarator":
            name = inner.child_by_field_name("declarator")
            return _strip_arguments(get_text(name)) if name is not None else ""
        if inner.type in ("operator_cast", "qualified_identifier"):  # a conversion has no further declarator
            return _strip_arguments(get_text(inner).partition("(")[0])
        inner = inner.child_by_field_name("declarator") or (inner.named_children[-1] if inner.type in _WRAPPED else None)
    return ""


def _strip_arguments(name: str) -> str:
    """`Ring<T, N>::push` -> `Ring::push`. The text after `operator` stays."""
    head, word, operator = name.partition("operator")
    while "<" in head:
        shorter = re.sub(r"<[^<>]*>", "", head)
        if shorter == head:
            break
        head = shorter
    space = " " if operator[:1].isspace() and operator.strip()[:1].isalpha() else ""
    return "".join(head.split()) + word + space + " ".join(operator.split())


def find_name(node: tree_sitter.Node) -> str:
    """Name that a declaration declares: found along the declarator, or the `name` of a class, enum or namespace."""
    for _ in range(_DEPTH_MAX):
        if node.type in _NAME_TYPES:
            return get_text(node)
        inner = node.child_by_field_name("declarator") or node.child_by_field_name("name")
        if inner is None and node.type in _WRAPPED:
            inner = node.named_children[-1] if node.named_children else None
        if inner is None:
            inner = node.child_by_field_name("type")
        if inner is None:
            return ""
        node = inner
    return ""


def add_own_headers(texts: dict[str, str], code: CodeBase) -> None:
    """Finds for each file the included headers that declare its functions.

    These are the header of the same name (`arm.hpp` for `arm.cpp`), and headers with the class of a function that is defined outside it.
    """
    by_name: dict[str, list[str]] = defaultdict(list)
    for shown in texts:
        if not shown.endswith(_SOURCE_SUFFIXES):
            by_name[shown.rpartition("/")[2]].append(shown)
    outside: dict[str, set[str]] = defaultdict(set)
    for function in code.functions:
        owners = function.name.split("::")[:-1]
        outside[function.file].update(set(owners) - code.classes.get(function.file, frozenset()))
    for shown, text in texts.items():
        if not outside[shown] and not shown.endswith(_SOURCE_SUFFIXES):
            continue
        headers = filter(None, (_find_header(shown, included, by_name) for included in _INCLUDE.findall(text)))
        own = [one for one in headers if _get_stem(one) == _get_stem(shown) or not outside[shown].isdisjoint(code.classes.get(one, ()))]
        code.own_headers[shown] = tuple(dict.fromkeys(own))


def _get_stem(shown: str) -> str:
    return shown.rpartition("/")[2].rpartition(".")[0]


def _find_header(shown: str, included: str, by_name: dict[str, list[str]]) -> str:
    """The file in the tree that the include names; if there are several, the one nearest to the source."""
    tail = included.lstrip("./")
    known = [path for path in by_name.get(tail.rpartition("/")[2], ()) if f"/{path}".endswith(f"/{tail}")]
    return min(known, key=lambda path: (-len(commonprefix((path, shown))), path), default="")  # noqa: RUF071 (a likeness, no path)
