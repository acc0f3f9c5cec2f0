# SPDX-License-Identifier: Apache-2.0
"""Properties and load of the host during a run, as far as available. Times are meaningless without them.

@satisfies SWR-TIM-019      Design: docs/design/timing.md#environment
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

CPUS = Path("/sys/devices/system/cpu")
UNKNOWN = "unknown"


@dataclass(frozen=True)
class Ticks:
    """Ticks of all processors since boot; `steal`: ticks in which another virtual machine had the processor."""

    total: int
    steal: int


def collect_setting() -> dict[str, object]:
    """Settings of the host that do not change during a run."""
    return {
        "kernel": platform.release(),
        "kernel_version": platform.version(),
        "preemption": find_preemption(platform.version(), _read(Path("/sys/kernel/realtime"))),
        "governor": _read(CPUS / "cpu0/cpufreq/scaling_governor") or UNKNOWN,
        "clock_source": _read(Path("/sys/devices/system/clocksource/clocksource0/current_clocksource")) or UNKNOWN,
        "virtual_machine": "hypervisor" in _read(Path("/proc/cpuinfo")),
        "isolated_cores": _read(CPUS / "isolated"),
    }


def collect_state() -> dict[str, object]:
    """Current load of the host."""
    ticks = read_ticks(_read(Path("/proc/stat")))
    frequency = _read(CPUS / "cpu0/cpufreq/scaling_cur_freq")
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
    return "PREEMPT_RT" if realtime == "1" else "none told"


def read_ticks(stat: str) -> Ticks:
    """@param stat content of /proc/stat. User times already include guest times, so the first eight fields are sufficient."""
    words = stat.partition("\n")[0].split()
    numbers = [int(word) for word in words[1:9]] if words[:1] == ["cpu"] else []
    return Ticks(sum(numbers), numbers[7] if len(numbers) > 7 else 0)


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError):
        return ""
