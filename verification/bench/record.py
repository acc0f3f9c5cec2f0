# SPDX-License-Identifier: Apache-2.0
"""bench.json: all figures of a run with their origin.

@satisfies SWR-BEN-004      Design: docs/design/bench.md#record
"""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from mamori_trace.base.text_file import write_text
from verification.bench.baseline import CountResult
from verification.bench.judge import FAILED, PASSED, RatioResult, list_failed_gates
from verification.bench.programs import Effort
from verification.bench.samples import Samples

SCHEMA = "mamori.bench/1"


@dataclass(frozen=True)
class Run:
    """Results of one call of `./mamori bench`. `proofs`: operation -> its forbidden actions; empty if there are none."""

    samples: Samples | None = None
    ratios: Sequence[RatioResult] = ()
    counts: Sequence[CountResult] = ()
    proofs: dict[str, str] = field(default_factory=dict)

    @property
    def gate_count(self) -> int:
        """Gates that have a verdict."""
        ratios = [one for one in self.ratios if one.kind == "gate" and one.verdict in (PASSED, FAILED)]
        return len(ratios) + len(self.counts) + len(self.proofs)

    @property
    def failed(self) -> list[str]:
        """One line per gate that failed."""
        ratios = [f"{one.id} {one.title} {one.size} / {one.against}" for one in list_failed_gates(self.ratios)]
        counts = [f"{one.id} {one.title}" for one in self.counts if one.verdict == FAILED]
        proofs = [f"{name}: {text}" for name, text in self.proofs.items() if text]
        return [*ratios, *counts, *proofs]


def collect_host() -> dict[str, object]:
    """Settings and load of the host, as far as the host provides them."""
    return {
        "kernel": f"{platform.release()} {platform.version()}",
        "governor": _read("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor") or "unknown",
        "clock_source": _read("/sys/devices/system/clocksource/clocksource0/current_clocksource") or "unknown",
        "virtual_machine": "hypervisor" in _read("/proc/cpuinfo"),
        "load_1_min": round(os.getloadavg()[0], 2),
        "steal_ticks": _get_steal(),
    }


def _read(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8").strip()
    except OSError:
        return ""


def _get_steal() -> int:
    """Ticks since boot in which another virtual machine used the processor."""
    words = _read("/proc/stat").partition("\n")[0].split()
    return int(words[8]) if len(words) > 8 else 0


def make_record(run: Run, environment: dict[str, object], before: dict[str, object], after: dict[str, object], effort: Effort
                ) -> dict[str, Any]:  # fmt: skip
    """The document that write_record() writes."""
    samples = run.samples
    return {
        "schema": SCHEMA,
        "environment": environment,
        "host": {"before": before, "after": after},
        "effort": asdict(effort),
        "compiler": samples.compiler if samples else None,
        "flags": samples.flags if samples else None,
        "absent": samples.absent if samples else {},
        "ratios": [asdict(one) for one in run.ratios],
        "counts": [asdict(one) for one in run.counts],
        "proofs": run.proofs,
        "failed_gates": run.failed,
        "cases": [
            {"metric": case.metric, "size": case.size, "unit": case.unit,
             "subjects": [{"name": one.name, "p50_ns": one.p50_ns, "rounds_ns": list(one.rounds_ns)} for one in
                          case.series.values()]}
            for case in (samples.cases.values() if samples else ())
        ],
    }  # fmt: skip


def write_record(record: dict[str, Any], folder: Path) -> Path:
    """Writes the record atomically. @return its path."""
    path = folder / "bench.json"
    write_text(path, json.dumps(record, indent=1) + "\n")
    return path
