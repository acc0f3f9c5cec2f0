# SPDX-License-Identifier: Apache-2.0
"""Faults of links: ids, parents, levels, safety levels, decomposition, design, kinds of links, reviews of links."""

from __future__ import annotations

import shutil
from pathlib import Path

from trace_sample import Sample, format_gtest_case, format_item, format_record

from seeds.places import GTEST, HEADER, SOFTWARE, SYSTEM, Seed, find_line

DECOMPOSITION = "requirements/decomposition.toml"
HAZARDS = "requirements/safety/hazards.md"
IDS = "requirements/ids.lock"
LINKS = "requirements/schema/links.toml"
LOCK = "requirements/trace.lock"
PACK = "requirements/schema/rules.toml"


def seed_design(s: Sample, link: str) -> int:
    path = s.root / SOFTWARE
    head, _, tail = path.read_text().rpartition("- Design: -")
    path.write_text(f"{head}- Design: {link}{tail}")
    return head.count("\n") + 1


def copy_links(s: Sample) -> None:
    shutil.copy(Path(__file__).parents[4] / LINKS, s.root / LINKS)


def parent_unknown(s: Sample) -> Seed:
    return "SYS-999", SOFTWARE, s.replace(SOFTWARE, "- Parents: SYS-003", "- Parents: SYS-003, SYS-999")


def duplicate(s: Sample) -> Seed:
    block = format_item("SWR-SUP-002", "Again", "The supervision shall repeat itself.", Parents="SYS-001")
    return "SWR-SUP-002", SOFTWARE, s.append(SOFTWARE, block)


def cycle(s: Sample) -> Seed:
    line = s.replace(SYSTEM, "- Parents: STK-001, HAZ-001", "- Parents: STK-001, HAZ-001, SWR-SUP-002")
    return "SWR-SUP-002 -> SYS-001 -> SWR-SUP-002", SYSTEM, line


def no_parent(s: Sample) -> Seed:
    s.append(SYSTEM, format_item("SYS-004", "Extra", "The tool shall be extra.", Parents="STK-001"))
    s.append(SOFTWARE, format_item("SWR-TLS-002", "Extra", "The tool shall be extra.", Parents="SYS-004", SIL="QM"))
    s.replace(HEADER, "SWR-SUP-002", "SWR-SUP-002, SWR-TLS-002")
    s.replace(GTEST, "  </testsuite>", format_gtest_case("ExtraTest", "IsExtra", "SWR-TLS-002") + "  </testsuite>")
    return "SYS-004", SYSTEM, s.replace(SYSTEM, "- Parents: STK-001\n- SIL: 2", "- Parents: -\n- SIL: QM")


def no_child(s: Sample) -> Seed:
    needs = "requirements/stakeholder/needs.md"
    return "STK-002", needs, s.append(needs, format_item("STK-002", "Lonely", "Engineers need more.", SIL="QM", Verify="review"))


def level_skipped(s: Sample) -> Seed:
    s.replace(SOFTWARE, "- Parents: SYS-001\n", "- Parents: STK-001\n")
    return "SWR-SUP-002", SOFTWARE, find_line(s, SOFTWARE, "- Parents: STK-001\n")


def level_sideways(s: Sample) -> Seed:
    return "SYS-001 names SYS-003", SYSTEM, s.replace(SYSTEM, "- Parents: STK-001, HAZ-001", "- Parents: STK-001, HAZ-001, SYS-003")


def sil_lower(s: Sample) -> Seed:
    line = s.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    return "SWR-SUP-002", SOFTWARE, line + 1


def decomposition_idle(s: Sample) -> Seed:
    return "no lower", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-001"))


def decomposition_of_nothing(s: Sample) -> Seed:
    return "no parent SYS-003", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-003", "SWR-TLS-001"))


def carrier_elsewhere(s: Sample) -> Seed:
    s.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    return "does not refine SYS-001", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-TLS-001"))


def carrier_unknown(s: Sample) -> Seed:
    s.replace(SOFTWARE, "- Parents: SYS-001\n- SIL: 2", "- Parents: SYS-001\n- SIL: 1")
    return "SWR-SUP-009", DECOMPOSITION, s.write(DECOMPOSITION, format_record("SWR-SUP-002", "SYS-001", "SWR-SUP-009"))


def design_file(s: Sample) -> Seed:
    return "docs/design/gone.md", SOFTWARE, seed_design(s, "docs/design/gone.md#a")


