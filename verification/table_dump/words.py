# SPDX-License-Identifier: Apache-2.0
"""Times and ways of a table in words, equal in text and pictures."""

from __future__ import annotations

from mamori.verification.table_dump.document import Window

WAY_TEXTS = {
    "same_window": "same window",
    "later_window": "later window",
    "next_frame": "next frame",
    "crossing": "crossing",
    "queue": "queue",
}
UNITS = ((1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "µs"), (1, "ns"))


def format_time(time_ns: int | None) -> str:
    """In the largest unit that gives a number from 1 on, with all its digits; empty for no time."""
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
