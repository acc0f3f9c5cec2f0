# SPDX-License-Identifier: Apache-2.0
# Goal: external files are read with the location of every part; an unreadable part is reported once with its location, never skipped.
# Method: small handwritten projects, valid and invalid, are given to the command.
from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from faulty.generate import generate

from mamori_trace.formats.registry import FORMATS, load_format

_SDOC = """[DOCUMENT]
TITLE: Arm

[[SECTION]]
TITLE: One

[REQUIREMENT]
UID: SYS-1
TITLE: First
STATEMENT: >>>
The arm shall stop.

It shall stay.
<<<
RATIONALE: Persons.

[[/SECTION]]

[REQUIREMENT]
UID: SWR-1
STATEMENT: The software shall stop the arm.
RELATIONS:
- TYPE: Parent
  VALUE: SYS-1
  ROLE: Refines
"""
_OFT = """# Arm
## Stop
`req~stop~1`

The arm shall stop.

Needs: impl, utest
"""
_NEEDS = '{"current_version": "1", "versions": {"1": {"needs": {\n"R_1": {"id": "R_1", "title": "Stop", "type": "req", "content": "It shall stop."}\n}}}}\n'
_TRLC = """package Arm
import Base
// A note.
section "One" {
  Requirement stop {
    description = \"\"\"The arm
      shall stop.\"\"\"
    sil = Sil.QM
    sources = [(1, "x"), (2, "y")]
    parents = [Base.top @ 3, other]
  }
}
"""
_ITEM = """active: true
links:
- SYS001: abc
- SYS002
normative: true
text: |
  The software shall stop.
"""
_MARKDOWN = """---
active: true
links: []
---

# Stop

The software shall stop.
"""
_WHOLE = {"strictdoc": ("a.sdoc", _SDOC), "oft": ("a.md", _OFT), "needs": ("needs.json", _NEEDS), "trlc": ("a.trlc", _TRLC)}


def _write(folder: Path, name: str, text: str | bytes) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


@pytest.mark.parametrize(
    ("name", "file", "text", "place", "word"),
    [
        ("strictdoc", "a.sdoc", _SDOC.partition("<<<")[0], "a.sdoc:10", "cut off"),
        ("strictdoc", "a.sdoc", "UID: X\n", "a.sdoc:1", "[DOCUMENT]"),
        ("strictdoc", "a.sdoc", _SDOC + "what is this\n", "a.sdoc:26", "what is this"),
        ("strictdoc", "a.sdoc", _SDOC.encode() + b"\n[TEXT]\nSTATEMENT: \xff\n", "a.sdoc:28", "UTF-8"),
        ("needs", "needs.json", _NEEDS[:60], "needs.json:2", "JSON"),
        ("needs", "needs.json", "[" * 100000, "needs.json:1", "nested"),
        ("needs", "needs.json", '{"current_version": "1"}', "needs.json:1", "versions"),
        ("needs", "needs.json", '{"versions": {"1": {"needs": {\n"R_1": 7}}}}', "needs.json:2", "R_1"),
        ("needs", "needs.json", b'{"versions": {\n"\xfe": 1}}', "needs.json:2", "UTF-8"),
        ("oft", "a.md", _OFT + "```\nopen\n", "a.md:9", "cut off"),
        ("oft", "a.md", _OFT + "`req~stop~one`\n", "a.md:8", "req~stop~one"),
        ("oft", "a.md", _OFT + "\0", "a.md:8", "zero byte"),
        ("trlc", "a.trlc", _TRLC.partition("  }")[0], "a.trlc:11", "cut off"),
        ("trlc", "a.trlc", _TRLC.replace("sil =", "sil ?"), "a.trlc:8", "?"),
        ("trlc", "a.trlc", "section", "a.trlc:1", "section"),
        ("trlc", "a.trlc", "package A\nT a { x = " + "[" * 500, "a.trlc:2", "["),
        ("trlc", "a.trlc", "package A\n" + 'section "s" {' * 500, "a.trlc:2", "section"),
        ("trlc", "a.trlc", b"package A\n// \xff", "a.trlc:2", "UTF-8"),
        ("doorstop", "SWR001.yml", "text: [\n", "SWR001.yml:2", "YAML"),
        ("doorstop", "SWR001.yml", "- a\n", "SWR001.yml:1", "table"),
        ("doorstop", "SWR001.yml", "a: " + "[" * 5000, "SWR001.yml:1", "YAML"),
        ("doorstop", "SWR001.yml", "a: " + "[" * 100000, "SWR001.yml:1", "YAML"),
        ("doorstop", "SWR001.yml", "- " * 100000, "SWR001.yml:1", "YAML"),
        ("doorstop", "SWR001.yml", b"text: \xff\n", "SWR001.yml:1", "UTF-8"),
        ("doorstop", "SWR001.md", "text\n", "SWR001.md:1", "head"),
        ("doorstop", "SWR001.md", "---\na: b: c\n---\n", "SWR001.md:2", "YAML"),
    ],
)
@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="violation")
def test_a_broken_file_is_one_finding_with_its_line(
    name: str, file: str, text: str | bytes, place: str, word: str, trace: Callable, tmp_path: Path
) -> None:
    _write(tmp_path, file, text)
    if name == "doorstop":
        _write(tmp_path, ".doorstop.yml", "settings:\n  prefix: SWR\n")

    outcome = trace("check", "--format", name, tmp_path, "--output", "json", "--allow-missing")

    broken = [row for row in outcome.content["findings"] if row["rule"] == "unreadable-input"]
    assert (outcome.status, len(broken)) == (2, 1)
    assert f"{broken[0]['file']}:{broken[0]['line']}" == place
    assert word in broken[0]["message"]


