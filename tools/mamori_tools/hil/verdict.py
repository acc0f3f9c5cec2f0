# SPDX-License-Identifier: Apache-2.0
"""The verdict on one run: the checks of the campaign on the record of the plant, checks on links and closed outputs, and the figure of the host.

@satisfies SWR-HIL-011, SWR-HIL-012, SWR-HIL-013      Design: docs/design/safe_arm.md#hardware-in-the-loop
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_tools.campaign.arm.judge import ROUNDING_S, judge
from mamori_tools.campaign.arm.run_record import load_run
from mamori_tools.campaign.case import Check, Verdict, conclude
from mamori_tools.hil.processes import RunFacts
from mamori_tools.hil.scenario import MESSAGE_FAULT, HilCase
from mamori_trace.base.errors import WorkError

LATENESS_MAX_S = 0.0003
"""Lateness of a window that the kernel tolerates (hil_system.hpp) [s]."""
STEAL_MAX_S = 0.02
"""Processor time taken by the hypervisor during a run that counts as a disturbance [s]."""
GAP_MAX_S = 0.0025
"""Two messages that are lost in a row are tolerated; a longer gap can stop the arm [s]."""
SILENCE_MAX_S = 0.005
"""kDriveSilenceMax: the plant closes after this time without a message [s]."""
CLOCK_S = 0.001
"""The plant observes the end of its time-out within one frame [s]."""

RECEIVERS = {"command": ("kernel", "command"), "device": ("kernel", "device"), "drive": ("plant", "drive"), "state": ("controller", "state")}
"""Link -> file and key with the counters of its receiver."""
CHANNELS = {"command": "ARM_COMMAND", "device": "ARM_DEVICES", "drive": "ARM_DRIVES", "state": "ARM_STATE"}
SIGNS = {"corruption": ("damaged", "foreign"), "repetition": ("unordered",), "sequence": ("unordered",), "loss": ("lost",), "delay": (),
         "insertion": ("damaged",), "masquerade": ("damaged",), "addressing": ("damaged",)}  # fmt: skip
"""Error -> counters of the receiver of which one must rise. After a delay, all messages are valid and too old."""
KEEPING = ("repetition", "insertion", "masquerade")
"""Errors that add messages: each true message still arrives in time."""


@dataclass(frozen=True)
class HilResult:
    """`virtual`: verdict of the same case in virtual time. `figure`: what disturbed the host; empty: nothing."""

    case: HilCase
    checks: tuple[Check, ...]
    verdict: Verdict
    virtual: Verdict | None
    figure: str
    facts: RunFacts
    run: Mapping[str, Any]

    @property
    def difference(self) -> str:
        """Why the verdict, or a part of the result, is not that in virtual time."""
        failed = [f"{check.name}: {check.measured} (expected {check.wanted})" for check in self.checks if not check.passed]
        return "; ".join(failed)


def evaluate(case: HilCase, facts: RunFacts, folder: Path, virtual: Verdict | None, own: Mapping[str, str]) -> HilResult:
    """A failed run of a disturbed host is inconclusive."""
    reports = {name: load_report(folder / f"{name}.json") for name in ("kernel", "plant", "controller")}
    run: dict[str, Any] = {}
    checks: list[Check] = []
    if "plant" not in own and case.kill != "plant":
        problem = facts.problem
        try:
            run = name_error(case, load_run(folder / "run.json"))
        except WorkError as error:
            problem = problem or str(error)
        checks += judge_kill(case, run, reports["plant"], problem) if case.kill else judge_case(case, run, problem)
    elif facts.problem:
        checks.append(Check("run", "a whole run", facts.problem, False))
    if case.kill == "plant":
        checks += judge_lost_plant(reports["kernel"])
    links = [] if case.kill else judge_links(case, reports, own)
    verdict = conclude([*checks, *links])
    figure = describe_host(reports, facts, case)
    # A host delays or loses messages. It makes no wrong ones.
    if verdict == "failed" and figure and all(check.passed for check in links):
        verdict = "inconclusive"
    checks += links
    return HilResult(case, tuple(checks), verdict, virtual, figure, facts, run)


def load_report(path: Path) -> dict[str, Any]:
    """Empty without a complete report."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def name_error(case: HilCase, run: dict[str, Any]) -> dict[str, Any]:
    """The record of the program names the fault that an error on a link replaces."""
    fault = run.get("fault")
    if case.error and isinstance(fault, dict) and fault.get("kind") == MESSAGE_FAULT:
        return {**run, "fault": {**fault, "link": case.link, "error": case.error}}
    return run


