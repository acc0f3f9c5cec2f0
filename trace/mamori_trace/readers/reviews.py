# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/reviews.toml.

@satisfies SWR-TRC-023      Design: docs/design/trace.md#reviews
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Problem
from mamori_trace.model.item import Schema
from mamori_trace.model.review_record import ReviewRecord
from mamori_trace.readers.toml_rows import Columns, is_date, read_rows, suggest

REVIEWS_PATH = "requirements/reviews.toml"
_COLUMNS = Columns(
    texts=("item", "method", "fingerprint", "looked_at", "author", "by", "date"),
    needed=("item", "method", "fingerprint", "looked_at", "by", "date"),
)


def read_reviews(root: Path, schema: Schema, problems: list[Problem]) -> list[ReviewRecord]:
    """Records in file order. An invalid record is a problem and has no effect."""
    records: list[ReviewRecord] = []
    for row, place in read_rows(root / REVIEWS_PATH, "mamori.reviews/1", "review", _COLUMNS, root, problems):
        record = ReviewRecord(place=place, **row)
        if record.method not in schema.verify:
            fault = f"method '{record.method}' is not one of {', '.join(schema.verify)}{suggest(record.method, schema.verify)}"
        else:
            fault = "" if is_date(record.date) else f"date: '{record.date}' is no day of the form 2026-11-30"
        if fault:
            problems.append(Problem(UNREADABLE, place, fault))
        else:
            records.append(record)
    return records
