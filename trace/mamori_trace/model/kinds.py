# SPDX-License-Identifier: Apache-2.0
"""Kinds of traced things, and the permitted links between them.

@satisfies SWR-TRC-028      Design: docs/design/trace.md#kinds-and-links
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Kind:
    """`levels`: levels of items.toml of this kind; none for things other than items. `required`: attributes that need a value."""

    key: str
    name: str
    levels: tuple[str, ...]
    required: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class LinkKind:
    """A link from each kind in `sources` to each kind in `targets`; `written` states where it is written."""

    key: str
    sources: tuple[str, ...]
    targets: tuple[str, ...]
    written: str


@dataclass(frozen=True, slots=True)
class KindSchema:
    """`requirements/schema/links.toml`. Without content, everything is permitted."""

    kinds: dict[str, Kind] = field(default_factory=dict)
    links: dict[str, LinkKind] = field(default_factory=dict)

    def find_kind(self, level: str) -> Kind | None:
        """The kind of an item level."""
        return next((kind for kind in self.kinds.values() if level in kind.levels), None)

    def list_targets(self, source: str, link: str) -> tuple[str, ...] | None:
        """Kinds to which `link` may lead from the kind `source`; None if the schema does not define them."""
        row = self.links.get(link)
        return row.targets if row is not None and source in row.sources else None