@pytest.mark.parametrize("name", _WHOLE)
@pytest.mark.verifies("SWR-TRC-048", technique="error_guessing", polarity="violation")
def test_the_wrong_format_an_empty_folder_and_no_folder_are_named_in_one_line(name: str, trace: Callable, tmp_path: Path) -> None:
    other = "oft" if name != "oft" else "needs"
    _write(tmp_path / "full", *_WHOLE[name])
    (tmp_path / "empty").mkdir()

    wrong = trace("check", "--format", other, tmp_path / "full")
    empty = trace("check", "--format", name, tmp_path / "empty")
    gone = trace("check", "--format", name, tmp_path / "gone")

    assert [(each.status, each.out, each.err.count("\n")) for each in (wrong, empty, gone)] == [(2, "", 1)] * 3
    assert f"--format {name}" in wrong.err
    assert "empty" in empty.err
    assert "no such" in gone.err


@pytest.mark.parametrize("name", _WHOLE)
@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="nominal")
def test_a_ring_of_links_to_folders_is_read_once(name: str, trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, *_WHOLE[name])
    (tmp_path / "round").symlink_to(tmp_path, target_is_directory=True)

    outcome = trace("check", "--format", name, tmp_path, "--output", "json", "--allow-missing")

    assert "duplicate-id" not in outcome.rules
    assert len(outcome.content["items"]) == (2 if name == "strictdoc" else 1)


@pytest.mark.parametrize("name", _WHOLE)
@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="violation")
def test_two_files_that_claim_one_id_are_both_named(name: str, trace: Callable, tmp_path: Path) -> None:
    file, text = _WHOLE[name]
    _write(tmp_path / "a", file, text)
    _write(tmp_path / "b", file, text)

    outcome = trace("check", "--format", name, tmp_path, "--output", "json", "--allow-missing")

    doubles = [row for row in outcome.content["findings"] if row["rule"] == "duplicate-id"]
    assert {row["file"] for row in doubles} == {f"b/{file}"}
    assert all(f"a/{file}" in row["message"] for row in doubles)


@pytest.mark.parametrize("folder", ["docs", "."])
@pytest.mark.verifies("SWR-TRC-045", technique="equivalence_classes", polarity="nominal")
def test_needs_on_one_line_are_placed_in_their_source(folder: str, trace: Callable, tmp_path: Path) -> None:
    """In the form of sphinx-needs 9; back links identify a link type of the project itself."""
    row = {"content": "It shall stop.", "docname": "arm/stop", "doctype": ".rst", "links": [], "links_back": [], "type": "req"}
    rows = {"R_1": {**row, "id": "R_1", "lineno": 3, "shows": [], "shows_back": []},
            "R_2": {**row, "id": "R_2", "lineno": 9, "shows": ["R_9"], "shows_back": []}}
    _write(tmp_path, "build/needs/needs.json", json.dumps({"current_version": "", "versions": {"": {"needs": rows}}}))
    _write(tmp_path, f"{folder}/arm/stop.rst", "Stop\n")

    outcome = trace("check", "--format", "needs", tmp_path / "build" / "needs" / "needs.json", "--root", tmp_path, "--output", "json", "--allow-missing")

    source = "arm/stop.rst" if folder == "." else "docs/arm/stop.rst"
    unknown = [(row["item"], row["file"], row["line"]) for row in outcome.content["findings"] if row["rule"] == "unknown-id"]
    assert unknown == [("R_9", source, 9)]


