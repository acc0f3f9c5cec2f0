# SPDX-License-Identifier: Apache-2.0
"""Compares the content of two profiles of one family, independent of their form and of the order of their parts.

@satisfies SWR-PFL-011      Design: docs/design/profiles.md#commands
"""

from __future__ import annotations

from dataclasses import dataclass

from lxml import etree

from mamori_tools.profiles.profile import Profile
from mamori_tools.profiles.schema_table import XSI
from mamori_tools.profiles.xml_file import get_key, get_local_name


@dataclass(frozen=True)
class Difference:
    """None: missing on this side."""

    place: str
    first: str | None
    second: str | None


def compare(first: Profile, second: Profile) -> list[Difference]:
    """Differences in the order of the first profile, then what only the second one has."""
    old, new = flatten(first), flatten(second)
    return [Difference(place, old.get(place), new.get(place)) for place in {**old, **new} if old.get(place) != new.get(place)]


def flatten(profile: Profile) -> dict[str, str]:
    """Each value by its place, for example `Components[Std0]/@id`. Comments, layout and `xsi:type` have none."""
    if profile.conf is not None:
        return {entry.key: entry.value for entry in profile.conf.entries}
    assert profile.root is not None
    values: dict[str, str] = {}
    places: dict[etree._Element, str] = {}
    used: dict[str, int] = {}
    for element in profile.root.iter("*"):
        parent = element.getparent()
        base = "" if parent is None else f"{places[parent]}{get_local_name(element)}{get_key(element)}"
        used[base] = used.get(base, 0) + 1
        place = f"{base}#{used[base]}" if used[base] > 1 else base
        places[element] = f"{place}/" if place else ""
        values |= {f"{places[element]}@{name.rpartition('}')[2]}": str(value) for name, value in element.attrib.items() if not name.startswith(f"{{{XSI}}}")}
        text = (element.text or "").strip()
        if text or not (element.attrib or len(element)):
            values[place] = text
    return values
