# SPDX-License-Identifier: Apache-2.0
"""Properties and load of the host during a run, as far as available. Times are meaningless without them.

@satisfies SWR-TIM-019      Design: docs/design/timing.md#environment
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from dataclasses import dataclass

from mamori_tools.timing.power import NOT_KNOWN, Roots, collect_power, read_text


@dataclass(frozen=True)
class Ticks:
    """Ticks of all processors since boot; `steal`: ticks in which another virtual machine had the processor."""

    total: int
    steal: int


def collect_setting(roots: Roots | None = None) -> dict[str, object]:
    """Settings of the host that do not change during a run."""
    roots = roots or Roots()
    return {
        "kernel": platform.release(),
        "kernel_version": platform.version(),
        "preemption": find_preemption(platform.version(), read_text(roots.sys / "kernel" / "realtime")),
        "clock_source": read_text(roots.sys / "devices/system/clocksource/clocksource0/current_clocksource") or NOT_KNOWN,
        "virtual_machine": "hypervisor" in read_text(roots.proc / "cpuinfo"),
        "isolated_cores": read_text(roots.processors / "isolated"),
        **collect_power(roots),
    }


def collect_state(roots: Roots | None = None) -> dict[str, object]:
    """Current load of the host."""
    roots = roots or Roots()
    ticks = read_ticks(read_text(roots.proc / "stat"))
    frequency = read_text(roots.processors / "cpu0/cpufreq/scaling_cur_freq")
    return {
        "load_1_min": round(os.getloadavg()[0], 2),
        "frequency_khz": int(frequency) if frequency.isdecimal() else None,
        "ticks": ticks.total,
        "steal_ticks": ticks.steal,
    }


def calc_steal_share(before: Mapping[str, object], after: Mapping[str, object]) -> float:
    """@param before added to results of collect_state(). @return share of all processor time that other virtual machines used, 0 .. 1."""
    total, steal = (int(str(after[key])) - int(str(before[key])) for key in ("ticks", "steal_ticks"))
    return steal / total if total > 0 else 0.0


def find_preemption(version: str, realtime: str) -> str:
    """@param version output of `uname -v`. @param realtime content of /sys/kernel/realtime, which only real-time kernels have."""
    words = version.replace("-", "_").split()
    for mode in ("PREEMPT_RT", "PREEMPT_DYNAMIC", "PREEMPT"):
        if mode in words:
            return "PREEMPT_RT" if realtime == "1" else mode
    return "PREEMPT_RT" if realtime == "1" else "not known"


def read_ticks(stat: str) -> Ticks:
    """@param stat content of /proc/stat. User times already include guest times, so the first eight fields are sufficient."""
    words = stat.partition("\n")[0].split()
    numbers = [int(word) for word in words[1:9]] if words[:1] == ["cpu"] else []
    return Ticks(sum(numbers), numbers[7] if len(numbers) > 7 else 0)
