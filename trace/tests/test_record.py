# SPDX-License-Identifier: Apache-2.0
# Goal: a test command runs once, its status is returned, and only the results that it wrote are bound to their inputs.
from __future__ import annotations

import hashlib
import json
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from git_sample import git, start_history
from trace_sample import Sample

RESULTS = "build/host-release/evidence/junit/*.xml"
PASS = '<testsuite name="s"><testcase classname="s" name="a"/></testsuite>'


def write(*files: Path, status: int = 0) -> list[str]:
    """A command that writes results."""
    return [sys.executable, "-c", "import sys, pathlib\nfor name in sys.argv[2:]:\n    "
            f"pathlib.Path(name).write_text({PASS!r})\nsys.exit(int(sys.argv[1]))",
            str(status), *map(str, files)]  # fmt: skip


def read_rows(folder: Path) -> dict[str, dict[str, str | None]]:
    return json.loads((folder / "records.json").read_text())["files"]


@pytest.fixture
def bare(tmp_path: Path) -> Path:
    """Sources and a program without git."""
    (tmp_path / "src").mkdir()
    (tmp_path / "src/arm.c").write_text("int a;")
    (tmp_path / "prog").write_bytes(b"program")
    (tmp_path / "out/junit").mkdir(parents=True)
    return tmp_path


@pytest.mark.verifies("SWR-TRC-103", technique="requirements_based", polarity="nominal")
def test_results_of_a_command_are_bound_and_judged(sample: Sample, trace: Callable) -> None:
    """A complete run of a project in git; the command only copies stored results."""
    junit = sample.evidence / "junit"
    for name in ("records.json", "environment.json"):
        (sample.evidence / name).unlink()
    text = (sample.root / "requirements/system/system.md").read_text()
    head, mark, rest = text.partition("## SYS-002")
    (sample.root / "requirements/system/system.md").write_text(head + mark + rest.replace("Status: approved", "Status: draft", 1))
    (sample.evidence / "campaign").rename(sample.root / "campaign_of_others")
    start_history(sample.root)
    saved = sample.root.parent / "saved"
    junit.rename(saved)
    before = trace("check", "--root", sample.root, "--evidence", sample.evidence, recorded=False)

    done = trace("record", "--root", sample.root, "--results", sample.root / RESULTS, "--", "cp", "-r", saved, junit)
    after = trace("check", "--root", sample.root, "--evidence", sample.evidence, "--output", "json", recorded=False)

    assert (before.status, done.status, done.out, done.err.count("\n")) == (1, 0, "", 1) and "2 result files recorded" in done.err
    assert (after.status, after.rules, after.get_verdict("SWR-SUP-001")) == (0, set(), "verified")
    sample.append("safety/include/alive.hpp", "// changed\n")
    assert trace("check", "--root", sample.root, "--output", "json", recorded=False).rules == {"evidence-stale"}


@pytest.mark.verifies("SWR-TRC-103", technique="interface", polarity="nominal")
def test_a_row_names_sources_program_and_command(bare: Path, trace: Callable) -> None:
    out = bare / "out/junit/prog.xml"
    words = ("record", "--root", bare, "--results", out, "--program", bare / "prog", "--source", bare / "src", "--", *write(out))

    assert trace(*words).status == 0

    row = read_rows(bare / "out")["junit/prog.xml"]
    assert row["sha256"] == hashlib.sha256(out.read_bytes()).hexdigest() and row["binary"] == hashlib.sha256(b"program").hexdigest()
    assert set(row) == {"sha256", "sources", "tool_chain", "configuration", "binary"} and all(len(row[key] or "") == 64 for key in row)
    assert json.loads((bare / "out/records.json").read_text())["source_folders"] == ["src"]
    (bare / "src/arm.c").write_text("int b;")
    assert trace(*words).status == 0
    assert read_rows(bare / "out")["junit/prog.xml"]["sources"] != row["sources"]


