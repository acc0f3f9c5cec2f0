# SPDX-License-Identifier: Apache-2.0
# Goal: tags at tests in other languages find the results of these tests; tags without a result are reported, never ignored.
# Method: a small OpenFastTrace project with one test file and one result is given to the command.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Outcome

_SPEC = "## Stop\n`req~stop~1`\n\nThe arm shall stop.\n\nNeeds: utest\n"
_TAG = "// [utest->req~stop~1]"
_JAVA = f"package a;\nclass StopTest {{\n    void helper() {{}}\n    {_TAG}\n    @Test\n    void stops() {{}}\n}}\n"
_KOTLIN = f"class StopTest {{\n    {_TAG}\n    @Test\n    fun `it stops`() {{}}\n}}\n"
_GO = f"package stop\n\n{_TAG}\nfunc TestStop(t *testing.T) {{}}\n"


def check(trace: Callable[..., Outcome], folder: Path, file: str, source: str, case: str) -> Outcome:
    for name, text in (("spec.md", _SPEC), (file, source), ("junit.xml", f"<testsuite>\n{case}\n</testsuite>\n")):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return trace("check", "--format", "oft", folder, "--results", folder / "junit.xml", "--output", "json")


@pytest.mark.parametrize(
    ("file", "source", "head"),
    [
        ("src/test/java/a/StopTest.java", _JAVA, 'classname="a.StopTest" name="stops"'),
        ("src/test/java/a/StopTest.java", _JAVA, 'classname="a.StopTest" name="stops(int)[1]"'),
        ("src/test/java/a/StopTest.java", _JAVA.replace("@Test", "@ParameterizedTest").replace("void stops", "public void stops"),
         'classname="a.StopTest" name="stops()"'),
        ("src/test/kotlin/StopTest.kt", _KOTLIN, 'classname="StopTest" name="it stops"'),
        ("stop/stop_test.go", _GO, 'classname="example.org/arm/stop" name="TestStop"'),
    ],
    ids=["surefire", "parameters", "gradle", "kotlin", "go"],
)  # fmt: skip
@pytest.mark.parametrize(("inner", "status", "verdict"), [("", 0, "verified"), ('<failure message="late"/>', 1, "failed")])
@pytest.mark.verifies("SWR-TRC-047", technique="equivalence_classes", polarity="nominal")
def test_a_result_counts_for_the_tag_at_its_test(
    file: str, source: str, head: str, inner: str, status: int, verdict: str, trace: Callable, tmp_path: Path
) -> None:
    outcome = check(trace, tmp_path, file, source, f"<testcase {head}>{inner}</testcase>")

    assert (outcome.status, outcome.get_verdict("req~stop~1")) == (status, verdict)


@pytest.mark.parametrize(
    ("file", "source", "line"),
    [
        ("src/test/java/a/StopTest.java", _JAVA, 4),
        ("src/test/java/a/StopTest.java", f"{_TAG}\nclass StopTest {{\n    @Test\n    void stops() {{}}\n}}\n", 1),
        ("tests/stop.rs", f"{_TAG}\n#[test]\nfn stops() {{}}\n", 1),
    ],
    ids=["not-run", "at-the-class", "language-not-known"],
)
@pytest.mark.verifies("SWR-TRC-047", technique="error_guessing", polarity="violation")
def test_a_tag_that_no_result_answers_is_told(file: str, source: str, line: int, trace: Callable, tmp_path: Path) -> None:
    outcome = check(trace, tmp_path, file, source, '<testcase classname="a.Other" name="other"/>')

    missing = [(row["file"], row["line"], row["item"]) for row in outcome.content["findings"] if row["rule"] == "result-missing"]
    assert (outcome.status, missing) == (1, [(file, line, "req~stop~1")])
    assert outcome.get_verdict("req~stop~1") != "verified"


_SDOC = """[DOCUMENT]
TITLE: Arm

[REQUIREMENT]
UID: SWR-1
STATEMENT: The software shall stop.
RELATIONS:
- TYPE: File
  VALUE: src/stop.c
- TYPE: File
  VALUE: tests/test_stop.py
"""
_DOORSTOP = """active: true
references:
- path: src/stop.c
  type: file
- path: tests/test_stop.py
  type: file
text: |
  The software shall stop.
"""
_CASE = '<testsuite><testcase classname="tests.test_stop" name="test_stop">{}</testcase></testsuite>'


def write_linked(folder: Path, name: str) -> Path:
    """A requirement that names its code and its test by files. @return the folder of the requirements."""
    docs = folder / "docs"
    texts = {"src/stop.c": "int stop(void) { return 0; }\n", "tests/test_stop.py": "def test_stop():\n    pass\n"}
    own = {"docs/a.sdoc": _SDOC} if name == "strictdoc" else {"docs/.doorstop.yml": "settings:\n  prefix: SWR\n", "docs/SWR1.yml": _DOORSTOP}
    for file, text in {**texts, **own}.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(text, encoding="utf-8")
    return docs


@pytest.mark.parametrize("name", ["strictdoc", "doorstop"])
@pytest.mark.parametrize(("inner", "status", "verdict"), [("", 0, "verified"), ('<failure message="late"/>', 1, "failed")])
@pytest.mark.verifies("SWR-TRC-047", technique="equivalence_classes", polarity="nominal")
def test_a_link_to_a_file_counts_for_its_code_and_tests(
    name: str, inner: str, status: int, verdict: str, trace: Callable, tmp_path: Path
) -> None:
    docs = write_linked(tmp_path, name)
    (tmp_path / "junit.xml").write_text(_CASE.format(inner), encoding="utf-8")

    outcome = trace("check", "--format", name, docs, "--root", tmp_path, "--results", tmp_path / "junit.xml", "--output", "json")

    assert (outcome.status, [row["verdict"] for row in outcome.content["items"]]) == (status, [verdict])


@pytest.mark.parametrize(("name", "lines"), [("strictdoc", [9, 11]), ("doorstop", [3, 5])])
@pytest.mark.verifies("SWR-TRC-047", technique="error_guessing", polarity="violation")
def test_a_link_to_a_file_that_is_not_there_is_told(name: str, lines: list[int], trace: Callable, tmp_path: Path) -> None:
    docs = write_linked(tmp_path, name)
    (tmp_path / "src" / "stop.c").unlink()
    (tmp_path / "tests" / "test_stop.py").unlink()

    outcome = trace("check", "--format", name, docs, "--root", tmp_path, "--allow-missing", "--output", "json")

    assert [row["line"] for row in outcome.content["findings"] if row["rule"] == "unknown-id"] == lines
    assert {"code-missing", "test-missing"} <= outcome.rules
