# SPDX-License-Identifier: Apache-2.0
# Goal: every notation that another tool accepts for a requirement, an item or a link has the same meaning here.
# Method: small files in the form of those tools are given to the command.
from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Outcome


def check(trace: Callable[..., Outcome], name: str, folder: Path, file: str, text: str) -> Outcome:
    (folder / file).write_text(text, encoding="utf-8")
    return trace("check", "--format", name, folder, "--output", "json", "--allow-missing")


def list_rows(outcome: Outcome, rule: str) -> list[tuple[str, int]]:
    return [(row["item"], row["line"]) for row in outcome.content["findings"] if row["rule"] == rule]


@pytest.mark.parametrize("needs", ["Needs: impl, utest", "Needs:\n* impl\n* utest", "Needs:\n\n  - impl\n  + utest\n\nTags:\n* one"])
@pytest.mark.verifies("SWR-TRC-046", technique="equivalence_classes", polarity="violation")
def test_what_an_openfasttrace_item_needs_may_stand_in_a_list(needs: str, trace: Callable, tmp_path: Path) -> None:
    outcome = check(trace, "oft", tmp_path, "a.md", f"# Stop\n`req~stop~1`\n\nThe arm shall stop.\n\n{needs}\n")

    assert outcome.rules == {"code-missing", "test-missing"}
    assert outcome.get_verdict("req~stop~1") != "verified"


@pytest.mark.parametrize("head", ["`req~stop~1`", "req~stop~1", "`req~stop~1` stops the arm", "req~stop~1: stop"])
@pytest.mark.verifies("SWR-TRC-045", technique="equivalence_classes", polarity="nominal")
def test_an_openfasttrace_item_begins_where_a_line_begins_with_its_id(head: str, trace: Callable, tmp_path: Path) -> None:
    outcome = check(trace, "oft", tmp_path, "a.md", f"# Stop\n{head}\n\nThe arm shall stop.\n\nCovers:\n* [feat~safe~1](#safe)\n")

    assert [row["id"] for row in outcome.content["items"]] == ["req~stop~1"]
    assert list_rows(outcome, "unknown-id") == [("feat~safe~1", 7)]


@pytest.mark.verifies("SWR-TRC-045", technique="equivalence_classes", polarity="violation")
def test_link_types_of_sphinx_needs_are_those_that_its_schema_names(trace: Callable, tmp_path: Path) -> None:
    """Without default values, a need has no empty list of back links that would show the type."""
    fields = {"shows": {"field_type": "links"}, "shows_back": {"field_type": "backlinks"}, "tags": {"field_type": "core"}}
    needs = {"R_1": {"id": "R_1", "type": "req", "content": "It shall stop.", "tags": ["a"], "shows": ["R_9"]}}
    version = {"needs_defaults_removed": True, "needs_schema": {"properties": fields}, "needs": needs}

    outcome = check(trace, "needs", tmp_path, "needs.json", json.dumps({"current_version": "1", "versions": {"1": version}}, indent=1))

    assert [item for item, _ in list_rows(outcome, "unknown-id")] == ["R_9"]


@pytest.mark.parametrize("schema", [None, 3, {"properties": []}, {"properties": {"shows": 3}}])
@pytest.mark.verifies("SWR-TRC-048", technique="error_guessing", polarity="violation")
def test_a_schema_of_sphinx_needs_that_is_none_names_no_link_type(schema: object, trace: Callable, tmp_path: Path) -> None:
    needs = {"R_1": {"id": "R_1", "type": "req", "content": "It shall stop.", "links": ["R_9"]}}

    outcome = check(trace, "needs", tmp_path, "needs.json", json.dumps({"versions": {"1": {"needs_schema": schema, "needs": needs}}}))

    assert (outcome.status, [item for item, _ in list_rows(outcome, "unknown-id")]) == (1, ["R_9"])


