# SPDX-License-Identifier: Apache-2.0
"""A report as text: one screen, or the complete text for timing.txt.

@satisfies SWR-TIM-026      Design: docs/design/timing.md#results
"""

from __future__ import annotations

import os
from collections.abc import Sequence

from mamori_tools.timing.analysis import ComponentRow, Distribution
from mamori_tools.timing.evt import Estimate
from mamori_tools.timing.power import describe_power
from mamori_tools.timing.reader import MISSED, OUTCOMES, PACES
from mamori_tools.timing.report import MISSES_STORED, Report
from mamori_tools.timing.verdict import NOT_KNOWN

MISSES_SHOWN = 5
CHAINS_SHOWN = 6
ROWS_SHOWN = 12
NAME_LENGTH = 90
MEMBER_LENGTH_MIN = 6  # characters of a chain member if the name of the chain is shortened
FINDINGS_SHOWN = 8


def make_text(report: Report, is_whole: bool) -> str:
    """@param is_whole all rows and reasons; otherwise the rows that fit on a screen, with a reference to the file."""
    parts = [_make_head(report), _make_windows(report, is_whole), _make_uses(report, is_whole), _make_components(report, is_whole),
             _make_states(report, is_whole), _make_state_components(report, is_whole),
             _make_chains(report, is_whole),
             _make_shifts(report, is_whole), _make_misses(report, is_whole), _make_estimates(report, is_whole), _make_verdict(report, is_whole)]  # fmt: skip
    return make_printable("\n\n".join("\n".join(part) for part in parts if part) + "\n")


def _make_head(report: Report) -> list[str]:
    run, host = report.run, report.host
    setting, before, after = host["setting"], host["before"], host["after"]
    rights = ", ".join(f"{one.name} {'granted' if one.is_granted else 'denied'}" for one in run.rights)
    return [
        *(f"*** {mark} ***" for mark in report.marks),
        f"{report.system}: {run.cycles_run} cycles of {format_us(run.table.frame_ns)} us"
        f"{' with stress-ng' if report.with_load else ''}; reference work {format_us(run.reference_ns)} us; times in us",
        f"privileges: {rights}",
        f"host: kernel {setting['kernel']} ({setting['preemption']}), governor {setting['governor']}, clock {setting['clock_source']}, "
        f"{'virtual machine, ' if setting['virtual_machine'] else ''}load {before['load_1_min']} .. {after['load_1_min']}, "
        f"steal {100 * report.steal_share:.2f} %",
        *describe_power(setting),
    ]


def _make_windows(report: Report, is_whole: bool) -> list[str]:
    head = ("window", "core", "offset", "length", "budget", "late p50", "p99", "p99.9", "max", "drift", "response max", "margin",
            "budget used", "margin", "missed", "overran")  # fmt: skip
    rows = []
    for one in report.windows:
        late = one.lateness
        rows.append((
            one.window, str(one.core), format_us(one.offset_ns), format_us(one.length_ns), format_us(one.budget_ns),
            *_format_quantiles(late, ("p50", "p99", "p999", "max")), format_us(one.drift.shift_ns),
            format_us(one.response.max if one.response else None), format_us(one.length_margin_ns), format_us(one.used_max_ns), format_us(one.budget_margin_ns),
            str(one.outcomes["missed"]), str(one.outcomes["overrun"]),
        ))  # fmt: skip
    return _cut([head, *rows], is_whole)


def _make_uses(report: Report, is_whole: bool) -> list[str]:
    """Use of the processor; empty for a program that does not record it."""
    rows = []
    for one in report.windows:
        if one.use is not None:
            rows.append((one.window, *_format_quantiles(one.use.cpu, ("p50", "max")), str(one.use.voluntary), str(one.use.involuntary),
                         format_us(one.use.own_ns), format_us(one.use.outside_ns), one.use.longest_by or "-"))  # fmt: skip
    if not rows:
        return []
    refused = [f"processor of core {index}: access to its switches was denied ({os.strerror(core.errno)}); causes outside a component are not known"
               for index, core in enumerate(report.run.switches.cores if report.run.switches else ()) if not core.is_known]  # fmt: skip
    head = ("window", "CPU p50", "max", "waits", "preempted", "own threads", "outside", "longest by")
    return [*_cut([head, *rows], is_whole), *refused]


def _make_components(report: Report, is_whole: bool) -> list[str]:
    head = ("component", "window", "runs", "min", "p50", "p99", "p99.9", "max", "declared", "margin", "ratio p50", "not returned")
    return _cut([head, *(_make_component(row, report.run.reference_ns) for row in report.components)], is_whole)


