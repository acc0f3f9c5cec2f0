# SPDX-License-Identifier: Apache-2.0
"""Which functions, classes and tests a range of lines belongs to, in C++ (tree-sitter) and Python (ast).

@satisfies SWR-TRC-070      Design: docs/design/trace_actions.md#impact
"""

from __future__ import annotations

import ast
from dataclasses import dataclass

import tree_sitter
import tree_sitter_cpp

CPP_SUFFIXES = (".hpp", ".h", ".cpp", ".cc", ".ipp")
_LANGUAGE = tree_sitter.Language(tree_sitter_cpp.language())
_TESTS = ("TEST", "TEST_F", "TEST_P", "TYPED_TEST", "TYPED_TEST_P")
_CLASSES = ("class_specifier", "struct_specifier", "union_specifier", "enum_specifier")


@dataclass(frozen=True, slots=True)
class Span:
    """A named part of a source with its first and last line, its comment included. A test is named `Suite.Name`."""

    name: str
    first: int
    last: int
    is_test: bool = False


def list_spans(text: str, file: str) -> list[Span]:
    """Functions, classes and tests of a source in order of their first lines; none for other kinds of files."""
    if file.endswith(CPP_SUFFIXES):
        return sorted(_list_cpp(text), key=lambda span: (span.first, -span.last))
    if file.endswith(".py"):
        return sorted(_list_python(text), key=lambda span: (span.first, -span.last))
    return []


def find_touched(spans: list[Span], ranges: list[tuple[int, int]]) -> tuple[list[Span], bool]:
    """The innermost spans that hold a line of `ranges`, and whether a line lies in none."""
    touched: dict[Span, None] = {}
    outside = False
    for first, last in ranges:
        meeting = [span for span in spans if span.first <= last and first <= span.last]
        for span in meeting:
            inner = [other for other in meeting if other is not span and _contains(span, other)]
            if _has_line_of_its_own(span, inner, first, last):
                touched[span] = None
        outside = outside or _has_line_of_its_own(Span("", first, last), meeting, first, last)
    return list(touched), outside


def _contains(outer: Span, inner: Span) -> bool:
    return outer.first <= inner.first and inner.last <= outer.last


def _has_line_of_its_own(span: Span, inner: list[Span], first: int, last: int) -> bool:
    """Whether a line of (first, last) inside `span` is in none of `inner`."""
    line = max(first, span.first)
    for each in sorted(inner, key=lambda other: other.first):
        if each.first > line:
            return True
        line = max(line, each.last + 1)
    return line <= min(last, span.last)


def _list_cpp(text: str) -> list[Span]:
    tree = tree_sitter.Parser(_LANGUAGE).parse(text.encode())
    spans: list[Span] = []
    stack: list[tuple[tree_sitter.Node, tuple[str, ...]]] = [(tree.root_node, ())]
    while stack:  # no recursion: sources may be nested as deep as they like
        node, scope = stack.pop()
        inner = scope
        if node.type == "function_definition" or (node.type == "field_declaration" and _find_function(node) is not None):
            span = _make_cpp_span(node, scope)
            if span is not None:
                spans.append(span)
            continue
        if node.type in _CLASSES and node.child_by_field_name("body") is not None:
            name = node.child_by_field_name("name")
            if name is not None:
                inner = (*scope, name.text.decode())
                spans.append(Span("::".join(inner), _find_start(node), node.end_point.row + 1))
        stack.extend((child, inner) for child in node.named_children)
    return spans


def _find_function(node: tree_sitter.Node) -> tree_sitter.Node | None:
    for _ in range(16):  # deeper declarators do not occur in code that people read
        if node.type == "function_declarator":
            return node
        inner = node.child_by_field_name("declarator")
        if inner is None and node.type == "reference_declarator" and node.named_children:
            inner = node.named_children[-1]
        if inner is None:
            return None
        node = inner
    return None


def _make_cpp_span(node: tree_sitter.Node, scope: tuple[str, ...]) -> Span | None:
    declarator = _find_function(node)
    name = declarator.child_by_field_name("declarator") if declarator is not None else None
    if name is None:
        return None
    word = name.text.decode()
    first, last = _find_start(node), node.end_point.row + 1
    if word in _TESTS:
        parameters = declarator.child_by_field_name("parameters")
        parts = [child.text.decode() for child in parameters.named_children] if parameters is not None else []
        if len(parts) == 2:
            return Span(".".join(parts), first, last, is_test=True)
    return Span("::".join((*scope, word)), first, last)


def _find_start(node: tree_sitter.Node) -> int:
    """First line of a definition with its template head and the comment right above it."""
    while node.parent is not None and node.parent.type in ("template_declaration", "declaration") and node.parent.parent is not None:
        node = node.parent
    row = node.start_point.row
    above = node.prev_named_sibling
    while above is not None and above.type == "comment" and above.end_point.row == row - 1 and b"@file" not in above.text:
        row = above.start_point.row
        above = above.prev_named_sibling
    return row + 1


def _list_python(text: str) -> list[Span]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []  # the whole file counts then
    spans: list[Span] = []
    stack: list[tuple[ast.AST, tuple[str, ...]]] = [(tree, ())]
    while stack:
        node, scope = stack.pop()
        for child in ast.iter_child_nodes(node):
            inner = scope
            if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                inner = (*scope, child.name)
                first = min([child.lineno, *(decorator.lineno for decorator in child.decorator_list)])
                is_test = child.name.startswith("test") and not isinstance(child, ast.ClassDef)
                spans.append(Span(".".join(inner), first, child.end_lineno or child.lineno, is_test))
            stack.append((child, inner))
    return spans
