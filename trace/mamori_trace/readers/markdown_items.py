# SPDX-License-Identifier: Apache-2.0
"""Reads strict item blocks from Markdown, line by line, with the location of every part.

An invalid block is reported as a problem and kept as far as possible, so that one error neither hides nor causes others.

@satisfies SWR-TRC-001      Design: docs/design/trace.md#items
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

from mamori_trace.base.files import UNREADABLE, get_shown_path, read_text, walk_folders
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.item import Item, Schema

MALFORMED = "malformed-item"
_ATTRIBUTE = re.compile(r"- ([A-Za-z]+):(.*)")


def read_items(root: Path, schema: Schema, problems: list[Problem]) -> list[Item]:
    """All items below requirements/, in file order. README files and the schema folder contain none."""
    base = root / "requirements"
    items: list[Item] = []
    for path in sorted(_list_files(base, root, problems)):
        if path.name == "README.md" or "schema" in path.relative_to(base).parts:
            continue
        shown = get_shown_path(path, root)
        items.extend(parse_items(read_text(path, shown, problems), shown, schema, problems))
    return items


def _list_files(base: Path, root: Path, problems: list[Problem]) -> Iterator[Path]:
    """Links to folders are not followed, because they could be endless. They are reported, because their items would otherwise be
    missing."""
    for folder, folders, files in walk_folders(base, root, problems):
        for path in (Path(folder, name) for name in folders):
            if path.is_symlink():
                message = "is a link to a folder, which is not followed; put the folder itself here, or links to its files"
                problems.append(Problem(UNREADABLE, Place((Path("requirements") / path.relative_to(base)).as_posix(), 1), message))
            elif path.suffix == ".md":
                yield path  # later reported as not a file
        yield from (Path(folder, name) for name in files if name.endswith(".md"))


def parse_items(text: str, shown: str, schema: Schema, problems: list[Problem]) -> list[Item]:
    """Items of one file. `shown` is its path in findings."""
    items: list[Item] = []
    block: _Block | None = None
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith(("# ", "## ")):
            _finish(block, items)
            block = _Block.open(line, Place(shown, number), schema, problems) if line.startswith("## ") else None
        elif block is not None:
            block.take(number, line.rstrip())
    _finish(block, items)
    return items


def _finish(block: _Block | None, items: list[Item]) -> None:
    if block is not None:
        items.append(block.close())


class _Block:
    """One item during reading: statement first, then the attributes in the order of the schema."""

    def __init__(self, item: Item, schema: Schema, problems: list[Problem]) -> None:
        self._item = item
        self._schema = schema
        self._problems = problems
        self._statement: list[str] = []
        self._statement_ended = False
        self._last = ""
        self._rank = -1

    @staticmethod
    def open(line: str, place: Place, schema: Schema, problems: list[Problem]) -> _Block | None:
        """Starts a block at a level-2 heading; a heading without a valid id starts none."""
        item_id, _, title = line[3:].strip().partition(" ")
        level = schema.find_level(item_id)
        if level is None:
            forms = ", ".join(each.pattern.pattern.replace(r"\d{3}", "nnn") for each in schema.levels.values())
            problems.append(
                Problem(MALFORMED, place, f"heading '{item_id or line}' does not begin with an id of the form {forms}")
            )
            return None
        block = _Block(Item(item_id, title.strip(), level.key, place), schema, problems)
        if not title.strip():
            block._refuse(place.line, "the heading has no title")
        return block

    def take(self, number: int, line: str) -> None:
        if not line:
            self._statement_ended = bool(self._statement)
            return
        match = _ATTRIBUTE.fullmatch(line) if line.startswith("- ") else None
        if match:
            name, value = match.groups()
            self._take_attribute(number, name, value.strip())
        elif self._last and line.startswith("  "):
            self._extend_attribute(number, line.strip())
        elif self._last:
            self._refuse(number, "text after the attributes; an item is a heading, one statement and its attributes")
        elif self._statement_ended:
            self._refuse(number, "a second paragraph; the statement is one paragraph")
        elif line.lstrip().startswith(("#", "```", "~~~", "- ", "* ", "|")):
            self._refuse(number, "only one paragraph of plain text may stand between the heading and the attributes")
        else:
            if not self._statement:
                self._item.statement_line = number
            self._statement.append(line.strip())

    def close(self) -> Item:
        item = self._item
        item.statement = " ".join(self._statement)
        if not item.statement:
            self._refuse(item.place.line, "has no statement between its heading and its attributes")
        missing = [name for name in self._schema.attributes if name not in item.lines]
        if missing:
            self._refuse(item.place.line, f"lacks {', '.join(missing)}")
        return item

    def _refuse(self, number: int, message: str) -> None:
        item = self._item
        item.whole = False
        self._problems.append(Problem(MALFORMED, Place(item.place.file, number), f"{item.id}: {message}", item.id))

    def _take_attribute(self, number: int, name: str, value: str) -> None:
        item = self._item
        if name not in self._schema.attributes:
            self._refuse(number, f"unknown attribute '{name}'; known are {', '.join(self._schema.attributes)}")
            return
        if name in item.lines:
            self._refuse(number, f"{name} is given twice (first in line {item.lines[name]})")
            return
        rank = self._schema.attributes.index(name)
        if rank < self._rank:
            self._refuse(number, f"{name} is out of order; the order is {', '.join(self._schema.attributes)}")
        else:
            self._rank = rank
        self._last = name
        item.lines[name] = number
        if not value:
            self._refuse(number, f"{name} is empty")
            return
        _SETTERS[name](self, number, value)

    def _extend_attribute(self, number: int, text: str) -> None:
        """A wrapped line; only prose may be wrapped."""
        if self._last == "Rationale":
            self._item.rationale = f"{self._item.rationale} {text}"
        else:
            self._refuse(number, f"{self._last} goes on in a second line; only Rationale may")

    def _set_rationale(self, _number: int, value: str) -> None:
        self._item.rationale = value

    def _set_parents(self, number: int, value: str) -> None:
        if value == "-":
            return
        parents = _split(value)
        wrong = [parent for parent in parents if self._schema.find_level(parent) is None]
        if wrong:
            self._refuse(number, f"Parents: '{wrong[0]}' is not an id")
        self._item.parents = tuple(parent for parent in parents if parent not in wrong)

    def _set_sil(self, number: int, value: str) -> None:
        self._item.sil = "".join(self._keep_known(number, "SIL", [value], self._schema.sil))

    def _set_verify(self, number: int, value: str) -> None:
        self._item.verify = self._keep_known(number, "Verify", _split(value), self._schema.verify)

    def _set_polarity(self, number: int, value: str) -> None:
        self._item.polarity = self._keep_known(number, "Polarity", _split(value), self._schema.polarity)

    def _set_design(self, _number: int, value: str) -> None:
        self._item.design = "" if value == "-" else value

    def _set_status(self, number: int, value: str) -> None:
        self._item.status = "".join(self._keep_known(number, "Status", [value], self._schema.status))

    def _keep_known(self, number: int, name: str, words: list[str], known: tuple[str, ...]) -> tuple[str, ...]:
        """`words` without unknown ones, which are reported."""
        for word in words:
            if word not in known:
                self._refuse(number, f"{name}: '{word}' is not one of {', '.join(known)}")
        return tuple([word for word in words if word in known])


_SETTERS: dict[str, Callable[[_Block, int, str], None]] = {
    "Rationale": _Block._set_rationale,
    "Parents": _Block._set_parents,
    "SIL": _Block._set_sil,
    "Verify": _Block._set_verify,
    "Polarity": _Block._set_polarity,
    "Design": _Block._set_design,
    "Status": _Block._set_status,
}


def _split(value: str) -> list[str]:
    return [word.strip() for word in value.split(",")]
