# SPDX-License-Identifier: Apache-2.0
# Goal: a change is followed from its lines to functions, requirements, hazards, tests, cases and reviews, on both sides of the change.
# Method: the sample project under git is changed in one way at a time.
from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from git_sample import commit, git, start_history
from trace_sample import Sample, format_item

from mamori_trace.readers.changed_functions import find_touched, list_spans

HEADER = "safety/include/alive.hpp"
SOURCE = "safety/src/alive.cpp"
TEST = "safety/tests/alive_test.cpp"
SOFTWARE = "requirements/software/software.md"
BODY = """#include "alive.hpp"

namespace mamori {

void LateReporter::step() {
    count();
}

template <typename T>
T add(T a, T b) {
    return a + b;
}

}  // namespace mamori
"""


@pytest.fixture
def history(sample: Sample) -> Sample:
    path = sample.root / SOURCE
    path.parent.mkdir()
    path.write_text(BODY, encoding="utf-8")
    start_history(sample.root)
    return sample


def get_ids(content: dict) -> set[str]:
    return {row["id"] for row in content["requirements"]}


def get_parts(content: dict) -> set[tuple[str, str]]:
    return {(row["name"], row["state"]) for row in content["functions"]}


@pytest.mark.verifies("SWR-TRC-070", technique="requirements_based", polarity="nominal")
def test_a_changed_line_touches_the_function_around_it(history: Sample, trace: Callable) -> None:
    history.replace(SOURCE, "    count();\n", "    count();\n    count();\n")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert get_parts(content) == {("LateReporter::step", "changed")}
    assert content["unattributed"] == []


@pytest.mark.verifies("SWR-TRC-070", technique="fault_injection", polarity="violation")
def test_a_removed_function_is_seen_on_the_older_side(history: Sample, trace: Callable) -> None:
    history.replace(SOURCE, "void LateReporter::step() {\n    count();\n}\n\n", "")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert ("LateReporter::step", "removed") in get_parts(content)
    assert {"SWR-SUP-001", "SWR-SUP-002"} <= get_ids(content)


@pytest.mark.verifies("SWR-TRC-070", technique="error_guessing", polarity="violation")
def test_a_renamed_file_keeps_its_functions_and_its_owners(history: Sample, trace: Callable) -> None:
    git(history.root, "mv", SOURCE, "safety/src/other name.cpp")
    history.replace("safety/src/other name.cpp", "count();", "count(2);")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert get_parts(content) == {("LateReporter::step", "changed")}
    assert get_ids(content) == {"SWR-SUP-001", "SWR-SUP-002"}


@pytest.mark.parametrize("name", ["a\nb.cpp", "-p.cpp", 'quo"te.cpp', "umlaut ä.cpp"])
@pytest.mark.verifies("SWR-TRC-070", technique="error_guessing", polarity="violation")
def test_odd_file_names_are_taken_as_they_are(history: Sample, trace: Callable, name: str) -> None:
    (history.root / "safety" / name).write_text("int f() { return 1; }\n", encoding="utf-8")
    commit(history.root, "Odd")
    (history.root / "safety" / name).write_text("int f() { return 2; }\n", encoding="utf-8")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert [(row["file"], row["name"]) for row in content["functions"]] == [(f"safety/{name}", "f")]


@pytest.mark.verifies("SWR-TRC-070", technique="error_guessing", polarity="violation")
def test_text_that_looks_like_a_patch_misleads_nobody(history: Sample, trace: Callable) -> None:
    history.append(SOURCE, "/*\n")
    commit(history.root, "Before")
    history.append(SOURCE, "diff --git a/x b/x\n@@ -1,9 +1,9 @@\n-- gone\n++ come\n*/\n")
    history.replace("tools/offline.py", "Works", "Runs")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert [row["file"] for row in content["functions"]] == [SOURCE, "tools/offline.py"]


@pytest.mark.verifies("SWR-TRC-070", technique="error_guessing", polarity="violation")
def test_changes_of_type_and_mode_do_not_shift_the_lines_of_other_files(history: Sample, trace: Callable) -> None:
    (history.root / HEADER).unlink()
    (history.root / HEADER).symlink_to("elsewhere.hpp")
    (history.root / "docs/design/arm.md").chmod(0o755)
    (history.root / "requirements/README.md").unlink()
    history.replace(SOURCE, "    return a + b;", "    return b + a;")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert [row["name"] for row in content["functions"] if row["file"] == SOURCE] == ["add"]
    assert content["headings"] == []


@pytest.mark.verifies("SWR-TRC-070", technique="error_guessing", polarity="violation")
def test_a_half_done_merge_is_read_as_it_lies_there(history: Sample, trace: Callable) -> None:
    git(history.root, "switch", "-q", "-c", "other")
    history.replace(SOURCE, "count();", "count(1);")
    commit(history.root, "Other")
    git(history.root, "switch", "-q", "main")
    git(history.root, "rm", "-q", SOURCE)
    commit(history.root, "Gone")
    with pytest.raises(subprocess.CalledProcessError):
        git(history.root, "merge", "-q", "other")
    history.replace("tools/offline.py", "Works", "Runs")

    content = trace("impact", "HEAD~1", "--root", history.root, "--output", "json").content

    assert ("tools/offline.py", "(file)") in {(row["file"], row["name"]) for row in content["functions"]}


