# SPDX-License-Identifier: Apache-2.0
# Goal: `new` creates a complete project from the example, or nothing. verification/proofs/test_plain_cmake.py proves that it builds and
# that its tests pass.
from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from mamori_tools.command import main as command
from mamori_tools.command import new_project
from mamori_tools.command.new_project import new
from mamori_tools.host.project import ROOT
from mamori_trace.actions import review
from mamori_trace.base.errors import InputError

FILES = [".gitignore", "CMakeLists.txt", "README.md", "requirements/schema/items.toml", "requirements/software.md",
         "requirements/system.md", "requirements/trace.lock", "src/components.hpp", "src/main.cpp", "src/system.hpp",
         "tests/system_test.cpp"]  # fmt: skip


def list_files(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


@pytest.mark.verifies("SWR-CLI-024")
def test_new_project_has_all_files_and_the_code_of_the_example(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert new(tmp_path / "robot_1") == 0

    folder = tmp_path / "robot_1"
    assert list_files(folder) == FILES
    assert os.listdir(tmp_path) == ["robot_1"]
    assert str(folder) in capsys.readouterr().out
    example = (ROOT / "examples" / "minimal" / "main.cpp").read_text(encoding="utf-8")
    shown = "".join((folder / "src" / name).read_text(encoding="utf-8") for name in ("components.hpp", "system.hpp", "main.cpp"))
    lost = [line for line in example.splitlines() if line not in shown]
    assert [line for line in lost if not line.startswith("// ") and "class Monitor" not in line] == []


@pytest.mark.verifies("SWR-CLI-024", technique="interface")
def test_folder_has_the_rights_that_the_user_gives_to_new_folders(tmp_path: Path) -> None:
    new(tmp_path / "robot")
    (tmp_path / "other").mkdir()

    assert (tmp_path / "robot").stat().st_mode == (tmp_path / "other").stat().st_mode


@pytest.mark.verifies("SWR-CLI-024", technique="back_to_back")
def test_links_of_a_new_project_are_reviewed_and_only_results_are_missing(tmp_path: Path) -> None:
    new(tmp_path / "robot")
    (tmp_path / "robot" / "evidence").mkdir()

    check = ["trace", "check", "--root", str(tmp_path / "robot"), "--evidence", str(tmp_path / "robot" / "evidence"), "--allow-missing"]
    assert command.main(check) == 0
    lock = tmp_path / "robot" / "requirements" / "trace.lock"
    lock.write_text(lock.read_text(encoding="utf-8").replace("SYS-001", "SYS-002"), encoding="utf-8")
    assert command.main(check) == 1


@pytest.mark.verifies("SWR-CLI-024", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("lost", ["static Wheel wheel;", "class Monitor ", "static void print(", "int main() {\n"])
def test_example_that_changed_its_form_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lost: str) -> None:
    for file in new_project.EXAMPLE.iterdir():
        (tmp_path / file.name).write_text(file.read_text(encoding="utf-8").replace(lost, "something else "), encoding="utf-8")
    monkeypatch.setattr(new_project, "EXAMPLE", tmp_path)

    with pytest.raises(RuntimeError, match=r"examples/minimal|must be there once"):
        new_project.make_files("robot")


BAD_NAMES = ["", ".", "..", "Robot", "1robot", "_robot", "my-robot", "my robot", "robot.", "röbot", "robot\n", "x" * 65, "test", "all", "mamori"]


@pytest.mark.verifies("SWR-CLI-025", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("name", BAD_NAMES)
def test_invalid_name_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], name: str) -> None:
    monkeypatch.chdir(tmp_path)

    assert command.main(["new", name]) == 2

    assert capsys.readouterr().err.rstrip("\n").count("\n") <= name.count("\n")
    assert os.listdir(tmp_path) == []


@pytest.mark.verifies("SWR-CLI-025", technique="boundary_values")
def test_longest_name_is_accepted(tmp_path: Path) -> None:
    assert new(tmp_path / ("x" * 64)) == 0


@pytest.mark.verifies("SWR-CLI-025", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("kind", ["folder", "file", "dangling link"])
def test_what_exists_is_left_alone(tmp_path: Path, kind: str) -> None:
    target = tmp_path / "robot"
    if kind == "folder":
        target.mkdir()
    elif kind == "file":
        target.write_text("mine", encoding="utf-8")
    else:
        target.symlink_to(tmp_path / "nowhere")

    with pytest.raises(InputError, match="exists already"):
        new(target)
    assert os.listdir(tmp_path) == ["robot"]
    assert kind != "file" or target.read_text(encoding="utf-8") == "mine"


@pytest.mark.verifies("SWR-CLI-025", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize("parent", [ROOT, ROOT / "examples"])
def test_place_inside_the_source_tree_is_refused_by_any_way(tmp_path: Path, parent: Path) -> None:
    (tmp_path / "link").symlink_to(parent)

    for path in (parent / "robot", tmp_path / "link" / "robot"):
        with pytest.raises(InputError, match="source tree"):
            new(path)
    assert not (parent / "robot").exists()


@pytest.mark.verifies("SWR-CLI-025", technique="error_guessing", polarity="violation")
def test_place_that_is_missing_or_cannot_be_written_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path / "gone" / "robot", Path("/proc/robot")):
        done = subprocess.run([sys.executable, "-P", "-m", "mamori_tools.command", "new", str(path)],
                              capture_output=True, text=True, check=False)  # fmt: skip
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
        assert str(path.parent) in done.stderr


@pytest.mark.verifies("SWR-CLI-025", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("error", "status"), [(OSError(errno.ENOSPC, "No space left on device"), 2), (KeyboardInterrupt(), 130)])
@pytest.mark.parametrize("at", range(len(FILES) + 1))
def test_full_disk_or_ctrl_c_at_any_file_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], error: BaseException, status: int, at: int
) -> None:
    write, calls = Path.write_text, 0

    def fail(path: Path, *words: str, **options: str) -> int:
        nonlocal calls
        calls += 1
        if calls == at + 1:
            raise error
        return write(path, *words, **options)

    def fail_review(arguments: object) -> int:
        raise InputError("trace.lock: cannot be written") if isinstance(error, OSError) else error

    monkeypatch.setattr(Path, "write_text", fail)
    if at >= len(FILES) - 1:  # the last file is the record of reviewed links
        monkeypatch.setattr(review, "run", fail_review)

    assert command.main(["new", str(tmp_path / "robot")]) == status
    assert os.listdir(tmp_path) == []
    assert "Traceback" not in capsys.readouterr().err