def _make_states(report: Report, is_whole: bool) -> list[str]:
    if not report.states:
        return []
    head = ("state", "operating", "window", "instances", "late p50", "max", "response p50", "max")
    rows = [(one.state, "yes" if one.is_operating else "no", one.window, str(one.count), *_format_quantiles(one.lateness, ("p50", "max")),
             *_format_quantiles(one.response, ("p50", "max"))) for one in report.states]  # fmt: skip
    return _cut([head, *rows], is_whole)


def _make_state_components(report: Report, is_whole: bool) -> list[str]:
    """Only in the complete text."""
    if not report.state_components or not is_whole:
        return []
    rows = [(one.state, one.component, str(one.execution.count), *_format_quantiles(one.execution, ("min", "p50", "p99", "max")))
            for one in report.state_components]  # fmt: skip
    return format_columns([("state", "component", "runs", "min", "p50", "p99", "max"), *rows])


def _make_component(row: ComponentRow, reference_ns: int) -> tuple[str, ...]:
    times = row.execution
    return (row.component, row.window, str(times.count if times else 0), *_format_quantiles(times, ("min", "p50", "p99", "p999", "max")),
            format_us(row.declared_ns), format_us(row.margin_ns), f"{times.p50 / reference_ns:.3g}" if times else "-",
            str(row.unfinished))  # fmt: skip


def _make_chains(report: Report, is_whole: bool) -> list[str]:
    if not report.chains:
        return ["chains: none", *([report.chain_note] if report.chain_note else [])]
    head = ("no.", "chain (window start of the input .. planned window end of the output)", "virtual", "reaction max", "measured p50", "p99", "max", "broken",
            "over bound")  # fmt: skip
    rows = []
    chosen = report.chains if is_whole else report.chains[:CHAINS_SHOWN]
    for number, row in enumerate(chosen, start=1):
        virtual = row.virtual
        span = format_us(virtual.max_ns) if virtual.min_ns == virtual.max_ns else f"{format_us(virtual.min_ns)} .. {format_us(virtual.max_ns)}"
        rows.append((str(number), row.name if is_whole else shorten(row.name), span, format_us(virtual.reaction_max_ns),
                     *_format_quantiles(row.measured, ("p50", "p99", "max")), str(row.broken), str(len(row.violations))))  # fmt: skip
    lines = format_columns([head, *rows])
    if len(chosen) < len(report.chains):
        lines.append(f"and {len(report.chains) - len(chosen)} more chains: timing.txt")
    if report.chain_note:
        lines.append(report.chain_note)
    return [*lines, *(_make_sensitivity(report) if is_whole else [])]


def _make_sensitivity(report: Report) -> list[str]:
    head = ("window", "chain no.", "budget", "length", "budget may grow", "length may grow to next window", "to next reader",
            "response grows per length")  # fmt: skip
    rows = [
        (one.window, str(number), format_us(one.budget_ns), format_us(one.length_ns), format_us(one.budget_growth_ns), format_us(one.core_gap_ns),
         format_us(one.reader_gap_ns), str(one.response_per_length))
        for number, row in enumerate(report.chains, start=1) for one in row.virtual.sensitivity
    ]  # fmt: skip
    return ["", *format_columns([head, *rows])]


def _make_shifts(report: Report, is_whole: bool) -> list[str]:
    if report.run.requests is None:
        return []
    head = ("window", "start p50", *(name for pace in PACES[1:] for name in (f"{pace} shift", "min", "max")))
    rows = [(one.window, *_format_quantiles(one.start, ("p50",)), *_format_quantiles(one.steady, ("p50", "min", "max")),
             *_format_quantiles(one.burst, ("p50", "min", "max"))) for one in report.shifts]  # fmt: skip
    rounds = max((one.start.count for one in report.shifts if one.start is not None), default=0)
    return [f"requests: {report.run.requests.count}, steady (1,000 per second) and in bursts of 100; rounds of {len(PACES)} x "
            f"{report.run.requests.block_cycles} cycles: {rounds}",
            *_cut([head, *rows], is_whole)]  # fmt: skip


def _make_misses(report: Report, is_whole: bool) -> list[str]:
    if not report.misses:
        return ["misses: none"]
    chosen = report.misses[: MISSES_STORED if is_whole else MISSES_SHOWN]
    rows = [(str(one.cycle), one.window, one.outcome, one.verdict, one.component or "-", format_us(one.late_ns), one.reason) for one in chosen]
    lines = format_columns([("cycle", "window", "outcome", "verdict", "component", "late", "what happened"), *rows])
    if len(chosen) < len(report.misses):
        lines.append(f"and {len(report.misses) - len(chosen)} more{'' if is_whole else ': timing.txt'}")
    return lines


