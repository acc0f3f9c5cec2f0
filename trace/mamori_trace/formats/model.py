# SPDX-License-Identifier: Apache-2.0
"""The neutral model: a requirement of any format, with the location of every part."""

from __future__ import annotations

from dataclasses import dataclass, field

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class Relation:
    """A link to `target`. `role` is the word of the format; `line` is the line of the link.

    `name` is the additional name of the relation; `review` is the last review of the link, as in trace.lock.
    """

    role: str
    target: str
    line: int
    name: str = ""
    review: str = ""


@dataclass(slots=True)
class ForeignItem:
    """One requirement as its own tool stores it.

    `statement` is None if the format has no field for it. `kind` and `document` group items into levels; `attributes` are all other
    attributes, under their own names. `files` are links to files of code and tests. `needs` are the kinds of coverage that the item
    requires; None if the format cannot specify them. `heading`: the item is only the title of the following items, so rules ignore it.
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
    """A part of a file that belongs to no item, or that the model cannot represent."""

    place: Place
    what: str


@dataclass(slots=True)
class ForeignProject:
    """All items of a project in file order, including duplicate definitions of an id. `headers`: initial text of each document."""

    format: str
    items: list[ForeignItem] = field(default_factory=list)
    losses: list[Loss] = field(default_factory=list)
    headers: dict[str, str] = field(default_factory=dict)
