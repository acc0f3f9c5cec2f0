# SPDX-License-Identifier: Apache-2.0
"""Reads needs.json, the export of sphinx-needs: the needs of the current version, with the line of each member.

@satisfies SWR-TRC-045, SWR-TRC-048      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from mamori_trace.base.files import UNREADABLE, get_shown_path
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_texts
from mamori_trace.formats.json_places import Lines, Table, parse_json
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss, Relation

NAME = "needs"
TITLE = "sphinx-needs"
SUFFIXES = ("needs.json",)
_FOLDERS_MAX = 5

_LINK_FIELDS = {"links", "parent_need", "satisfies", "refines", "derives", "derived_from", "implements", "fulfils", "fulfills", "parents",
                "traces", "covers", "realizes", "verifies", "tests"}  # fmt: skip
_DERIVED = {"id", "title", "content", "description", "type", "type_name", "docname", "doctype", "lineno", "lineno_content", "sections",
            "section_name", "signature", "parts", "is_need", "is_part", "is_external", "id_parent", "id_complete", "full_title",
            "target_id", "parent_needs", "layout", "style", "hide", "collapse", "has_dead_links", "has_forbidden_dead_links", "arch",
            "jinja_content", "external_css", "external_url", "is_import", "is_modified", "modifications", "type_color", "type_prefix",
            "type_style", "constraints_results", "constraints_passed", "constraints_error", "pre_content", "post_content", "delete",
            "template", "pre_template", "post_template", "rationale"}  # fmt: skip


def looks_alike(name: str, text: str) -> bool:
    return name.endswith(".json") and '"versions"' in text and '"needs"' in text


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """The needs of every needs.json below `path`; a file that the user specifies may have any name."""
    project = ForeignProject(NAME)
    for shown, text in read_texts(path, SUFFIXES, root, problems):
        content = parse_json(text, shown, problems)
        if content is not None:
            _read_content(content, text, shown, root, project, problems)
    return project


def _read_content(content: Any, text: str, shown: str, root: Path, project: ForeignProject, problems: list[Problem]) -> None:
    versions = content.get("versions") if isinstance(content, dict) else None
    if not isinstance(versions, Table) or not versions:
        problems.append(Problem(UNREADABLE, Place(shown, 1), "has no 'versions', so it is no needs.json; build it with the builder 'needs'"))
        return
    current = content.get("current_version")
    chosen = current if current in versions else list(versions)[-1]
    lines = Lines(text)
    start = lines.find_key(chosen, max(lines.find_key("versions", 0), 0), opens="{")
    version = versions[chosen]
    needs = version.get("needs") if isinstance(version, Table) else None
    if not isinstance(needs, Table):
        problems.append(Problem(UNREADABLE, Place(shown, lines.get_line(max(start, 0))), f"version '{chosen}' holds no table 'needs'"))
        return
    for other in versions:
        if other != chosen:
            project.losses.append(Loss(Place(shown, lines.get_line(max(lines.find_key(other, 0, opens="{"), 0))), f"version {other}"))
    begin = lines.find_key("needs", max(start, 0), opens="{")
    found: dict[str, str] = {}
    dense = text.count("\n") < len(needs.pairs)
    links = _LINK_FIELDS | _list_link_fields(version)
    offsets = _find_offsets([key for key, _ in needs.pairs], lines, begin + len('"needs"'))
    for index, (key, value) in enumerate(needs.pairs):
        place = Place(shown, lines.get_line(offsets[index]))
        if not isinstance(value, dict):
            problems.append(Problem(UNREADABLE, place, f"need '{key}' is no table"))
            continue
        end = offsets[index + 1] if index + 1 < len(offsets) else None
        item = _make_item(key, value, place, lines, (offsets[index], end), links)
        source = _place_in_source(value, shown, root, found) if dense else None
        project.items.append(_move(item, source) if source else item)


def _find_offsets(keys: list[str], lines: Lines, cursor: int) -> list[int]:
    """Offset of the key of each need; the members are in file order."""
    offsets = []
    for key in keys:
        found = lines.find_key(key, cursor)
        cursor = found if found >= 0 else cursor
        offsets.append(cursor)
        cursor += 1
    return offsets


def _list_link_fields(version: dict[str, Any]) -> set[str]:
    """The link types of the project, from the field descriptions of the version. They are the only source if default values were
    omitted."""
    schema = version.get("needs_schema")
    fields = schema.get("properties") if isinstance(schema, dict) else None
    rows = fields.items() if isinstance(fields, dict) else ()
    return {name for name, row in rows if isinstance(row, dict) and row.get("field_type") == "links"}


def _make_item(key: str, need: dict[str, Any], place: Place, lines: Lines, span: tuple[int, int | None], links: set[str]) -> ForeignItem:
    item = ForeignItem(str(need.get("id", key)), str(need.get("title", "")), place, kind=str(need.get("type", "")))
    item.document = str(need.get("docname", ""))
    own = "content" if "content" in need else "description"
    item.statement = str(need[own]) if own in need else None
    item.rationale = str(need.get("rationale") or "")
    for name, value in need.items():
        offset = lines.find_key(name, *span)
        item.lines[name] = lines.get_line(offset) if offset >= 0 else place.line
        if name in links or (isinstance(value, list) and f"{name}_back" in need and name not in _DERIVED):
            targets = value if isinstance(value, list) else [value] if value else []
            item.relations += [Relation(name, str(target), item.lines[name]) for target in targets]
        elif name not in _DERIVED and not name.endswith("_back") and value not in (None, "", [], {}):
            item.attributes[name] = value if isinstance(value, str) else ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    item.statement_line = item.lines.get(own, place.line)
    return item


def _move(item: ForeignItem, place: Place) -> ForeignItem:
    """The item with all its parts at one location."""
    item.place, item.statement_line = place, place.line
    item.lines = dict.fromkeys(item.lines, place.line)
    item.relations = [replace(each, line=place.line) for each in item.relations]
    return item


def _place_in_source(need: dict[str, Any], shown: str, root: Path, found: dict[str, str]) -> Place | None:
    """The location where the author wrote the need. sphinx-needs writes all needs on one line, so the line of the export is useless."""
    name, line = f"{need.get('docname') or ''}{need.get('doctype') or '.rst'}", need.get("lineno")
    if not need.get("docname") or not isinstance(line, int) or isinstance(line, bool) or line < 1:
        return None
    if name not in found:
        above = list((root / shown).resolve().parents)[:_FOLDERS_MAX]
        folders = [folder / inner for folder in above for inner in ("", "docs", "source", "docs/source")]
        found[name] = next((get_shown_path(folder / name, root) for folder in folders if (folder / name).is_file()), name)
    return Place(found[name], line)
