# SPDX-License-Identifier: Apache-2.0
"""Changes of limits and wiring, for files that state what the parts of a machine are and how they are connected.

A limit is scaled or gets the opposite sign. A row of a table, an element of a list or an argument is removed, or exchanged with its
neighbour. An enumerator or a member is exchanged with the next one of its file that has the same scope or object.

@satisfies SWR-VER-033      Design: docs/design/test_strength.md#example-arm
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from tree_sitter import Node

Change = tuple[int, int, str, str]
"""Bytes `start` .. `end` - 1, operator, replacement."""

SKIPPED = frozenset(("comment", "preproc_include", "preproc_def", "preproc_function_def", "preproc_call", "static_assert_declaration",
                     "template_parameter_list", "operator_name", "attribute_declaration", "using_declaration"))  # fmt: skip
LISTS = frozenset(("argument_list", "initializer_list", "template_argument_list"))
TABLES = re.compile(r"(?:\w+::)*(?:system|parts)")  # calls whose arguments are rows, at any depth
FIELDS = "MAMORI_FIELDS("  # both ends of a message use the same order
INTEGER = re.compile(r"([0-9']+)([uUlL]*)")
REAL = re.compile(r"[0-9.]+(?:e-?[0-9]+)?")
ENUMERATOR = re.compile(r"((?:\w+::)+)(k[A-Z]\w*)")


def make_changes(root: Node) -> Iterator[Change]:
    """All changes below `root`."""
    enumerators: dict[str, list[Node]] = {}
    members: dict[str, list[Node]] = {}
    pending = [root]
    while pending:
        node = pending.pop()
        if node.type in SKIPPED:
            continue
        pending.extend(reversed(node.children))
        match node.type:
            case "number_literal":
                yield from _scale(node)
            case "qualified_identifier" if (parts := ENUMERATOR.fullmatch(_text(node))) and not _is_label(node):
                enumerators.setdefault(parts[1], []).append(node)
            case "field_expression" if not _is_call(node):
                members.setdefault(_text(node.child_by_field_name("argument")), []).append(node)
        if node.type in LISTS:
            yield from _exchange_neighbours(node)
            yield from _remove_elements(node)
    for nodes in (*enumerators.values(), *members.values()):
        yield from _exchange_names(nodes)


def _scale(node: Node) -> Iterator[Change]:
    """Twice, half, and the opposite sign; the operator `constant` moves a number by one."""
    text = _text(node)
    integer = INTEGER.fullmatch(text)
    changed: Sequence[str] = ()
    if integer is not None:
        value, suffix = int(integer[1].replace("'", "")), integer[2]
        changed = [f"{each}{suffix}" for each in sorted({2 * value, value // 2} - {value - 1, value, value + 1})]
    elif REAL.fullmatch(text) and float(text) != 0.0:
        changed = (f"(2.0 * {text})", f"(0.5 * {text})", f"(-{text})")
    yield from ((node.start_byte, node.end_byte, "limit", each) for each in changed)


def _exchange_neighbours(node: Node) -> Iterator[Change]:
    if node.parent is not None and _text(node.parent).startswith(FIELDS):
        return
    for first, second in zip(elements := _list_elements(node), elements[1:], strict=False):
        between = _between(node, first.end_byte, second.start_byte)
        if _text(first) != _text(second) and _find_kind(first) == _find_kind(second) != "call_expression":
            yield first.start_byte, second.end_byte, "exchange", f"{_text(second)}{between}{_text(first)}"


def _find_kind(node: Node) -> str:
    """Neighbours of different kinds would not compile, and calls are rows, whose order has no meaning."""
    enumerator = ENUMERATOR.fullmatch(_text(node))
    return enumerator[1] if enumerator else node.type


def _remove_elements(node: Node) -> Iterator[Change]:
    """Elements of lists that stay complete without them: rows and their parts, names of a type list, values of an aggregate."""
    elements = _list_elements(node)
    if len(elements) < 2 or (node.type == "argument_list" and not _is_in_table(node)):
        return
    for index, element in enumerate(elements):
        is_last = index == len(elements) - 1
        start = elements[index - 1].end_byte if is_last else element.start_byte
        end = element.end_byte if is_last else elements[index + 1].start_byte
        yield start, end, "removal", "\n" * _between(node, start, end).count("\n")


def _exchange_names(nodes: Sequence[Node]) -> Iterator[Change]:
    """@param nodes of one scope or object, in the order of the file."""
    names = list(dict.fromkeys(map(_text, nodes)))
    if len(names) < 2:
        return
    following = dict(zip(names, (*names[1:], names[0]), strict=True))
    for node in nodes:
        yield node.start_byte, node.end_byte, "exchange", following[_text(node)]


def _list_elements(node: Node) -> list[Node]:
    """Empty if a comment separates elements, because its end of line would hide code, and for the few parameters of a template."""
    children = node.named_children
    is_few = node.type == "template_argument_list" and len(children) < 3
    return [] if is_few or any(child.type == "comment" for child in children) else children


def _between(node: Node, start: int, end: int) -> str:
    text = node.text or b""
    return text[start - node.start_byte : end - node.start_byte].decode("utf-8")


def _is_in_table(node: Node) -> bool:
    above: Node | None = node
    while above is not None:
        function = above.child_by_field_name("function") if above.type == "call_expression" else None
        if function is not None and TABLES.fullmatch(_text(function)):
            return True
        above = above.parent
    return False


def _is_label(node: Node) -> bool:
    parent = node.parent
    return parent is not None and parent.type == "case_statement" and parent.child_by_field_name("value") == node


def _is_call(node: Node) -> bool:
    parent = node.parent
    return parent is not None and parent.type in ("call_expression", "field_expression")


def _text(node: Node | None) -> str:
    return node.text.decode("utf-8") if node is not None and node.text is not None else ""
