# SPDX-License-Identifier: Apache-2.0
"""Handwritten logs in the format of lcm-logger, and type files."""

from __future__ import annotations

import struct
from pathlib import Path

INNER = "package a.b;\n\nstruct Inner {\n    double x[2];\n    string name;\n}\n"
OUTER = """// A comment; struct not { of } interest
package a;
/* nor
   this */
struct Outer {
    const int32_t N = 4, M = 0x2; const double PI = 3.1e-2;
    int8_t i8; int16_t i16; int32_t i32; int64_t i64;
    byte e2e[3];
    float single; double big;
    boolean flag, flags[2];
    int32_t n; int16_t m;
    a.b.Inner inner[n];
    float matrix[n][m][2];
    string words[m];
    Own own;
}
struct Own { int8_t k; }
"""
BEGIN_US = 1_700_000_000_000_000


def write_types(folder: Path) -> Path:
    folder.mkdir()
    (folder / "inner.lcm").write_text(INNER, encoding="utf-8")
    (folder / "outer.lcm").write_text(OUTER, encoding="utf-8")
    return folder


def make_event(number: int, time_us: int, channel: str, data: bytes) -> bytes:
    name = channel.encode()
    return struct.pack(">IQqII", 0xEDA1DA01, number, BEGIN_US + time_us, len(name), len(data)) + name + data
