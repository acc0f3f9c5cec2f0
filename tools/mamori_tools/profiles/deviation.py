# SPDX-License-Identifier: Apache-2.0
"""The deviations from the schemas that the tolerant mode accepts, and the notes on files that conform. Numbers are never reused.

@satisfies SWR-PFL-005      Design: docs/design/profiles.md#tolerant-mode
"""

from __future__ import annotations

from dataclasses import dataclass

DEVIATIONS = {
    "D01": "the element uses its extension without xsi:type",
    "D02": "xsi:type is not a type of this element",
    "D03": "the child elements are not in the order of the schema",
    "D04": "a required attribute is missing",
    "D05": "a value differs in case or spelling from an allowed value",
    "D06": "a value does not have the type of its attribute",
    "D07": "the attribute is unknown",
    "D08": "the element is unknown",
    "D09": "a name differs in prefix, spelling or version",
    "D10": "a required element is missing",
    "D11": "the element occurs too often",
    "D12": "text between elements",
    "D13": "the root element differs from that of the schema",
    "D14": "the content is that of another version",
    "D15": "a date is not in ISO 8601",
    "D20": "the key is unknown",
    "D21": "the key occurs more than once",
    "D22": "the line has no key, or no colon or equals sign after the key",
    "D23": "the file is not UTF-8",
    "D24": "the last line ends with a continuation",
}
NOTES = {
    "N01": "an object reference contains the address of a host",
    "N02": "the configuration set holds settings of an editor",
    "N03": "the name is from an older version of OpenRTM",
    "N04": "the id does not have the usual form",
    "N05": "the value begins or ends with a space",
    "N06": "a connection or an order names something that the system does not have",
    "N07": "the name occurs more than once",
    "N08": "the version is unknown",
}


@dataclass(frozen=True)
class Deviation:
    """`id` is a key of DEVIATIONS or NOTES; `place` the path of the element, or the key; `repair` how the value in memory differs, or detail."""

    id: str
    line: int
    place: str
    repair: str

    @property
    def sentence(self) -> str:
        return DEVIATIONS.get(self.id) or NOTES[self.id]
