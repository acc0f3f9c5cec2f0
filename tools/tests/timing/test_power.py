# SPDX-License-Identifier: Apache-2.0
# Goal: the record states the settings of the host that delay threads, and advice for the unfavourable ones only. Method: folders that are made
# as Linux shows them, with values on both sides of each limit, and with files that are missing or contain no number.
from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mamori_tools.timing.environment import collect_setting, collect_state
from mamori_tools.timing.power import IDLE_EXIT_MAX_US, NOT_KNOWN, Roots, collect_power, describe_power


@pytest.fixture
def roots(tmp_path: Path) -> Roots:
    roots = Roots(tmp_path / "sys", tmp_path / "proc", tmp_path / "dev")
    for folder in (roots.processors, roots.proc / "sys" / "kernel", roots.dev):
        folder.mkdir(parents=True)
    return roots


def put(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text + "\n", encoding="utf-8")


def put_state(roots: Roots, processor: int, number: int, name: str, latency: object, disable: str = "0") -> None:
    folder = roots.processors / f"cpu{processor}" / "cpuidle" / f"state{number}"
    for file, text in (("name", name), ("latency", str(latency)), ("disable", disable)):
        put(folder / file, text)


def put_throttling(roots: Roots, runtime: object, period: object) -> None:
    for name, value in (("runtime", runtime), ("period", period)):
        put(roots.proc / "sys" / "kernel" / f"sched_rt_{name}_us", str(value))


def put_latency_limit(roots: Roots, limit_us: int) -> None:
    (roots.dev / "cpu_dma_latency").write_bytes(limit_us.to_bytes(4, "little", signed=True))


@pytest.mark.verifies("SWR-TIM-062", technique="boundary_values")
def test_system_that_states_nothing_is_not_known_and_gets_no_advice(roots: Roots) -> None:
    assert collect_power(roots) == {"governor": NOT_KNOWN, "turbo": NOT_KNOWN, "idle_state": NOT_KNOWN, "cpu_dma_latency_us": NOT_KNOWN,
                                    "rt_throttling": NOT_KNOWN, "advice": []}  # fmt: skip


@pytest.mark.verifies("SWR-TIM-062")
def test_favourable_settings_get_no_advice(roots: Roots) -> None:
    put_state(roots, 0, 0, "POLL", 0)
    put_state(roots, 0, 1, "C1", IDLE_EXIT_MAX_US)
    put_state(roots, 0, 2, "C6", IDLE_EXIT_MAX_US + 1, disable="1")
    put_throttling(roots, -1, 1_000_000)
    put(roots.processors / "cpu0/cpufreq/scaling_governor", "performance")
    put(roots.processors / "intel_pstate/no_turbo", "1")
    put_latency_limit(roots, 2_000_000_000)

    assert collect_power(roots) == {
        "governor": "performance", "turbo": "off", "idle_state": {"name": "C1", "exit_latency_us": IDLE_EXIT_MAX_US},
        "cpu_dma_latency_us": 2_000_000_000, "rt_throttling": {"runtime_us": -1, "period_us": 1_000_000, "is_on": False}, "advice": [],
    }  # fmt: skip


@pytest.mark.verifies("SWR-TIM-062")
def test_each_unfavourable_setting_gets_one_advice(roots: Roots) -> None:
    put_state(roots, 0, 1, "C1", 1)
    put_state(roots, 3, 2, "C6", IDLE_EXIT_MAX_US + 1)
    put_throttling(roots, 950_000, 1_000_000)
    put(roots.processors / "cpu0/cpufreq/scaling_governor", "performance")
    put(roots.processors / "cpu12/cpufreq/scaling_governor", "powersave")
    put(roots.processors / "cpufreq/boost", "1")

    power: Any = collect_power(roots)
    assert power["idle_state"] == {"name": "C6", "exit_latency_us": IDLE_EXIT_MAX_US + 1}, "on any processor"
    assert power["governor"] == "performance, powersave"
    assert (power["turbo"], power["rt_throttling"]["is_on"]) == ("on", True)
    idle, throttling, governor, turbo = power["advice"]
    assert "11 us to leave idle state C6" in idle
    assert "950000 of 1000000 us" in throttling
    assert governor.endswith("cpupower frequency-set -g performance")
    assert turbo.endswith(f"write 0 to {roots.processors / 'cpufreq/boost'}")


