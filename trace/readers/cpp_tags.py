# SPDX-License-Identifier: Apache-2.0
"""Reads `@satisfies` tags from C++ comments and binds each to the class or function below it (tree-sitter).

@satisfies SWR-TRC-002      Design: docs/design/trace.md#code-tags
"""

from __future__ import annotations

import re
from pathlib import Path

import tree_sitter
import tree_sitter_cpp

from mamori.trace.model.evidence import CodeTag
from mamori.trace.model.finding import Place, Problem
from mamori.trace.readers.files import is_test_file, read_text, walk_sources

SUFFIXES = (".hpp", ".h", ".cpp", ".cc", ".ipp")
TAG = re.compile(r"@satisfies[ \t]+([A-Z]+-[\w-]+(?:[ \t]*,[ \t]*[A-Z]+-[\w-]+)*)")
BARE_TAG = re.compile(r"^[\s/*#'\"]*@satisfies\b(?![ \t]+[A-Z]+-[\w-])")
FILE_SYMBOL = "file"

_LANGUAGE = tree_sitter.Language(tree_sitter_cpp.language())
_COMMENTS = tree_sitter.Query(_LANGUAGE, "(comment) @comment")
_NAME_TYPES = ("identifier", "type_identifier", "field_identifier", "qualified_identifier", "operator_name",
               "destructor_name", "namespace_identifier")  # fmt: skip


def read_cpp_tags(root: Path, problems: list[Problem]) -> list[CodeTag]:
    """Tags of all C++ files below `root` that are no tests."""
    parser = tree_sitter.Parser(_LANGUAGE)
    tags: list[CodeTag] = []
    for path, shown in walk_sources(root, SUFFIXES):
        if not is_test_file(shown):
            text = read_text(path, shown, problems)
            if "@satisfies" in text:
                tags.extend(parse_cpp_tags(text, shown, parser, problems))
    return tags


def parse_cpp_tags(text: str, shown: str, parser: tree_sitter.Parser, problems: list[Problem]) -> list[CodeTag]:
    """Tags of one file."""
    tree = parser.parse(text.encode())
    captures = tree_sitter.QueryCursor(_COMMENTS).captures(tree.root_node)
    comments = sorted(captures.get("comment", []), key=lambda node: node.start_byte)
    tags: list[CodeTag] = []
    for block in _group_blocks(comments):
        if not any(b"@satisfies" in node.text for node in block):
            continue
        symbol = _get_symbol(block)
        for node in block:
            for offset, line in enumerate(node.text.decode().splitlines()):
                place = Place(shown, node.start_point.row + offset + 1)
                tags.extend(make_tags(line, place, symbol, problems))
    return tags


def make_tags(line: str, place: Place, symbol: str, problems: list[Problem]) -> list[CodeTag]:
    """Tags of one line of a comment. A tag that names nothing is a problem."""
    if BARE_TAG.search(line):
        problems.append(Problem("unknown-id", place, "@satisfies names no requirement id"))
    found = (word.strip() for match in TAG.finditer(line) for word in match[1].split(","))
    return [CodeTag(requirement, place, symbol) for requirement in found]


def _group_blocks(comments: list[tree_sitter.Node]) -> list[list[tree_sitter.Node]]:
    """Comments on neighbouring lines form one block."""
    blocks: list[list[tree_sitter.Node]] = []
    for node in comments:
        if blocks and node.start_point.row == blocks[-1][-1].end_point.row + 1:
            blocks[-1].append(node)
        else:
            blocks.append([node])
    return blocks


def _get_symbol(block: list[tree_sitter.Node]) -> str:
    """Name of the declaration below the block; the file when the block is the file's own or nothing follows."""
    if any(b"@file" in node.text for node in block):
        return FILE_SYMBOL
    node = block[-1].next_named_sibling
    while node is not None and node.type == "comment":
        node = node.next_named_sibling
    return (_find_name(node) if node is not None else "") or FILE_SYMBOL


def _find_name(node: tree_sitter.Node) -> str:
    """Name that a declaration declares: follows the declarator, or takes the `name` of a class, enum or namespace."""
    for _ in range(16):  # deeper declarators do not occur in code that people read
        if node.type in _NAME_TYPES:
            return node.text.decode()
        inner = node.child_by_field_name("declarator") or node.child_by_field_name("name")
        if inner is None and node.type in ("template_declaration", "reference_declarator", "linkage_specification"):
            inner = node.named_children[-1] if node.named_children else None
        if inner is None:
            inner = node.child_by_field_name("type")
        if inner is None:
            return ""
        node = inner
    return ""