@pytest.mark.verifies("SWR-TRC-103", technique="interface", polarity="nominal")
def test_results_of_a_foreign_project_are_bound_by_their_record(bare: Path, trace: Callable) -> None:
    (bare / "reqs.csv").write_text("ID,Title,Statement\nSWR-1,Stop,The arm shall stop.\n")
    (bare / "src/arm.c").write_text("/* @satisfies SWR-1 */\nint a;")
    out = bare / "results/a.xml"
    out.parent.mkdir()
    named = PASS.replace('name="a"/>', 'name="a"><properties><property name="requirement" value="SWR-1"/></properties></testcase>')
    judge = ("check", "--root", bare, "--format", "csv", bare / "reqs.csv", "--results", out, "--output", "json")
    out.write_text(named)
    unbound = trace(*judge, recorded=False)

    script = f"import pathlib; pathlib.Path({str(out)!r}).write_text({named!r})"
    done = trace("record", "--root", bare, "--results", out, "--source", bare / "src", "--", sys.executable, "-c", script)
    bound = trace(*judge, recorded=False)

    assert unbound.get_verdict("SWR-1") == "unbound" and "result-unbound" in unbound.rules
    assert (done.status, bound.get_verdict("SWR-1"), "result-unbound" in bound.rules) == (0, "verified", False)
    (bare / "src/arm.c").write_text("int b;")
    assert "evidence-stale" in trace(*judge, recorded=False).rules


@pytest.mark.parametrize("status", [0, 1, 7, 255])
@pytest.mark.verifies("SWR-TRC-103", technique="boundary_values", polarity="nominal")
def test_the_status_of_the_command_is_handed_on(status: int, bare: Path, trace: Callable) -> None:
    out = bare / "out/a.xml"

    outcome = trace("record", "--root", bare, "--results", out, "--source", bare / "src", "--", *write(out, status=status))

    assert outcome.status == status and list(read_rows(bare / "out")) == ["a.xml"]


@pytest.mark.verifies("SWR-TRC-103", technique="fault_injection", polarity="violation")
def test_only_what_the_command_wrote_is_recorded(bare: Path, trace: Callable) -> None:
    old, new = bare / "out/junit/old.xml", bare / "out/junit/new.xml"
    old.write_text(PASS)

    outcome = trace("record", "--root", bare, "--results", bare / "out/junit/*.xml", "--source", bare / "src", "--", *write(new))

    assert outcome.status == 0 and list(read_rows(bare / "out")) == ["junit/new.xml"]
    assert "old.xml: the command did not write it" in outcome.err
    again = trace("record", "--root", bare, "--results", bare / "out/junit/*.xml", "--source", bare / "src", "--", *write(old))
    assert again.status == 0 and list(read_rows(bare / "out")) == ["junit/new.xml", "junit/old.xml"]


@pytest.mark.verifies("SWR-TRC-103", technique="fault_injection", polarity="violation")
def test_sources_that_change_during_the_run_are_no_record(bare: Path, trace: Callable) -> None:
    out = bare / "out/a.xml"
    script = f"import pathlib; pathlib.Path({str(bare / 'src/arm.c')!r}).write_text('x'); pathlib.Path({str(out)!r}).write_text({PASS!r})"

    outcome = trace("record", "--root", bare, "--results", out, "--source", bare / "src", "--", sys.executable, "-c", script)

    assert outcome.status == 2 and "sources changed" in outcome.err and not (bare / "out/records.json").exists()


def bad(*words: str) -> list[str]:
    return list(words)


