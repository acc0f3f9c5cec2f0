# SPDX-License-Identifier: Apache-2.0
# Goal: each error of the operating system is reported in one line with its remedy, is never treated as absence, and leaves all files
# unchanged.
# Method: unusable links, names and paths. Unlistable folders are simulated, because the superuser can list every folder.
from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample

from mamori_trace.base.system_error import _REASONS, describe
from mamori_trace.base.write import write_whole
from mamori_trace.command import main

LOCK = "requirements/trace.lock"
NEW = ("new", "SWR", "--area", "SUP", "--parents", "SYS-001")


def _move_behind_link(path: Path, target: Path) -> None:
    target.parent.mkdir(parents=True)
    path.rename(target)
    path.symlink_to(os.path.relpath(target, path.parent))


def _refuse_listing(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Behaves like a user without permission for `folder`."""
    for name in ("scandir", "listdir"):
        real = getattr(os, name)

        def refuse(path: str | os.PathLike[str] | int = ".", real: Callable = real) -> object:
            if not isinstance(path, int) and os.path.abspath(os.fspath(path)) == str(folder):
                raise PermissionError(errno.EACCES, "Permission denied", str(path))
            return real(path)

        monkeypatch.setattr(os, name, refuse)


@pytest.mark.verifies("SWR-TRC-095", technique="requirements_based", polarity="nominal")
def test_a_review_writes_through_a_link_and_keeps_the_rights_of_the_file(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    link, target = sample.root / LOCK, tmp_path / "shared" / "links.lock"
    _move_behind_link(link, target)
    target.chmod(0o640)
    sample.replace("requirements/system/system.md", "The tool shall run offline.", "The tool shall run alone.")

    outcome = trace("review", "SYS-003", "--by", "Somebody Else", "--root", sample.root)

    assert (outcome.status, link.is_symlink(), target.stat().st_mode & 0o777) == (0, True, 0o640)
    assert "Somebody Else" in target.read_text()
    assert [path.name for path in target.parent.iterdir()] == ["links.lock"]
    assert trace("check", "--root", sample.root).status == 0


@pytest.mark.verifies("SWR-TRC-095", technique="requirements_based", polarity="nominal")
def test_a_draft_is_appended_through_a_link(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    link, target = sample.root / "requirements" / "software" / "software.md", tmp_path / "shared" / "software.md"
    _move_behind_link(link, target)

    outcome = trace(*NEW, "--root", sample.root, "--file", link)

    assert (outcome.status, link.is_symlink()) == (0, True)
    assert "## SWR-SUP-003 New item\n" in target.read_text()


@pytest.mark.verifies("SWR-TRC-095", technique="equivalence_classes", polarity="nominal")
def test_a_link_to_a_file_that_is_not_there_yet_gets_it(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("file")

    write_whole(tmp_path / "link", "text")

    assert ((tmp_path / "file").read_text(), (tmp_path / "link").is_symlink()) == ("text", True)


@pytest.mark.parametrize(("target", "words"), [("link", "loop of links"), ("gone/file", "no such folder"), (".", "folder or a device")])
@pytest.mark.verifies("SWR-TRC-095", technique="error_guessing", polarity="violation")
def test_a_link_that_leads_nowhere_is_refused_and_stays(target: str, words: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(target)

    outcome = trace("export", "csv", "--out", tmp_path / "link", "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n"), words in outcome.err) == (2, 1, True), outcome.err
    assert sorted(os.listdir(tmp_path)) == ["link", "project"]
    assert os.readlink(tmp_path / "link") == target


@pytest.mark.verifies("SWR-TRC-095", technique="fault_injection", polarity="violation")
def test_a_file_that_cannot_be_written_whole_is_as_it_was(tmp_path: Path, sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    before = (sample.root / LOCK).read_bytes()
    sample.replace("requirements/system/system.md", "The tool shall run offline.", "The tool shall run alone.")

    def fill(path: Path, data: bytes) -> int:
        path.touch()
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(Path, "write_bytes", fill)
    outcome = trace("review", "--all", "--by", "Somebody", "--root", sample.root)

    assert (outcome.status, outcome.err) == (2, f"mamori trace: {sample.root / LOCK}: cannot be written: no room is left on the disk; "
                                                "make room, then call again\n")  # fmt: skip
    assert (sample.root / LOCK).read_bytes() == before
    assert not list((sample.root / "requirements").glob(".*"))


@pytest.mark.verifies("SWR-TRC-049", technique="fault_injection", polarity="violation")
def test_an_import_without_its_reviews_takes_its_files_back(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    trace("export", "reqif", "--out", tmp_path / "a.reqif", "--root", sample.root)
    empty = tmp_path / "empty"
    (empty / "requirements").mkdir(parents=True)
    (sample.root / "requirements" / "schema").rename(empty / "requirements" / "schema")
    (empty / LOCK).symlink_to("nowhere/trace.lock")

    outcome = trace("import", "reqif", tmp_path / "a.reqif", "--into", "requirements/taken", "--root", empty)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert not [path for path in (empty / "requirements" / "taken").rglob("*") if path.is_file()]


@pytest.mark.parametrize("number", sorted(_REASONS))
@pytest.mark.verifies("SWR-TRC-009", technique="equivalence_classes", polarity="violation")
def test_a_refusal_names_the_path_and_the_remedy_without_a_number(number: int) -> None:
    words = describe(OSError(number, os.strerror(number), "some/file"))

    assert words.startswith("some/file: ")
    assert ("Errno" in words, words.count("; "), "\n" in words) == (False, 1, False)


@pytest.mark.verifies("SWR-TRC-009", technique="equivalence_classes", polarity="violation")
def test_a_refusal_without_a_path_or_of_another_kind_keeps_the_words_of_the_system() -> None:
    assert describe(OSError(errno.ENXIO, "No such device", "f")) == "f: No such device; mend it, then call again"
    assert describe(OSError(errno.ENOENT, "No usable folder")) == "No usable folder; mend it, then call again"
    assert describe(OSError("it is no file")) == "it is no file"


@pytest.mark.parametrize("out", ["project/README.md/index.html", "n" * 300, "/proc/nowhere/index.html"])
@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_a_place_that_takes_no_file_is_one_clear_line(out: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (sample.root / "README.md").write_text("")

    outcome = trace("export", "json", "--root", sample.root, "--out", tmp_path / out)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert ("Errno" in outcome.err, "cannot be written: " in outcome.err, "; " in outcome.err) == (False, True, True)


@pytest.mark.parametrize("folder", ["requirements/software", "safety/tests", "build/host-release/evidence/junit"])
@pytest.mark.verifies("SWR-TRC-009", technique="fault_injection", polarity="violation")
def test_a_folder_that_cannot_be_listed_is_no_empty_one(folder: str, sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    _refuse_listing(monkeypatch, sample.root / folder)

    outcome = trace("check", "--root", sample.root, "--output", "json", "--allow-missing")

    told = [(row["file"], row["line"]) for row in outcome.content["findings"] if row["rule"] == "unreadable-input"]
    assert (outcome.status, told) == (2, [(folder, 1)])


@pytest.mark.verifies("SWR-TRC-009", technique="fault_injection", polarity="violation")
def test_evidence_that_cannot_be_looked_for_is_not_missing(sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    _refuse_listing(monkeypatch, sample.root / "build")

    outcome = trace("check", "--root", sample.root, "--allow-missing")

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert f"{sample.root / 'build'}: cannot be read: permission denied; " in outcome.err


@pytest.mark.verifies("SWR-TRC-078", technique="fault_injection", polarity="violation")
def test_no_id_is_allocated_while_items_cannot_be_read(sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    _refuse_listing(monkeypatch, sample.root / "requirements" / "software")

    outcome = trace(*NEW, "--root", sample.root)

    assert (outcome.status, outcome.out) == (2, "")
    assert "requirements/software:1: cannot be read: permission denied; " in outcome.err


@pytest.mark.verifies("SWR-TRC-074", technique="fault_injection", polarity="violation")
def test_no_bundle_is_made_of_half_of_the_evidence(sample: Sample, trace: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _refuse_listing(monkeypatch, sample.evidence / "campaign" / "no_fault-1")

    outcome = trace("bundle", "--root", sample.root, "--out", tmp_path / "bundle.tar")

    assert (outcome.status, outcome.err.count("\n"), (tmp_path / "bundle.tar").exists()) == (2, 1, False)
    assert "no_fault-1: permission denied; " in outcome.err


@pytest.mark.verifies("SWR-TRC-010", technique="error_guessing", polarity="violation")
def test_a_reader_who_is_gone_ends_the_command_without_a_word(sample: Sample, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    class Gone(io.StringIO):
        def flush(self) -> None:
            raise BrokenPipeError(errno.EPIPE, "Broken pipe")

    monkeypatch.setattr(sys, "stdout", Gone())

    status = main(["show", "SYS-001", "--root", str(sample.root)])

    assert (status, capsys.readouterr().err) == (141, "")


@pytest.mark.verifies("SWR-TRC-010", technique="boundary_values", polarity="violation")
def test_a_word_of_any_length_gives_a_line_that_can_be_read(sample: Sample, trace: Callable) -> None:
    outcome = trace("show", "A" * 100_000, "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n"), len(outcome.err) < 1000) == (2, 1, True)


@pytest.mark.verifies("SWR-TRC-095", technique="error_guessing", polarity="violation")
def test_page_and_paper_do_not_overwrite_each_other(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("page")

    outcome = trace("report", "--root", sample.root, "--out", tmp_path / "page", "--pdf", tmp_path / "link")

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert not (tmp_path / "page").exists()


@pytest.mark.parametrize(
    ("words", "named"),
    [(("--root", "nowhere"), "nowhere: no such folder; "), (("--results", "empty"), "empty: holds no result file (*.xml); "),
     (("--results", "nowhere"), "nowhere: no such result file; "), (("--schema", "nowhere"), "nowhere: no such file; ")],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-048", technique="error_guessing", polarity="violation")
def test_a_project_of_another_tool_is_not_judged_beside_what_was_named(
    words: tuple[str, str], named: str, trace: Callable, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text("ID,Title,Statement\nA-1,First,It shall be.\n")
    (tmp_path / "empty").mkdir()
    option, path = words

    outcome = trace("check", "--format", "csv", tmp_path / "a.csv", option, tmp_path / path)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert named in outcome.err


@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_items_behind_a_link_to_a_folder_are_missed_aloud(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (sample.root / "requirements" / "system" / "shared").symlink_to(tmp_path / "shared")
    (sample.root / "requirements" / "ring.md").symlink_to(".")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    told = [(row["file"], "is not followed" in row["message"]) for row in outcome.content["findings"]]
    assert (outcome.status, outcome.rules, told) == (2, {"unreadable-input"}, [("requirements/ring.md", True), ("requirements/system/shared", True)])