def judge_case(case: HilCase, run: Mapping[str, Any], problem: str) -> list[Check]:
    return judge(case.arm, run, problem)


def judge_kill(case: HilCase, run: Mapping[str, Any], plant: Mapping[str, Any], problem: str) -> list[Check]:
    """The plant must close within its bound, then stand, and be held by its brakes within the physical limits."""
    if problem or not run:
        return [Check("run", "a whole run", problem or "no run", False)]
    bounds = case.arm.bounds
    physics = run["physics"]
    standstill = run.get("standstill_at_s")
    reacted = run.get("reacted_at_s")
    margins = [limit - speed for speed, limit in zip(physics["max_speed_rad_s"], physics["speed_limit_rad_s"], strict=True)]
    checks = [
        Check("operational first", "operational", str(run.get("operational_at_s")), run.get("operational_at_s") is not None),
        Check("final state", "Safe", str(run.get("final_state")), run.get("final_state") == "Safe"),
        Check("reaction", "torque off", str(run.get("reaction")), reacted is not None),
        Check("standstill", "reached", str(standstill), standstill is not None),
        Check("hold drift", f"<= {bounds.hold_drift_rad:g} rad", f"{physics['hold_drift_rad']:.6f} rad", physics["hold_drift_rad"] <= bounds.hold_drift_rad),
        Check("speed limit", "each joint within its limit", f"margin {min(margins):.3f} rad/s", min(margins) >= 0.0),
        Check("position range", "margin >= 0 rad", f"{physics['min_position_margin_rad']:.4f} rad", physics["min_position_margin_rad"] >= 0.0),
    ]  # fmt: skip
    if case.kill == "kernel":
        lost, closed = plant.get("lost_at_s"), plant.get("closed_at_s")
        delay = None if lost is None or closed is None else closed - lost
        checks.append(Check("closed on the time line", f"<= {SILENCE_MAX_S:.3f} s", str(delay), delay is not None and delay <= SILENCE_MAX_S + ROUNDING_S))
        wall = plant.get("closed_after_s", 0.0)
        bound = SILENCE_MAX_S + CLOCK_S
        checks.append(Check("closed by the clock", f"<= {bound:.3f} s", f"{wall:.4f} s", 0.0 < wall <= bound))
    return checks


def judge_lost_plant(kernel: Mapping[str, Any]) -> list[Check]:
    """The kernel must close its outputs within its bound after the last answer."""
    closed, last, bound = kernel.get("closed_at_s"), kernel.get("last_answer_s"), kernel.get("closes_within_s", 0.0)
    delay = None if closed is None or last is None else closed - last
    return [
        Check("outputs closed", f"<= {bound:.4f} s", "never" if delay is None else f"{delay:.4f} s", delay is not None and 0.0 <= delay <= bound + ROUNDING_S),
        Check("first fault", "MeasurementStale", str(kernel.get("first_fault")), kernel.get("first_fault") == "MeasurementStale"),
    ]


