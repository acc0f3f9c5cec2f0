# SPDX-License-Identifier: Apache-2.0
"""Creates the rows of safety/include/mamori/safety/e2e/residual_error.hpp: the compile-time figures of the 16- and 32-bit checksums.

    python -P -m mamori_tools.e2e.facts

@satisfies SWR-E2E-023      Design: docs/design/e2e.md#residual-error
"""

from __future__ import annotations

import math
import struct
import sys
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from mamori_tools.e2e.residual import CRC16, CRC32_P4, Checksum, Distance, Spectrum, calc_spectrum, find_distance
from mamori_tools.e2e.spectra import P4_LENGTHS, load
from mamori_tools.host.project import ROOT
from mamori_trace.base.text_file import write_text

HEADER = ROOT / "safety" / "include" / "mamori" / "safety" / "e2e" / "residual_error.hpp"
# Bytes. 4093: the longest message with a distance above 2.
CRC16_LENGTHS = (*range(3, 9), 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64, 96, 128, 256, 512, 1024, 2048, 4093, 4096)
# First and last line of the rows in the header.
FIRST = "// clang-format off: a row per line, all written by tools/mamori_tools/e2e/facts.py\n"
LAST = "// clang-format on\n"
TEXT = """/// Profiles 5 and 6.
inline constexpr std::array kResidualFacts16{{
{rows16}
}};
static_assert(calc_fingerprint(kResidualFacts16) == 0x{fingerprint16:08X}U, "a row was changed; run facts.py");

/// Profiles 4, 8 and 44.
inline constexpr std::array kResidualFacts32{{
{rows32}
}};
static_assert(calc_fingerprint(kResidualFacts32) == 0x{fingerprint32:08X}U, "a row was changed; run facts.py");
"""


@dataclass(frozen=True)
class Fact:
    """A row of the header. Length in bytes, share in hundredths of 2^-width."""

    length: int
    distance: Distance
    share: int

    @property
    def values(self) -> tuple[int, ...]:
        return self.length, self.distance.bits, self.distance.patterns, self.share

    def make_row(self) -> str:
        return f"    ResidualFacts{{{', '.join(f'{value}U' for value in self.values)}}},"


def calc_shares(spectrum: Spectrum) -> Iterator[tuple[int, float]]:
    """For each weight, the share of its patterns that pass, in units of 2^-width.

    Krawtchouk polynomials divided by their value at 0 stay within -1 .. 1. The values for one half of the weights follow from the other
    half. With the widest floating-point numbers, the loss is therefore less than 1e-6.
    """
    bits = spectrum.bits
    weights = np.array(sorted(spectrum.counts), dtype=np.longdouble)
    counts = np.array([spectrum.counts[weight] for weight in sorted(spectrum.counts)], dtype=np.longdouble)
    turned_counts = np.where(weights % 2 == 0, counts, -counts)
    before: npt.NDArray[Any] = np.zeros_like(weights)
    now: npt.NDArray[Any] = np.ones_like(weights)
    for turned in range(bits // 2 + 1):
        yield turned, float(counts @ now)
        yield bits - turned, float(turned_counts @ now)
        before, now = now, ((bits - 2 * weights) * now - turned * before) / (bits - turned)


def make_fact(spectrum: Spectrum) -> Fact:
    """Rounds the share up."""
    distance = find_distance(spectrum)
    greatest = max((share for weight, share in calc_shares(spectrum) if weight > distance.bits), default=0.0)
    return Fact(spectrum.bits // 8, distance, math.ceil(100 * greatest + 1e-3))


def make_facts(checksum: Checksum, lengths: Iterable[int]) -> Iterator[Fact]:
    """@raise ValueError if a stored file is missing or damaged."""
    for length in lengths:
        spectrum = load(checksum, length)
        if spectrum is None and checksum.width > 16:
            raise ValueError(f"{checksum.name}, {length} bytes: make the files first: python -P -m mamori_tools.e2e.spectra")
        yield make_fact(spectrum or calc_spectrum(checksum, 8 * length))


def make_header() -> str:
    """The complete header with new rows. @raise ValueError like make_facts()."""
    texts: dict[str, str | int] = {}
    for checksum, lengths in ((CRC16, CRC16_LENGTHS), (CRC32_P4, P4_LENGTHS)):
        rows = list(make_facts(checksum, lengths))
        values = [value for row in rows for value in row.values]
        texts[f"rows{checksum.width}"] = "\n".join(row.make_row() for row in rows)
        texts[f"fingerprint{checksum.width}"] = zlib.crc32(struct.pack(f"<{len(values)}Q", *values))
    text = HEADER.read_text(encoding="utf-8")
    begin = text.index(FIRST) + len(FIRST)
    return text[:begin] + TEXT.format(**texts) + text[text.index(LAST, begin) :]


def main(path: Path = HEADER) -> int:
    """@return exit status."""
    try:
        write_text(path, make_header())
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
