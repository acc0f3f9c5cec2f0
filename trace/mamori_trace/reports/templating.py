# SPDX-License-Identifier: Apache-2.0
"""The templates of the pages, with their filters, styles and scripts.

@satisfies SWR-TRC-011, SWR-TRC-062      Design: docs/design/trace.md#data-in-the-page
"""

from __future__ import annotations

import base64
import hashlib
import re
from pathlib import Path

import jinja2
from markupsafe import Markup, escape

_WORD_START = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_TEMPLATES = Path(__file__).parent / "templates"
_STYLES = ("base.css", "frame.css", "cards.css", "matrix.css", "item.css", "campaign.css", "print.css")
_SCRIPTS = ("data.js", "parts.js", "matrix.js", "item.js", "lists.js", "search.js", "frame.js")
# Runs before the page is drawn: with scripts, one view is shown at a time in the selected colours.
_FIRST_SCRIPT = """
document.documentElement.classList.add("js");
try { document.documentElement.dataset.theme = localStorage.getItem("mamori-theme") || ""; } catch (error) { /* the file's own choice */ }
"""


def make_environment() -> jinja2.Environment:
    """Templates with the filters, styles and scripts of the report."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        optimized=False,  # a page is drawn once, so finding constant parts takes longer than it saves
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    script = f'\n(() => {{\n"use strict";\n{_read_templates(_SCRIPTS)}}})();\n'
    environment.filters["css"] = lambda word: word.replace(" ", "-")
    environment.filters["to"] = _make_link
    environment.filters["camel"] = lambda name: Markup("<wbr>").join(_WORD_START.split(name))
    environment.filters["n"] = lambda number: f"{number:,}"
    environment.globals["style"] = Markup(_read_templates(_STYLES))
    environment.globals["first_script"] = Markup(_FIRST_SCRIPT)
    environment.globals["script"] = Markup(script)
    # Only the two scripts of the page may run, so a script in an unescaped text would not run.
    environment.globals["script_hashes"] = Markup(" ".join(map(_calc_script_hash, (_FIRST_SCRIPT, script))))
    return environment


def _read_templates(names: tuple[str, ...]) -> str:
    return "".join((_TEMPLATES / name).read_text(encoding="utf-8") for name in names)


def _calc_script_hash(script: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"


def _make_link(target: str) -> Markup:
    """`#view?filters` as attributes that the script combines; without a script, the link leads to the view."""
    view, _, query = target.partition("?")
    return Markup(f'href="{escape(view)}"') + (Markup(f' data-query="{escape(query)}"') if query else Markup(""))
