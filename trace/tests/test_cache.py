# SPDX-License-Identifier: Apache-2.0
# Goal: an unchanged project is not read again, every change of any input is detected, and outcomes with unknown inputs are not stored.
# Method: the small clean project; each kind of input is changed alone, and the outcome is compared with a run without the cache.
from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import trace_sample

from mamori_trace.cache import outcome, state
from mamori_trace.command import main

EVIDENCE = "build/host-release/evidence"


class Keeper:
    """Runs the check through the cache and counts the real checks."""

    def __init__(self, sample: trace_sample.Sample, capsys: pytest.CaptureFixture[str]) -> None:
        self.sample = sample
        self.made = 0
        self._capsys = capsys

    @property
    def folder(self) -> Path:
        return self.sample.root / "build" / state.FOLDER_NAME

    @property
    def files(self) -> list[Path]:
        return sorted(self.folder.glob("*")) if self.folder.exists() else []

    def check(self, *more: str, run: Callable[[], object] = lambda: None) -> tuple[int, str, str]:
        words = ["check", "--root", str(self.sample.root), *more]

        def make() -> int:
            self.made += 1
            run()
            return main(words)

        status = outcome.run_kept(words, make)
        captured = self._capsys.readouterr()
        return status, captured.out, captured.err

    def check_anew(self) -> tuple[int, str, str]:
        status = main(["check", "--root", str(self.sample.root)])
        captured = self._capsys.readouterr()
        return status, captured.out, captured.err


@pytest.fixture
def fresh(sample: trace_sample.Sample, capsys: pytest.CaptureFixture[str]) -> Keeper:
    """A project whose files were written just now."""
    return Keeper(sample, capsys)


@pytest.fixture
def keeper(fresh: Keeper, monkeypatch: pytest.MonkeyPatch) -> Keeper:
    """A project whose files count as old."""
    monkeypatch.setattr(state, "RACY_NS", -(10**15))
    return fresh


@pytest.mark.verifies("SWR-TRC-091")
@pytest.mark.parametrize("more", [(), ("--output", "json"), ("--allow-missing",)])
def test_unchanged_project_is_told_again_without_reading(keeper: Keeper, more: tuple[str, ...]) -> None:
    first = keeper.check(*more)

    assert keeper.check(*more) == first
    assert keeper.made == 1


@pytest.mark.verifies("SWR-TRC-091")
def test_findings_are_repeated_with_their_status(keeper: Keeper) -> None:
    keeper.sample.replace("requirements/software/software.md", "shall report a late", "will report a late")
    first = keeper.check()

    assert first[0] == 1 and "shall-count" in first[1]
    assert keeper.check() == first
    assert keeper.made == 1


def edit(file: str, old: str, new: str) -> Callable[[trace_sample.Sample], object]:
    return lambda sample: sample.replace(file, old, new)


def add(file: str, text: str) -> Callable[[trace_sample.Sample], object]:
    def write(sample: trace_sample.Sample) -> None:
        path = sample.root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    return write


def remove(file: str) -> Callable[[trace_sample.Sample], object]:
    return lambda sample: (sample.root / file).unlink()


def edit_and_put_time_back(sample: trace_sample.Sample) -> None:
    path = sample.root / "requirements/software/software.md"
    before = path.stat()
    sample.replace("requirements/software/software.md", "shall open no", "might open no"[:5] + " open no")
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert (path.stat().st_size, path.stat().st_mtime_ns) == (before.st_size, before.st_mtime_ns)


def replace_file_by_another(sample: trace_sample.Sample) -> None:
    path = sample.root / "safety/include/alive.hpp"
    other = path.with_name("other.hpp")
    other.write_text(path.read_text().replace("SWR-SUP-002", "SWR-SUP-009"))
    other.replace(path)


def turn_file_into_folder(sample: trace_sample.Sample) -> None:
    (sample.root / "docs/design/arm.md").unlink()
    (sample.root / "docs/design/arm.md").mkdir()


