# SPDX-License-Identifier: Apache-2.0
"""The element types of RTC and RTS profiles as data, read from the tables in `schema/`.

A table has one unindented line per type, followed by its indented parts:

    versions 0.1 0.2 ...           versions of the profile, oldest first
    namespace PREFIX URI
    root PREFIX:ELEMENT TYPE
    simple NAME VALUE...           values of attributes; not a type that a file can name
    PREFIX:NAME = VALUE...         the same, as a type that a file can name
    PREFIX:NAME [< BASE]           type; BASE is the type that it extends
      @NAME[!][:TYPE]              attribute (!: required; default type: string)
      NAME[?*+][++]:TYPE           child elements in order (none: 1, ?: 0 or 1, *: any number, +: 1 or more, ++: 2 or more)
      ( NAME:TYPE | NAME:TYPE )    one of these children

`{0.2-}`, `{-0.1}` after a name or part: only from or up to this version. A type without prefix is built in, simple, or of the same namespace as
another type with this name.

@satisfies SWR-PFL-002      Design: docs/design/profiles.md#schema
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from typing import Any

BUILT_IN = ("string", "boolean", "integer", "double", "dateTime", "duration")
VERSION_LIMIT = re.compile(r"\{(\d\.\d)?-(\d\.\d)?\}")
COUNTS = {"": (1, 1), "?": (0, 1), "*": (0, None), "+": (1, None), "++": (2, None)}
XSI = "http://www.w3.org/2001/XMLSchema-instance"
XSI_TYPE = f"{{{XSI}}}type"


@dataclass(frozen=True)
class Attribute:
    """`name` in Clark notation; `type` is the name of a built-in or simple type."""

    name: str
    type: str
    is_required: bool


@dataclass(frozen=True)
class Child:
    """`name` in Clark notation. `choice` numbers the group of alternatives in the type, None if the child is in no group."""

    name: str
    type: str
    least: int
    most: int | None
    choice: int | None


@dataclass
class ElementType:
    """A complex type. `attributes` and `children` include the inherited ones, which come first."""

    name: str
    base: str | None
    own_attributes: list[Attribute] = field(default_factory=list)
    own_children: list[Child] = field(default_factory=list)
    attributes: dict[str, Attribute] = field(default_factory=dict)
    children: dict[str, Child] = field(default_factory=dict)


@dataclass
class SchemaTable:
    """One version of one profile. Type names have a prefix."""

    family: str
    version: str
    namespaces: dict[str, str] = field(default_factory=dict)
    root: str = ""
    root_type: str = ""
    values: dict[str, tuple[str, ...]] = field(default_factory=dict)
    types: dict[str, ElementType] = field(default_factory=dict)

    def list_extensions(self, name: str) -> list[str]:
        """The documentation and extension types of a type, nearest first. In files, they replace it by `xsi:type`."""
        found: list[str] = []
        while name:
            name = next((own.name for own in self.types.values() if own.base == name and own.name.endswith(("_doc", "_ext"))), "")
            found += [name] if name else []
        return found

    def is_derived(self, name: str | None, base: str) -> bool:
        while name is not None and name != base:
            name = self.types[name].base if name in self.types else None
        return name is not None

    def read_type(self, element: Any) -> str:
        """The name that `xsi:type` of an element has in this table, if it has one; empty without `xsi:type`."""
        prefix, _, local = element.get(XSI_TYPE, "").strip().rpartition(":")
        uri = element.nsmap.get(prefix or None)
        return next((f"{name}:{local}" for name, own in self.namespaces.items() if own == uri and local), local)

    def shorten(self, name: str) -> str:
        """Clark notation -> `prefix:local`."""
        uri, _, local = name.removeprefix("{").rpartition("}")
        return next((f"{prefix}:{local}" for prefix, own in self.namespaces.items() if own == uri), local)


@cache
def list_versions(family: str) -> tuple[str, ...]:
    """Versions of the profile `rtc` or `rts`, oldest first."""
    return next(tuple(line.split()[1:]) for line in _read(family) if line.startswith("versions "))


@cache
def load_table(family: str, version: str) -> SchemaTable:
    """@param family `rtc` or `rts`. @param version one of list_versions()."""
    table = SchemaTable(family, version)
    own: ElementType | None = None
    for line in _read(family):
        words = [VERSION_LIMIT.sub("", word) for word in line.split() if _is_in(word, version)]
        if line.startswith(" "):
            if own is not None:
                _add_parts(table, own, words)
        elif not _is_in(line.split()[0], version):
            own = None
        elif words[0] == "namespace":
            table.namespaces[words[1]] = words[2]
        elif words[0] == "root" and len(words) == 3:
            prefix, _, name = words[1].partition(":")
            table.root, table.root_type = f"{{{table.namespaces[prefix]}}}{name}", words[2]
        elif words[0] == "simple":
            table.values[words[1]] = tuple(words[2:])
        elif words[1:2] == ["="]:
            table.values[words[0]] = tuple(words[2:])
        elif words[0] not in ("versions", "root"):
            own = table.types[words[0]] = ElementType(words[0], words[2] if words[1:2] == ["<"] else None)
    _resolve(table)
    return table


@cache
def list_element_names(family: str) -> frozenset[str]:
    """Names of elements of all versions, without namespace."""
    tables = [load_table(family, version) for version in list_versions(family)]
    return frozenset(name.rpartition("}")[2] for table in tables for own in table.types.values() for name in own.children)


def _read(family: str) -> Iterator[str]:
    text = files("mamori_tools.profiles").joinpath("schema", f"{family}.txt").read_text(encoding="utf-8")
    yield from (line for line in text.splitlines() if line.strip() and not line.startswith("#"))


def _is_in(word: str, version: str) -> bool:
    limit = VERSION_LIMIT.search(word)
    return limit is None or (limit[1] or "") <= version <= (limit[2] or "9")


def _add_parts(table: SchemaTable, own: ElementType, words: list[str]) -> None:
    space = f"{{{table.namespaces[own.name.partition(':')[0]]}}}"
    choice = own.own_children[-1].choice if own.own_children and words[:1] == ["|"] else None
    for word in words:
        name, _, type_ = word.partition(":")
        if word == "(":
            choice = len(own.own_children)
        elif word == ")":
            choice = None
        elif word.startswith("@"):
            own.own_attributes.append(Attribute(space + name.strip("@!"), type_ or "string", name.endswith("!")))
        elif word != "|":
            bare = name.rstrip("?*+")
            own.own_children.append(Child(space + bare, type_, *COUNTS[name[len(bare) :]], choice))


def _resolve(table: SchemaTable) -> None:
    """Completes type names with their prefix, and adds inherited parts."""
    known = {name.partition(":")[2]: name for name in [*table.types, *(name for name in table.values if ":" in name)]}

    def complete(part: Attribute | Child) -> str:
        return part.type if part.type in BUILT_IN or part.type in table.values else known[part.type]

    for own in table.types.values():
        own.own_attributes = [Attribute(part.name, complete(part), part.is_required) for part in own.own_attributes]
        own.own_children = [Child(part.name, complete(part), part.least, part.most, part.choice) for part in own.own_children]
    for own in table.types.values():
        line: ElementType | None = own
        while line is not None:
            own.attributes = {part.name: part for part in line.own_attributes} | own.attributes
            own.children = {part.name: part for part in line.own_children} | own.children
            line = table.types[line.base] if line.base else None
