# SPDX-License-Identifier: Apache-2.0
# Goal: if two commands write to one project, the second ends immediately. Files that the first one leaves, for any kind of end, block no
# command. A checkout that is read-only, moved or reached by a link is reported in one line.
# Method: a real process that holds the lock; mount namespaces if the host permits them.
from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from mamori_tools.command import locks
from mamori_tools.command.main import list_commands, main, make_parser
from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import MissingError
from mamori_trace.base.project_lock import KEYS, LOCK, hold_lock
from mamori_trace.command import main as trace

HOLDER = """
import subprocess, sys, time
from pathlib import Path
from mamori_trace.base.project_lock import hold_lock

with hold_lock(Path(sys.argv[1]), "./mamori test --quick"):
    child = subprocess.Popen(sys.argv[2:] or ["sleep", "60"], stdout=sys.stdout)
    print("held", child.pid, flush=True)
    child.wait()
"""
TIMEOUT_S = 20.0
READERS = [
    ("new", "x"), ("log", "x"), ("lcm", "types", "x", "--out", "y"), ("campaign", "x"),
    ("table", "x"), ("constraint", "x<1"), ("profile", "check", "x"), ("e2e", "--profile", "1", "--length", "8", "--rate", "1", "--pe", "0.01"),
    ("bench", "--list"), ("mutate", "--list"),
]  # fmt: skip
WRITERS = [("demo",), ("run",), ("test",), ("build",), ("verify",), ("timing", "x"), ("cost", "x"), ("bench",), ("mutate",), ("fuzz",),
           ("prove", "safe-state"), ("hil",)]  # fmt: skip
TRACE_WRITERS = [
    ("report",), ("review", "--all"), ("init",), ("new", "SWR"), ("record", "--results", "x", "--", "true"),
    ("import", "csv", "x", "--into", "requirements/x"), ("bundle", "--out", "x"),
]  # fmt: skip


class Holder:
    """A process that holds the lock of a folder and runs a child."""

    def __init__(self, folder: Path, *child: str) -> None:
        environment = {name: value for name, value in os.environ.items() if name != KEYS}
        self.process = subprocess.Popen([sys.executable, "-P", "-c", HOLDER, str(folder), *child], stdout=subprocess.PIPE, text=True,
                                        env=environment)  # fmt: skip
        assert self.process.stdout is not None
        self.child = int(self.process.stdout.readline().split()[1])

    def kill(self) -> None:
        self.process.kill()
        self.process.wait(TIMEOUT_S)


@pytest.fixture
def holder(tmp_path: Path) -> Iterator[Holder]:
    one = Holder(tmp_path)
    yield one
    one.process.kill()
    os.kill(one.child, signal.SIGKILL)
    one.process.wait(TIMEOUT_S)


@pytest.fixture(autouse=True)
def no_caller(monkeypatch: pytest.MonkeyPatch) -> None:
    """The command that runs these tests holds its own lock."""
    monkeypatch.delenv(KEYS, raising=False)