CHANGES = {
    "requirement, same size": edit("requirements/software/software.md", "report a late", "repeat a lot "),
    "requirement, same size and time": edit_and_put_time_back,
    "requirement file added": add("requirements/software/more.md", "# More\n\n## SWR-BAD-001 Broken\n"),
    "requirement file removed": remove("requirements/software/software.md"),
    "requirement folder added": add("requirements/extra/deep/more.md", "# More\n\n## SWR-BAD-001 Broken\n"),
    "schema": edit("requirements/schema/items.toml", '"state_transition", ', ""),
    "unfinished words": edit("requirements/schema/items.toml", "weak_word_exceptions", 'unfinished_words = ["late"]\nweak_word_exceptions'),
    "review lock": lambda sample: (sample.root / "requirements/trace.lock").write_text("# empty\n"),
    "review lock removed": remove("requirements/trace.lock"),
    "source": edit("safety/include/alive.hpp", "@satisfies SWR-SUP-002", "@satisfies SWR-SUP-007"),
    "source put in its place": replace_file_by_another,
    "source added": add("safety/include/more.hpp", "/// @file\n/// @satisfies SWR-XXY-001\n"),
    "source folder added": add("ports/posix/more.cpp", "/// @file\n/// @satisfies SWR-XXY-001\n"),
    "source removed": remove("safety/include/alive.hpp"),
    "Python source": edit("tools/offline.py", "SWR-TLS-001", "SWR-TLS-002"),
    "script added": add("tools/run.sh", "# @satisfies SWR-XXY-001\n"),
    "test": edit("safety/tests/alive_test.cpp", 'verifies("SWR-SUP-002")', 'verifies("SWR-SUP-003")'),
    "test added": add("safety/tests/more_test.cpp", 'TEST(A, B) {\n    verifies("SWR-SUP-001");\n}\n'),
    "design heading": edit("docs/design/arm.md", "## Hazards", "## Dangers"),
    "design document removed": remove("docs/design/arm.md"),
    "design document is a folder": turn_file_into_folder,
    "result": edit(f"{EVIDENCE}/junit/safety.xml", 'name="SilenceIsReported" status="run"', 'name="SilenceIsReported" status="notrun"'),
    "result file added": add(f"{EVIDENCE}/junit/more.xml", "<testsuites><testcase"),
    "result file removed": remove(f"{EVIDENCE}/junit/tools.xml"),
    "environment removed": remove(f"{EVIDENCE}/environment.json"),
    "campaign": edit(f"{EVIDENCE}/campaign/campaign.json", '"encoder_freeze-1",\n   "scenario"', '"encoder_freeze-9",\n   "scenario"'),
    "campaign removed": remove(f"{EVIDENCE}/campaign/campaign.json"),
    "timing record added": add(f"{EVIDENCE}/timing/one/timing.json", "{"),
}


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
def test_change_of_an_input_is_noticed(keeper: Keeper, change: Callable[[trace_sample.Sample], object]) -> None:
    keeper.check()
    assert len(keeper.files) == 1
    change(keeper.sample)

    told = keeper.check()
    assert keeper.made == 2
    assert told == keeper.check_anew()


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
def test_change_of_the_commit_is_noticed(keeper: Keeper) -> None:
    def git(*words: str) -> None:
        who = ("-c", "user.name=the maintainers", "-c", "user.email=maintainers@localhost")
        subprocess.run(["git", "-C", str(keeper.sample.root), *who, *words], check=True, capture_output=True)

    git("init", "-q")
    git("commit", "-q", "--allow-empty", "-m", "one")
    keeper.check()
    keeper.check()
    assert keeper.made == 1
    git("commit", "-q", "--allow-empty", "-m", "two")

    status, out, _ = keeper.check()
    assert keeper.made == 2
    assert status == 1 and "evidence-stale" in out


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
@pytest.mark.parametrize("change", ["option", "environment", "date", "tool", "folder", "library"])
def test_change_beside_the_project_is_noticed(keeper: Keeper, monkeypatch: pytest.MonkeyPatch, change: str) -> None:
    keeper.check()
    match change:
        case "environment":
            monkeypatch.setenv("NO_COLOR", "changed")
        case "date":
            monkeypatch.setattr(outcome.time, "strftime", lambda *_: "2030-01-01")
        case "tool":
            monkeypatch.setattr(state, "read_tool_state", lambda _: {"command.py": [0, 0, 0, 0, 0, 0]})
        case "folder":
            monkeypatch.chdir(keeper.sample.root)
        case "library":
            monkeypatch.setattr(sys, "path", [*sys.path, "/nowhere/site-packages"])

    keeper.check(*(["--allow-missing"] if change == "option" else []))
    assert keeper.made == 2


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
def test_file_written_just_now_is_not_trusted(fresh: Keeper) -> None:
    fresh.check()

    assert not fresh.files
    fresh.check()
    assert fresh.made == 2


@pytest.mark.verifies("SWR-TRC-092")
@pytest.mark.parametrize(("behind_ns", "racy"), [(0, True), (state.RACY_NS - 1, True), (state.RACY_NS, False), (-(10**12), True)])
def test_age_from_which_a_file_is_trusted(behind_ns: int, racy: bool) -> None:
    now = 10**18
    old = now - 10**12

    assert state.is_racy([0, 0, 0, 0, now - behind_ns, old], now) is racy
    assert state.is_racy([0, 0, 0, 0, old, now - behind_ns], now) is racy
    assert not state.is_racy(None, now)


