# SPDX-License-Identifier: Apache-2.0
# Goal: an id is allocated only once in the life of a project; a draft is well-formed or not written.
from __future__ import annotations

from collections.abc import Callable

import pytest
from git_sample import commit, git, start_history
from trace_sample import Sample, format_item

from mamori_trace.base.errors import FormatError
from mamori_trace.model.new_item import allocate
from mamori_trace.readers.project import read_requirements

SOFTWARE = "requirements/software/software.md"
NEW = ("new", "SWR", "--area", "SUP", "--parents", "SYS-001")


@pytest.mark.verifies("SWR-TRC-078", technique="requirements_based", polarity="nominal")
def test_a_draft_is_printed_with_the_next_id(sample: Sample, trace: Callable) -> None:
    outcome = trace(*NEW, "--title", "Early", "--root", sample.root)

    assert outcome.status == 0
    assert outcome.out.startswith("## SWR-SUP-003 Early\n\nThe item shall be stated.\n\n- Rationale: ")
    for row in ("- Parents: SYS-001\n", "- SIL: 2\n", "- Status: draft\n"):
        assert row in outcome.out
    assert "no history" in outcome.err


@pytest.mark.verifies("SWR-TRC-078", technique="requirements_based", polarity="nominal")
def test_an_appended_draft_is_read_without_a_finding(sample: Sample, trace: Callable) -> None:
    start_history(sample.root)
    file = sample.root / SOFTWARE

    outcome = trace(*NEW, "--root", sample.root, "--file", file)
    sample.review()

    place = outcome.out.strip().removeprefix("SWR-SUP-003 in ")
    line = int(place.rpartition(":")[2])
    assert (outcome.status, outcome.err) == (0, "")
    assert file.read_text().splitlines()[line - 1] == "## SWR-SUP-003 New item"
    project = read_requirements(sample.root)
    assert project.problems == []
    assert project.items["SWR-SUP-003"].status == "draft"


@pytest.mark.verifies("SWR-TRC-078", technique="fault_injection", polarity="violation")
def test_an_id_of_another_branch_or_of_the_past_is_not_used_again(sample: Sample, trace: Callable) -> None:
    start_history(sample.root)
    git(sample.root, "switch", "-q", "-c", "other")
    sample.append(SOFTWARE, format_item("SWR-SUP-007", "Other", "The supervision shall be other.", Parents="SYS-001"))
    commit(sample.root, "Other")
    git(sample.root, "switch", "-q", "main")
    other = trace(*NEW, "--root", sample.root)
    sample.append(SOFTWARE, format_item("SWR-SUP-011", "Past", "The supervision shall be past.", Parents="SYS-001"))
    commit(sample.root, "Come")
    git(sample.root, "revert", "--no-edit", "HEAD")
    past = trace(*NEW, "--root", sample.root)

    assert other.out.startswith("## SWR-SUP-008 ")
    assert past.out.startswith("## SWR-SUP-012 ")


@pytest.mark.verifies("SWR-TRC-078", technique="fault_injection", polarity="violation")
def test_an_id_that_only_the_lock_knows_is_not_used_again(sample: Sample, trace: Callable) -> None:
    sample.append("requirements/trace.lock", "SWR-SUP-020 000000000000 SYS-001 000000000000 2026-11-21 Somebody\n")

    assert trace(*NEW, "--root", sample.root).out.startswith("## SWR-SUP-021 ")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("new", "SWQ"), "nearest: SWR"),
        (("new", "SWR", "--parents", "SYS-001"), "SUP, TLS"),
        (("new", "SWR", "--area", "SUQ", "--parents", "SYS-001"), "nearest: SUP"),
        (("new", "SWR", "--area", "S", "--new-area"), "cannot be an area"),
        (("new", "SYS", "--area", "SUP", "--parents", "STK-001"), "no area"),
        (("new", "SWR", "--area", "SUP", "--parents", "SYS-01"), "nearest: SYS-001"),
        (("new", "SWR", "--area", "SUP"), "--parents"),
        (("new", "SWR", "--area", "SUP", "--parents", "SWR-SUP-001"), "of level SWR"),
        ((*NEW, "--sil", "9"), "SIL"),
        ((*NEW, "--title", "a\n## SWR-SUP-099 b"), "SWR-SUP-003"),
        ((*NEW, "--statement", "# x"), "statement"),
        ((*NEW, "--file", "/etc/passwd"), "below"),
        ((*NEW, "--file", "requirements/README.md"), "below"),
        ((*NEW, "--file", "requirements/loop.md"), "loop of links"),
    ],
)
@pytest.mark.verifies("SWR-TRC-078", technique="error_guessing", polarity="violation")
def test_what_cannot_be_is_one_error_and_changes_nothing(
    sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], word: str
) -> None:
    monkeypatch.chdir(sample.root)
    if "requirements/loop.md" in arguments:
        (sample.root / "requirements" / "loop.md").symlink_to("loop.md")
    before = {path: path.read_bytes() for path in sample.root.rglob("*") if path.is_file()}

    outcome = trace(*arguments)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert word in outcome.err
    assert {path: path.read_bytes() for path in sample.root.rglob("*") if path.is_file()} == before


@pytest.mark.verifies("SWR-TRC-078", technique="boundary_values", polarity="violation")
def test_the_numbers_end_at_999() -> None:
    assert allocate("SYS-", ["SYS-998 SYS-1234"]) == "SYS-999"
    with pytest.raises(FormatError):
        allocate("SYS-", ["SYS-999"])


@pytest.mark.verifies("SWR-TRC-078", technique="requirements_based", polarity="nominal")
def test_a_new_area_and_a_new_file_begin_together(sample: Sample, trace: Callable) -> None:
    file = sample.root / "requirements" / "software" / "new_things.md"

    outcome = trace("new", "SWR", "--area", "NEW", "--new-area", "--parents", "SYS-003", "--root", sample.root, "--file", file)

    assert outcome.status == 0
    assert file.read_text().startswith("# New things\n\n## SWR-NEW-001 New item\n")
    assert "- SIL: QM\n" in file.read_text()


@pytest.mark.verifies("SWR-TRC-078", technique="error_guessing", polarity="violation")
def test_a_file_of_other_bytes_stays_as_it_is(sample: Sample, trace: Callable) -> None:
    file = sample.root / "requirements" / "software" / "bytes.md"
    file.write_bytes(b"# \xff\n")

    outcome = trace(*NEW, "--root", sample.root, "--file", file)

    assert (outcome.status, file.read_bytes()) == (2, b"# \xff\n")
