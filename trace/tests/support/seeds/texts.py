# SPDX-License-Identifier: Apache-2.0
"""Faults of the texts of items and documents."""

from __future__ import annotations

from trace_sample import Sample

from seeds.places import SOFTWARE, SYSTEM, Seed, find_line


def malformed(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.append(SOFTWARE, "Afterthought.\n")


def weak(s: Sample) -> Seed:
    return "'if possible'", SOFTWARE, s.replace(SOFTWARE, "open no connection.", "open no connection if possible.")


def unfinished(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.replace(SOFTWARE, "open no connection", "open to" + "do no connection")


def shall_absent(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.replace(SOFTWARE, "shall open no", "opens no")


def shall_twice(s: Sample) -> Seed:
    return "SWR-TLS-001", SOFTWARE, s.replace(SOFTWARE, "no connection.", "no connection and shall close it.")


def document_id(s: Sample) -> Seed:
    (s.root / "docs" / "manual" / "safety").mkdir(parents=True)
    (s.root / "docs" / "manual" / "safety" / "limits.md").write_text("# Limits\n\nSYS-001 and SWR-SUP-909 hold.\n")
    return "SWR-SUP-909", "docs/manual/safety/limits.md", 3


def violation_not_demanded(s: Sample) -> Seed:
    s.replace(SYSTEM, "- Parents: STK-001, HAZ-001\n- SIL: 2\n- Verify: test\n- Polarity: nominal, violation",
              "- Parents: STK-001, HAZ-001\n- SIL: 2\n- Verify: test\n- Polarity: nominal")  # fmt: skip
    return "SYS-001 answers HAZ-001", SYSTEM, find_line(s, SYSTEM, "- Polarity: nominal\n")


SEEDS = (
    (malformed, "malformed-item", False),
    (weak, "weak-word", True),
    (unfinished, "unfinished-text", True),
    (shall_absent, "shall-count", True),
    (shall_twice, "shall-count", True),
    (document_id, "document-link", True),
    (violation_not_demanded, "violation-not-demanded", True),
)
"""Seed, rule, whether the links are reviewed again afterwards."""
