# SPDX-License-Identifier: Apache-2.0
"""YAML in which every value has its line, so that messages can name the location of an invalid value.

Only text, lists and mappings are built, from parser events; no tag constructs an object. An alias may replace only a scalar: model files
use this for sources. Aliases of lists and mappings are rejected, because a small file could otherwise grow without limit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names
from mamori_trace.base.text_file import SourceText, read_text

MAX_DEPTH = 20
MAX_BYTES = 1_000_000

_TRUE = frozenset({"true", "True", "yes", "on"})
_FALSE = frozenset({"false", "False", "no", "off"})
_NULL = frozenset({"", "~", "null", "Null", "NULL"})


def parse_events(source: SourceText) -> Iterator[yaml.Event]:
    """Parser events of the only document in `source`, without the stream events.

    Raises InputError on a syntax error and on a second document.
    """
    documents = 0
    try:
        for event in yaml.parse(source.text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
            if isinstance(event, yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    raise InputError("a second document starts; keep one per file", source.path, line_of(event))
            if not isinstance(event, (yaml.StreamStartEvent, yaml.StreamEndEvent)):
                yield event
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = None if mark is None else min(mark.line + 1, max(1, len(source.text.splitlines())))
        cut = mark is not None and not source.text[_offset(source.text, mark):].strip()
        hint = "the file ends too early; write it again" if cut else "mend the YAML there"
        raise InputError(f"no YAML: {error.problem or error.context}; {hint}", source.path, line) from error
    except yaml.YAMLError as error:
        raise InputError(f"no YAML: {error}; mend the YAML", source.path) from error
    if documents == 0:
        raise InputError("holds no YAML document; write it again", source.path)


def line_of(event: yaml.Event) -> int:
    """Line of the start of the event, counted from 1."""
    assert event.start_mark is not None  # the parser gives each event its location
    return event.start_mark.line + 1


@dataclass(frozen=True)
class Node:
    """One YAML value with its location. `value` is text, a list of nodes, or a mapping from text to nodes."""

    path: Path
    line: int
    name: str
    value: str | list[Node] | dict[str, Node]
    plain: bool = False
    key_lines: dict[str, int] = field(default_factory=dict)

    def error(self, text: str) -> InputError:
        """An error that names the location of this value."""
        return InputError(f"{self.name}: {text}", self.path, self.line)

    def is_null(self) -> bool:
        return self.plain and isinstance(self.value, str) and self.value in _NULL

    def as_mapping(self, allowed: frozenset[str] | None = None) -> dict[str, Node]:
        """The entries. Raises InputError if this is not a mapping or has a key that is not in `allowed`."""
        if not isinstance(self.value, dict):
            raise self.error("write a mapping (key: value) here")
        if allowed is None:
            return self.value
        for key in self.value:
            if key not in allowed:
                raise InputError(f"unknown key '{key}' in {self.name}; {nearest_names(key, sorted(allowed))}",
                                 self.path, self.key_lines[key])
        return self.value

    def as_list(self) -> list[Node]:
        if not isinstance(self.value, list):
            raise self.error("write a list [..] here")
        return self.value

    def as_text(self) -> str:
        if not isinstance(self.value, str) or self.is_null():
            raise self.error("write a text here")
        return self.value

    def as_float(self) -> float:
        """A finite number."""
        text = self.as_text()
        try:
            number = float(text)
        except ValueError:
            raise self.error(f"'{text}' is not a number") from None
        if not math.isfinite(number):
            raise self.error(f"{text} is not finite; write a finite number")
        return number

    def as_int(self) -> int:
        text = self.as_text()
        try:
            return int(text)
        except ValueError:
            raise self.error(f"'{text}' is not an integer") from None

    def as_bool(self) -> bool:
        text = self.as_text()
        if text not in _TRUE | _FALSE:
            raise self.error(f"'{text}' is neither true nor false")
        return text in _TRUE

    def get(self, key: str) -> Node:
        """The entry `key`. Raises InputError if it is missing."""
        entries = self.as_mapping()
        if key not in entries:
            raise self.error(f"'{key}' is missing; add it")
        return entries[key]


def load(path: Path | str, what: str) -> Node:
    """Reads a small YAML file; `what` names its kind in messages. Raises InputError; see `parse_events`, `read_text`."""
    source = read_text(path, what, MAX_BYTES)
    events = parse_events(source)
    next(events)  # the start of the document
    root = _Builder(events, source.path).build(next(events), what, 0)
    for _ in events:  # detects a second document
        pass
    return root


class _Builder:
    """Creates nodes from events and stores the scalars with an anchor."""

    def __init__(self, events: Iterator[yaml.Event], path: Path) -> None:
        self._events = events
        self._path = path
        self._anchors: dict[str, yaml.ScalarEvent] = {}

    def build(self, event: yaml.Event, name: str, depth: int) -> Node:
        line = line_of(event)
        if depth > MAX_DEPTH:
            raise InputError(f"nested deeper than {MAX_DEPTH} levels; flatten it", self._path, line)
        if isinstance(event, yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise InputError(f"*{event.anchor} stands for no single value above; write it out", self._path, line)
            event = self._anchors[event.anchor]
        if isinstance(event, yaml.ScalarEvent):
            if event.anchor is not None:
                self._anchors[event.anchor] = event
            return Node(self._path, line, name, event.value, plain=event.implicit[0])
        if isinstance(event, yaml.SequenceStartEvent):
            items: list[Node] = []
            while not isinstance(inner := next(self._events), yaml.SequenceEndEvent):
                items.append(self.build(inner, f"{name}[{len(items) + 1}]", depth + 1))
            return Node(self._path, line, name, items)
        return self._build_mapping(line, name, depth)

    def _build_mapping(self, line: int, name: str, depth: int) -> Node:
        entries: dict[str, Node] = {}
        key_lines: dict[str, int] = {}
        while not isinstance(key := next(self._events), yaml.MappingEndEvent):
            if not isinstance(key, yaml.ScalarEvent):
                raise InputError(f"a key of {name} is no text; write key: value", self._path, line_of(key))
            if key.value in entries:
                raise InputError(f"key '{key.value}' of {name} stands twice; remove one", self._path, line_of(key))
            entries[key.value] = self.build(next(self._events), key.value, depth + 1)
            key_lines[key.value] = line_of(key)
        return Node(self._path, line, name, entries, key_lines=key_lines)


def _offset(text: str, mark: yaml.Mark) -> int:
    """Location of `mark` in `text`. The C parser and the Python parser count the index in characters."""
    return min(mark.index, len(text))
