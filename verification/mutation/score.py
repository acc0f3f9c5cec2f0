# SPDX-License-Identifier: Apache-2.0
"""Calculates a score from verdicts, and compares the score with its limit.

@satisfies SWR-VER-005, SWR-VER-006      Design: docs/design/test_strength.md#score
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from verification.mutation.sources import ALL_LAYERS, Layer, get_layer
from verification.mutation.trial import EQUIVALENT, INVALID, KILLED, SURVIVED, Result

DOUBT = 0.05  # a sample contradicts the limit if a layer exactly at the limit yields such a sample with a probability below this
NORMAL_975 = 1.959964  # two-sided 95 % of the normal distribution
LISTED = "listed as equivalent"


@dataclass
class Counts:
    """Verdicts of the mutants of one file, or of all."""

    killed: int = 0
    survived: int = 0
    listed: int = 0
    same_code: int = 0
    invalid: int = 0

    @property
    def valid(self) -> int:
        """Mutants that a test could distinguish from the original."""
        return self.killed + self.survived

    @property
    def tried(self) -> int:
        return self.valid + self.listed + self.same_code + self.invalid

    @property
    def score(self) -> float:
        """Share of the valid mutants that were killed; 1 if there was none."""
        return self.killed / self.valid if self.valid else 1.0

    def add(self, verdict: str) -> None:
        name = {KILLED: "killed", SURVIVED: "survived", LISTED: "listed", EQUIVALENT: "same_code", INVALID: "invalid"}[verdict]
        setattr(self, name, getattr(self, name) + 1)

    def __add__(self, other: Counts) -> Counts:
        return Counts(self.killed + other.killed, self.survived + other.survived, self.listed + other.listed,
                      self.same_code + other.same_code, self.invalid + other.invalid)  # fmt: skip


def count(results: Iterable[Result]) -> dict[str, Counts]:
    """Counts per file, by name."""
    files: dict[str, Counts] = {}
    for result in sorted(results, key=lambda result: result.mutant):
        files.setdefault(result.mutant.file, Counts()).add(result.verdict)
    return files


def add_up(files: dict[str, Counts]) -> Counts:
    return sum(files.values(), Counts())


def add_up_layers(files: dict[str, Counts]) -> dict[Layer, Counts]:
    """The sum of each layer that has files, in the order of ALL_LAYERS."""
    sums = {layer: {file: counts for file, counts in files.items() if get_layer(file) == layer} for layer in ALL_LAYERS}
    return {layer: add_up(own) for layer, own in sums.items() if own}


def is_met(counts: Counts, bar: float, is_sample: bool) -> bool:
    """A complete run must reach the limit. A sample may miss the limit by chance: it fails if a layer exactly at the limit yields at least
    as many survivors with a probability below DOUBT."""
    if not is_sample:
        return counts.score >= bar
    return calc_chance(counts.survived, counts.valid, bar) >= DOUBT


def calc_chance(survived: int, valid: int, bar: float) -> float:
    """Probability of at least `survived` survivors among `valid` mutants if each survives with probability 1 - `bar`."""
    return math.fsum(math.comb(valid, k) * (1.0 - bar) ** k * bar ** (valid - k) for k in range(survived, valid + 1))


def calc_interval(killed: int, valid: int) -> tuple[float, float]:
    """Wilson's 95 % interval of the share of mutants that the tests kill, calculated from a sample. Source: E. B. Wilson, Probable
    inference, the law of succession, and statistical inference, J. Am. Stat. Assoc. 22 (1927). The interval is [0, 1] without mutants."""
    if valid == 0:
        return 0.0, 1.0
    share, spread = killed / valid, NORMAL_975**2 / valid
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = math.sqrt(spread * share * (1.0 - share) + spread**2 / 4.0) / (1.0 + spread)
    return max(0.0, middle - half), min(1.0, middle + half)