def design_heading(s: Sample) -> Seed:
    return "#hazard", SOFTWARE, seed_design(s, "docs/design/arm.md#hazard")


def no_design(s: Sample) -> Seed:
    s.write(PACK, '# [[design]]\nschema = "mamori.rules/1"\n[rule.design-missing]\n2 = "error"\nQM = "off"\n')
    for file in (SYSTEM, SOFTWARE):
        text = (s.root / file).read_text()
        (s.root / file).write_text(text.replace("- Design: -", "- Design: docs/design/arm.md#hazards"))
    text = (s.root / SOFTWARE).read_text()
    (s.root / SOFTWARE).write_text(text.replace("- Design: docs/design/arm.md#hazards", "- Design: -", 1))
    return "SWR-SUP-001", SOFTWARE, find_line(s, SOFTWARE, "- Design: -")


def demand(s: Sample, rule: str) -> None:
    s.write(PACK, f'# [[rule]]\nschema = "mamori.rules/1"\n[rule.{rule}]\nall = "error"\n')


def no_goal(s: Sample) -> Seed:
    demand(s, "refinement-missing")
    return "HAZ-001 is refined by no SG item", HAZARDS, find_line(s, HAZARDS, "## HAZ-001")


def architecture_without_integration(s: Sample) -> Seed:
    demand(s, "integration-missing")
    line = s.append(SYSTEM, format_item("ARC-001", "Layer", "The supervisor shall be a layer.", Parents="SYS-001", Verify="review"))
    s.replace(SOFTWARE, "- Parents: SYS-001\n", "- Parents: ARC-001\n")
    return "ARC-001 has no nominal integration test", SYSTEM, line + 8


def code_for_a_need(s: Sample) -> Seed:
    copy_links(s)
    return "STK-001, which is of the kind need", HEADER, s.replace(HEADER, "SWR-SUP-002", "SWR-SUP-002, STK-001")


def hazard_without_design(s: Sample) -> Seed:
    copy_links(s)
    return "HAZ-001 says no Design", HAZARDS, s.replace(HAZARDS, "- Design: docs/design/arm.md#hazards", "- Design: -")


def suspect(s: Sample) -> Seed:
    s.replace(SYSTEM, "The tool shall run offline.", "The tool shall run far away.")
    return "SYS-003 changed", SOFTWARE, find_line(s, SOFTWARE, "- Parents: SYS-003")


def lock_gone(s: Sample) -> Seed:
    (s.root / "requirements" / "trace.lock").unlink()
    return "trace review", "requirements/trace.lock", 1


def id_taken_again(s: Sample) -> Seed:
    s.write(IDS, "# [[ids]]\nSWR-SUP-002 0123456789ab 2026-10-01 Brake wear\n")
    return "'Brake wear'", SOFTWARE, find_line(s, SOFTWARE, "## SWR-SUP-002")


def id_dropped(s: Sample) -> Seed:
    with (s.root / LOCK).open("a") as lock:
        lock.write("SWR-SUP-009 0123456789ab SYS-001 0123456789ab 2026-10-01 Sample Reviewer\n")
    return "SWR-SUP-009", LOCK, find_line(s, LOCK, "SWR-SUP-009")


SEEDS = (
    (parent_unknown, "unknown-id", True),
    (duplicate, "duplicate-id", False),
    (cycle, "cycle", True),
    (no_parent, "parent-missing", True),
    (no_child, "child-missing", True),
    (level_skipped, "level-order", True),
    (level_sideways, "level-order", True),
    (sil_lower, "sil-lower", True),
    (decomposition_idle, "decomposition-unused", True),
    (decomposition_of_nothing, "decomposition-unused", True),
    (carrier_elsewhere, "decomposition-unsound", True),
    (carrier_unknown, "decomposition-unsound", True),
    (design_file, "design-link", True),
    (design_heading, "design-link", True),
    (no_design, "design-missing", True),
    (no_goal, "refinement-missing", True),
    (architecture_without_integration, "integration-missing", True),
    (code_for_a_need, "link-kind", True),
    (hazard_without_design, "link-kind", True),
    (suspect, "suspect-link", False),
    (lock_gone, "suspect-link", False),
    (id_taken_again, "id-reused", True),
    (id_dropped, "id-unrecorded", False),
)
"""Seed, rule, whether the links are reviewed again afterwards."""