@pytest.mark.verifies("SWR-TRC-045", technique="equivalence_classes", polarity="nominal")
def test_trlc_values_are_told_apart(trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.trlc", _TRLC)
    _write(tmp_path, "a.rsl", "package Arm\nenum Sil { QM }\n")

    outcome = trace("check", "--format", "trlc", tmp_path, "--output", "json", "--allow-missing")

    (item,) = outcome.content["items"]
    unknown = [row["item"] for row in outcome.content["findings"] if row["rule"] == "unknown-id"]
    assert (item["id"], item["statement"].split(), item["sil"]) == ("Arm.stop", ["The", "arm", "shall", "stop."], "QM")
    assert unknown == ["Arm.other", "Base.top"]


@pytest.mark.verifies("SWR-TRC-045", technique="equivalence_classes", polarity="nominal")
def test_doorstop_items_may_be_yaml_or_markdown(trace: Callable, tmp_path: Path) -> None:
    for prefix in ("SYS", "SWR"):
        _write(tmp_path, f"{prefix}/.doorstop.yml", f"settings:\n  prefix: {prefix}\n")
    _write(tmp_path, "SYS/SYS001.md", _MARKDOWN)
    _write(tmp_path, "SYS/SYS003.yml", "normative: false\ntext: A heading\n")
    _write(tmp_path, "SWR/SWR001.yml", _ITEM)
    _write(tmp_path, "loose.yml", "text: No item\n")

    outcome = trace("check", "--format", "doorstop", tmp_path, "--output", "json", "--allow-missing")

    items = {row["id"]: row for row in outcome.content["items"]}
    assert {key: (row["title"], row["statement"]) for key, row in items.items()} == {
        "SYS001": ("Stop", "The software shall stop."), "SWR001": ("SWR001", "The software shall stop.")}  # fmt: skip
    unknown = [(row["item"], row["line"]) for row in outcome.content["findings"] if row["rule"] == "unknown-id"]
    assert unknown == [("SYS002", 3)]


@pytest.mark.parametrize("arguments", [("--format", "word", "."), ("--results", "x.xml"), ("--format", "oft", ".", "--sources", "gone")])
@pytest.mark.verifies("SWR-TRC-048", technique="error_guessing", polarity="violation")
def test_wrong_words_of_the_command_are_one_line(arguments: tuple[str, ...], trace: Callable) -> None:
    outcome = trace("check", *arguments)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)


