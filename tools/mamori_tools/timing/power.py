# SPDX-License-Identifier: Apache-2.0
"""Settings of processors and scheduler that delay real-time threads, with advice if they are unfavourable.

@satisfies SWR-TIM-062      Design: docs/design/timing.md#environment
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

NOT_KNOWN = "not known"
IDLE_EXIT_MAX_US = 10
"""Exit latency of an idle state above which there is advice: 1 % of a major frame of 1 ms."""


@dataclass(frozen=True)
class Roots:
    """Folders in which the system states its settings."""

    sys: Path = Path("/sys")
    proc: Path = Path("/proc")
    dev: Path = Path("/dev")

    @property
    def processors(self) -> Path:
        return self.sys / "devices" / "system" / "cpu"


@dataclass(frozen=True)
class IdleState:
    """An idle state of a processor (C-state)."""

    name: str
    exit_latency_us: int


@dataclass(frozen=True)
class Throttling:
    """Threads with a fixed priority may use `runtime_us` of each `period_us`; a negative value means all."""

    runtime_us: int
    period_us: int

    @property
    def is_on(self) -> bool:
        return 0 <= self.runtime_us < self.period_us


def collect_power(roots: Roots) -> dict[str, object]:
    """Settings as rows of the record, each "not known" if the system does not state it, and one advice for each unfavourable setting."""
    limit_us, governor, turbo = find_latency_limit(roots), find_governor(roots), find_turbo(roots)
    idle, throttling = find_idle_state(roots, limit_us), find_throttling(roots)
    advice = [_advise_idle(idle), _advise_throttling(throttling), _advise_governor(governor), _advise_turbo(turbo, roots)]
    return {
        "governor": governor,
        "turbo": turbo,
        "idle_state": asdict(idle) if idle else NOT_KNOWN,
        "cpu_dma_latency_us": NOT_KNOWN if limit_us is None else limit_us,
        "rt_throttling": {**asdict(throttling), "is_on": throttling.is_on} if throttling else NOT_KNOWN,
        "advice": [sentence for sentence in advice if sentence],
    }


def describe_power(setting: Mapping[str, Any]) -> list[str]:
    """@param setting result of collect_power(), also as read from a record. @return lines of the report."""
    idle, throttling = setting["idle_state"], setting["rt_throttling"]
    state = idle if idle == NOT_KNOWN else f"{idle['name']} ({idle['exit_latency_us']} us to leave)"
    if throttling != NOT_KNOWN:
        throttling = f"{throttling['runtime_us']} of {throttling['period_us']} us" if throttling["is_on"] else "off"
    return [f"processor: deepest idle state {state}, RT throttling {throttling}, turbo {setting['turbo']}",
            *(f"advice: {sentence}" for sentence in setting["advice"])]  # fmt: skip


def find_idle_state(roots: Roots, limit_us: int | None) -> IdleState | None:
    """@param limit_us latency that a program has requested; deeper states are not used. None: none known.
    @return the deepest state that is enabled on any processor; None if no state is known."""
    states = []
    for folder in roots.processors.glob("cpu[0-9]*/cpuidle/state[0-9]*"):
        latency_us = read_number(folder / "latency")
        is_possible = latency_us is not None and (limit_us is None or latency_us <= limit_us)
        if latency_us is not None and is_possible and read_text(folder / "disable") != "1":
            states.append(IdleState(read_text(folder / "name") or NOT_KNOWN, latency_us))
    return max(states, key=lambda state: (state.exit_latency_us, state.name), default=None)


def find_latency_limit(roots: Roots) -> int | None:
    """Minimum latency that programs have requested by /dev/cpu_dma_latency [us], for root only; about 2000 s without a request."""
    try:
        content = (roots.dev / "cpu_dma_latency").read_bytes()
    except OSError:
        return None
    return int.from_bytes(content, "little", signed=True) if len(content) == 4 else None


def find_throttling(roots: Roots) -> Throttling | None:
    runtime_us, period_us = (read_number(roots.proc / "sys" / "kernel" / f"sched_rt_{name}_us") for name in ("runtime", "period"))
    return None if runtime_us is None or period_us is None else Throttling(runtime_us, period_us)


def find_governor(roots: Roots) -> str:
    """The governors of all processors, each once."""
    names = {read_text(file) for file in roots.processors.glob("cpu[0-9]*/cpufreq/scaling_governor")} - {""}
    return ", ".join(sorted(names)) or NOT_KNOWN


def find_turbo(roots: Roots) -> str:
    """@return "on", "off" or "not known"."""
    for file, value_on in _list_turbo_files(roots):
        if (value := read_number(file)) is not None:
            return "on" if value == value_on else "off"
    return NOT_KNOWN


def read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError):
        return ""


def read_number(path: Path) -> int | None:
    try:
        return int(read_text(path))
    except ValueError:
        return None


def _list_turbo_files(roots: Roots) -> list[tuple[Path, int]]:
    return [(roots.processors / "intel_pstate" / "no_turbo", 0), (roots.processors / "cpufreq" / "boost", 1)]


def _advise_idle(state: IdleState | None) -> str:
    if state is None or state.exit_latency_us <= IDLE_EXIT_MAX_US:
        return ""
    return (f"a processor needs {state.exit_latency_us} us to leave idle state {state.name}: disable deep states (cpupower idle-set -D "
            f"{IDLE_EXIT_MAX_US}), or hold /dev/cpu_dma_latency open with the value 0 during the run")  # fmt: skip


def _advise_throttling(throttling: Throttling | None) -> str:
    if throttling is None or not throttling.is_on:
        return ""
    return (f"the kernel stops threads with a fixed priority when they have used {throttling.runtime_us} of {throttling.period_us} us: set "
            "kernel.sched_rt_runtime_us to -1 (sysctl) if windows and watches need more")  # fmt: skip


def _advise_governor(governor: str) -> str:
    if governor in (NOT_KNOWN, "performance"):
        return ""
    return f"governor {governor} changes the frequency with the load: cpupower frequency-set -g performance"


def _advise_turbo(turbo: str, roots: Roots) -> str:
    if turbo != "on":
        return ""
    file, value_on = next((file, value) for file, value in _list_turbo_files(roots) if read_number(file) is not None)
    return f"turbo changes the frequency with load and temperature: write {1 - value_on} to {file}"
