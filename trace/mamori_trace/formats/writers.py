# SPDX-License-Identifier: Apache-2.0
"""Writes the neutral model as JSON, needs.json, OpenFastTrace Markdown and StrictDoc text.

@satisfies SWR-TRC-050      Design: docs/design/trace_formats.md#export
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable

from mamori_trace.formats.csv_file import format_csv
from mamori_trace.formats.model import ForeignItem, ForeignProject
from mamori_trace.formats.write_doorstop import make_doorstop
from mamori_trace.formats.write_reqif import format_reqif

_OFT_KINDS = {"STK": "feat", "HAZ": "feat", "SYS": "req", "AOU": "req", "SWR": "dsn"}
_PROJECT = "Requirements"


def format_json(project: ForeignProject) -> str:
    """All data, and links with their last review."""
    items = [
        {"id": item.id, "title": item.title, "statement": item.statement, "rationale": item.rationale, "kind": item.kind,
         "document": item.document, "attributes": item.attributes, "file": item.place.file, "line": item.place.line,
         "relations": [{"role": each.role, "target": each.target, "name": each.name, "review": each.review} for each in item.relations]}
        for item in project.items
    ]  # fmt: skip
    return json.dumps({"schema": "mamori.requirements/1", "headers": project.headers, "items": items}, indent=1, ensure_ascii=False) + "\n"


def format_needs(project: ForeignProject) -> str:
    """needs.json; attributes get the lower-case names that sphinx-needs requires."""
    needs = {
        item.id: {
            "id": item.id, "title": item.title, "type": item.kind.lower() or "req", "docname": item.document.removesuffix(".md"),
            "content": item.statement or "", "rationale": item.rationale, "links": [each.target for each in item.relations],
            **{re.sub(r"\W", "_", name.lower()): value for name, value in item.attributes.items()},
        }
        for item in project.items
    }  # fmt: skip
    content = {"current_version": "1", "project": _PROJECT, "versions": {"1": {"needs": needs, "needs_amount": len(needs)}}}
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def format_oft(project: ForeignProject) -> str:
    """Specification items of revision 1. OpenFastTrace keywords stay unchanged; other attributes become comments."""
    names = {item.id: _make_oft_id(item) for item in project.items}
    blocks = [f"# {_PROJECT}\n"]
    for item in project.items:
        parts = [f"## {item.title or item.id}", f"`{names[item.id]}`", item.statement or ""]
        parts += [f"Rationale:\n\n{item.rationale}"] if item.rationale else []
        others = [f"{name}: {value}" for name, value in item.attributes.items() if value and name not in ("Needs", "Tags")]
        parts += ["Comment:\n\n" + ", ".join(others)] if others else []
        covers = "\n".join(f"- `{names.get(each.target, each.target)}`" for each in item.relations)
        parts += [f"Covers:\n\n{covers}"] if covers else []
        kind = names[item.id].partition("~")[0]
        parts += [f"Tags: {item.attributes['Tags']}"] if item.attributes.get("Tags") else []
        needs = item.attributes.get("Needs") if "Needs" in item.attributes else {"feat": "req", "req": "dsn"}.get(kind, "impl, utest")
        parts += [f"Needs: {needs}"] if needs else []
        blocks.append("\n\n".join(parts) + "\n")
    return "\n".join(blocks)


def _make_oft_id(item: ForeignItem) -> str:
    if re.fullmatch(r"[A-Za-z]+~[A-Za-z][\w.\-]*~\d+", item.id):
        return item.id
    return f"{_OFT_KINDS.get(item.kind, 'req')}~{re.sub(r'[^A-Za-z0-9_.-]', '-', item.id)}~1"


def format_strictdoc(project: ForeignProject) -> str:
    """One document; its grammar names every attribute."""
    names = {name: re.sub(r"\W", "_", name.upper()) for item in project.items for name in item.attributes}
    fields = ["UID", *dict.fromkeys(names.values()), "TITLE", "STATEMENT", "RATIONALE"]
    lines = ["[DOCUMENT]", f"TITLE: {_PROJECT}", "", "[GRAMMAR]", "ELEMENTS:", "- TAG: REQUIREMENT", "  FIELDS:"]
    for field in fields:
        lines += [f"  - TITLE: {field}", "    TYPE: String", "    REQUIRED: False"]
    lines += ["  RELATIONS:", "  - TYPE: Parent", "  - TYPE: File"]
    for item in project.items:
        rows = [("UID", item.id), *((names[name], value) for name, value in item.attributes.items()),
                ("TITLE", item.title), ("STATEMENT", item.statement or ""), ("RATIONALE", item.rationale)]  # fmt: skip
        lines += ["", "[REQUIREMENT]"]
        lines += [f"{name}: >>>\n{value}\n<<<" if "\n" in value else f"{name}: {value}" for name, value in rows if value]
        lines += ["RELATIONS:"] if item.relations else []
        for each in item.relations:
            lines += ["- TYPE: Parent", f"  VALUE: {each.target}"]
    return "\n".join(lines) + "\n"


WRITERS: dict[str, Callable[[ForeignProject], str]] = {
    "reqif": format_reqif, "csv": format_csv, "json": format_json, "needs": format_needs, "oft": format_oft, "strictdoc": format_strictdoc,
}  # fmt: skip
"""Formats of one file: its text."""

FOLDER_WRITERS: dict[str, Callable[[ForeignProject], dict[str, str]]] = {"doorstop": make_doorstop}
"""Formats of one folder: the texts of its files."""