def _make_estimates(report: Report, is_whole: bool) -> list[str]:
    refused = [(row.component, one) for row, one in zip(report.components, report.estimates, strict=True) if one.refusal]
    given = [(row.component, one) for row, one in zip(report.components, report.estimates, strict=True) if not one.refusal]
    lines = [f"extreme values: '{name}': {_format_estimate(one)}" for name, one in given]
    if refused and is_whole:
        lines += [f"extreme values: '{name}': rejected: {one.refusal}" for name, one in refused]
    elif refused:
        others = f" (and for {len(refused) - 1} more: timing.txt)" if len(refused) > 1 else ""
        lines.append(f"extreme values: rejected for '{refused[0][0]}': {refused[0][1].refusal}{others}")
    return lines


def _format_estimate(one: Estimate) -> str:
    return ", ".join(f"exceeded with probability {p:g} per window instance: {format_us(int(value))} us" for p, value in one.quantiles_ns.items())


def _make_verdict(report: Report, is_whole: bool) -> list[str]:
    lines = []
    if lost := report.host_misses:
        missed = sum(miss.outcome == OUTCOMES[MISSED] for miss in lost)
        unknown = sum(miss.verdict == NOT_KNOWN for miss in lost)
        lines.append(f"lost outside the program: {missed} windows skipped and {len(lost) - missed} overruns, late by up to "
                     f"{format_us(max(miss.late_ns for miss in lost))} us, steal {100 * report.steal_share:.2f} % of all processor time; "
                     f"no finding of the code{f' ({unknown} of them not known)' if unknown else ''}")  # fmt: skip
    lines += [f"note: {note}" for note in report.notes]
    shown = report.findings if is_whole else report.findings[:FINDINGS_SHOWN]
    lines += [f"finding: {text}" for text in shown]
    if len(shown) < len(report.findings):
        lines.append(f"and {len(report.findings) - len(shown)} more findings: timing.txt")
    return [*lines, f"findings: {len(report.findings)}"]


def _cut(rows: Sequence[tuple[str, ...]], is_whole: bool) -> list[str]:
    shown = rows if is_whole else rows[: ROWS_SHOWN + 1]
    more = [f"and {len(rows) - len(shown)} more: timing.txt"] if len(shown) < len(rows) else []
    return [*format_columns(shown), *more]


def _format_quantiles(times: Distribution | None, names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple("-" if times is None else format_us(getattr(times, name)) for name in names)


def format_us(ns: int | None) -> str:
    """Microseconds with the significant digits."""
    if ns is None:
        return "-"
    us = ns / 1e3
    if us == int(us) or abs(us) >= 1000.0:
        return f"{us:.0f}"
    return f"{us:.1f}" if abs(us) >= 10.0 else f"{us:.2f}"


def make_printable(text: str) -> str:
    """Removes control characters of names from a file, before they reach a terminal."""
    return "".join(letter if letter.isprintable() or letter == "\n" else "\N{REPLACEMENT CHARACTER}" for letter in text)


def shorten(name: str, length: int = NAME_LENGTH) -> str:
    """At most `length` characters, an even number. Each member of a chain keeps its beginning, so that chains that differ in one member
    stay distinguishable. A single name, or a list of too many members, keeps both ends."""
    members = name.split(" > ")
    for kept in range(max(map(len, members)), MEMBER_LENGTH_MIN - 1, -1) if len(members) > 1 else ():
        short = " > ".join(one if len(one) <= kept else f"{one[: kept - 2]}.." for one in members)
        if len(short) <= length:
            return short
    return name if len(name) <= length else f"{name[: length // 2 - 2]} .. {name[-length // 2 + 2 :]}"


def format_columns(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Columns as wide as their contents; numbers are right-aligned."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    is_number = [all(_is_number(row[column]) for row in rows[1:]) and len(rows) > 1 for column in range(len(rows[0]))]
    return [
        "  ".join(text.rjust(width) if number else text.ljust(width) for text, width, number in zip(row, widths, is_number, strict=True)).rstrip()
        for row in rows
    ]


def _is_number(text: str) -> bool:
    return text == "-" or text.replace(".", "").replace("-", "").replace("e", "").replace("+", "").isdigit()
