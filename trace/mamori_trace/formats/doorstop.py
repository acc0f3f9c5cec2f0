# SPDX-License-Identifier: Apache-2.0
"""Reads Doorstop: one YAML file, or one Markdown file with a YAML head, per item; a folder with `.doorstop.yml` is a document.

YAML is read as a tree of nodes, so each key has its line, and aliases are never multiplied.

@satisfies SWR-TRC-045, SWR-TRC-048      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

import re
from pathlib import Path

import yaml

from mamori_trace.base.files import UNREADABLE, get_shown_path
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.yaml_depth import demand_shallow
from mamori_trace.formats.files import list_files, read_whole
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss, Relation

NAME = "doorstop"
TITLE = "Doorstop"
SUFFIXES = (".yml", ".yaml", ".md")

_SETTINGS = ".doorstop.yml"
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_HEAD = re.compile(r"---[ \t]*\n(.*?\n)---[ \t]*(?:\n|$)(.*)", re.DOTALL)
_TITLE_LINE = re.compile(r"\s*#[ \t]+(.*)\n?")
_OWN = {"active", "derived", "header", "links", "normative", "text", "reviewed", "level", "references", "ref"}
_RING_MAX = 20


def looks_alike(name: str, text: str) -> bool:
    return name.endswith(SUFFIXES) and re.search(r"^(?:active|normative|reviewed):", text, re.MULTILINE) is not None


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """The items of every document at or below `path`."""
    project = ForeignProject(NAME)
    prefixes: dict[Path, str | None] = {}
    for file in list_files(path, SUFFIXES, root, problems):
        folder = file.parent
        if folder not in prefixes:
            prefixes[folder] = _read_prefix(folder, root, problems)
        prefix = prefixes[folder]
        if prefix is not None:
            shown = get_shown_path(file, root)
            text = read_whole(file, shown, problems)
            if text is not None:
                _read_item(text, file.stem, prefix, shown, file.suffix == ".md", project, problems)
    return project


def _read_prefix(folder: Path, root: Path, problems: list[Problem]) -> str | None:
    """The prefix of the document in `folder`, or None if the folder is not a document."""
    file = folder / _SETTINGS
    if not file.is_file():
        return None
    shown = get_shown_path(file, root)
    text = read_whole(file, shown, problems)
    settings = _compose(text, shown, 0, problems).get("settings") if text is not None else None
    table = _get_members(settings) if settings is not None else {}
    return _get_text(table["prefix"]) if "prefix" in table else folder.name.upper()


def _compose(text: str, shown: str, offset: int, problems: list[Problem]) -> dict[str, yaml.Node]:
    """Members of the mapping in `text`; empty after reporting a problem."""
    try:
        demand_shallow(text, _LOADER)
        node = yaml.compose(text, Loader=_LOADER)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        reason = getattr(error, "problem", None) or "nested too deeply"
        problems.append(Problem(UNREADABLE, Place(shown, (mark.line + 1 if mark else 1) + offset), f"is not whole YAML ({reason})"))
        return {}
    if not isinstance(node, yaml.MappingNode):
        problems.append(Problem(UNREADABLE, Place(shown, 1 + offset), "holds no table of attributes, so it is no Doorstop item"))
        return {}
    return _get_members(node)


def _get_members(node: yaml.Node) -> dict[str, yaml.Node]:
    if not isinstance(node, yaml.MappingNode):
        return {}
    return {key.value: value for key, value in node.value if isinstance(key, yaml.ScalarNode)}


def _get_text(node: yaml.Node, depth: int = 0) -> str:
    """A value as text; nesting that is deeper than in handwritten files is truncated."""
    if isinstance(node, yaml.ScalarNode):
        return "" if node.tag.endswith(":null") else node.value.strip()
    if depth >= 2:
        return "..."
    if isinstance(node, yaml.MappingNode):
        return ", ".join(f"{_get_text(key, depth + 1)}: {_get_text(value, depth + 1)}" for key, value in node.value[:_RING_MAX])
    return ", ".join(_get_text(each, depth + 1) for each in node.value[:_RING_MAX])


def _read_item(text: str, uid: str, prefix: str, shown: str, markdown: bool, project: ForeignProject, problems: list[Problem]) -> None:
    body, offset = "", 0
    if markdown:
        head = _HEAD.match(text)
        if head is None:
            problems.append(Problem(UNREADABLE, Place(shown, 1), "has no YAML head between two lines of '---'"))
            return
        text, body, offset = head[1], head[2], 1
    members = _compose(text, shown, offset, problems)
    if not members:
        return
    place = Place(shown, 1)
    if _get_text(members["normative"]) == "false" if "normative" in members else False:
        project.losses.append(Loss(place, f"{uid}: is not normative (a heading or a note)"))
        return
    item = ForeignItem(uid, "", place, kind=prefix, document=prefix)
    item.lines = {name: node.start_mark.line + 1 + offset for name, node in members.items()}
    _take_texts(item, members, body, text)
    item.attributes = {name: _get_text(node) for name, node in members.items() if name not in _OWN}
    if "active" in members and _get_text(members["active"]) == "false":
        item.attributes["status"] = "inactive"
    if "derived" in members and _get_text(members["derived"]) == "true":
        item.document += " (derived)"
    item.rationale = item.attributes.pop("rationale", "")
    _take_links(item, members.get("links"), shown, offset)
    _take_files(item, members.get("references"), offset)
    for name in ("references", "ref", "reviewed"):
        if name in members and _get_text(members[name]):
            project.losses.append(Loss(Place(shown, item.lines[name]), f"{uid}: {name}"))
    project.items.append(item)


def _take_texts(item: ForeignItem, members: dict[str, yaml.Node], body: str, head: str) -> None:
    """In a Markdown item the body is the text, and its first heading is the header."""
    item.title = _get_text(members["header"]) if "header" in members else ""
    item.statement = _get_text(members["text"]) if "text" in members else ""
    item.statement_line = item.lines.get("text", 1)
    if body.strip():
        title = _TITLE_LINE.match(body)
        item.title = title[1].strip() if title else item.title
        item.statement = body[title.end() if title else 0 :].strip()
        blank = body.index(item.statement) if item.statement else 0
        item.statement_line = head.count("\n") + 3 + body.count("\n", 0, blank)
    item.title = item.title or item.id


def _take_links(item: ForeignItem, links: yaml.Node | None, shown: str, offset: int) -> None:
    """`- SYS001: stamp`, or `- SYS001`."""
    for each in links.value if isinstance(links, yaml.SequenceNode) else ():
        target = next(iter(_get_members(each)), "") if isinstance(each, yaml.MappingNode) else _get_text(each)
        if target:
            item.relations.append(Relation("links", target, each.start_mark.line + 1 + offset))


def _take_files(item: ForeignItem, references: yaml.Node | None, offset: int) -> None:
    """`- path: src/a.c`, with the line of the path."""
    for each in references.value if isinstance(references, yaml.SequenceNode) else ():
        path = _get_members(each).get("path")
        if path is not None and _get_text(path):
            item.files.append(Relation("references", _get_text(path), path.start_mark.line + 1 + offset))
