# SPDX-License-Identifier: Apache-2.0
"""The code of the project: its functions, and the requirements that own each function by tags.

@satisfies SWR-TRC-030      Design: docs/design/trace.md#functions
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class CodeSchema:
    """Content of requirements/schema/code.toml. `traced`: folders and files whose functions need an owner. `no_evidence`: those whose
    change leaves the evidence valid. `integration`: those whose tests are integration tests."""

    traced: tuple[str, ...] = ()
    no_evidence: tuple[str, ...] = ()
    integration: tuple[str, ...] = ()

    def is_traced(self, file: str) -> bool:
        return _is_below(file, self.traced)

    def is_integration(self, file: str) -> bool:
        return _is_below(file, self.integration)


def _is_below(file: str, places: tuple[str, ...]) -> bool:
    return any(file == one or file.startswith(f"{one}/") for one in places)


class Function(NamedTuple):
    """A function with a body. Lines count from 1, including `last`; `body` is the first line that a call executes.

    `name` includes the enclosing classes, but no namespace. `requirements` are the ids of all tags that own the function, nearest first.
    """

    file: str
    name: str
    first: int
    last: int
    body: int
    requirements: tuple[str, ...] = ()

    @property
    def place(self) -> Place:
        return Place(self.file, self.first)


class Scope(NamedTuple):
    """The scope of a tag: the lines of a declaration (also for a separate definition), or, without a name, the complete file."""

    file: str
    name: str
    first: int
    last: int
    requirements: tuple[str, ...]


@dataclass(slots=True)
class CodeBase:
    """Filled by the readers. `classes` are defined in a C++ file; `own_headers` are the headers that declare them."""

    functions: list[Function] = field(default_factory=list)
    scopes: list[Scope] = field(default_factory=list)
    classes: dict[str, frozenset[str]] = field(default_factory=dict)
    own_headers: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def bind(self) -> list[Function]:
        """All functions with their requirements, ordered by file and line."""
        scopes_of: dict[str, list[Scope]] = defaultdict(list)
        for scope in self.scopes:
            scopes_of[scope.file].append(scope)
        bound = [self._bind(function, scopes_of) for function in self.functions]
        return sorted(bound, key=lambda function: (function.file, function.first, function.name))

    def _bind(self, function: Function, scopes_of: dict[str, list[Scope]]) -> Function:
        owners = list(self._find_owners(function, scopes_of))
        owners.sort(key=lambda scope: (not scope.name, scope.last - scope.first))
        return function._replace(requirements=tuple(dict.fromkeys(word for scope in owners for word in scope.requirements)))

    def _find_owners(self, function: Function, scopes_of: dict[str, list[Scope]]) -> Iterator[Scope]:
        for scope in scopes_of.get(function.file, ()):
            if not scope.name or scope.first <= function.first <= scope.last or _declares(scope, function):
                yield scope
        for header in self.own_headers.get(function.file, ()):
            for scope in scopes_of.get(header, ()):
                if not scope.name or _declares(scope, function):
                    yield scope


def _declares(scope: Scope, function: Function) -> bool:
    """Whether the declaration belongs to the function or an enclosing class. Overloads share their tags."""
    return f"::{scope.name}::" in f"::{function.name}::"
