# SPDX-License-Identifier: Apache-2.0
"""Kinds of traced things, and the permitted links between them.

@satisfies SWR-TRC-028      Design: docs/design/trace.md#kinds-and-links
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Kind:
    """`levels`: levels of items.toml that are of this kind; none for things that are not items. `required`: attributes that need a value."""

    key: str
    name: str
    levels: tuple[str, ...]
    required: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class LinkKind:
    """A link from each kind of `sources` to each kind of `targets`; `written` names its location."""

    key: str
    sources: tuple[str, ...]
    targets: tuple[str, ...]
    written: str


@dataclass(frozen=True, slots=True)
class KindSchema:
    """`requirements/schema/links.toml`. An empty one allows everything."""

    kinds: dict[str, Kind] = field(default_factory=dict)
    links: dict[str, LinkKind] = field(default_factory=dict)

    def find_kind(self, level: str) -> Kind | None:
        """The kind of an item level."""
        return next((kind for kind in self.kinds.values() if level in kind.levels), None)

    def list_targets(self, source: str, link: str) -> tuple[str, ...] | None:
        """Kinds that `link` may lead to from the kind `source`; None if the schema does not define that."""
        row = self.links.get(link)
        return row.targets if row is not None and source in row.sources else None
