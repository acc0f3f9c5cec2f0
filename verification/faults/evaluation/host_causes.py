# SPDX-License-Identifier: Apache-2.0
"""Host causes of a run: processor time that the host took from the windows."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class HostFigures:
    """Sums over one run, measured by `StallWatch`."""

    stalls: int = 0
    longest_stall_ns: int = 0
    lost_ns: int = 0
    late_polls: int = 0
    run_delay_ns: int = 0
    steal_ms: int = 0
    involuntary_switches: int = 0

    def to_text(self) -> str:
        return (
            f"{self.stalls} stalls, longest {self.longest_stall_ns // 1000} us, lost {self.lost_ns // 1000} us in {self.late_polls} late polls, "
            f"run delay {self.run_delay_ns // 1000} us, steal {self.steal_ms} ms, {self.involuntary_switches} involuntary switches"
        )


class Spans:
    """Intervals in the order of their ends [ns]."""

    def __init__(self, begins: Sequence[int] = (), ends: Sequence[int] = ()) -> None:
        self.begins = begins
        self.ends = ends

    def __len__(self) -> int:
        return len(self.ends)

    def merge(self, other: Spans) -> Spans:
        """@return the intervals of both objects."""
        pairs = sorted(zip((*self.ends, *other.ends), (*self.begins, *other.begins), strict=True), key=lambda pair: pair[0])
        return Spans([begin for _, begin in pairs], [end for end, _ in pairs])

    def overlaps(self, begin: int, end: int) -> bool:
        """Whether an interval has an instant in common with `begin` to `end` (both included)."""
        first = bisect_left(self.ends, begin)
        return first < len(self.ends) and self.begins[first] <= end

    def calc_loss(self, begin: int, end: int) -> int:
        """Total length of the intervals between `begin` and `end` [ns]."""
        return sum(self._list_parts(begin, end))

    def calc_longest_loss(self, begin: int, end: int) -> int:
        """Length of the longest of these intervals [ns]."""
        return max(self._list_parts(begin, end), default=0)

    def _list_parts(self, begin: int, end: int) -> Iterator[int]:
        for index in range(bisect_left(self.ends, begin), len(self.ends)):
            if self.begins[index] >= end:
                return
            yield min(self.ends[index], end) - max(self.begins[index], begin)