@pytest.mark.parametrize("words", WRITERS, ids=" ".join)
@pytest.mark.verifies("SWR-CLI-040", technique="equivalence_classes", polarity="violation")
def test_a_second_writer_is_refused_at_once(
    words: tuple[str, ...], holder: Holder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(locks, "ROOT", tmp_path)
    monkeypatch.setattr("mamori_tools.command.main._dispatch", lambda *_: pytest.fail("the command began"))

    assert main(words) == 3

    said = capsys.readouterr().err
    assert said.startswith(f"mamori: {tmp_path}: './mamori test --quick' (process {holder.process.pid}, started 20")
    assert said.count("\n") == 1


@pytest.mark.parametrize("words", TRACE_WRITERS, ids=lambda words: words[0])
@pytest.mark.verifies("SWR-CLI-040", technique="equivalence_classes", polarity="violation")
def test_a_second_writer_of_the_trace_tool_is_refused_at_once(
    words: tuple[str, ...], holder: Holder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(tmp_path.rglob("*"))

    assert trace([words[0], "--root", str(tmp_path), *words[1:]]) == 3

    said = capsys.readouterr().err
    assert f"(process {holder.process.pid}, started 20" in said
    assert said.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.verifies("SWR-CLI-040", technique="equivalence_classes")
def test_every_command_is_a_writer_or_a_reader_and_readers_take_no_lock() -> None:
    assert {words[0] for words in (*READERS, *WRITERS)} == set(list_commands())
    assert [words for words in READERS if locks.list_written(make_parser().parse_args(words))] == []
    assert [words for words in WRITERS if locks.list_written(make_parser().parse_args(words)) != [ROOT]] == []


@pytest.mark.parametrize("words", [("check",), ("show", "SWR-X-001"), ("query", "id ~ SWR"), ("export", "csv", "--out", "/dev/null/x")])
@pytest.mark.verifies("SWR-CLI-040", technique="equivalence_classes")
def test_readers_of_the_trace_tool_work_while_the_lock_is_held(words: tuple[str, ...], holder: Holder, tmp_path: Path) -> None:
    assert trace([words[0], "--root", str(tmp_path), *words[1:]]) == 2  # there are no requirements


@pytest.mark.verifies("SWR-CLI-040")
@pytest.mark.parametrize("command", ["build", "verify", "timing", "cost"])
def test_the_project_of_a_user_is_locked_as_well(command: str, tmp_path: Path) -> None:
    (tmp_path / "CMakeLists.txt").write_text("find_package(mamori CONFIG REQUIRED)\n", encoding="utf-8")
    (tmp_path / "arm").mkdir()
    named = tmp_path / "arm" if command in ("timing", "cost") else tmp_path

    assert locks.list_written(make_parser().parse_args([command, str(named)])) == [ROOT, tmp_path]


@pytest.mark.verifies("SWR-CLI-040")
def test_a_command_that_the_holder_starts_passes(tmp_path: Path) -> None:
    code = f"from pathlib import Path; from mamori_trace.base.project_lock import hold_lock\nwith hold_lock(Path({str(tmp_path)!r}), 'child'): pass"

    one = Holder(tmp_path, sys.executable, "-P", "-c", code)

    assert one.process.wait(TIMEOUT_S) == 0
    assert not (tmp_path / LOCK).exists()


@pytest.mark.verifies("SWR-CLI-040", technique="error_guessing", polarity="violation")
def test_the_key_of_another_holder_does_not_open_the_lock(holder: Holder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(KEYS, "0123456789abcdef")

    with pytest.raises(MissingError), hold_lock(tmp_path, "orphan"):
        pass


@pytest.mark.verifies("SWR-CLI-041", technique="fault_injection")
def test_the_lock_of_a_killed_command_is_no_lock_although_its_child_lives(holder: Holder, tmp_path: Path) -> None:
    holder.kill()
    assert (tmp_path / LOCK).exists()
    os.kill(holder.child, 0)

    with hold_lock(tmp_path, "next"):
        assert f'"pid": {os.getpid()}' in (tmp_path / LOCK).read_text(encoding="utf-8")

    assert not (tmp_path / LOCK).exists()


@pytest.mark.parametrize("content", ["", "half a li", '{"pid": 1}', "[]", "\0" * 100], ids=["empty", "text", "other", "list", "binary"])
@pytest.mark.verifies("SWR-CLI-041", technique="equivalence_classes")
def test_a_file_that_nobody_holds_is_no_lock(content: str, tmp_path: Path) -> None:
    (tmp_path / "build").mkdir()
    (tmp_path / LOCK).write_text(content, encoding="utf-8")

    with hold_lock(tmp_path, "next"):
        pass

    assert list((tmp_path / "build").iterdir()) == []


@pytest.mark.parametrize("has_build", [False, True])
@pytest.mark.verifies("SWR-CLI-041")
def test_nothing_stays_of_a_lock_that_is_released(has_build: bool, tmp_path: Path) -> None:
    if has_build:
        (tmp_path / "build").mkdir()

    with pytest.raises(ZeroDivisionError), hold_lock(tmp_path, "one"):
        os.environ[KEYS] = str(1 / 0)

    assert KEYS not in os.environ
    assert [path.name for path in tmp_path.iterdir()] == (["build"] if has_build else [])


@pytest.mark.verifies("SWR-CLI-040", technique="state_transition", polarity="violation")
def test_of_many_writers_one_at_a_time_works(tmp_path: Path) -> None:
    code = f"""
import sys, time
from pathlib import Path
from mamori_trace.base.project_lock import MissingError, hold_lock
folder, done = Path({str(tmp_path)!r}), 0
while done < 100:
    try:
        with hold_lock(folder, "one of many"):
            (folder / "busy").mkdir()
            (folder / "busy").rmdir()
            done += 1
    except MissingError:
        time.sleep(0.0005)
"""
    many = [subprocess.Popen([sys.executable, "-P", "-c", code], stderr=subprocess.PIPE, text=True) for _ in range(4)]

    assert [one.communicate(timeout=60)[1] for one in many] == [""] * 4
    assert list(tmp_path.rglob("*")) in ([], [tmp_path / "build"])


def make_tree(root: Path, name: str, made_in: Path) -> Path:
    tree = root / "build" / name
    (tree / "CMakeFiles").mkdir(parents=True)
    (tree / "CMakeCache.txt").write_text(f"CMAKE_BUILD_TYPE:STRING=\nCMAKE_CACHEFILE_DIR:INTERNAL={made_in}\n", encoding="utf-8")
    (tree / "evidence.txt").write_text("stays\n", encoding="utf-8")
    return tree


@pytest.mark.verifies("SWR-CLI-042", technique="equivalence_classes", polarity="violation")
def test_trees_of_a_moved_checkout_are_configured_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own = make_tree(tmp_path, "own", tmp_path / "build" / "own")
    (tmp_path.parent / "link").symlink_to(tmp_path)
    linked = make_tree(tmp_path, "linked", tmp_path.parent / "link" / "build" / "linked")
    moved = make_tree(tmp_path, "moved", Path("/old/place/build/moved"))

    locks.discard_moved_trees(tmp_path)

    assert sorted(path.name for path in moved.iterdir()) == ["evidence.txt"]
    assert all((tree / "CMakeCache.txt").exists() and (tree / "CMakeFiles").exists() for tree in (own, linked))
    assert capsys.readouterr().err == f"mamori: {moved} was configured in /old/place/build/moved; it is configured again\n"


@pytest.mark.verifies("SWR-CLI-042", technique="fault_injection", polarity="violation")
def test_a_place_that_cannot_be_written_is_named_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(locks, "ROOT", tmp_path)
    (tmp_path / "build").write_text("a file where the folder should be\n", encoding="utf-8")

    refused = pytest.raises(MissingError, match=f"^{tmp_path}/build/mamori.lock: cannot be written .*; make {tmp_path} writable")
    with refused, locks.hold_locks(make_parser().parse_args(["fuzz"]), ["fuzz"]):
        pass


def has_namespaces() -> bool:
    return shutil.which("unshare") is not None and subprocess.run(["unshare", "-rm", "true"], check=False, capture_output=True).returncode == 0


def call_read_only(words: str) -> subprocess.CompletedProcess[str]:
    """Calls the command with a read-only view of the checkout."""
    script = f"mount --bind {ROOT} {ROOT} && mount -o remount,bind,ro {ROOT} && cd {ROOT} || exit 99; {sys.executable} -P -B -m mamori_tools.command"
    return subprocess.run(["unshare", "-rm", "sh", "-c", f"{script} {words}"], capture_output=True, text=True, check=False)


NAMESPACES = pytest.mark.skipif(not has_namespaces(), reason="verdict=no-privilege: this host grants no mount namespace")


@NAMESPACES
@pytest.mark.parametrize("words", ["demo", "fuzz", "timing examples/safe_arm"])
@pytest.mark.verifies("SWR-CLI-042", technique="fault_injection", polarity="violation")
def test_a_read_only_checkout_is_named_in_one_line(words: str) -> None:
    done = call_read_only(words)

    assert (done.returncode, done.stdout) == (3, "")
    assert "mamori.lock: cannot be written (Read-only file system)" in done.stderr and done.stderr.count("\n") == 1


@NAMESPACES
@pytest.mark.verifies("SWR-CLI-042")
def test_a_read_only_checkout_serves_readers() -> None:
    done = call_read_only("e2e --profile 5 --length 64 --rate 100 --pe 0.01 --json")

    assert (done.returncode, done.stderr) == (1, "")