def judge_links(case: HilCase, reports: Mapping[str, Mapping[str, Any]], own: Mapping[str, str]) -> list[Check]:
    """An injected error shows in the counters of its receiver; on the other links, nothing is damaged or out of order."""
    checks = []
    for link, (process, key) in RECEIVERS.items():
        news = reports[process].get(key)
        if process in own or news is None:
            continue
        if link == case.link:
            signs = () if is_silent(case) else SIGNS[case.error]
            seen = sum(int(news[sign]) for sign in signs)
            checks.append(Check(f"{case.error} on {link}", "detected", f"{', '.join(signs) or 'age'}: {seen}", not signs or seen > 0))
            continue
        if news.get("is_closed") or (link == "device" and is_hang(case)):
            continue  # after a long gap or hang of the receiver, each message counts as unordered
        wrong = {name: news[name] for name in ("damaged", "unordered", "foreign", "truncated", "oversized") if news[name]}
        hint = f" on {CHANNELS[link]}; stop any other sender on this channel" if wrong else ""
        checks.append(Check(f"link {link}", "one sender, no wrong message", f"{wrong or 'none'}{hint}", not wrong))
    return checks


def is_silent(case: HilCase) -> bool:
    """A loss without end leaves no later message that could show it in a counter."""
    return case.error == "loss" and case.arm.fault is not None and case.arm.fault.duration_s is None


def is_hang(case: HilCase) -> bool:
    return case.arm.fault is not None and case.arm.fault.kind == "supervisor_hang"


def describe_host(reports: Mapping[str, Mapping[str, Any]], facts: RunFacts, case: HilCase) -> str:
    """What shows that the host, not the software, delayed a window or a message; empty: nothing."""
    parts = []
    kernel, plant, controller = (reports[name] for name in ("kernel", "plant", "controller"))
    may_overrun = is_hang(case)
    if kernel:
        if not kernel["has_priority"] or not kernel["has_locked_memory"]:
            parts.append("no fixed priority or no locked memory")
        if kernel["missed"] and not may_overrun:
            parts.append(f"{kernel['missed']} windows skipped")
        if kernel["overran"] and not may_overrun:
            parts.append(f"{kernel['overran']} windows overran")
        if kernel["worst_lateness_s"] > LATENESS_MAX_S:
            parts.append(f"a window was late by {kernel['worst_lateness_s'] * 1e3:.2f} ms")
    if not kernel and plant.get("late_windows"):
        parts.append(f"{plant['late_windows']} late windows before the kernel was killed")
    parts += _list_late_links(case, kernel, plant, controller)
    if plant.get("late_s", 0.0) > LATENESS_MAX_S:
        parts.append(f"the thread of the plant was late by {plant['late_s'] * 1e3:.2f} ms")
    if facts.steal_s > STEAL_MAX_S:
        parts.append(f"the hypervisor took {facts.steal_s * 1e3:.0f} ms")
    return ", ".join(parts)


def _list_late_links(case: HilCase, kernel: Mapping[str, Any], plant: Mapping[str, Any], controller: Mapping[str, Any]) -> list[str]:
    """Links on which a message was late although its sender was not. A link whose injected error holds back messages has gaps of its own."""
    is_of_messages = case.arm.fault is not None and case.arm.fault.kind.startswith("message_")
    faulty = ("" if case.error in KEEPING else case.link) or ("command" if is_of_messages and not case.link else "")
    # Link -> longest gap between two messages where they are sent and received. The kernel sends in each frame; its report shows skipped ones.
    gaps = {"drive": (0.0, plant.get("received_gap_s", 0.0)), "state": (0.0, controller.get("received_gap_s", 0.0)),
            "device": (plant.get("sent_gap_s"), kernel.get("device_gap_s", 0.0)),
            "command": (controller.get("sent_gap_s"), kernel.get("command_gap_s", 0.0))}  # fmt: skip
    return [f"no message on {link} for {received * 1e3:.1f} ms, although it was sent in time"
            for link, (sent, received) in gaps.items() if link != faulty and sent is not None and sent <= GAP_MAX_S < received]  # fmt: skip
