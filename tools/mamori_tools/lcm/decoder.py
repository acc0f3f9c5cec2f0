# SPDX-License-Identifier: Apache-2.0
"""Decodes LCM messages with the types of `.lcm` files to values for JSON.

@satisfies SWR-REC-017      Design: docs/design/recorder.md#lcm-logs
"""

from __future__ import annotations

import math
import struct
from typing import Any

from mamori_tools.lcm.type_files import Member, Struct, Types

FINGERPRINT_BYTES = 8
FORMATS = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "byte": "B", "float": "f", "double": "d", "boolean": "B"}
NUMBER_SCHEMA = {"type": ["number", "string"], "description": "NaN and infinity are strings"}


class DecodeError(Exception):
    """The message does not match its type."""


class _Reader:
    def __init__(self, types: Types, data: bytes) -> None:
        self._types, self._data, self.position = types, data, FINGERPRINT_BYTES

    def read_struct(self, kind: Struct) -> dict[str, Any]:
        values: dict[str, Any] = {}
        for member in kind.members:
            sizes = [size if isinstance(size, int) else self._check_size(member, values[size]) for size in member.sizes]
            values[member.name] = self._read_array(member.type, sizes) if sizes else self._read_many(member.type, 1)[0]
        return values

    def _check_size(self, member: Member, size: int) -> int:
        if not 0 <= size <= len(self._data):
            raise DecodeError(f"length {size} of '{member.name}' is out of range")
        return size

    def _read_array(self, kind: str, sizes: list[int]) -> list[Any]:
        if len(sizes) == 1:
            return self._read_many(kind, sizes[0])
        return [self._read_array(kind, sizes[1:]) for _ in range(sizes[0])]

    def _read_many(self, kind: str, count: int) -> list[Any]:
        if kind == "string":
            return [self._read_string() for _ in range(count)]
        if kind not in FORMATS:
            return [self.read_struct(self._types.structs[kind]) for _ in range(count)]
        values = list(self._unpack(f">{count}{FORMATS[kind]}"))
        if kind == "boolean":
            if any(value > 1 for value in values):
                raise DecodeError("a boolean is neither 0 nor 1")
            return [bool(value) for value in values]
        return values if kind not in ("float", "double") else [value if math.isfinite(value) else _name_number(value) for value in values]

    def _read_string(self) -> str:
        (size,) = self._unpack(">i")
        if size < 1 or size > len(self._data):
            raise DecodeError(f"length {size} of a string is out of range")
        (octets,) = self._unpack(f"{size}s")
        if octets[-1] != 0:
            raise DecodeError("a string does not end with NUL")
        return bytes(octets[:-1]).decode("utf-8", "backslashreplace")

    def _unpack(self, form: str) -> tuple[Any, ...]:
        try:
            values = struct.unpack_from(form, self._data, self.position)
        except struct.error:
            raise DecodeError("the message is truncated") from None
        self.position += struct.calcsize(form)
        return values


def _name_number(value: float) -> str:
    return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"


def find_type(types: Types, data: bytes) -> Struct | None:
    """@return the type of a message by its fingerprint."""
    return types.fingerprints.get(int.from_bytes(data[:FINGERPRINT_BYTES], "big")) if len(data) >= FINGERPRINT_BYTES else None


def decode(types: Types, kind: Struct, data: bytes) -> dict[str, Any]:
    """@return members by name, in order. @raise DecodeError."""
    reader = _Reader(types, data)
    values = reader.read_struct(kind)
    if reader.position != len(data):
        raise DecodeError(f"the message is {len(data) - reader.position} octets longer than its type")
    return values


def make_schema(types: Types, kind: Struct) -> dict[str, Any]:
    """JSON schema of decode()."""
    return {"title": kind.name, "type": "object", "properties": {one.name: _make_member(types, one) for one in kind.members},
            "required": [one.name for one in kind.members]}  # fmt: skip


def _make_member(types: Types, member: Member) -> dict[str, Any]:
    if member.type in types.structs:
        schema = make_schema(types, types.structs[member.type])
    elif member.type in ("float", "double"):
        schema = dict(NUMBER_SCHEMA)
    else:
        schema = {"type": {"string": "string", "boolean": "boolean"}.get(member.type, "integer")}
    for _ in member.sizes:
        schema = {"type": "array", "items": schema}
    return schema