@pytest.mark.verifies("SWR-TRC-046", technique="requirements_based", polarity="nominal")
def test_a_table_of_the_user_says_what_the_levels_are(trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.sdoc", _SDOC)
    table = _write(tmp_path, "levels.toml", 'schema = "mamori.foreign/1"\n[level.SYS]\nname = "Upper"\n[level.SWR]\nparents = ["SYS"]\n')

    outcome = trace("check", "--format", "strictdoc", tmp_path, "--schema", table, "--output", "json")
    shown = trace("show", "SWR-1", "--format", "strictdoc", tmp_path, "--schema", table)

    assert (outcome.rules, "SYS-1 First" in shown.out) == ({"test-missing"}, True)


@pytest.mark.parametrize(
    "text",
    ["schema = ", 'schema = "other/1"', 'schema = "mamori.foreign/1"\ncolour = 1', 'schema = "mamori.foreign/1"\ngroup_by = "x"',
     'schema = "mamori.foreign/1"\nsil = 3', 'schema = "mamori.foreign/1"\n[level.SYS]\nid = "("'],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-046", technique="error_guessing", polarity="violation")
def test_a_bad_table_is_one_line(text: str, trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.sdoc", _SDOC)
    table = _write(tmp_path, "levels.toml", text)

    outcome = trace("check", "--format", "strictdoc", tmp_path, "--schema", table)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert "levels.toml" in outcome.err


@pytest.mark.verifies("SWR-TRC-046", technique="requirements_based", polarity="violation")
def test_items_of_no_level_of_the_table_are_told(trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.sdoc", _SDOC)
    table = _write(tmp_path, "levels.toml", 'schema = "mamori.foreign/1"\n[level.SYS]\n')

    outcome = trace("check", "--format", "strictdoc", tmp_path, "--schema", table, "--output", "json", "--allow-missing")

    assert [row["item"] for row in outcome.content["findings"] if row["rule"] == "malformed-item"] == ["SWR-1"]


@pytest.mark.parametrize(
    ("tag", "file", "symbol"),
    [
        ("/// @relation(SWR-1, scope=function)", "src/a.cpp", "stop"),
        ("// @satisfies SWR-1", "src/a.cpp", "stop"),
        ("// lobster-trace: SWR-1", "src/a.hpp", "stop"),
        ("// @need-ids: SWR-1", "src/a.c", "stop"),
        ("// @relation(SWR-1)", "src/a.rs", "file"),
        ("// @relation(SWR-1)", "src/a.scala", "file"),
        ("# @relation(SWR-1)", "src/a.rb", "file"),
        ("-- @relation(SWR-1)", "src/a.adb", "file"),
    ],
)
@pytest.mark.verifies("SWR-TRC-047", technique="equivalence_classes", polarity="nominal")
def test_a_tag_of_another_tool_belongs_to_the_function_below(tag: str, file: str, symbol: str, trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.sdoc", _SDOC)
    _write(tmp_path, file, f"{tag}\nint stop(void) {{ return 0; }}\n")

    outcome = trace("show", "SWR-1", "--format", "strictdoc", tmp_path, "--allow-missing")

    assert f"{file}:1 ({symbol})" in outcome.out


@pytest.mark.verifies("SWR-TRC-047", technique="equivalence_classes", polarity="nominal")
def test_python_tags_and_tests_are_read_too(trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.sdoc", _SDOC)
    _write(tmp_path, "stop.py", 'def stop():\n    """Stops.\n\n    @relation(SWR-1, scope=function)\n    """\n')
    _write(tmp_path, "tests/test_stop.py", "class TestStop:\n    # @verifies SWR-1\n    def test_it_stops(self):\n        pass\n")
    case = '<testsuite><testcase classname="tests.test_stop.TestStop" name="test_it_stops"/></testsuite>'
    results = _write(tmp_path, "junit.xml", case)

    outcome = trace("check", "--format", "strictdoc", tmp_path, "--results", results)
    shown = trace("show", "SWR-1", "--format", "strictdoc", tmp_path, "--results", results)

    assert outcome.status == 0, outcome.out
    assert "stop.py:4 (stop)" in shown.out
    assert "passed  tests.test_stop.TestStop.test_it_stops" in shown.out


@pytest.mark.verifies("SWR-TRC-047", technique="error_guessing", polarity="violation")
def test_words_in_code_that_are_no_comments_are_no_tags(trace: Callable, tmp_path: Path) -> None:
    _write(tmp_path, "a.sdoc", _SDOC)
    _write(tmp_path, "src/a.cpp", 'const char* text = "@relation(SWR-9, scope=function)";\nint f(A* a) { return a->b[x->y]; }\n')
    _write(tmp_path, "src/b.py", 'TEXT = "@satisfies SWR-9"\n')

    outcome = trace("check", "--format", "strictdoc", tmp_path, "--output", "json", "--allow-missing")

    assert "unknown-id" not in outcome.rules


@pytest.mark.verifies("SWR-TRC-045", technique="interface", polarity="nominal")
def test_links_of_a_foreign_project_are_reviewed_beside_it(trace: Callable, tmp_path: Path) -> None:
    generate("strictdoc", "", tmp_path)
    chosen = ("--format", "strictdoc", tmp_path)
    before = trace("review", *chosen, "--all", "--by", "the maintainers")
    file = tmp_path / "docs" / "stk.sdoc"
    file.write_text(file.read_text().replace("control of unit 3.", "control of unit 33."))

    changed = trace("check", *chosen, "--results", tmp_path / "results", "--output", "json")
    again = trace("review", *chosen, "STK-003", "--by", "the maintainers")
    after = trace("check", *chosen, "--results", tmp_path / "results")

    assert (before.status, changed.rules, again.status, after.status) == (0, {"suspect-link"}, 0, 0)
    assert f"`mamori trace review --format strictdoc {tmp_path} " in changed.content["findings"][0]["message"]
    assert (tmp_path / "trace.lock").is_file()


@pytest.mark.verifies("SWR-TRC-045", technique="interface", polarity="nominal")
def test_the_report_shows_a_foreign_project(trace: Callable, tmp_path: Path) -> None:
    project = generate("oft", "", tmp_path / "project")

    outcome = trace("report", *project.arguments, "--out", tmp_path / "page.html")

    assert (outcome.status, "dsn~item-007~1" in (tmp_path / "page.html").read_text()) == (0, True)


@pytest.mark.verifies("SWR-TRC-045", technique="interface", polarity="nominal")
@pytest.mark.parametrize("name", FORMATS)
def test_a_format_is_loaded_by_the_name_that_it_gives_itself(name: str) -> None:
    assert name == load_format(name).NAME
