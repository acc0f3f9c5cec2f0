# SPDX-License-Identifier: Apache-2.0
"""Reads `.lcm` files and calculates the fingerprints of their structs.

@satisfies SWR-REC-017      Design: docs/design/recorder.md#lcm-logs
Source: LCM documentation, "LCM Type Specification Language"; the fingerprint is that of the code of lcm-gen
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import read_text

PRIMITIVES = ("int8_t", "int16_t", "int32_t", "int64_t", "byte", "float", "double", "string", "boolean")
INTEGERS = ("int8_t", "int16_t", "int32_t", "int64_t")
TOKEN = re.compile(r"//[^\n]*|/\*.*?\*/|\s+|(?P<token>[A-Za-z_][A-Za-z0-9_.]*|-?[0-9][0-9A-Za-z.+-]*|[][{}();,=])", re.DOTALL)
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
DEPTH_MAX = 32
"""Structs within structs."""
MASK = (1 << 64) - 1


@dataclass(frozen=True)
class Member:
    """`type`: a primitive, or a struct with its package. `sizes` of an array: a number, or the name of an earlier integer member."""

    name: str
    type: str
    sizes: tuple[int | str, ...]


@dataclass(frozen=True)
class Struct:
    name: str
    members: tuple[Member, ...]
    path: Path


@dataclass(frozen=True)
class Types:
    """Structs by name with their package, and by fingerprint."""

    structs: Mapping[str, Struct]
    fingerprints: Mapping[int, Struct]


def read_types(folder: Path) -> Types:
    """Reads all `.lcm` files in `folder`. @raise InputError if there is none or one is invalid."""
    if not folder.is_dir():
        raise InputError("not a folder; specify the folder of the .lcm files (./mamori lcm types)", folder)
    structs: dict[str, Struct] = {}
    for path in sorted(folder.glob("*.lcm")):
        for struct in _Parser(path).read():
            if struct.name in structs:
                raise InputError(f"struct {struct.name} is also in {structs[struct.name].path.name}; remove one", path)
            structs[struct.name] = struct
    if not structs:
        raise InputError("contains no .lcm file with a struct; specify the folder of the .lcm files (./mamori lcm types)", folder)
    return Types(structs, {_calc_fingerprint(structs, struct, 0): struct for struct in structs.values()})


class _Parser:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._text = read_text(path, "LCM type file", 1_000_000).text
        self._tokens = list(self._split())
        self._index = 0

    def read(self) -> Iterator[Struct]:
        package = ""
        while self._index < len(self._tokens):
            word = self._take()
            if word == "package":
                package = self._take(NAME_WITH_PACKAGE) + "."
                self._take(";")
            elif word == "struct":
                yield self._read_struct(package)
            else:
                self._complain(f"'{word}' is not supported here; only packages and structs are")

    def _read_struct(self, package: str) -> Struct:
        name = package + self._take(NAME)
        members: list[Member] = []
        self._take("{")
        while not self._skip("}"):
            if self._skip("const"):  # not part of messages
                while self._take() != ";":
                    pass
                continue
            kind = self._take(NAME_WITH_PACKAGE)
            if kind not in PRIMITIVES and "." not in kind:
                kind = package + kind
            while True:
                member = Member(self._take(NAME), kind, tuple(self._read_sizes(members)))
                if any(member.name == other.name for other in members):
                    self._complain(f"struct {name} has two members '{member.name}'")
                members.append(member)
                if not self._skip(","):
                    break
            self._take(";")
        return Struct(name, tuple(members), self._path)

    def _read_sizes(self, members: list[Member]) -> Iterator[int | str]:
        while self._skip("["):
            word = self._take()
            size = int(word) if word.isdecimal() else word
            is_length = any(other.name == size and other.type in INTEGERS and not other.sizes for other in members)
            if isinstance(size, int) and size < 1:
                self._complain(f"the array size {size} is not positive")
            if isinstance(size, str) and not is_length:
                self._complain(f"the array size '{word}' is neither a number nor an earlier integer member")
            yield size
            self._take("]")

    def _split(self) -> Iterator[tuple[str, int]]:
        position = 0
        while position < len(self._text):
            found = TOKEN.match(self._text, position)
            if found is None:
                raise InputError(f"unexpected character {self._text[position]!r}", self._path, self._text.count("\n", 0, position) + 1)
            if found["token"]:
                yield found["token"], position
            position = found.end()

    def _take(self, wanted: str | re.Pattern[str] = "") -> str:
        if self._index >= len(self._tokens):
            self._complain("the file ends within a declaration")
        word = self._tokens[self._index][0]
        self._index += 1
        if isinstance(wanted, re.Pattern):
            if not wanted.fullmatch(word):
                self._complain(f"{word!r} is not a name")
        elif wanted and word != wanted:
            self._complain(f"{word!r} instead of {wanted!r}")
        return word

    def _skip(self, word: str) -> bool:
        """Whether the next word is `word`; then it is consumed."""
        is_next = self._index < len(self._tokens) and self._tokens[self._index][0] == word
        self._index += is_next
        return is_next

    def _complain(self, text: str) -> NoReturn:
        position = self._tokens[min(self._index, len(self._tokens)) - 1][1] if self._tokens else 0
        raise InputError(f"{text}; correct the type file (lcm-gen checks it too)", self._path, self._text.count("\n", 0, position) + 1)


NAME_WITH_PACKAGE = re.compile(rf"{NAME.pattern}(?:\.{NAME.pattern})*")


def _calc_fingerprint(structs: Mapping[str, Struct], struct: Struct, depth: int) -> int:
    """@raise InputError for a struct that is missing or contains itself."""
    if depth == DEPTH_MAX:
        raise InputError(f"struct {struct.name} contains itself or is nested deeper than {DEPTH_MAX}", struct.path)
    value, nested = 0x12345678, 0
    for member in struct.members:
        value = _add_text(value, member.name)
        if member.type in PRIMITIVES:
            value = _add_text(value, member.type)
        elif member.type in structs:
            nested += _calc_fingerprint(structs, structs[member.type], depth + 1)
        else:
            raise InputError(f"member '{member.name}' of {struct.name}: no type '{member.type}' in this folder; add its file", struct.path)
        value = _add_byte(value, len(member.sizes))
        for size in member.sizes:
            value = _add_text(_add_byte(value, isinstance(size, str)), str(size))
    total = (value + nested) & MASK
    return (total << 1 | total >> 63) & MASK


def _add_byte(value: int, byte: int) -> int:
    signed = value - (1 << 64) if value >> 63 else value
    return ((value << 8 & MASK) ^ (signed >> 55 & MASK)) + byte & MASK


def _add_text(value: int, text: str) -> int:
    value = _add_byte(value, len(text))
    for character in text.encode("ascii"):
        value = _add_byte(value, character)
    return value
