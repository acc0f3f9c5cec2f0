# SPDX-License-Identifier: Apache-2.0
"""The neutral model: what a requirement is in any of the formats, with the place of every part."""

from __future__ import annotations

from dataclasses import dataclass, field

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class Relation:
    """A link to `target`. `role` is the word of the format; `line` is where the link stands.

    `name` is what people called the relation beside its role; `review` is the last look at the link, as trace.lock words it.
    """

    role: str
    target: str
    line: int
    name: str = ""
    review: str = ""


@dataclass(slots=True)
class ForeignItem:
    """One requirement as its own tool keeps it.

    `statement` is None where the format gives no place for one. `kind` and `document` group items into levels; `attributes` are all
    others, under their own names. `files` are links to files of code and tests. `needs` are the kinds of coverage that the item itself
    asks for, None where it cannot say. `heading`: it only names what stands below it, so no rule judges it.
    """

    id: str
    title: str
    place: Place
    statement: str | None = None
    statement_line: int = 0
    rationale: str = ""
    kind: str = ""
    document: str = ""
    attributes: dict[str, str] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    relations: list[Relation] = field(default_factory=list)
    needs: tuple[str, ...] | None = None
    files: list[Relation] = field(default_factory=list)
    heading: bool = False


@dataclass(frozen=True, slots=True)
class Loss:
    """Something in a file that is no part of any item, or that has no room in the model."""

    place: Place
    what: str


@dataclass(slots=True)
class ForeignProject:
    """All items of a project in file order. Two definitions of one id are both kept. `headers`: text at the head of each document."""

    format: str
    items: list[ForeignItem] = field(default_factory=list)
    losses: list[Loss] = field(default_factory=list)
    headers: dict[str, str] = field(default_factory=dict)