@pytest.mark.parametrize(
    ("words", "status", "told"),
    [
        (bad("--source", "{root}/src", "--", "true"), 1, "wrote no file"),
        (bad("--source", "{root}/src", "--", "false"), 1, "wrote no file"),
        (bad("--source", "{root}/src", "--", "sh", "-c", "exit 9"), 9, "wrote no file"),
        (bad("--source", "{root}/src", "--", "sh", "-c", "kill -9 $$"), 137, "wrote no file"),
        (bad("--source", "{root}/src", "--", "no-such-program"), 3, "is no program"),
        (bad("--source", "{root}/none", "--", "true"), 2, "is not there"),
        (bad("--source", "/usr/include", "--", "true"), 2, "is not below"),
        (bad("--", "true"), 2, "--source"),
        (bad("--source", "{root}/src", "--program", "{root}/none", "--", "touch", "{root}/out/a.xml"), 2, "--program"),
        (bad("--source", "{root}/src", "--evidence", "{root}/src", "--", "touch", "{root}/out/a.xml"), 2, "--evidence"),
    ],
    ids=["no-result", "failed", "status", "signal", "no-program", "no-source", "outside", "no-git", "no-test-program", "evidence"],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-103", technique="error_guessing", polarity="violation")
def test_wrong_words_are_one_line_and_record_nothing(words: list[str], status: int, told: str, bare: Path, trace: Callable) -> None:
    given = [word.format(root=bare) for word in words]

    outcome = trace("record", "--root", bare, "--results", bare / "out/*.xml", *given, recorded=False)

    assert outcome.status == status and told in outcome.err and outcome.err.count("\n") == 1, outcome.err
    assert not list(bare.rglob("records.json")) and outcome.out == ""


@pytest.mark.parametrize("front", [("mamori_trace",), ("mamori_tools.command", "trace")], ids=["module", "launcher"])
@pytest.mark.verifies("SWR-TRC-103", technique="interface", polarity="nominal")
def test_the_command_keeps_its_own_words_and_streams(front: tuple[str, ...], bare: Path) -> None:
    out = bare / "out/a.xml"
    script = f"import sys, pathlib; pathlib.Path({str(out)!r}).write_text({PASS!r}); print(sys.argv[1:]); sys.exit(5)"
    words = [sys.executable, "-P", "-m", *front, "record", "--root", str(bare), "--results", str(out), "--source", str(bare / "src"), "--",
             sys.executable, "-c", script, "--output", "--", "-x"]  # fmt: skip

    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=120)

    assert (done.returncode, done.stdout) == (5, "['--output', '--', '-x']\n"), done.stderr


HOSTILE = {
    "fsmonitor": ("core.fsmonitor", ""),
    "clean": ("filter.bad.clean", "*.hpp filter=bad\n"),
    "process": ("filter.bad.process", "*.hpp filter=bad\n"),
    "smudge": ("filter.bad.smudge", "*.hpp filter=bad\n"),
    "textconv": ("diff.bad.textconv", "*.hpp diff=bad\n"),
    "driver": ("diff.bad.command", "*.hpp diff=bad\n"),
    "external": ("diff.external", ""),
    "pager": ("core.pager", ""),
    "log-pager": ("pager.log", ""),
    "gpg": ("gpg.program", ""),
    "editor": ("core.editor", ""),
    "ssh": ("core.sshCommand", ""),
}


@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.verifies("SWR-TRC-106", technique="fault_injection", polarity="violation")
def test_no_program_of_a_judged_repository_is_started(name: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    key, attributes = HOSTILE[name]
    marker, program = tmp_path / "marker", tmp_path / "program"
    start_history(sample.root)
    if attributes:
        (sample.root / ".gitattributes").write_text(attributes)
        git(sample.root, "add", ".gitattributes")
        git(sample.root, "commit", "-q", "-m", "attributes")
    program.write_text(f"#!/bin/sh\ntouch {marker}\ncat\n")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    git(sample.root, "config", key, str(program))
    git(sample.root, "config", "log.showSignature", "true")
    sample.append("safety/include/alive.hpp", "// changed\n")
    os.utime(sample.root / "tools/offline.py")

    for words in (("check",), ("report", "--out", tmp_path / "page.html"), ("show", "SYS-001", "--history"), ("query", "level=SWR"),
                  ("impact", "HEAD"), ("new", "SWR", "--area", "SUP", "--parents", "SYS-001", "--title", "T"),
                  ("bundle", "--out", tmp_path / f"bundle-{name}")):  # fmt: skip
        trace(*words, "--root", sample.root)

    assert not marker.exists()


@pytest.mark.verifies("SWR-TRC-106", technique="requirements_based", polarity="nominal")
def test_git_still_answers(sample: Sample, trace: Callable) -> None:
    head = start_history(sample.root)
    sample.append("safety/include/alive.hpp", "// changed\n")

    outcome = trace("impact", head, "--root", sample.root, "--output", "json")

    assert outcome.status == 0 and "safety/include/alive.hpp" in outcome.out


@pytest.mark.verifies("SWR-TRC-106", technique="error_guessing", polarity="violation")
def test_the_marker_would_be_left(sample: Sample, tmp_path: Path) -> None:
    """Shows that plain git starts the program, so the test above can fail."""
    start_history(sample.root)
    marker, program = tmp_path / "marker", tmp_path / "program"
    program.write_text(f"#!/bin/sh\ntouch {marker}\n")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    git(sample.root, "config", "core.fsmonitor", str(program))

    git(sample.root, "status", "--porcelain")

    assert marker.exists()
