# SPDX-License-Identifier: Apache-2.0
"""Residual error of a checksum: the exact probability that a damaged message passes, from the weights of the dual code.

The error patterns that pass form a linear code: the errors whose syndromes add up to zero. Its dual code has 2^width words. The weight of
each word follows from one value of the Walsh-Hadamard transform of the syndromes. From these weights, the MacWilliams identities give the
number of passing patterns of each weight (as integers), and the probability that a pattern passes.

@satisfies SWR-E2E-020, SWR-E2E-021      Design: docs/design/e2e.md#residual-error
Source: MacWilliams and Sloane, The Theory of Error-Correcting Codes, chapter 5; IEC 61784-3 (rate of residual errors)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from decimal import Decimal, localcontext
from functools import cache
from math import comb
from typing import Any

import numpy as np
import numpy.typing as npt

GUARD_DIGITS = 30  # digits of a result that remain after cancellation
LOW_BITS = 16  # bits of a dual word: one block of the transform; 2^16 numbers of 16 bits fit the cache of a core
BATCH = 16  # number of parallel blocks
NO_TELLING: Callable[[float], None] = lambda share: None  # noqa: E731

Words = npt.NDArray[np.uint64]


@dataclass(frozen=True)
class Checksum:
    """The properties that determine which errors pass. `gap`: bits [0 ..] between payload and checksum that are divided but not sent."""

    name: str
    width: int
    polynomial: int
    gap: int = 0


CRC8 = Checksum("CRC-8 SAE J1850", 8, 0x1D)
CRC8_H2F = Checksum("CRC-8 H2F", 8, 0x2F, gap=8)
CRC16 = Checksum("CRC-16 CCITT", 16, 0x1021, gap=16)
CRC32_P4 = Checksum("CRC-32 P4", 32, 0xF4ACFB13)
CRC32 = Checksum("CRC-32 Ethernet", 32, 0x04C11DB7)
CRC64 = Checksum("CRC-64 ECMA", 64, 0x42F0E1EBA9EA3693)


@dataclass(frozen=True)
class Profile:
    """The properties of a profile that affect its residual error. Lengths in bytes, with the header."""

    number: int
    checksum: Checksum
    length_min: int
    length_max: int


# An identifier before the payload (1, 11) has no influence on errors; an identifier after it (2, 22, 5, 6) is a gap.
PROFILES = {
    profile.number: profile
    for profile in (
        Profile(1, CRC8, 2, 30),
        Profile(2, CRC8_H2F, 2, 256),
        Profile(4, CRC32_P4, 12, 4096),
        Profile(5, CRC16, 3, 4096),
        Profile(6, CRC16, 5, 4096),
        Profile(7, CRC64, 20, 4_194_304),
        Profile(8, CRC32_P4, 16, 4_194_304),
        Profile(11, CRC8, 2, 30),
        Profile(22, CRC8_H2F, 2, 256),
        Profile(44, CRC32_P4, 12, 65_535),
    )
}


@dataclass(frozen=True)
class Spectrum:
    """Weights of the dual code: `counts[j]` of its 2^width words have j ones. `bits`: length of a message."""

    checksum: Checksum
    bits: int
    counts: dict[int, int]


@dataclass(frozen=True)
class Distance:
    """The minimum number of flipped bits that can pass, and the number of such patterns."""

    bits: int
    patterns: int


def calc_syndromes(checksum: Checksum, bits: int) -> list[int]:
    """Contribution of each sent bit to the remainder: first the bits of the checksum, then those of the payload from its end."""
    top, mask = checksum.width - 1, (1 << checksum.width) - 1
    syndromes, power = [], 1
    for place in range(bits + checksum.gap):
        if place <= top or place > top + checksum.gap:
            syndromes.append(power)
        power = power << 1 & mask ^ (checksum.polynomial if power >> top else 0)
    return syndromes


def transform(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Walsh-Hadamard transform of each column; the number of rows is a power of two. Overwrites `values`."""
    rows, columns = values.shape
    source, target, half = values, np.empty_like(values), 1
    while half < rows:
        pairs = source.reshape(rows // (2 * half), 2, half * columns)
        results = target.reshape(pairs.shape)
        np.add(pairs[:, 0], pairs[:, 1], out=results[:, 0])
        np.subtract(pairs[:, 0], pairs[:, 1], out=results[:, 1])
        source, target, half = target, source, 2 * half
    return source


def make_blocks(checksum: Checksum, bits: int) -> Iterator[tuple[float, npt.NDArray[Any]]]:
    """Transforms of all 2^width dual words, several blocks at a time, each with the completed share of the work [0 .. 1].

    A block contains the dual words with one upper part, which only changes the signs of the syndromes.
    """
    low_bits = min(checksum.width, LOW_BITS)
    blocks = 1 << (checksum.width - low_bits)
    words, times = np.unique(np.array(calc_syndromes(checksum, bits), dtype=np.uint64), return_counts=True)
    lows = (words & np.uint64((1 << low_bits) - 1)).astype(np.int64)
    highs = (words >> np.uint64(low_bits)).astype(np.int64)
    order = np.argsort(lows, kind="stable")
    lows, highs, times = lows[order], highs[order], times[order]
    starts = np.flatnonzero(np.concatenate(([True], lows[1:] != lows[:-1])))
    signs = np.array([1], dtype=np.int8)  # sign of a word: -1 for an odd number of ones
    for _ in range(checksum.width - low_bits):
        signs = np.concatenate((signs, -signs))
    number = np.int16 if bits <= np.iinfo(np.int16).max else np.int32
    for first in range(0, blocks, BATCH):
        uppers = np.arange(first, min(first + BATCH, blocks))
        turned = (signs[highs[:, None] & uppers[None, :]] * times[:, None]).astype(number)
        values = np.zeros((1 << low_bits, len(uppers)), dtype=number)
        values[lows[starts]] = np.add.reduceat(turned, starts, axis=0)
        yield (uppers[-1] + 1) / blocks, transform(values)


def calc_spectrum(checksum: Checksum, bits: int, tell: Callable[[float], None] = NO_TELLING) -> Spectrum:
    """Weights of all 2^width dual words. Takes milliseconds up to 16 bits, and nearly a minute for 32 bits.

    @param bits length of the message, at least the width of the checksum. @param tell receives the completed share [0 .. 1].
    """
    counts = np.zeros(2 * bits + 1, dtype=np.int64)
    for share, values in make_blocks(checksum, bits):
        places = values.ravel().astype(np.intp)  # the type that bincount() needs; its own conversion is slower
        places += bits
        counts += np.bincount(places, minlength=len(counts))
        tell(share)
    return Spectrum(checksum, bits, {(2 * bits - int(place)) // 2: int(counts[place]) for place in np.flatnonzero(counts)})


def count_patterns(spectrum: Spectrum) -> Iterator[int]:
    """Number of passing error patterns of 0, 1, 2 .. bits (MacWilliams). @raise ValueError if these are not weights of a dual code."""
    bits = spectrum.bits
    weights = sorted(spectrum.counts)
    before, now = [0] * len(weights), [1] * len(weights)  # Krawtchouk polynomials of two adjacent degrees
    for turned in range(bits + 1):
        total = sum(spectrum.counts[weight] * value for weight, value in zip(weights, now, strict=True))
        count, rest = divmod(total, 1 << spectrum.checksum.width)
        if rest or count < 0 or (turned == 0 and count != 1):
            raise ValueError(f"{turned} turned bits: {total} / 2^{spectrum.checksum.width} is no number of patterns")
        yield count
        degree = turned + 1
        terms = zip(weights, now, before, strict=True)
        before, now = now, [((bits - 2 * weight) * value - (bits - turned + 1) * last) // degree for weight, value, last in terms]


def find_distance(spectrum: Spectrum) -> Distance:
    """@raise ValueError like count_patterns()."""
    for turned, count in enumerate(count_patterns(spectrum)):
        if turned > 0 and count > 0:
            return Distance(turned, count)
    raise ValueError("nothing passes; a frame is longer than its checksum")


def calc_residual(spectrum: Spectrum, distance: Distance, pe: Decimal) -> Decimal:
    """Probability that a message arrives damaged and passes [1 per message].

    The result is the probability of all passing patterns minus the probability of no error. The number of cancelled digits is known in
    advance, because patterns of the minimum weight are part of the result. Using so many more digits avoids any loss.
    @param pe bit error probability, above 0 and up to 0.5.
    """
    shared = 1 + ((1 - pe) / pe) ** distance.bits / distance.patterns
    with localcontext() as context:
        context.prec = GUARD_DIGITS + shared.adjusted() + 1
        bias = 1 - 2 * pe
        passing = sum((Decimal(count) * (bias**weight if weight else 1) for weight, count in spectrum.counts.items()), Decimal(0))
        result = passing / (1 << spectrum.checksum.width) - (1 - pe) ** spectrum.bits
    return +result


def sum_patterns(spectrum: Spectrum, pe: Decimal) -> Decimal:
    """The same result as a plain sum over the patterns of each weight. It is for comparison only, because it is too slow for long
    messages."""
    terms = (
        count * pe**turned * (1 - pe) ** (spectrum.bits - turned) for turned, count in enumerate(count_patterns(spectrum)) if turned
    )
    return sum(terms, Decimal(0))


def bound_residual(bits: int, distance: int, pe: Decimal) -> Decimal:
    """Upper bound for any message if only the Hamming distance is known [1 per message]: the probability of at least that many flipped
    bits."""
    return min(Decimal(1), comb(bits, distance) * pe**distance)


@cache
def find_least_distance(checksum: Checksum, bits: int) -> int:
    """A proven Hamming distance from a search of all patterns of few bits, for checksums too wide for the dual code.

    Forms sums of one, two, three syndromes, as far as memory permits: two equal sums of k syndromes are a passing pattern of 2 k bits. A
    single flipped bit never passes, at any length.
    """
    depth = next((depth for depth, most in ((3, 256), (2, 4096), (1, 524_288)) if bits <= most), 0)
    syndromes = np.array(calc_syndromes(checksum, bits) if depth else [], dtype=np.uint64)
    sums = [np.zeros(1, dtype=np.uint64)]
    for size in range(1, depth + 1):
        sums.append(np.sort(_add_all(syndromes, size)))
    for size in range(1, depth + 1):
        places = np.searchsorted(sums[size], sums[size - 1])
        if (sums[size].take(places, mode="clip") == sums[size - 1]).any():
            return 2 * size - 1
        if (sums[size][1:] == sums[size][:-1]).any():
            return 2 * size
    least = max(2, 2 * depth + 1)
    # A polynomial with an even number of terms detects any odd number of flipped bits.
    return least + least % 2 if (checksum.polynomial.bit_count() + 1) % 2 == 0 else least


def _add_all(syndromes: Words, size: int) -> Words:
    """All sums of `size` different syndromes."""
    if size == 1:
        return syndromes
    return np.concatenate([_add_all(syndromes[place + 1 :], size - 1) ^ one for place, one in enumerate(syndromes[: 1 - size])])
