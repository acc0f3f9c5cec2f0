# SPDX-License-Identifier: Apache-2.0
# Goal: tools write files atomically, for any end of the writing: an error, Ctrl-C, a full disk. An error of the system ends a command in
# one line. Method: each writer with each failure; a tiny disk in a mount namespace; a reader that ends early.
from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from mamori_tools.command.main import main
from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import write_text
from mamori_trace.base.whole_file import whole_file
from mamori_trace.base.write import write_whole

PROGRAM = [sys.executable, "-P", "-B", "-m", "mamori_tools.command"]


def write_through(path: Path, text: str) -> None:
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8")


WRITERS: list[Callable[[Path, str], None]] = [write_text, write_whole, write_through]
REFUSALS = (InputError, OSError)


@pytest.mark.parametrize("write", WRITERS)
@pytest.mark.verifies("SWR-CLI-043")
def test_a_file_is_replaced_and_keeps_its_mode(write: Callable[[Path, str], None], tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old", encoding="utf-8")
    path.chmod(0o640)
    (tmp_path / "link").symlink_to("a.txt")

    write(tmp_path / "link", "new")

    assert (path.read_text(encoding="utf-8"), path.stat().st_mode & 0o777) == ("new", 0o640)
    assert (tmp_path / "link").is_symlink()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.txt", "link"]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), ValueError("no text"), KeyboardInterrupt(), SystemExit(1)], ids=repr)
@pytest.mark.parametrize("is_begun", [False, True])
@pytest.mark.verifies("SWR-CLI-043", technique="fault_injection", polarity="violation")
def test_whatever_ends_the_writing_leaves_the_old_file_alone(error: BaseException, is_begun: bool, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old", encoding="utf-8")

    def write() -> None:
        with whole_file(path) as part:
            if is_begun:
                part.write_text("ne", encoding="utf-8")
            raise error

    with pytest.raises(type(error)):
        write()

    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("write", WRITERS)
@pytest.mark.parametrize("name", ["folder", "pipe", "loop", "lost", "file/x", "n" * 300, "/dev/null", "/dev/full"])
@pytest.mark.verifies("SWR-CLI-043", technique="equivalence_classes", polarity="violation")
def test_what_is_no_file_is_refused(write: Callable[[Path, str], None], name: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "lost").symlink_to("/nowhere/at/all")
    (tmp_path / "file").write_text("", encoding="utf-8")
    before = sorted(tmp_path.rglob("*"))

    with pytest.raises(REFUSALS) as refusal:
        write(tmp_path / name, "new")

    assert "\n" not in str(refusal.value)
    assert sorted(tmp_path.rglob("*")) == before
    assert not Path("/dev/null").is_file()


@pytest.mark.verifies("SWR-CLI-043", technique="error_guessing", polarity="violation")
def test_no_tool_writes_with_a_temporary_name_of_its_own() -> None:
    """Exempt: the writer itself, the result of a child of a step, and the report within a temporary folder."""
    known = {"trace/mamori_trace/base/whole_file.py", "tools/mamori_tools/host/steps.py", "trace/mamori_trace/actions/bundle.py"}
    own = re.compile(r"os\.replace\(|\.part\b[\"'}]")
    files = [path for folder in ("trace", "tools", "verification") for path in (ROOT / folder).rglob("*.py")]

    found = {path.relative_to(ROOT).as_posix() for path in files
             if not path.name.startswith("test_") and own.search(path.read_text(encoding="utf-8"))}  # fmt: skip

    assert found == known


def has_namespaces() -> bool:
    return shutil.which("unshare") is not None and subprocess.run(["unshare", "-rm", "true"], check=False, capture_output=True).returncode == 0


@pytest.mark.skipif(not has_namespaces(), reason="verdict=no-privilege: this host grants no mount namespace")
@pytest.mark.verifies("SWR-CLI-043", technique="fault_injection", polarity="violation")
def test_a_full_disk_keeps_the_previous_report(tmp_path: Path) -> None:
    """The disk has space for only one report."""
    project, disk = tmp_path / "project", tmp_path / "project" / "report"
    project.mkdir()
    subprocess.run([*PROGRAM, "trace", "init", "--root", str(project)], check=True, capture_output=True)
    (project / "build" / "host-release" / "evidence" / "junit").mkdir(parents=True)
    (project / "build" / "host-release" / "evidence" / "junit" / "a.xml").write_text('<testsuite><testcase name="a"/></testsuite>', encoding="utf-8")
    disk.mkdir()
    call = f"{' '.join(PROGRAM)} trace report --allow-missing --root {project}"
    script = f"""
        {call} >{tmp_path}/first 2>&1
        size=$(( $(stat -c %s {disk}/index.html) * 3 / 2 ))
        mount -t tmpfs -o size=$size none {disk} || exit 99
        {call} >{tmp_path}/first 2>&1
        sha256sum <{disk}/index.html
        {call} 2>{tmp_path}/said >{tmp_path}/shown
        echo $?
        sha256sum <{disk}/index.html
        ls -A {disk}
    """

    done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, check=False)

    before, status, after, *names = done.stdout.splitlines()
    said = (tmp_path / "said").read_text(encoding="utf-8")
    assert (status, after, names) == ("2", before, ["index.html"])
    assert "no room is left on the disk" in said and said.count("\n") == 1


@pytest.mark.parametrize("words", ["e2e --profile 5 --length 64 --rate 100 --pe 0.01 --json", "e2e --profile 5 --length 64 --rate 100 --pe 0.01",
                                   "bench --list", "mutate --list"])  # fmt: skip
@pytest.mark.verifies("SWR-CLI-044", technique="error_guessing", polarity="violation")
def test_a_reader_that_leaves_is_no_error(words: str) -> None:
    read, write = os.pipe()
    os.close(read)

    done = subprocess.run([*PROGRAM, *words.split()], stdout=write, stderr=subprocess.PIPE, text=True, check=False, cwd=ROOT)
    os.close(write)

    assert (done.returncode, done.stderr) == (141, "")


SCREEN = """
import sys
from pathlib import Path
from mamori_tools.command import main as command
from mamori_tools.host.project import Project
from mamori_tools.host.steps import Context, Step, run_steps

command.run = lambda argv: run_steps([Step("one", (("sleep", "0"),))], Context(Project(Path(sys.argv[1])), 1)) and 0
sys.exit(command.main([]))
"""


@pytest.mark.verifies("SWR-CLI-044", technique="error_guessing", polarity="violation")
def test_a_reader_that_leaves_a_table_of_steps_is_no_error(tmp_path: Path) -> None:
    read, write = os.pipe()
    os.close(read)

    done = subprocess.run([sys.executable, "-P", "-c", SCREEN, str(tmp_path)], stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)

    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.verifies("SWR-CLI-044", technique="fault_injection", polarity="violation")
def test_output_to_a_full_disk_ends_in_one_line() -> None:
    with open("/dev/full", "wb") as full:
        done = subprocess.run([*PROGRAM, *"e2e --profile 5 --length 64 --rate 100 --pe 0.01".split()], stdout=full, stderr=subprocess.PIPE,
                              text=True, check=False)  # fmt: skip

    assert done.returncode == 2
    assert done.stderr == "mamori: no room is left on the disk; make room, then call again\n"


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (OSError(28, "No space left on device", "build/x"), "build/x: no room is left on the disk; make room, then call again"),
        (PermissionError(13, "Permission denied", "build/log"), "build/log: permission denied; give your user the right to it"),
        (OSError(5, "Input/output error"), "Input/output error; mend it, then call again"),
        (UnicodeEncodeError("utf-8", "a\udcff", 1, 2, "surrogates not allowed"), "'a\\udcff' has a character that is not valid text"),
    ],
)
@pytest.mark.verifies("SWR-CLI-044", technique="fault_injection", polarity="violation")
def test_a_refusal_of_the_system_ends_in_one_line(
    error: Exception, line: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def run(_: object) -> int:
        raise error

    monkeypatch.setattr("mamori_tools.command.main.run", run)

    assert main(["demo"]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"mamori: {line}") and said.count("\n") == 1
