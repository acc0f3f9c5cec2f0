# SPDX-License-Identifier: Apache-2.0
"""Makes safety/include/mamori/safety/e2e/residual_facts.hpp: what the compiler is told of the 16- and 32-bit checksums.

    python -P -m mamori.verification.e2e.facts

@satisfies SWR-E2E-023      Design: docs/design/e2e.md#residual-error
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from mamori.verification.command.project import ROOT
from mamori.verification.e2e.residual import CRC16, CRC32_P4, Checksum, Distance, Spectrum, calc_spectrum, find_distance
from mamori.verification.e2e.spectra import P4_LENGTHS, load

HEADER = ROOT / "safety" / "include" / "mamori" / "safety" / "e2e" / "residual_facts.hpp"
# Bytes. 4093: the longest frame with a distance above 2.
CRC16_LENGTHS = (*range(3, 9), 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64, 96, 128, 256, 512, 1024, 2048, 4093, 4096)
TEXT = """// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the compiler is told of the residual errors of frames with 16- and 32-bit checksums. Written by
/// verification/e2e/facts.py; a test makes it again and compares.
///
/// @satisfies SWR-E2E-023      Design: docs/design/e2e.md#residual-error
#ifndef MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP
#define MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace mamori::safety::detail {{

/// Error patterns that pass in frames of one length.
struct ResidualFacts {{
    std::size_t length{{0U}};      ///< of the frame with its header [bytes]
    std::uint32_t distance{{0U}};  ///< fewest turned bits that may pass
    double patterns{{0.0}};        ///< how many patterns of so many bits pass
    double ratio{{0.0}};           ///< greatest share of any higher weight that passes [2^-width]
}};

// clang-format off: a row per line
/// Profiles 5 and 6.
inline constexpr std::array kResidualFacts16{{
{rows16}
}};

/// Profiles 4, 8 and 44.
inline constexpr std::array kResidualFacts32{{
{rows32}
}};
// clang-format on

}}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_E2E_RESIDUAL_FACTS_HPP
"""


@dataclass(frozen=True)
class Fact:
    """A row of the header. Length in bytes."""

    length: int
    distance: Distance
    ratio: float

    def make_row(self) -> str:
        return f"    ResidualFacts{{{self.length}U, {self.distance.bits}U, {self.distance.patterns}.0, {self.ratio:.2f}}},"


def calc_shares(spectrum: Spectrum) -> Iterator[tuple[int, float]]:
    """For each weight the share of its patterns that pass, in units of 2^-width.

    Krawtchouk polynomials divided by their value at 0 stay within -1 .. 1, and those of one half of the weights follow from the
    other half, so the widest floating-point numbers lose less than 1e-6.
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
    """The ratio is rounded up."""
    distance = find_distance(spectrum)
    greatest = max((share for weight, share in calc_shares(spectrum) if weight > distance.bits), default=0.0)
    return Fact(spectrum.bits // 8, distance, math.ceil(100 * greatest + 1e-3) / 100)


def make_facts(checksum: Checksum, lengths: Iterable[int]) -> Iterator[Fact]:
    """@raise ValueError a stored file is missing or damaged."""
    for length in lengths:
        spectrum = load(checksum, length)
        if spectrum is None and checksum.width > 16:
            raise ValueError(f"{checksum.name}, {length} bytes: make the files first: python -P -m mamori.verification.e2e.spectra")
        yield make_fact(spectrum or calc_spectrum(checksum, 8 * length))


def make_header() -> str:
    """The whole header. @raise ValueError as make_facts()."""
    rows16, rows32 = (
        "\n".join(fact.make_row() for fact in make_facts(checksum, lengths))
        for checksum, lengths in ((CRC16, CRC16_LENGTHS), (CRC32_P4, P4_LENGTHS))
    )
    return TEXT.format(rows16=rows16, rows32=rows32)


def main(path: Path = HEADER) -> int:
    """@return exit status."""
    try:
        path.write_text(make_header(), encoding="utf-8")
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
