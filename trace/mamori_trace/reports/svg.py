# SPDX-License-Identifier: Apache-2.0
"""Prepares an SVG drawing for an HTML page: small, without global styles, with unique ids."""

from __future__ import annotations

import re

_METADATA = re.compile(r"<metadata>.*?</metadata>|<style[^>]*>.*?</style>|<defs>\s*</defs>|<!--.*?-->", re.DOTALL)
_DEFINED = re.compile(r'\sid="([^"]+)"')
_USED = re.compile(r'(?:xlink:)?href="#([^"]+)"|url\(#([^)]+)\)')
_SIZE = re.compile(r'(<svg\b[^>]*?)\s(?:width|height|xmlns:xlink|version|xmlns)="[^"]*"')
_PATH = re.compile(r'd="([^"]*)"')
_LONG_NUMBER = re.compile(r"-?\d+\.\d{2,}")
_VALUE = re.compile(r'="[^"]*"')
_BETWEEN_TAGS = re.compile(r">\s+<")


def make_inline(svg: str, prefix: str, label: str) -> str:
    """`svg` without prologue, metadata and global styles; coordinates rounded to a tenth; used ids prefixed, others removed.

    `label` is the text for readers who cannot see the drawing; it must already be escaped.
    """
    text = _METADATA.sub("", svg[svg.index("<svg") :])
    used = {first or second for first, second in _USED.findall(text)}
    names = {name: f"{prefix}-{index}" for index, name in enumerate(sorted(used))}
    text = _DEFINED.sub(lambda match: f' id="{names[match[1]]}"' if match[1] in used else "", text)
    text = _USED.sub(lambda match: f'href="#{names[match[1]]}"' if match[1] else f"url(#{names[match[2]]})", text)
    text = _PATH.sub(lambda match: f'd="{_shorten_path(match[1])}"', text)
    text = _VALUE.sub(lambda match: _LONG_NUMBER.sub(lambda number: _round(number[0], 2), match[0]), text)
    while _SIZE.search(text):
        text = _SIZE.sub(r"\1", text)
    text = text.replace("<svg", f'<svg role="img" aria-label="{label}"', 1)
    return _BETWEEN_TAGS.sub("><", text).strip()


def _shorten_path(path: str) -> str:
    """`M 1.0204 2.3001 \\nL 3.0 4.0` -> `M1 2.3L3 4`."""
    rounded = _LONG_NUMBER.sub(lambda match: _round(match[0], 1), " ".join(path.split()))
    return re.sub(r"\s*([A-Za-z])\s*", r"\1", rounded)


def _round(number: str, digits: int) -> str:
    text = f"{float(number):.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
