# SPDX-License-Identifier: Apache-2.0
"""Lists the functions and classes of a Python file from its syntax tree.

@satisfies SWR-TRC-030      Design: docs/design/trace.md#functions
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

from mamori_trace.model.code import Function

_NESTS = ("body", "orelse", "handlers", "finalbody", "cases")


@dataclass(frozen=True, slots=True)
class Definition:
    """A class or function with its lines, decorators included; a module has no name and no lines. `inner`: inside a function."""

    node: ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    name: str
    first: int
    last: int
    inner: bool = False


def list_definitions(tree: ast.Module) -> list[Definition]:
    """All classes and functions, in order of their lines."""
    return sorted(_walk(tree, "", False), key=lambda one: (one.first, one.name))


def _walk(node: ast.AST, around: str, inner: bool) -> Iterator[Definition]:
    """Definitions below `node`; only statements are searched, because expressions contain none."""
    for name in _NESTS:
        for child in getattr(node, name, ()):
            if not isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                yield from _walk(child, around, inner)
                continue
            full = f"{around}::{child.name}" if around else child.name
            first = min([child.lineno, *(decorator.lineno for decorator in child.decorator_list)])
            yield Definition(child, full, first, child.end_lineno or child.lineno, inner)
            yield from _walk(child, full, inner or not isinstance(child, ast.ClassDef))


def make_functions(definitions: list[Definition], shown: str) -> list[Function]:
    """The functions in `definitions`; a function inside another function is part of the outer one."""
    return [Function(shown, one.name, one.first, one.last, _find_body(one.node)) for one in definitions
            if isinstance(one.node, ast.FunctionDef | ast.AsyncFunctionDef) and not one.inner]  # fmt: skip


def _find_body(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Line of the first statement that a call executes. Loading the module already executes the head."""
    first, *others = node.body
    is_text = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    return (others[0] if is_text and others else first).lineno