def spoil(kept: Path, kind: str) -> None:
    data = kept.read_bytes()
    body = b'{"status": 0}' if kind == "shape" else b"[" * 100_000
    match kind:
        case "cut off":
            kept.write_bytes(data[: len(data) // 2])
        case "one byte":
            kept.write_bytes(data[:-20] + b"x" + data[-19:])
        case "empty":
            kept.write_bytes(b"")
        case "bytes":
            kept.write_bytes(bytes(range(256)))
        case "shape" | "nested":
            kept.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
        case "status":
            body = json.dumps({**json.loads(data.partition(b"\n")[2]), "status": 3}).encode()
            kept.write_bytes(hashlib.sha256(body).hexdigest().encode() + b"\n" + body)
        case "folder":
            kept.unlink()
            kept.mkdir()


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
@pytest.mark.parametrize("kind", ["cut off", "one byte", "empty", "bytes", "shape", "nested", "status", "folder"])
def test_broken_or_foreign_store_is_ignored(keeper: Keeper, kind: str) -> None:
    first = keeper.check()
    spoil(keeper.files[0], kind)

    assert keeper.check() == first
    assert keeper.made == 2
    assert not list(keeper.folder.glob("*.part"))


@pytest.mark.verifies("SWR-TRC-091", polarity="violation")
@pytest.mark.parametrize("word", ["--no-cache", "--no-c"])
def test_cache_can_be_turned_off(keeper: Keeper, word: str) -> None:
    keeper.check()
    kept = [path.read_bytes() for path in keeper.files]
    keeper.sample.replace("requirements/software/software.md", "shall report a late", "will report a late")

    assert keeper.check(word)[0] == 1
    assert keeper.check(word)[0] == 1
    assert keeper.made == 3
    assert [path.read_bytes() for path in keeper.files] == kept


def write_a_file(folder: Path) -> None:
    (folder / "side.txt").write_text("x")


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
@pytest.mark.parametrize("doubt", [
    lambda folder: write_a_file(folder),
    lambda folder: os.rename(folder / "side.txt", folder / "moved.txt"),
    lambda _: subprocess.run([sys.executable, "--version"], capture_output=True, check=True),
    lambda _: os.system("true"),
    lambda _: open("/proc/uptime").close(),
    lambda _: os.listdir(os.open(".", os.O_RDONLY)),
    lambda _: sys.stdout.buffer.flush(),
], ids=["written", "moved", "process", "shell", "living file", "descriptor", "around the copy"])  # fmt: skip
def test_what_cannot_be_vouched_for_is_not_kept(keeper: Keeper, tmp_path: Path, doubt: Callable[[Path], object]) -> None:
    write_a_file(tmp_path)
    keeper.check(run=lambda: doubt(tmp_path))

    assert not keeper.files


@pytest.mark.verifies("SWR-TRC-092", polarity="violation")
def test_input_that_could_not_be_read_is_not_kept(keeper: Keeper) -> None:
    keeper.sample.replace("requirements/schema/items.toml", "mamori.items/1", "mamori.items/0")

    assert keeper.check()[0] == 2
    assert not keeper.files


@pytest.mark.verifies("SWR-TRC-091", polarity="violation")
def test_project_without_build_folder_stays_as_it_is(keeper: Keeper) -> None:
    shutil.rmtree(keeper.sample.root / "build")
    before = sorted(keeper.sample.root.rglob("*"))

    keeper.check("--allow-missing")
    assert sorted(keeper.sample.root.rglob("*")) == before


@pytest.mark.verifies("SWR-TRC-091")
def test_only_some_outcomes_are_kept(keeper: Keeper, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(outcome.KEPT_MAX + 3):
        monkeypatch.setenv("NO_COLOR", str(number))
        keeper.check()

    assert len(keeper.files) == outcome.KEPT_MAX
    keeper.check()
    assert keeper.made == outcome.KEPT_MAX + 3


@pytest.mark.verifies("SWR-TRC-091")
def test_other_actions_are_never_repeated(keeper: Keeper) -> None:
    runs: list[int] = []
    words = ["show", "SYS-001", "--root", str(keeper.sample.root)]

    def make() -> int:
        runs.append(1)
        return 0

    assert [outcome.run_kept(words, make) for _ in range(2)] == [0, 0]
    assert len(runs) == 2 and not keeper.files
