# SPDX-License-Identifier: Apache-2.0
"""Parts of a handwritten SVG: elements, widths of texts, colours that all readers can distinguish.

@satisfies SWR-TAB-005      Design: docs/design/cost.md#time-line
"""

from __future__ import annotations

import unicodedata
import xml.etree.ElementTree as ElementTree

FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
FONT_SIZE = 12
INK, QUIET, GRID, PAPER = "#1b1b1b", "#5f6368", "#d7d9dc", "#ffffff"
# Okabe and Ito, "Color Universal Design", 2008: pale for the window, full for its budget. Source: https://jfly.uni-koeln.de/color/
COLOURS = (("#cfe6f5", "#56b4e9"), ("#fae3b8", "#e69f00"), ("#c4e8dc", "#009e73"), ("#f2d9e7", "#cc79a7"),
           ("#fbf7c4", "#e3d51e"), ("#c8dcee", "#4a90c4"), ("#f6d3bd", "#d97732"))  # fmt: skip


def calc_width(text: str, size: float = FONT_SIZE) -> float:
    """An upper bound of the width of a text [px] in any font, because the reader's font is unknown."""
    ems = {"W": 1.0, "F": 1.0}
    return sum(ems.get(unicodedata.east_asian_width(letter), 0.64 if letter not in "WMmw@%" else 1.0) for letter in text) * size


def shorten(text: str, width: float, size: float = FONT_SIZE) -> str:
    """The text. If it is too long: both its ends with three dots in between, because long names differ at either end."""
    if calc_width(text, size) <= width:
        return text
    for kept in range(len(text) - 1, 1, -1):
        short = f"{text[:(kept + 1) // 2]}…{text[len(text) - kept // 2:]}"
        if calc_width(short, size) <= width:
            return short
    return ""


def clean(text: str) -> str:
    """Without characters that XML 1.0 cannot represent."""
    return "".join(letter if letter.isprintable() else "\N{REPLACEMENT CHARACTER}" for letter in text)


class Drawing:
    """An SVG of fixed size in pixels, created element by element."""

    def __init__(self, width: float, height: float, title: str) -> None:
        self._root = ElementTree.Element("svg", {
            "xmlns": "http://www.w3.org/2000/svg", "width": f"{width:g}", "height": f"{height:g}",
            "viewBox": f"0 0 {width:g} {height:g}", "font-family": FONT, "font-size": str(FONT_SIZE), "role": "img"})  # fmt: skip
        ElementTree.SubElement(self._root, "title").text = clean(title)
        self.box(0, 0, width, height, PAPER)

    def box(self, x: float, y: float, width: float, height: float, fill: str, edge: str = "none", hint: str = "") -> None:
        """@param hint text that viewers show under the mouse pointer."""
        element = ElementTree.SubElement(self._root, "rect", {
            "x": f"{x:.2f}", "y": f"{y:.2f}", "width": f"{max(0.0, width):.2f}", "height": f"{height:.2f}", "fill": fill,
            "stroke": edge, "stroke-width": "0.8"})  # fmt: skip
        if hint:
            ElementTree.SubElement(element, "title").text = clean(hint)

    def line(self, x1: float, y1: float, x2: float, y2: float, colour: str = GRID) -> None:
        ElementTree.SubElement(self._root, "line", {"x1": f"{x1:.2f}", "y1": f"{y1:.2f}", "x2": f"{x2:.2f}", "y2": f"{y2:.2f}",
                                                    "stroke": colour, "stroke-width": "1"})  # fmt: skip

    def text(self, x: float, y: float, text: str, anchor: str = "start", colour: str = INK, bold: bool = False,
             size: float = FONT_SIZE) -> None:  # fmt: skip
        """@param y of the base line."""
        attributes = {"x": f"{x:.2f}", "y": f"{y:.2f}", "text-anchor": anchor, "fill": colour, "font-size": f"{size:g}"}
        if bold:
            attributes["font-weight"] = "bold"
        ElementTree.SubElement(self._root, "text", attributes).text = clean(text)

    def to_text(self) -> str:
        ElementTree.indent(self._root, " ")
        return ElementTree.tostring(self._root, encoding="unicode") + "\n"