@pytest.mark.verifies("SWR-TRC-070", technique="requirements_based", polarity="nominal")
def test_new_files_count_before_git_knows_them(history: Sample, trace: Callable) -> None:
    (history.root / "tools" / "more.py").write_text('"""More.\n\n@satisfies SWR-TLS-001\n"""\n\n\ndef run():\n    pass\n')

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert get_parts(content) == {("run", "added"), ("(file)", "added")}
    assert get_ids(content) == {"SWR-TLS-001"}


@pytest.mark.verifies("SWR-TRC-070", technique="equivalence_classes", polarity="nominal")
def test_spans_of_both_languages() -> None:
    cpp = "class A {\n  public:\n    // one\n    int one() { return 1; }\n    void two();\n};\nTEST_F(S, N) {\n}\noperator_less x;\n"
    python = "class A:\n    @mark\n    def one(self):\n        def inner():\n            pass\n\n\ndef test_b():\n    pass\n"

    assert [(span.name, span.first, span.last) for span in list_spans(cpp, "a.hpp")] == [
        ("A", 1, 6), ("A::one", 3, 4), ("A::two", 5, 5), ("S.N", 7, 8)]  # fmt: skip
    assert [(span.name, span.first, span.last, span.is_test) for span in list_spans(python, "a.py")] == [
        ("A", 1, 5, False), ("A.one", 2, 5, False), ("A.one.inner", 4, 5, False), ("test_b", 8, 9, True)]  # fmt: skip


@pytest.mark.verifies("SWR-TRC-070", technique="equivalence_classes", polarity="nominal")
def test_parts_have_the_names_that_owners_and_coverage_know() -> None:
    cpp = (
        "template <int N>\nvoid Ring<N>::push() {\n    struct Inner {\n        int a;\n    };\n}\n"
        "enum class Word { kOne };\nstruct A {\n    A() = default;\n    struct B {\n        int size() const;\n    };\n};\n"
    )

    assert [(span.name, span.first, span.last) for span in list_spans(cpp, "a.cpp")] == [
        ("Ring::push", 1, 6), ("Word", 7, 7), ("A", 8, 13), ("A::A", 9, 9), ("A::B", 10, 12), ("A::B::size", 11, 11)]  # fmt: skip


@pytest.mark.parametrize(
    ("lines", "names", "outside"),
    [((2, 2), ["A"], False), ((4, 4), ["A::one"], False), ((5, 7), ["A", "A::two", "S.N"], False), ((9, 9), [], True), ((8, 9), ["S.N"], True)],
)
@pytest.mark.verifies("SWR-TRC-070", technique="boundary_values", polarity="nominal")
def test_the_innermost_part_is_touched(lines: tuple[int, int], names: list[str], outside: bool) -> None:
    cpp = "class A {\n  public:\n    // one\n    int one() { return 1; }\n    void two();\n};\nTEST_F(S, N) {\n}\nint x;\n"

    touched, beyond = find_touched(list_spans(cpp, "a.hpp"), [lines])

    assert ([span.name for span in touched], beyond) == (names, outside)


@pytest.mark.verifies("SWR-TRC-071", technique="requirements_based", polarity="nominal")
def test_the_chain_goes_up_to_hazards_and_needs(history: Sample, trace: Callable) -> None:
    history.replace(HEADER, "    void step();", "    void step(int count);")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert get_ids(content) == {"SWR-SUP-001", "SWR-SUP-002"}
    assert content["above"] == ["HAZ-001", "STK-001", "SYS-001"]
    assert "SWR-SUP-002 Late" in trace("impact", "HEAD", "--root", history.root).out


@pytest.mark.verifies("SWR-TRC-071", technique="requirements_based", polarity="nominal")
def test_a_changed_heading_touches_the_items_that_link_to_it(history: Sample, trace: Callable) -> None:
    history.append("docs/design/arm.md", "\nThe watchdog watches.\n")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert {row["name"] for row in content["headings"]} == {"arm", "supervision-who-watches"}
    assert get_ids(content) == {"SYS-001"}


@pytest.mark.verifies("SWR-TRC-071", technique="error_guessing", polarity="violation")
def test_what_nobody_owns_is_told_and_not_left_out(history: Sample, trace: Callable) -> None:
    (history.root / "CMakeLists.txt").write_text("project(x)\n")
    (history.root / "tools" / "loose.py").write_text("def f():\n    pass\n")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content
    text = trace("impact", "HEAD", "--root", history.root).out

    assert content["unattributed"] == ["CMakeLists.txt"]
    assert "tools/loose.py: f added (owned by no requirement)" in text


