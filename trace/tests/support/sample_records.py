# SPDX-License-Identifier: Apache-2.0
"""Records of an instruction count and of a timing run, in the form of the tools."""

from __future__ import annotations

from typing import Any

from trace_sample import ENVIRONMENT

COST: dict[str, Any] = {
    "schema": "mamori.cost/1", "system": "safe_arm", "exit_status": 0, "marks": [], "assumption": "no model of caches",
    "margin_percent": 50.0, "growth_percent": 2.0, "build": {"compiler": "GNU 12.2.0", "flags": "-O2", "c_library": "glibc 2.36"},
    "environment": ENVIRONMENT,
    "classes": [{"name": "still", "cycles": 400, "first": 0, "every": 2, "step_count": 1200, "notes": ["the arm ended in state Operational"]}],
    "pace": {"ns_per_instruction": 1.7204, "component": "channel", "least_ns": 0.22, "reference_ns": 0.257, "reference_instructions": 32_776},
    "ratios": [{"component": "channel", "openings": 625, "median_ns": 1.7204, "p99_ns": 3.715}],
    "steps": [
        {"input_class": name, "component": component, "window": "protect", "pass_name": "execute",
         "instructions": {"count": 200, "min": 539, "median": 545, "max": most, "cycle": 152}, "time_ns": 937.4}
        for name, most in (("still", 551), ("motion", 552)) for component in ("arm_reader", "channel")],
    "limits": [{"what": "window", "name": "protect", "limit_ns": 250_000, "input_class": "still", "cycle": 7, "instructions": 4961,
                "heaviest": "safety_supervisor", "time_ns": 8534.9, "needed_ns": 12_802.4, "left_ns": 237_197.6, "is_kept": True}],
    "findings": [],
}  # fmt: skip
TIMES = {"count": 1987, "min": 400, "p50": 15_765, "p99": 31_135, "p999": 609_263, "max": 8_656_241}
STATE = {"load_1_min": 0.84, "frequency_khz": None, "ticks": 1, "steal_ticks": 0}
TIMING: dict[str, Any] = {
    "schema": "mamori.timing/1", "system": "safe_arm", "exit_status": 0, "marks": [], "is_partial": False,
    "cycles": {"asked": 2000, "run": 2000}, "frame_ns": 1_000_000, "reference_ns": 8513, "with_load": False,
    "rights": {"priority": {"is_granted": True, "errno": 0}, "memory": {"is_granted": True, "errno": 0}},
    "environment": ENVIRONMENT,
    "host": {
        "setting": {"kernel": "6.18", "kernel_version": "#1 SMP", "preemption": "PREEMPT_RT", "governor": "performance",
                    "clock_source": "tsc", "virtual_machine": False, "isolated_cores": "1"},
        "before": STATE, "after": STATE | {"frequency_khz": 2_400_000}, "steal_share": 0.0012,
    },
    "findings": [], "notes": ["the program: the arm ended in state Safe"],
    "windows": [{
        "window": "protect", "core": 0, "offset_ns": 0, "length_ns": 300_000, "period_ns": 1_000_000, "budget_ns": 250_000,
        "outcomes": {"completed": 1987, "overrun": 2, "missed": 11}, "lateness": TIMES, "response": TIMES, "used_max_ns": 103_000,
        "budget_margin_ns": 147_000, "length_margin_ns": -776_600,
    }],
    "components": [
        {"component": "arm_reader", "window": "protect", "declared_ns": 5_000, "execution": TIMES, "margin_ns": 874, "unfinished": 0,
         "extreme_values": {"refusal": "the openings are not independent", "quantiles": [], "tests": []}},
        {"component": "drive_gate", "window": "act", "declared_ns": None, "execution": None, "margin_ns": None, "unfinished": 0,
         "extreme_values": {"refusal": None, "quantiles": [{"exceeded_with": 1e-6, "value_ns": 4321.9}], "tests": []}},
    ],
    "ratios": [{"component": "arm_reader", "ratio": 0.015270762}],
    "chains": [{"name": "arm_reader > drive_gate", "virtual": {"min_ns": 800_000, "max_ns": 900_000, "reaction_max_ns": 1_900_000},
                "measured": None, "broken": 3, "violation_count": 0}],
    "chain_note": "feedback is not followed: channel > joint_monitor", "miss_count": 13,
    "misses": [{"cycle": 4000 + number, "window": "protect", "outcome": "missed", "component": None, "late_ns": 323_773,
                "reason": "released after its planned close", "is_host": True} for number in range(12)]
    + [{"cycle": 5000, "window": "protect", "outcome": "overrun", "component": "arm_reader", "late_ns": 1000, "reason": "came back late",
        "is_host": False}],
}  # fmt: skip
