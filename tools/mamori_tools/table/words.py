# SPDX-License-Identifier: Apache-2.0
"""Texts for the times and channels of a table, equal in text and pictures."""

from __future__ import annotations

from mamori_tools.table.document import Table, Window
from mamori_tools.table.mode_rows import Reference, Values

WAY_TEXTS = {
    "same_window": "same window",
    "later_window": "later window",
    "next_frame": "next frame",
    "crossing": "crossing",
    "queue": "queue",
}
OTHERS_MAX = 2
"""Maximum number of modes after `all but`, because lists of exceptions are harder to read."""
UNITS = ((1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "µs"), (1, "ns"))


def format_time(time_ns: int | None) -> str:
    """Time in the largest unit with a value of at least 1, with all its digits; empty if no time is declared."""
    if time_ns is None:
        return ""
    factor, unit = next(((factor, unit) for factor, unit in UNITS if abs(time_ns) >= factor), (1, "ns"))
    whole, rest = divmod(abs(time_ns), factor)
    digits = f"{rest:0{len(str(factor)) - 1}d}".rstrip("0") if rest else ""
    return f"{'-' if time_ns < 0 else ''}{whole}{'.' if digits else ''}{digits} {unit}"


def format_rate(window: Window) -> str:
    """The declared rate with its slower ones, for example `1000 (500) Hz`."""
    if window.rate_hz is None:
        return ""
    slower = ", ".join(f"{1e9 / period:g}" for period in window.slower_periods_ns if period > 0)
    return f"{window.rate_hz:g}{f' ({slower})' if slower else ''} Hz"


def format_kind(window: Window) -> str:
    if window.kind == "event_driven":
        return f"{window.events_per_cycle} events"
    return window.kind.replace("_", " ")


def format_modes(table: Table, modes: tuple[int, ...]) -> str:
    """Names of these modes, or `all but` the few others; empty if all modes are included."""
    others = [index for index in range(len(table.modes)) if index not in modes]
    if not others:
        return ""
    if not modes:
        return "no mode"
    if len(others) < len(modes) and len(others) <= OTHERS_MAX:
        return "all but " + ", ".join(table.mode_name(index) for index in others)
    return ", ".join(table.mode_name(index) for index in sorted(modes))


def format_reference(reference: Reference | None) -> str:
    """The name; a question mark for a missing object; empty for none."""
    if reference is None:
        return ""
    is_unknown = reference.index is None and reference.name != "?"
    return f"{reference.name} (?)" if is_unknown else reference.name


def format_values(values: Values | None) -> str:
    """Values of the elements with all their digits."""
    return "?" if values is None else ", ".join("?" if value is None else str(value) for value in values)
