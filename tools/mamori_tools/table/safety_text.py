# SPDX-License-Identifier: Apache-2.0
"""Rows of the safety layer of a system table as rows of text.

@satisfies SWR-CYC-033      Design: docs/design/cost.md#text
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_tools.table.document import Table
from mamori_tools.table.safety_rows import FaultConfirmation, Safety
from mamori_tools.table.words import format_time

Row = tuple[str, ...]
Section = tuple[str, list[Row]]
"""A title and its rows, headings first."""
MACHINE = "machine"
"""Raises each fault that no row of the table raises: SafetyCycle::is_present() of the application."""


def make_safety_sections(table: Table) -> Iterator[Section]:
    safety = table.safety
    if safety is None:
        return
    supervised = [(table.component_name(row.component), _count(row.late_cycles), _count(row.expired_cycles),
                   format_time(row.shortest_ns) if row.shortest_ns else "", format_time(row.longest_ns),
                   str(row.checkpoints) if row.checkpoints else "",
                   "watchdog is not serviced" if row.fault is None else name_fault(table, row.fault))
                  for row in safety.supervised]  # fmt: skip
    yield "supervision", [("component", "late after", "expired after", "shortest run", "longest run", "checkpoints", "failure"), *supervised]
    sources = [(confirmation.replace("_", " "), f"{table.component_name(row.component)}.{row.port}")
               for row in safety.stop_sources for confirmation in row.confirms]  # fmt: skip
    yield "confirmations of stops", [("confirmation", "source"), *sources]
    tests = [(f"{number}", format_time(row.found_within_ns), name_fault(table, row.fault)) for number, row in enumerate(safety.self_tests)]
    yield "repeated self tests", [("self test", "found within", "fault"), *tests]
    assumptions = [(row.name, format_time(row.within_ns), name_fault(table, safety.cycle.self_test_fault)) for row in safety.assumptions]
    yield "assumptions", [("assumption", "known within", "fault"), *assumptions]
    protections = [(table.component_name(row.component), f"profile {row.profile}", format_time(row.fresh_within_ns),
                    format_time(row.lead_ns) if row.lead_ns else "", "" if row.max_delta is None else str(row.max_delta - 1),
                    name_fault(table, row.fault)) for row in safety.protections]  # fmt: skip
    yield "protected connections", [("receiver", "E2E", "fresh within", "lead", "losses in a row", "fault"), *protections]
    yield "safety cycle", [("setting", "value"), *_make_settings(table, safety)]


def _make_settings(table: Table, safety: Safety) -> Iterator[Row]:
    cycle = safety.cycle
    contacts = "with contacts" if cycle.brakes_have_contacts else "without contacts"
    yield "SS2 becomes SS1 after", format_time(cycle.ss2_within_ns)
    yield "SS1 becomes STO after", format_time(cycle.ss1_within_ns)
    yield "brakes close within", f"{format_time(cycle.brakes_close_within_ns)}, {contacts}"
    yield "torque despite STO locks out after", format_time(cycle.torque_feedback_ns)
    yield "watchdog is serviced every", f"{format_time(cycle.watchdog_shortest_ns)} to {format_time(cycle.watchdog_longest_ns)}"
    yield "latest window start", format_time(cycle.lateness_max_ns)
    yield "STO after closed brakes", ", ".join(name_fault(table, fault) for fault in cycle.brakes_first) or "none"


def name_fault(table: Table, fault: int | None) -> str:
    """`F7 Overspeed`: the number is that of the fault register and of the events, and never reused."""
    return "none" if fault is None else f"{format_id(fault)} {table.faults.get(fault, '(not declared)')}"


def format_id(fault: int) -> str:
    return f"F{fault}"


def make_fault_cells(table: Table, fault: int) -> Row:
    """What raises a fault, when it is latched, and when it may be acknowledged; nothing without rows of the safety layer."""
    safety = table.safety
    if safety is None:
        return "", "", ""
    row = next((row for row in safety.confirmations if row.fault == fault), FaultConfirmation(fault))
    latched = [_count(row.cycles) + (f", minus {row.decay} per cycle without it" if row.decay else "")] if row.cycles else []
    latched += [format_time(row.time_ns)] if row.time_ns else []
    # A silent component is found once in its expired_cycles; the safety cycle does not let its fault heal before.
    cycles = max([row.healing_cycles, *(entry.expired_cycles for entry in safety.supervised if entry.fault == fault)])
    healed = _count(cycles) + (f" and {format_time(row.healing_ns)}" if row.healing_ns else "")
    return ", ".join(_list_causes(table, safety, fault)) or MACHINE, " or ".join(latched), healed


def _list_causes(table: Table, safety: Safety, fault: int) -> list[str]:
    cycle = safety.cycle
    causes = [table.component_name(row.component) for row in safety.supervised if row.fault == fault]
    causes += [f"loss at {table.component_name(row.component)}" for row in safety.protections if row.fault == fault]
    causes += [f"self test {number}" for number, row in enumerate(safety.self_tests) if row.fault == fault]
    named = ((cycle.late_reaction_fault, "late reaction"), (cycle.self_test_fault, "failed self test"),
             (cycle.unconfirmed_brakes_fault, "unconfirmed brakes"))  # fmt: skip
    return causes + [cause for number, cause in named if number == fault]


def _count(cycles: int) -> str:
    return f"{cycles} cycle{'' if cycles == 1 else 's'}"
