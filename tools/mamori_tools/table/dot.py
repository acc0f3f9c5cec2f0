# SPDX-License-Identifier: Apache-2.0
"""Calls graphviz for the layout of a picture.

@satisfies SWR-TAB-006, SWR-TAB-012      Design: docs/design/cost.md#graph
"""

from __future__ import annotations

import shutil
import signal
import subprocess
import xml.etree.ElementTree as ElementTree

from mamori_tools.table.svg import clean
from mamori_trace.base.errors import InputError

SVG = "{http://www.w3.org/2000/svg}"
LAYOUT_TIMEOUT_S = 120
ElementTree.register_namespace("", SVG.strip("{}"))
ElementTree.register_namespace("xlink", "http://www.w3.org/1999/xlink")
LABEL_STYLE = ".labels text { paint-order: stroke; stroke: white; stroke-width: 3px; stroke-linejoin: round; }"


def draw(text: str, name: str) -> str:
    """The picture as SVG. Raises InputError if graphviz is missing or fails.

    @param text in the language of graphviz. @param name of the picture, for error messages.
    """
    program = shutil.which("dot")
    if program is None:
        raise InputError(f"the {name} needs the program 'dot'; install it with: apt-get install graphviz")
    try:
        done = subprocess.run([program, "-Tsvg"], input=text, capture_output=True, text=True, encoding="utf-8",
                              check=False, timeout=LAYOUT_TIMEOUT_S)  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise InputError(f"dot found no layout of the {name} within {LAYOUT_TIMEOUT_S} s; use --text for a table of this size") from error
    if done.returncode != 0:
        cause = done.stderr.strip().splitlines() or [signal.strsignal(-done.returncode) or "no word of it"]
        raise InputError(f"dot could not draw the {name}: {cause[0]}; use --text for this table")
    return _raise_labels(done.stdout)


def _raise_labels(picture: str) -> str:
    """Draws edge labels on top. dot draws edges in sequence, each over previous labels, which would make them unreadable."""
    root = ElementTree.fromstring(picture)
    graph = root.find(f"{SVG}g")
    if graph is None:
        return picture
    labels = ElementTree.Element(f"{SVG}g", {"class": "labels"})
    ElementTree.SubElement(labels, f"{SVG}style").text = LABEL_STYLE
    for edge in (group for group in graph.findall(f"{SVG}g") if group.get("class") == "edge"):
        for parent in list(edge.iter()):
            for text in parent.findall(f"{SVG}text"):
                parent.remove(text)
                labels.append(text)
    graph.append(labels)
    return ElementTree.tostring(root, encoding="unicode") + "\n"


def quote(*lines: str) -> str:
    """Literal text lines in the dot language, without escapes and HTML."""
    return '"' + "\\n".join(clean(line).replace("\\", "\\\\").replace('"', '\\"') for line in lines) + '"'
