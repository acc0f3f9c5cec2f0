# SPDX-License-Identifier: Apache-2.0
# Goal: kinds and links are a closed vocabulary; safety goals and architecture elements are optional levels; evidence of techniques
# must exist.
from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample, format_item, format_technique

from mamori_trace.checks import list_rule_ids
from mamori_trace.readers.kinds import read_kinds
from mamori_trace.readers.project import read_project, read_requirements
from mamori_trace.readers.schema import read_schema

ROOT = Path(__file__).parents[2]
LINKS = "requirements/schema/links.toml"
TECHNIQUES = "requirements/schema/techniques.toml"
SYSTEM = "requirements/system/system.md"
SOFTWARE = "requirements/software/software.md"
REFINED = ("refinement-missing", "integration-missing")
KINDS = {"need", "hazard", "safety_goal", "requirement", "architecture", "assumption", "design", "code", "test", "result", "coverage", "proof",
         "timing", "campaign", "fmea_row", "deviation", "review"}  # fmt: skip


@pytest.fixture
def typed(sample: Sample) -> Sample:
    """The clean project with the kinds of this project."""
    shutil.copy(ROOT / LINKS, sample.root / LINKS)
    return sample


@pytest.mark.verifies("SWR-TRC-028", technique="requirements_based", polarity="nominal")
def test_every_kind_of_the_project_is_there_and_every_level_has_one() -> None:
    schema = read_schema(ROOT)

    kinds = read_kinds(ROOT, schema)

    assert set(kinds.kinds) == KINDS
    assert all(kinds.find_kind(level) for level in schema.levels)
    assert kinds.list_targets("code", "satisfies") == ("requirement",)
    assert kinds.list_targets("code", "verifies") is None


@pytest.mark.verifies("SWR-TRC-028", technique="requirements_based", polarity="nominal")
def test_safety_goals_and_architecture_elements_stand_between_the_levels(typed: Sample, trace: Callable) -> None:
    link = "docs/design/arm.md#hazards"
    typed.append("requirements/safety/hazards.md", format_item("SG-001", "Stop", "The arm shall stop.", Parents="HAZ-001", Verify="review"))
    typed.append(SYSTEM, format_item("ARC-001", "Supervisor", "The supervisor shall be a layer.", Parents="SYS-001", Verify="review", Design=link))
    typed.replace(SYSTEM, "- Parents: STK-001, HAZ-001", "- Parents: STK-001, SG-001")
    typed.replace(SOFTWARE, "- Parents: SYS-001\n", "- Parents: ARC-001\n")
    typed.review()

    outcome = trace("check", "--root", typed.root, "--output", "json")

    assert (outcome.status, outcome.content["findings"]) == (0, [])
    assert [outcome.get_verdict(name) for name in ("SG-001", "ARC-001", "HAZ-001")] == ["verified"] * 3


def refine(typed: Sample) -> None:
    """Gives the hazard a goal, and the goal an architecture element whose tests are to be integration tests."""
    typed.write("requirements/schema/rules.toml", '# [[rule]]\nschema = "mamori.rules/1"\n' + "".join(f'[rule.{rule}]\nall = "error"\n' for rule in REFINED))
    typed.append("requirements/safety/hazards.md", format_item("SG-001", "Stop", "The arm shall stop.", Parents="HAZ-001", Verify="review"))
    typed.append(SYSTEM, format_item("ARC-001", "Layer", "The arm shall have a layer.", Parents="SYS-001", Design="docs/design/arm.md#hazards"))
    typed.replace(SYSTEM, "- Parents: STK-001, HAZ-001", "- Parents: STK-001, SG-001")
    typed.replace(SOFTWARE, "- Parents: SYS-001\n", "- Parents: ARC-001\n")
    typed.review()


@pytest.mark.parametrize(("tests", "rules"), [("tools", set()), ("safety", {"integration-missing"})])
@pytest.mark.verifies("SWR-TRC-113", technique="equivalence_classes", polarity="nominal")
def test_only_an_integration_test_shows_an_architecture_element(typed: Sample, trace: Callable, tests: str, rules: set[str]) -> None:
    refine(typed)
    typed.write("requirements/schema/code.toml", f'# [[code]]\nschema = "mamori.code/1"\nintegration = ["{tests}"]\n')
    typed.replace("tools/tests/test_offline.py", "SWR-TLS-001", "ARC-001")

    outcome = trace("check", "--root", typed.root, "--output", "json")

    assert outcome.rules & set(REFINED) == rules


@pytest.mark.parametrize(
    ("old", "new"), [("- Parents: STK-001, SG-001", "- Parents: STK-001"), ("- Parents: SYS-001\n", "- Parents: SYS-003\n")]
)
@pytest.mark.verifies("SWR-TRC-113", technique="fault_injection", polarity="violation")
def test_a_goal_without_architecture_below_it_is_found(typed: Sample, trace: Callable, old: str, new: str) -> None:
    refine(typed)
    typed.replace(SYSTEM, old, new)

    findings = trace("check", "--root", typed.root, "--output", "json").content["findings"]

    assert [each["item"] for each in findings if each["rule"] == "refinement-missing"] == ["SG-001"]