@pytest.mark.verifies("SWR-TRC-072", technique="requirements_based", polarity="nominal")
def test_a_changed_item_names_tests_cases_and_reviews(history: Sample, trace: Callable) -> None:
    history.replace(SOFTWARE, "report a silent entity", "report each silent entity")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content
    history.review()
    after = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert content["items"] == [{"id": "SWR-SUP-001", "state": "changed", "fields": ["statement"]}]
    assert {row["test"] for row in content["tests"]} == {"AliveTest.SilenceIsReported", "AliveTest.SilenceIsNotHealedByOneReport"}
    assert any("AliveTest*.SilenceIsReported*" in command for command in content["commands"])
    assert [(row["child"], row["parent"], row["recorded"]) for row in content["reviews"]] == [
        ("SWR-SUP-001", "HAZ-001", False), ("SWR-SUP-001", "SYS-001", False)]  # fmt: skip
    assert all(row["recorded"] for row in after["reviews"])


@pytest.mark.verifies("SWR-TRC-072", technique="requirements_based", polarity="nominal")
def test_cases_of_a_touched_system_item_run_again(history: Sample, trace: Callable) -> None:
    history.replace("requirements/system/system.md", "when an encoder freezes", "when any encoder freezes")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert content["cases"] == ["no_fault-1", "encoder_freeze-1"]
    assert content["commands"][-1] == "./mamori demo --scenario encoder_freeze no_fault"


@pytest.mark.verifies("SWR-TRC-072", technique="error_guessing", polarity="violation")
def test_added_and_removed_items_and_tests_are_told(history: Sample, trace: Callable) -> None:
    history.append(SOFTWARE, format_item("SWR-SUP-003", "New", "The supervision shall be new.", Parents="SYS-001"))
    text = (history.root / TEST).read_text()
    (history.root / TEST).write_text(text[: text.index("TEST_P")])
    old = git(history.root, "rev-parse", "HEAD")
    new = commit(history.root, "Change")

    content = trace("impact", old, "--to", new, "--root", history.root, "--output", "json").content

    assert content["items"] == [{"id": "SWR-SUP-003", "state": "added", "fields": []}]
    assert [row["test"] for row in content["removed_tests"]] == ["LateTest.LatenessIsReported"]
    assert "SWR-SUP-002" in get_ids(content)
    assert {(row["child"], row["why"]) for row in content["reviews"]} == {("SWR-SUP-003", "new link")}


@pytest.mark.verifies("SWR-TRC-072", technique="error_guessing", polarity="violation")
def test_a_helper_of_tests_touches_the_tests_of_its_folder(history: Sample, trace: Callable) -> None:
    (history.root / "tools" / "tests" / "support.py").write_text("X = 1\n")

    content = trace("impact", "HEAD", "--root", history.root, "--output", "json").content

    assert [row["test"] for row in content["tests"]] == ["test_offline.test_no_connection"]
    assert content["commands"] == [".venv/bin/python -P -m pytest tools/tests/test_offline.py::test_no_connection"]


@pytest.mark.verifies("SWR-TRC-072", technique="error_guessing", polarity="violation")
def test_absent_campaign_evidence_is_told(history: Sample, trace: Callable) -> None:
    shutil.rmtree(history.root / "build")

    outcome = trace("impact", "HEAD", "--root", history.root)

    assert (outcome.status, "no campaign evidence is at hand" in outcome.out) == (0, True)


@pytest.mark.parametrize("revision", ["nowhere", "--output=/tmp/x", "", "HEAD~99", "HEAD:requirements"])
@pytest.mark.verifies("SWR-TRC-073", technique="error_guessing", polarity="violation")
def test_an_unknown_revision_is_one_error(history: Sample, trace: Callable, revision: str) -> None:
    outcome = trace("impact", "--root", history.root, "--", revision)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert "is unknown" in outcome.err


@pytest.mark.verifies("SWR-TRC-073", technique="error_guessing", polarity="violation")
def test_no_repository_and_no_requirements_are_one_error(sample: Sample, trace: Callable) -> None:
    no_repository = trace("impact", "HEAD", "--root", sample.root)
    git(sample.root, "init", "-q")
    git(sample.root, "commit", "-q", "--allow-empty", "-m", "Nothing")
    no_requirements = trace("impact", "HEAD", "--root", sample.root)

    assert (no_repository.status, no_requirements.status) == (2, 2)
    assert "not in a git repository" in no_repository.err
    assert "holds no requirements" in no_requirements.err


@pytest.mark.verifies("SWR-TRC-073", technique="error_guessing", polarity="violation")
def test_a_shallow_clone_says_how_to_mend_it(history: Sample, trace: Callable, tmp_path: Path) -> None:
    commit(history.root, "Second")
    clone = tmp_path / "clone"
    subprocess.run(["git", "clone", "-q", "--depth", "1", history.root.as_uri(), str(clone)], check=True)

    outcome = trace("impact", "HEAD~1", "--root", clone)

    assert (outcome.status, "shallow" in outcome.err) == (2, True)
