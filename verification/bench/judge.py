# SPDX-License-Identifier: Apache-2.0
"""Compares samples with the acceptance limits: each limit with the median of its per-round ratios, never with a time.

@satisfies SWR-BEN-001, SWR-BEN-002, SWR-BEN-003      Design: docs/design/bench.md#bars
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from verification.bench.bars import Bars, GrowthBar
from verification.bench.samples import Samples, Series

ROUNDS_MIN = 5
"""With fewer rounds, the median is too uncertain for a verdict."""

PASSED, FAILED, ABSENT = "passed", "failed", "not available"


@dataclass(frozen=True)
class RatioResult:
    """One limit at one size. If `ratio` is None, `note` states why."""

    id: str
    title: str
    metric: str
    size: int
    ours: str
    against: str
    limit: float
    kind: str
    verdict: str
    ratio: float | None = None
    lowest: float | None = None  # of all rounds
    highest: float | None = None
    ours_ns: float | None = None
    against_ns: float | None = None
    note: str = ""


FLOORS = ("seqlock", "hand-written exchange", "CRC-32 frame", "virtual call", "virtual call + clock", "padded Lamport ring")


def judge(samples: Samples, bars: Bars, floors: Sequence[str] = FLOORS) -> list[RatioResult]:
    """@param floors subjects that are part of the program: a missing one is a failure.
    @return one result for each limit and size whose metric was measured.
    """
    measured = {metric for metric, _ in samples.cases}
    results = []
    for bar in bars.ratios:
        for size, limit in bar.limits.items() if bar.metric in measured else ():
            ours = _find(samples, bar.metric, size, bar.ours)
            against = _find(samples, bar.metric, size, bar.against)
            base = RatioResult(bar.id, bar.title, bar.metric, size, bar.ours, bar.against, limit, bar.kind, ABSENT)
            has_reason = bar.kind == "advisory" and bar.ours in samples.absent  # a privilege that the host does not grant
            missing_fails = bar.against in floors or (ours is None and not has_reason)
            results.append(_compare(base, ours, against, samples, missing_fails))
    for growth in bars.growths:
        if growth.metric in measured:
            ours = _find(samples, growth.metric, growth.to_size, growth.ours)
            before = _find(samples, growth.metric, growth.from_size, growth.ours)
            base = RatioResult(growth.id, growth.title, growth.metric, growth.to_size, growth.ours,
                               f"itself at {growth.from_size}", growth.limit, growth.kind, ABSENT,
                               note=_describe_floor(samples, growth))  # fmt: skip
            results.append(_compare(base, ours, before, samples, missing_fails=True))
    return results


def list_failed_gates(results: Sequence[RatioResult]) -> list[RatioResult]:
    return [result for result in results if result.kind == "gate" and result.verdict == FAILED]


def _describe_floor(samples: Samples, growth: GrowthBar) -> str:
    """Growth of the lower bound in the same run. No program with the same calls can grow less on this host."""
    floor = _find(samples, growth.metric, growth.to_size, growth.floor)
    before = _find(samples, growth.metric, growth.from_size, growth.floor)
    if floor is None or before is None:
        return ""
    return f"{growth.floor} itself: {median(_form_ratios(floor, before)):.2f}"


def _form_ratios(ours: Series, against: Series) -> list[float]:
    return [mine / theirs for mine, theirs in zip(ours.rounds_ns, against.rounds_ns, strict=True)]


def _find(samples: Samples, metric: str, size: int, name: str) -> Series | None:
    case = samples.cases.get((metric, size))
    return case.series.get(name) if case else None


def _compare(base: RatioResult, ours: Series | None, against: Series | None, samples: Samples, missing_fails: bool
             ) -> RatioResult:  # fmt: skip
    fields = dict(vars(base))
    if ours is None or against is None:
        name = base.ours if ours is None else base.against
        fields["note"] = samples.absent.get(name, "was not measured")
        fields["verdict"] = FAILED if missing_fails else ABSENT
        return RatioResult(**fields)
    ratios = _form_ratios(ours, against)
    ratio = median(ratios)
    fields.update(ratio=ratio, lowest=min(ratios), highest=max(ratios), ours_ns=ours.p50_ns, against_ns=against.p50_ns,
                  verdict=PASSED if ratio <= base.limit else FAILED)  # fmt: skip
    if len(ratios) < ROUNDS_MIN:
        fields.update(verdict=FAILED, note=f"{len(ratios)} rounds are too few, at least {ROUNDS_MIN} are needed")
    return RatioResult(**fields)
