# SPDX-License-Identifier: Apache-2.0
"""Compares the content of two profiles of one family, independent of their form and of the order of their parts.

@satisfies SWR-PFL-011      Design: docs/design/profiles.md#commands
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from lxml import etree

from mamori_tools.profiles.attribute_value import BOOLEANS
from mamori_tools.profiles.profile import Profile
from mamori_tools.profiles.schema_table import BUILT_IN, XSI
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
    types = {} if first.conf is not None else {
        name.rpartition("}")[2]: part.type for own in first.table.types.values() for name, part in own.attributes.items() if part.type in BUILT_IN}  # fmt: skip

    def is_different(place: str) -> bool:
        one, other, type_ = old.get(place), new.get(place), types.get(place.rpartition("@")[2], "string")
        return one != other and (one is None or other is None or _get_meaning(one.strip(), type_) != _get_meaning(other.strip(), type_))

    return [Difference(place, old.get(place), new.get(place)) for place in {**old, **new} if is_different(place)]


def _get_meaning(text: str, type_: str) -> object:
    """A value that is equal for all spellings of a valid value."""
    match type_:
        case "boolean":
            return BOOLEANS.get(text, text)
        case "integer":
            return int(text)
        case "double":
            return text if text.endswith(("INF", "NaN")) else float(text)
        case "dateTime":
            date = datetime.fromisoformat(text)
            return date if date.tzinfo is None else date.timestamp()
        case _:
            return text


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