@pytest.mark.parametrize("word", ["Sil.QM", "Arm.Sil.QM"])
@pytest.mark.verifies("SWR-TRC-045", technique="equivalence_classes", polarity="nominal")
def test_a_trlc_enumeration_may_stand_behind_its_package(word: str, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.rsl").write_text("package Arm\nenum Sil { QM }\n", encoding="utf-8")

    outcome = check(trace, "trlc", tmp_path, "a.trlc", f'package Arm\nReq stop {{ description = "It shall stop." sil = {word} }}\n')

    (item,) = outcome.content["items"]
    assert (item["sil"], list_rows(outcome, "unknown-id")) == ("QM", [])


@pytest.mark.verifies("SWR-TRC-050", technique="interface", polarity="violation")
def test_an_openfasttrace_item_comes_back_with_its_own_needs_and_tags(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.md").write_text("# Stop\n`req~stop~1`\n\nThe arm shall stop.\n\nTags: one, two\n\nNeeds: impl, utest\n", encoding="utf-8")
    steps = [("reqif", "oft", "a.md", "b.reqif"), ("oft", "reqif", "b.reqif", "b.md")]
    sent = [trace("export", to, "--format", name, tmp_path / source, "--out", tmp_path / out).status for to, name, source, out in steps]

    outcome = trace("check", "--format", "oft", tmp_path / "b.md", "--output", "json", "--allow-missing")

    assert (sent, outcome.rules) == ([0, 0], {"code-missing", "test-missing"})
    assert "\nTags: one, two\n\nNeeds: impl, utest\n" in (tmp_path / "b.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(("named", "expected"), [(1, [9]), (0, [])], ids=["most-have-one", "none-has-one"])
@pytest.mark.verifies("SWR-TRC-046", technique="equivalence_classes", polarity="violation")
def test_a_strictdoc_requirement_without_a_uid_is_told_where_others_have_one(
    named: int, expected: list[int], trace: Callable, tmp_path: Path
) -> None:
    text = "[DOCUMENT]\nTITLE: Arm\n\n[{}]\nUID: SWR-1\nSTATEMENT: It shall stop.\n\n\n[REQUIREMENT]\nSTATEMENT: It shall stay.\n"

    outcome = check(trace, "strictdoc", tmp_path, "a.sdoc", text.format("REQUIREMENT" if named else "RULE"))

    assert [line for _, line in list_rows(outcome, "malformed-item")] == expected


_REQIF = """<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd"><SPEC-TYPES>
<ATTRIBUTE-DEFINITION-STRING IDENTIFIER="c" LONG-NAME="ReqIF.ChapterName"/><ATTRIBUTE-DEFINITION-STRING IDENTIFIER="t" LONG-NAME="ReqIF.Text"/>
</SPEC-TYPES><SPEC-OBJECTS>
{}
</SPEC-OBJECTS><SPEC-RELATIONS>{}</SPEC-RELATIONS></REQ-IF>
"""
_REF = "<SPEC-OBJECT-REF>{}</SPEC-OBJECT-REF>"
_LINK = f"<SPEC-RELATION><SOURCE>{_REF.format('R-2')}</SOURCE><TARGET>{_REF.format('R-1')}</TARGET></SPEC-RELATION>"


def format_object(name: str, **values: str) -> str:
    cells = "".join(
        f'<ATTRIBUTE-VALUE-STRING THE-VALUE="{value}"><DEFINITION><ATTRIBUTE-DEFINITION-STRING-REF>{key}</ATTRIBUTE-DEFINITION-STRING-REF>'
        "</DEFINITION></ATTRIBUTE-VALUE-STRING>"
        for key, value in values.items()
    )
    return f'<SPEC-OBJECT IDENTIFIER="{name}"><VALUES>{cells}</VALUES></SPEC-OBJECT>'


@pytest.mark.parametrize(
    ("values", "links", "judged"),
    [
        ({"c": "Stops"}, "", ["R-2"]),
        ({"c": "Stops", "t": ""}, "", ["R-2"]),
        ({"c": "", "t": ""}, "", ["R-1", "R-2"]),
        ({"c": "Stops", "t": "It shall stop."}, "", ["R-1", "R-2"]),
        ({"c": "Stops"}, _LINK, ["R-1", "R-2"]),
    ],
    ids=["chapter", "empty-text", "no-name", "text", "linked"],
)
@pytest.mark.verifies("SWR-TRC-046", technique="equivalence_classes", polarity="violation")
def test_a_chapter_of_reqif_is_no_requirement(values: dict[str, str], links: str, judged: list[str], trace: Callable, tmp_path: Path) -> None:
    objects = [format_object("R-1", **values), format_object("R-2", c="", t="It shall stay.")]

    outcome = check(trace, "reqif", tmp_path, "a.reqif", _REQIF.format("\n".join(objects), links))

    assert [row["id"] for row in outcome.content["items"]] == judged


@pytest.mark.verifies("SWR-TRC-045", technique="interface", polarity="violation")
def test_results_that_are_named_twice_all_count(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.md").write_text("# Stop\n`req~stop~1`\n\nThe arm shall stop.\n\nNeeds: utest\n", encoding="utf-8")
    for name, inner in (("a", '<failure message="late"/>'), ("b", "")):
        case = f'<testcase name="{name}"><properties><property name="Verifies" value="req~stop~1"/></properties>{inner}</testcase>'
        (tmp_path / f"{name}.xml").write_text(f"<testsuite>{case}</testsuite>", encoding="utf-8")

    outcome = trace("check", "--format", "oft", tmp_path, "--results", tmp_path / "a.xml", "--results", tmp_path / "b.xml", "--output", "json")

    assert (outcome.status, outcome.get_verdict("req~stop~1")) == (1, "failed")
