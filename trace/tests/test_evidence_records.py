# SPDX-License-Identifier: Apache-2.0
# Goal: evidence of other sources and altered evidence are reported; a commit of the tested files leaves the evidence valid.
from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import COMMIT, ENVIRONMENT, Sample

from mamori_trace.readers.evidence_records import hash_file, list_recorded
from mamori_trace.readers.sources import calc_sources

EVIDENCE = "build/host-release/evidence"
HEADER = "safety/include/alive.hpp"
SCHEMA_OF_CODE = 'schema = "mamori.code/1"\nno_evidence = ["requirements/trace.lock"]\n'


def git(root: Path, *arguments: str) -> None:
    people = {f"GIT_{who}_{what}": "tester@localhost" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    subprocess.run(["git", "-C", str(root), *arguments], check=True, capture_output=True, env={**os.environ, **people})


@pytest.fixture
def clone(sample: Sample) -> Sample:
    """The clean sample as a git repository, with evidence that names its sources."""
    (sample.root / ".gitignore").write_text("/build/\n")
    (sample.root / "requirements/schema/code.toml").write_text(SCHEMA_OF_CODE)
    git(sample.root, "init", "-q")
    git(sample.root, "add", "-A")
    git(sample.root, "commit", "-q", "-m", "one")
    record(sample)
    return sample


def record(sample: Sample, **inputs: str) -> None:
    """Writes the hashes of the sources and of all evidence files."""
    sources = calc_sources(sample.root, ("requirements/trace.lock",))
    row = {"sources": sources, "tool_chain": "a" * 64, "configuration": "b" * 64, "binary": None, **inputs}
    (sample.evidence / "environment.json").write_text(json.dumps({**ENVIRONMENT, "inputs": {"sources": sources}}))
    files = {path.relative_to(sample.evidence).as_posix(): {**row, "sha256": hash_file(path)} for path in list_recorded(sample.evidence)}
    (sample.evidence / "records.json").write_text(json.dumps({"schema": "mamori.records/1", "files": files}))


def check(sample: Sample, trace: Callable) -> list[tuple[str, str]]:
    """Rule and file of each finding."""
    outcome = trace("check", "--root", sample.root, "--output", "json")
    return [(one["rule"], one["file"]) for one in outcome.content["findings"]]


@pytest.mark.verifies("SWR-TRC-035", technique="state_transition", polarity="nominal")
def test_the_hash_of_sources_follows_contents_not_commits(clone: Sample) -> None:
    root = clone.root
    first = calc_sources(root)
    assert len(first) == 64
    (root / HEADER).touch()
    assert calc_sources(root) == first

    clone.append(HEADER, "// more\n")
    changed = calc_sources(root)
    assert changed != first
    git(root, "commit", "-qam", "two")
    assert calc_sources(root) == changed

    (root / "new.cpp").write_text("int a;\n")
    added = calc_sources(root)
    assert added not in (first, changed)
    git(root, "add", "-A")
    assert calc_sources(root) == added
    (root / "new.cpp").unlink()
    assert calc_sources(root) == changed

    (root / "build" / "note.txt").write_text("git does not see this\n")
    assert calc_sources(root) == changed


@pytest.mark.verifies("SWR-TRC-035", technique="error_guessing", polarity="nominal")
def test_odd_names_links_and_folders_without_git_have_a_hash_or_none(clone: Sample, tmp_path: Path) -> None:
    (clone.root / "a b\nc\t\u3042.txt").write_text("x")
    (clone.root / "loop").symlink_to(".")
    first = calc_sources(clone.root)
    (clone.root / "loop").unlink()
    (clone.root / "loop").symlink_to("..")

    assert len(first) == 64 and calc_sources(clone.root) != first
    (tmp_path / "plain").mkdir()
    assert calc_sources(tmp_path / "plain") == ""
    assert calc_sources(tmp_path / "absent") == ""


@pytest.mark.verifies("SWR-TRC-035", technique="requirements_based", polarity="nominal")
def test_evidence_of_these_sources_is_fresh_on_any_commit(clone: Sample, trace: Callable) -> None:
    content = json.loads((clone.evidence / "campaign/campaign.json").read_text())
    content["environment"] = json.loads((clone.evidence / "environment.json").read_text())
    (clone.evidence / "campaign/campaign.json").write_text(json.dumps(content))
    record(clone)

    assert check(clone, trace) == []
    clone.append("requirements/trace.lock", "")
    git(clone.root, "commit", "-q", "--allow-empty", "-m", "two")
    assert check(clone, trace) == []


@pytest.mark.verifies("SWR-TRC-035", technique="fault_injection", polarity="violation")
def test_a_change_that_nobody_committed_makes_evidence_stale(clone: Sample, trace: Callable) -> None:
    clone.append(HEADER, "// changed since\n")

    outcome = trace("check", "--root", clone.root, "--output", "json")

    stale = [one for one in outcome.content["findings"] if one["file"] == f"{EVIDENCE}/environment.json"]
    assert outcome.status == 1 and outcome.rules == {"evidence-stale"}
    assert [one["line"] for one in stale] == [1] and COMMIT[:12] in stale[0]["message"]


@pytest.mark.verifies("SWR-TRC-035", technique="fault_injection", polarity="violation")
def test_a_single_file_of_other_sources_is_told(clone: Sample, trace: Callable) -> None:
    content = json.loads((clone.evidence / "records.json").read_text())
    content["files"]["junit/safety.xml"]["sources"] = "0" * 64
    (clone.evidence / "records.json").write_text(json.dumps(content))

    assert ("evidence-stale", f"{EVIDENCE}/junit/safety.xml") in check(clone, trace)


@pytest.mark.verifies("SWR-TRC-036", technique="fault_injection", polarity="violation")
def test_a_file_that_is_not_as_recorded_is_told(sample: Sample, trace: Callable) -> None:
    (sample.evidence / "records.json").unlink()
    record(sample)
    assert check(sample, trace) == []

    sample.append(f"{EVIDENCE}/junit/tools.xml", "\n")
    (sample.evidence / "junit/added.xml").write_text("<testsuites/>")
    (sample.evidence / "coverage").mkdir()
    (sample.evidence / "coverage/by_hand.info").write_text("SF:a\nend_of_record\n")
    assert check(sample, trace) == [
        ("evidence-altered", f"{EVIDENCE}/coverage/by_hand.info"),
        ("evidence-altered", f"{EVIDENCE}/junit/added.xml"),
        ("evidence-altered", f"{EVIDENCE}/junit/tools.xml"),
    ]


@pytest.mark.verifies("SWR-TRC-036", technique="fault_injection", polarity="violation")
def test_a_recorded_file_that_is_gone_is_told(sample: Sample, trace: Callable) -> None:
    (sample.evidence / "junit/extra.xml").write_text("<testsuites/>")
    record(sample)
    (sample.evidence / "junit/extra.xml").unlink()

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.rules == {"evidence-altered"}
    assert "junit/extra.xml" in outcome.content["findings"][0]["message"]


@pytest.mark.parametrize(
    "text",
    ["{", "[]", '{"schema": "mamori.records/2", "files": {}}', '{"schema": "mamori.records/1"}',
     '{"schema": "mamori.records/1", "files": {"junit/safety.xml": {"sha256": 1}}}', "\0"],
    ids=["cut", "list", "schema", "files", "row", "zero"],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-036", technique="error_guessing", polarity="violation")
def test_broken_records_are_one_finding(sample: Sample, trace: Callable, text: str) -> None:
    (sample.evidence / "records.json").write_text(text)

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.status == 2
    assert [(one["rule"], one["file"]) for one in outcome.content["findings"]] == [("unreadable-input", f"{EVIDENCE}/records.json")]
