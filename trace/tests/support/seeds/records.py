# SPDX-License-Identifier: Apache-2.0
"""Faults of reviews, techniques and waivers."""

from __future__ import annotations

from trace_sample import Sample, format_item, format_review, format_technique, format_waiver

from mamori_trace.readers.project import read_requirements
from seeds.places import SYSTEM, Seed

REVIEWS = "requirements/reviews.toml"
TECHNIQUES = "requirements/schema/techniques.toml"
WAIVERS = "requirements/waivers.toml"


def add_analysed(s: Sample, verify: str = "analysis") -> int:
    """An item that analysis verifies. @return the line of that attribute."""
    block = format_item("AOU-001", "Clock", "The integrator shall provide a clock.", Parents="SYS-001", Verify=verify)
    return s.append(SYSTEM, block) + block[: block.index("- Verify")].count("\n")


def write_review(s: Sample, **changes: str) -> int:
    s.review()
    fingerprint = read_requirements(s.root).items["AOU-001"].calc_fingerprint()
    return s.write(REVIEWS, format_review("AOU-001", fingerprint, **changes))


def review_absent(s: Sample) -> Seed:
    return "AOU-001 demands analysis", SYSTEM, add_analysed(s)


def review_outdated(s: Sample) -> Seed:
    line = add_analysed(s)
    s.write(REVIEWS, format_review("AOU-001", "0123456789ab"))
    return "AOU-001 changed", SYSTEM, line


def review_of_nothing(s: Sample) -> Seed:
    return "AOU-007", REVIEWS, s.write(REVIEWS, format_review("AOU-007", "0123456789ab"))


def review_not_demanded(s: Sample) -> Seed:
    return "SWR-TLS-001, which demands test", REVIEWS, s.write(REVIEWS, format_review("SWR-TLS-001", "0123456789ab", method="review"))


def review_by_author(s: Sample) -> Seed:
    add_analysed(s)
    return "by its author", REVIEWS, write_review(s, author="sample reviewer")


def review_without_author(s: Sample) -> Seed:
    add_analysed(s)
    return "does not say who wrote", REVIEWS, write_review(s, author="")


def technique_without_proof(s: Sample) -> Seed:
    return "neither items nor tests", TECHNIQUES, s.write(TECHNIQUES, format_technique())


def technique_without_item(s: Sample) -> Seed:
    return "SWR-SUP-009 is defined nowhere", TECHNIQUES, s.write(TECHNIQUES, format_technique(items=["SWR-SUP-009"]))


def technique_without_test(s: Sample) -> Seed:
    return "no test uses back_to_back", TECHNIQUES, s.write(TECHNIQUES, format_technique(tests=["back_to_back"]))


def technique_without_heading(s: Sample) -> Seed:
    return "no heading #gone", TECHNIQUES, s.write(TECHNIQUES, format_technique(documents=["docs/design/arm.md#gone"]))


def waiver_idle(s: Sample) -> Seed:
    return "SWR-SUP-002", WAIVERS, s.write(WAIVERS, format_waiver("sil-lower", item="SWR-SUP-002"))


def waiver_over(s: Sample) -> Seed:
    return "2026-11-20", WAIVERS, s.write(WAIVERS, format_waiver("sil-lower", item="SWR-SUP-002", expires="2026-11-20"))


def waiver_silent(s: Sample) -> Seed:
    return "no reason", WAIVERS, s.write(WAIVERS, format_waiver("sil-lower", item="SWR-SUP-002", reason=""))


SEEDS = (
    (review_absent, "review-missing", True),
    (review_outdated, "review-missing", True),
    (review_of_nothing, "review-unused", True),
    (review_not_demanded, "review-unused", True),
    (review_by_author, "independence-missing", True),
    (review_without_author, "independence-missing", True),
    (technique_without_proof, "technique-unshown", True),
    (technique_without_item, "technique-unshown", True),
    (technique_without_test, "technique-unshown", True),
    (technique_without_heading, "technique-unshown", True),
    (waiver_idle, "waiver-unused", True),
    (waiver_over, "waiver-expired", True),
    (waiver_silent, "waiver-without-reason", True),
)
"""Seed, rule, whether the links are reviewed again afterwards."""
