# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori lcm types` writes what a program prints as files that lcm-gen accepts, and rejects any other program in one line.
# Method: the command in this process; programs are shell scripts with the output of print_lcm_types().
from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from mamori_tools.command.main import main

INNER = "// Made by Mamori from the field list of a::b::Point. Change that list, not this file.\npackage a.b;\n\nstruct Point {\n    double x;\n}\n"
OUTER = (
    "// Made by Mamori from the field list of a::Cloud. Change that list, not this file.\npackage a;\n\nstruct Cloud_e2e {\n    byte e2e[12];\n"
    "    int32_t n_points;  // 0 .. 4\n    a.b.Point points[n_points];\n}\n"
)


def write_program(folder: Path, output: str, status: int = 0) -> Path:
    (folder / "output").write_text(output, encoding="utf-8")
    program = folder / "program"
    program.write_text(f"#!/bin/sh\ncat '{folder}/output'\nexit {status}\n", encoding="utf-8")
    program.chmod(0o755)
    return program


@pytest.mark.verifies("SWR-LCM-013", technique="requirements_based")
def test_each_struct_becomes_a_file(tmp_path: Path) -> None:
    program = write_program(tmp_path, INNER + OUTER + INNER)

    assert main(["lcm", "types", str(program), "--out", str(tmp_path / "new" / "types")]) == 0

    written = {path.name: path.read_text(encoding="utf-8") for path in (tmp_path / "new" / "types").iterdir()}
    assert written == {"a.b.Point.lcm": INNER, "a.Cloud_e2e.lcm": OUTER}


@pytest.mark.verifies("SWR-LCM-013", technique="back_to_back")
@pytest.mark.skipif(shutil.which("lcm-gen") is None, reason="lcm-gen is not installed")
def test_lcm_gen_accepts_the_files(tmp_path: Path) -> None:
    assert main(["lcm", "types", str(write_program(tmp_path, INNER + OUTER)), "--out", str(tmp_path / "types")]) == 0

    files = [str(path) for path in sorted((tmp_path / "types").iterdir())]
    done = subprocess.run(["lcm-gen", "--python", "--ppath", str(tmp_path / "python"), *files], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "python" / "a" / "Cloud_e2e.py").is_file()


@pytest.mark.verifies("SWR-LCM-013", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("output", "status", "message"),
    [("", 0, "printed no LCM type"), ("hello\n", 0, "line 1 of its output"), (INNER + "x\n", 0, "line 7 of its output"),
     (INNER[:-3], 0, "line 1 of its output"), (INNER, 1, "ended with status 1"), ("ä", 0, "is not ASCII"),
     (INNER + INNER.replace("double", "float"), 0, "two different types are named a.b.Point"),
     (INNER.replace("package a.b", "package ../a"), 0, "line 1 of its output")],
)  # fmt: skip
def test_any_other_output_is_rejected_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str], output: str, status: int, message: str) -> None:
    assert main(["lcm", "types", str(write_program(tmp_path, output, status)), "--out", str(tmp_path / "types")]) == 2

    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1
    assert message in errors[0]
    assert not (tmp_path / "types").exists()


@pytest.mark.verifies("SWR-LCM-013", technique="equivalence_classes", polarity="violation")
def test_what_cannot_be_started_or_written_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = write_program(tmp_path, INNER)
    text = tmp_path / "text"
    text.write_text("no program", encoding="utf-8")
    for words, place in (([str(tmp_path / "absent"), "--out", "x"], "absent"), ([str(text), "--out", "x"], "text"),
                         ([str(program), "--out", str(text / "types")], "types")):  # fmt: skip
        assert main(["lcm", "types", *words]) == 2
        errors = capsys.readouterr().err.splitlines()
        assert len(errors) == 1
        assert place in errors[0]
