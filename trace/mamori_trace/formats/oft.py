# SPDX-License-Identifier: Apache-2.0
"""Reads OpenFastTrace Markdown: specification items `type~name~revision` with the keywords below them.

@satisfies SWR-TRC-045, SWR-TRC-048      Design: docs/design/trace_formats.md#formats
"""

from __future__ import annotations

import re
from pathlib import Path

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_texts
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss, Relation

NAME = "oft"
TITLE = "OpenFastTrace"
SUFFIXES = (".md", ".markdown")

_ID = r"[A-Za-z]+~[A-Za-z][\w.\-]*~\d+"
_ITEM = re.compile(rf"\s*(?:<a id=\"[^\"]*\">\s*</a>\s*)?`?({_ID})`?\s*|`?({_ID})`?(?![\w~.\-]).*")
"""OpenFastTrace treats any line that begins with an id as an item."""
_BROKEN = re.compile(r"\s*`([A-Za-z]+~[^`]*)`\s*")
_HEADING = re.compile(r" {0,3}#+\s+(.*?)\s*#*")
_SECTION = re.compile(r"(Covers|Depends|Rationale|Comment|Description):\s*(.*)")
_WORDS = re.compile(r"(Status|Needs|Tags):\s*(.*)")
_ENTRY = re.compile(r"\s*[*+-]\s+(.*?)\s*")
_LINKED = re.compile(rf"`?({_ID})`?|\[[^\]]*\]\(#({_ID})\)")
_WORD = re.compile(r"[A-Za-z]+")
_FORWARD = re.compile(rf"\s*\w+\s*-->\s*\w+(?:\s*,\s*\w+)*\s*:\s*({_ID})\s*")


def looks_alike(name: str, text: str) -> bool:
    return name.endswith(SUFFIXES) and re.search(rf"^`?{_ID}`?\s*$", text, re.MULTILINE) is not None


def read(path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """Every specification item below `path`."""
    project = ForeignProject(NAME)
    for shown, text in read_texts(path, SUFFIXES, root, problems):
        _File(shown, project, problems).take_all(text)
    return project


class _File:
    """One file during reading; `_section` is the keyword whose text or list continues."""

    def __init__(self, shown: str, project: ForeignProject, problems: list[Problem]) -> None:
        self._shown = shown
        self._project = project
        self._problems = problems
        self._heading = ""
        self._item: ForeignItem | None = None
        self._section = ""
        self._texts: dict[str, list[str]] = {}

    def take_all(self, text: str) -> None:
        in_fence = False
        for number, line in enumerate(text.splitlines(), start=1):
            if line.lstrip().startswith("```"):
                in_fence = not in_fence
            elif not in_fence:
                self._take(number, line)
        if in_fence:
            self._problems.append(Problem(UNREADABLE, Place(self._shown, number), "a code fence is never closed; the file is cut off"))
        self._close()

    def _take(self, number: int, line: str) -> None:
        heading, start = _HEADING.fullmatch(line), _ITEM.fullmatch(line)
        if heading:
            self._close()
            self._heading = heading[1]
        elif start:
            self._close()
            named = start[1] or start[2]
            kind = named.partition("~")[0]
            self._item = ForeignItem(named, self._heading, Place(self._shown, number), "", number, kind=kind, needs=())
            self._section = "Description"
        elif _FORWARD.fullmatch(line):
            self._project.losses.append(Loss(Place(self._shown, number), f"forwarding: {line.strip()}"))
        elif broken := _BROKEN.fullmatch(line):
            message = f"'{broken[1]}' is not an id of the form type~name~revision"
            self._problems.append(Problem(UNREADABLE, Place(self._shown, number), message))
        elif self._item is not None:
            self._take_part(self._item, number, line)

    def _take_part(self, item: ForeignItem, number: int, line: str) -> None:
        words, section, entry = _WORDS.fullmatch(line), _SECTION.fullmatch(line), _ENTRY.fullmatch(line)
        if words:
            item.lines[words[1]] = number
            if words[1] == "Needs":
                item.needs = tuple(filter(None, (word.strip() for word in words[2].split(","))))
            item.attributes[words[1]] = words[2].strip()
            self._section = "Description" if words[1] == "Status" else "" if words[2].strip() else words[1]
        elif section:
            self._section = section[1]
            item.lines[section[1]] = number
            self._texts.setdefault(section[1], []).append(section[2])
        elif self._section in ("Needs", "Tags") and entry:
            self._take_listed(item, entry[1])
        elif self._section in ("Covers", "Depends") and entry:
            linked = _LINKED.search(entry[1])
            item.relations.append(Relation(self._section, (linked[1] or linked[2]) if linked else entry[1], number))
        elif self._section:
            if line.strip() and self._section == "Description" and not any(self._texts.get("Description", [])):
                item.statement_line = number
            self._texts.setdefault(self._section, []).append(line.strip())
        elif line.strip():
            self._project.losses.append(Loss(Place(self._shown, number), f"text after the keywords of {item.id}"))

    def _take_listed(self, item: ForeignItem, entry: str) -> None:
        """One word of `Needs` or `Tags` if each word has its own line."""
        words = _WORD.findall(entry) if self._section == "Needs" else [entry]
        if words:
            item.needs = (*(item.needs or ()), words[-1]) if self._section == "Needs" else item.needs
            item.attributes[self._section] = ", ".join(filter(None, (item.attributes[self._section], words[-1])))

    def _close(self) -> None:
        item, texts = self._item, {name: "\n".join(lines).strip() for name, lines in self._texts.items()}
        self._item, self._section, self._texts = None, "", {}
        if item is not None:
            item.statement = texts.get("Description", "")
            item.rationale = texts.get("Rationale", "")
            if texts.get("Comment"):
                item.attributes["Comment"] = texts["Comment"]
            self._project.items.append(item)