@pytest.mark.verifies("SWR-TIM-062", technique="equivalence_classes")
def test_turbo_of_intel_is_on_when_it_is_not_forbidden(roots: Roots) -> None:
    put(roots.processors / "intel_pstate/no_turbo", "0")

    power: Any = collect_power(roots)
    assert power["turbo"] == "on"
    assert power["advice"][0].endswith(f"write 1 to {roots.processors / 'intel_pstate/no_turbo'}")


@pytest.mark.verifies("SWR-TIM-062", technique="boundary_values")
@pytest.mark.parametrize(("limit_us", "name"), [(132, "C1"), (133, "C6"), (1, "POLL"), (0, "POLL")])
def test_state_deeper_than_a_requested_latency_is_not_used(roots: Roots, limit_us: int, name: str) -> None:
    for number, (state, latency) in enumerate((("POLL", 0), ("C1", 2), ("C6", 133))):
        put_state(roots, 0, number, state, latency)
    put_latency_limit(roots, limit_us)

    power: Any = collect_power(roots)
    assert power["idle_state"]["name"] == name
    assert power["cpu_dma_latency_us"] == limit_us


@pytest.mark.verifies("SWR-TIM-062", technique="boundary_values")
@pytest.mark.parametrize(
    ("runtime", "period", "is_on"), [(0, 1, True), (999_999, 1_000_000, True), (1_000_000, 1_000_000, False), (-1, 1_000_000, False)]
)
def test_throttling_is_on_when_less_than_the_period_may_be_used(roots: Roots, runtime: int, period: int, is_on: bool) -> None:
    put_throttling(roots, runtime, period)

    power: Any = collect_power(roots)
    assert power["rt_throttling"] == {"runtime_us": runtime, "period_us": period, "is_on": is_on}
    assert len(power["advice"]) == is_on


@pytest.mark.verifies("SWR-TIM-062", technique="fault_injection")
def test_files_without_a_number_are_not_known(roots: Roots) -> None:
    put_state(roots, 0, 0, "C1", "fast")
    put_throttling(roots, "all", 1_000_000)
    put(roots.processors / "cpufreq/boost", "")
    put(roots.processors / "cpu0/cpufreq/scaling_governor", "")
    (roots.dev / "cpu_dma_latency").write_bytes(b"\x00\x00\x00")

    assert set(map(str, collect_power(roots).values())) == {NOT_KNOWN, "[]"}


@pytest.mark.verifies("SWR-TIM-019", technique="interface")
def test_setting_and_state_are_read_below_the_given_folders(roots: Roots) -> None:
    put(roots.proc / "cpuinfo", "flags : fpu hypervisor")
    put(roots.proc / "stat", "cpu  1 0 2 3 0 0 0 4 0 0")
    put(roots.processors / "isolated", "2-3")
    put(roots.processors / "cpu0/cpufreq/scaling_cur_freq", "1800000")
    put(roots.sys / "devices/system/clocksource/clocksource0/current_clocksource", "tsc")

    setting, state = collect_setting(roots), collect_state(roots)
    assert (setting["virtual_machine"], setting["isolated_cores"], setting["clock_source"]) == (True, "2-3", "tsc")
    assert (state["frequency_khz"], state["ticks"], state["steal_ticks"]) == (1_800_000, 10, 4)


@pytest.mark.verifies("SWR-TIM-062", technique="interface")
@pytest.mark.parametrize(
    ("changes", "line"),
    [({"idle_state": NOT_KNOWN, "rt_throttling": NOT_KNOWN, "turbo": NOT_KNOWN},
      "processor: deepest idle state not known, RT throttling not known, turbo not known"),
     ({"idle_state": {"name": "C6", "exit_latency_us": 133}, "rt_throttling": {"runtime_us": 95, "period_us": 100, "is_on": True}, "turbo": "on"},
      "processor: deepest idle state C6 (133 us to leave), RT throttling 95 of 100 us, turbo on"),
     ({"idle_state": NOT_KNOWN, "rt_throttling": {"runtime_us": -1, "period_us": 100, "is_on": False}, "turbo": "off"},
      "processor: deepest idle state not known, RT throttling off, turbo off")],
)  # fmt: skip
def test_text_shows_settings_and_advice(changes: dict[str, object], line: str) -> None:
    assert describe_power({**changes, "advice": ["do this", "do that"]}) == [line, "advice: do this", "advice: do that"]
