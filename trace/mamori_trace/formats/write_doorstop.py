# SPDX-License-Identifier: Apache-2.0
"""Writes the neutral model as Doorstop documents: one folder for each prefix of ids, with one YAML file for each item.

@satisfies SWR-TRC-050      Design: docs/design/trace_formats.md#export
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import yaml

from mamori_trace.base.errors import InputError
from mamori_trace.formats.model import ForeignItem, ForeignProject

_UID = re.compile(r"(?P<prefix>[A-Za-z](?:[\w.\-]*?\w)??)(?P<sep>[-_.]?)(?P<number>\d+)", re.ASCII)
_UID_LENGTH_MAX = 200  # becomes the name of a file
_OWN = {"active", "derived", "header", "level", "links", "normative", "ref", "references", "reviewed", "text"}
_RETIRED = {"retired", "inactive"}
_LINE_LENGTH = 120


class _Text(str):
    """A text for readers, written as a block of lines, like Doorstop does."""


class _Dumper(yaml.SafeDumper):
    pass


def _represent_text(dumper: yaml.SafeDumper, text: _Text) -> yaml.ScalarNode:
    return dumper.represent_scalar("tag:yaml.org,2002:str", f"{text}\n" if text else "", style="|" if text else None)


_Dumper.add_representer(_Text, _represent_text)


@dataclass(slots=True)
class _Document:
    """Items of one prefix in order. `parent` is the prefix of the document above; empty for the top document."""

    prefix: str
    sep: str
    digits: int
    items: list[ForeignItem] = field(default_factory=list)
    parent: str = ""


def make_doorstop(project: ForeignProject) -> dict[str, str]:
    """Texts by their paths. Raises InputError for an id that Doorstop cannot read."""
    documents: dict[str, _Document] = {}
    homes: dict[str, str] = {}
    for item in project.items:
        parts = _demand_uid(item.id, item)
        for relation in item.relations:
            _demand_uid(relation.target, item)
        prefix, number = parts["prefix"], parts["number"]
        document = documents.setdefault(prefix.casefold(), _Document(prefix, parts["sep"], len(number)))
        document.digits = max(document.digits, len(number))
        document.items.append(item)
        homes[item.id] = document.prefix
    _build_tree(list(documents.values()), homes)
    files = {}
    for document in documents.values():
        files[f"{document.prefix}/.doorstop.yml"] = _format_settings(document)
        for position, item in enumerate(document.items, start=1):
            files[f"{document.prefix}/{item.id}.yml"] = _format_item(item, document, position)
    return files


def _demand_uid(name: str, item: ForeignItem) -> re.Match[str]:
    """@return the parts of `name`."""
    parts = _UID.fullmatch(name) if len(name) <= _UID_LENGTH_MAX else None
    if parts is None:
        raise InputError(f"{item.place}: {name} is no id for Doorstop, which wants letters, digits and -_. with a number at the end; "
                         "give it such an id, or choose another format")  # fmt: skip
    return parts


def _build_tree(documents: list[_Document], homes: dict[str, str]) -> None:
    """Places each document below the target of most of its links. Doorstop needs one tree, so documents without links go below the
    largest."""
    known = {document.prefix: document for document in documents}
    for document in documents:
        targets = Counter(homes[each.target] for item in document.items for each in item.relations if each.target in homes)
        targets.pop(document.prefix, None)
        ranked = sorted(targets, key=lambda prefix: (-targets[prefix], prefix))
        document.parent = next((prefix for prefix in ranked if document.prefix not in _list_above(prefix, known)), "")
    tops = Counter(_list_above(document.prefix, known)[-1] for document in documents)
    top = next(iter(sorted(tops, key=lambda prefix: (-tops[prefix], prefix))), "")
    for document in documents:
        if not document.parent and document.prefix != top:
            document.parent = top


def _list_above(prefix: str, known: dict[str, _Document]) -> list[str]:
    """The document and its ancestors; links that would close a cycle are ignored."""
    above = [prefix]
    while known[above[-1]].parent:
        above.append(known[above[-1]].parent)
    return above


def _format_settings(document: _Document) -> str:
    settings: dict[str, Any] = {"digits": document.digits, "prefix": document.prefix, "sep": document.sep}
    if document.parent:
        settings["parent"] = document.parent
    return _dump({"settings": settings})


def _format_item(item: ForeignItem, document: _Document, position: int) -> str:
    """Links and items have no stamps, because in Doorstop a stamp records a review."""
    others = {f"attribute-{name}" if name in _OWN else name: value for name, value in item.attributes.items()}
    words = {value.lower() for name, value in item.attributes.items() if name.lower() == "status"}
    rows = {
        "active": not words & _RETIRED,
        "derived": bool(document.parent) and not item.relations,
        "header": _Text(item.title.strip()),
        "level": f"1.{position}",
        "links": [{target: None} for target in dict.fromkeys(each.target for each in item.relations)],
        "normative": True,
        "ref": "",
        "reviewed": None,
        "text": _Text((item.statement or "").strip()),
        **({"rationale": _Text(item.rationale.strip())} if item.rationale.strip() else {}),
        **others,
    }
    return _dump(dict(sorted(rows.items())))


def _dump(content: dict[str, Any]) -> str:
    return yaml.dump(content, Dumper=_Dumper, allow_unicode=True, default_flow_style=False, sort_keys=False, width=_LINE_LENGTH)