@pytest.mark.verifies("SWR-TRC-113", technique="error_guessing", polarity="violation")
def test_a_refining_level_that_does_not_exist_is_one_clear_line(typed: Sample, trace: Callable) -> None:
    typed.replace("requirements/schema/items.toml", 'refined_by = "SG"', 'refined_by = "SX"')

    outcome = trace("check", "--root", typed.root)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert "level HAZ: refined_by names 'SX'" in outcome.err


@pytest.mark.verifies("SWR-TRC-028", technique="fault_injection", polarity="violation")
def test_a_safety_goal_makes_who_answers_it_protective(typed: Sample, trace: Callable) -> None:
    typed.append("requirements/safety/hazards.md", format_item("SG-001", "Stop", "The arm shall stop.", Parents="HAZ-001", Verify="review"))
    typed.append(SYSTEM, format_item("SYS-004", "Brake", "The arm shall brake.", Parents="SG-001"))
    typed.replace(SOFTWARE, "- Parents: SYS-001\n", "- Parents: SYS-001, SYS-004\n")
    typed.review()

    outcome = trace("check", "--root", typed.root, "--output", "json")

    assert [(each["rule"], each["item"]) for each in outcome.content["findings"]] == [("violation-not-demanded", "SYS-004")]


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('levels = ["STK"]', 'levels = ["STK", "HAZ"]', "the kinds need, hazard"),
        ('levels = ["STK"]', "levels = []", "level STK of items.toml is of no kind"),
        ('levels = ["STK"]', 'levels = ["STX"]', "nearest: STK"),
        ('levels = ["STK"]', 'levels = "STK"', "no list of words"),
        ('levels = ["STK"]', 'level = ["STK"]', "nearest: levels"),
        ('required = ["Design"]\n\n[kind.safety_goal]', 'required = ["Desing"]\n\n[kind.safety_goal]', "nearest: Design"),
        ('from = ["code"]', 'from = ["cod"]', "nearest: code"),
        ('from = ["code"]', "from = []", "[link.satisfies] says no from"),
        ('schema = "mamori.links/1"', 'schema = "mamori.links/2"', "schema is"),
        ("[kind.need]", "[kinds.need]", "nearest: kind"),
        ("[kind.need]", "[kind.need", LINKS),
    ],
)
@pytest.mark.verifies("SWR-TRC-028", technique="error_guessing", polarity="violation")
def test_a_schema_of_kinds_that_contradicts_is_one_clear_line(typed: Sample, trace: Callable, old: str, new: str, named: str) -> None:
    typed.replace(LINKS, old, new)

    outcome = trace("check", "--root", typed.root)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert named in outcome.err and LINKS in outcome.err


@pytest.mark.verifies("SWR-TRC-027", technique="requirements_based", polarity="nominal")
def test_a_technique_that_is_shown_stands_in_the_project_and_on_the_page(sample: Sample, trace: Callable) -> None:
    lists = {"items": ["SWR-SUP-001"], "tests": ["interface"], "documents": ["docs/design/arm.md#hazards"]}
    sample.write(TECHNIQUES, format_technique(**lists))

    outcome = trace("report", "--root", sample.root)

    (technique,) = read_project(sample.root, None, list_rule_ids()).techniques or []
    assert (outcome.status, technique.phase, technique.items) == (0, "design", ("SWR-SUP-001",))
    page = (sample.root / "report" / "index.html").read_text()
    assert "<td>Looking twice</td><td>Annex Z; needs the bought text; design</td>" in page
    assert '<td><a class="id" href="#item/SWR-SUP-001">SWR-SUP-001</a>; interface: 2 passed results; docs/design/arm.md#hazards</td>' in page


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('phase = "design"', 'phase = "desing"', "nearest: design"),
        ('clause = "Annex Z; needs the bought text"\n', "", "says no clause"),
        ("documents = ", "document = ", "nearest: documents"),
        ('documents = ["docs/design/arm.md"]', 'documents = "docs/design/arm.md"', "no list of texts"),
    ],
)
@pytest.mark.verifies("SWR-TRC-027", technique="error_guessing", polarity="violation")
def test_a_broken_technique_is_named(sample: Sample, trace: Callable, old: str, new: str, named: str) -> None:
    sample.write(TECHNIQUES, format_technique(documents=["docs/design/arm.md"]).replace(old, new))

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert (outcome.status, outcome.rules) == (2, {"unreadable-input"})
    assert [(each["file"], each["line"]) for each in outcome.content["findings"]] == [(TECHNIQUES, 3)]
    assert named in outcome.content["findings"][0]["message"]


@pytest.mark.verifies("SWR-TRC-027", technique="requirements_based", polarity="nominal")
def test_a_project_without_a_table_of_techniques_has_none(sample: Sample) -> None:
    assert read_project(sample.root, None, list_rule_ids()).techniques is None
    assert read_requirements(sample.root).kinds.kinds == {}
