# SPDX-License-Identifier: Apache-2.0
"""Reads `@satisfies` tags from C++ comments and binds each to the class or function below it (tree-sitter).

@satisfies SWR-TRC-002, SWR-TRC-105      Design: docs/design/trace.md#code-tags
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import tree_sitter
import tree_sitter_cpp

from mamori_trace.base.files import is_test_file, read_text, walk_sources
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.code import CodeBase, Scope
from mamori_trace.model.evidence import CodeTag
from mamori_trace.readers.cpp_functions import Captures, FileFunctions, add_own_headers, capture, find_name, get_text, list_functions
from mamori_trace.readers.cpp_plain import find_dead_lines
from mamori_trace.readers.tag_text import FILE_SYMBOL, ID_PATTERN, has_mark, make_tags

SUFFIXES = (".hpp", ".h", ".cpp", ".cc", ".ipp")

_LANGUAGE = tree_sitter.Language(tree_sitter_cpp.language())


@dataclass(slots=True)
class _Block:
    """Comments on adjacent lines: the file line (from 0) where each begins, their texts, the first and the last node."""

    rows: list[int]
    texts: list[str]
    first: tree_sitter.Node
    last: tree_sitter.Node

    @property
    def text(self) -> str:
        return "\n".join(self.texts)


@dataclass(frozen=True, slots=True)
class _Target:
    """The scope of the tags of one comment block."""

    symbol: str
    first: int
    last: int


_WHOLE_FILE = _Target(FILE_SYMBOL, 0, 0)


def read_cpp_tags(
    root: Path, problems: list[Problem], code: CodeBase | None = None, id_pattern: str = ID_PATTERN
) -> list[CodeTag]:
    """Tags of all C++ files below `root` except tests. @param code also receives the functions of these files."""
    parser = tree_sitter.Parser(_LANGUAGE)
    tags: list[CodeTag] = []
    texts: dict[str, str] = {}
    for path, shown in walk_sources(root, SUFFIXES, problems):
        if not is_test_file(shown):
            text = read_text(path, shown, problems)
            if code is not None:
                texts[shown] = text
            if code is not None or has_mark(text):
                tags.extend(parse_cpp_tags(text, shown, parser, problems, code, id_pattern))
    if code is not None:
        add_own_headers(texts, code)
    return tags


def parse_cpp_tags(
    text: str, shown: str, parser: tree_sitter.Parser, problems: list[Problem],
    code: CodeBase | None = None, id_pattern: str = ID_PATTERN,
) -> list[CodeTag]:  # fmt: skip
    """Tags of one file; its functions are added to `code`."""
    tree = parser.parse(text.encode())
    captures = capture(tree.root_node)
    found = list_functions(captures, shown)
    if code is not None:
        code.functions.extend(found.functions)
        code.classes[shown] = frozenset(one.name for one in found.classes)
    tags: list[CodeTag] = []
    dead = find_dead_lines(text) if has_mark(text) else frozenset()
    for block in _list_blocks(captures) if has_mark(text) else ():
        target = _find_target(block, found)
        of_block: list[CodeTag] = []
        for row, comment in zip(block.rows, block.texts, strict=True):
            for number, line in enumerate(comment.splitlines(), start=row + 1) if has_mark(comment) else ():
                if number not in dead:
                    of_block.extend(make_tags(line, Place(shown, number), target.symbol, problems, id_pattern))
        tags.extend(of_block)
        if code is not None:
            code.scopes.extend(_make_scopes(of_block, target, shown, found))
    return tags


def _make_scopes(tags: list[CodeTag], target: _Target, shown: str, found: FileFunctions) -> list[Scope]:
    """One scope for the file tags, and one for the tags of the declaration."""
    scopes = []
    for chosen in (_WHOLE_FILE, target) if target != _WHOLE_FILE else (_WHOLE_FILE,):
        words = tuple(tag.requirement for tag in tags if tag.symbol == chosen.symbol)
        if words:
            name = "" if chosen is _WHOLE_FILE else found.qualify(chosen.symbol, chosen.first)
            scopes.append(Scope(shown, name, chosen.first, chosen.last, words))
    return scopes


def _list_blocks(captures: Captures) -> list[_Block]:
    """Blocks of comments (adjacent lines form one block) that may contain a tag."""
    blocks: list[_Block] = []
    end = -2
    for node in sorted(captures.get("comment", ()), key=lambda node: node.start_byte):
        row = node.start_point[0]
        if row != end + 1:
            blocks.append(_Block([], [], node, node))
        block = blocks[-1]
        block.rows.append(row)
        block.texts.append(get_text(node))
        block.last = node
        end = node.end_point[0]
    return [block for block in blocks if has_mark(block.text)]


def _find_target(block: _Block, found: FileFunctions) -> _Target:
    """The function that contains the block, or the declaration below it. The file for a file comment, or if nothing follows."""
    if "@file" in block.text:
        return _WHOLE_FILE
    around = found.find_around(block.rows[0] + 1)
    if around is not None:
        return _Target(around.name.rpartition("::")[2], around.first, around.last)
    node = block.last.next_named_sibling
    while node is not None and node.type == "comment":
        node = node.next_named_sibling
    name = find_name(node) if node is not None else ""
    return _Target(name, node.start_point.row + 1, node.end_point.row + 1) if node is not None and name else _WHOLE_FILE
