# SPDX-License-Identifier: Apache-2.0
# Goal: a harness that reads beyond its input is found; the input is stored, and the report shows a command that repeats the finding.
# Method: the runner on a small separate project, with harnesses that are correct, overflow, or do not compile.
from __future__ import annotations

import json
import shlex
import subprocess
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import InputError
from verification.fuzz.command import FOLDER, Request, fuzz
from verification.fuzz.harness import find_harnesses, read_corpus

KERNEL = """\
int calc_sum(const unsigned char* data, int size) {{
    int sum = 0;
    for (int i = 0; i < size{error}; ++i) sum += data[i];
    return sum;
}}
"""
HARNESS = """\
#include <cstddef>
#include <cstdint>
int calc_sum(const unsigned char* data, int size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return calc_sum(data, static_cast<int>(size)) < 0;
}
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A project whose kernel is one function, and one harness for this function, `sum`."""
    (tmp_path / "kernel" / "src").mkdir(parents=True)
    (tmp_path / "kernel" / "src" / "sum.cpp").write_text(KERNEL.format(error=""), encoding="utf-8")
    (tmp_path / "fuzz").mkdir()
    (tmp_path / "fuzz" / "sum_fuzz.cpp").write_text(HARNESS, encoding="utf-8")
    return tmp_path


def run(root: Path, *names: str, keep: bool = False) -> int:
    return fuzz(Request(names, seconds=1, keep=keep), root / "fuzz", root)


@pytest.mark.verifies("SWR-VER-010")
def test_sound_harness_passes_and_is_counted(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(root) == 0

    assert "sum: passed: " in capsys.readouterr().out
    (row,) = json.loads((root / "build" / "host-release" / "evidence" / "fuzz" / "fuzz.json").read_text("utf-8"))["harnesses"]
    assert row["executions"] > 0
    assert row["edges"] > 0
    assert row["findings"] == []


@pytest.mark.verifies("SWR-VER-010", technique="fault_injection", polarity="violation")
def test_seeded_overflow_is_found_kept_and_can_be_repeated(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "kernel" / "src" / "sum.cpp").write_text(KERNEL.format(error=" + 1"), encoding="utf-8")

    assert run(root) == 1

    told = capsys.readouterr().out
    assert "heap-buffer-overflow" in told
    assert "sum: FAILED" in told
    command = next(line.split("again:")[1] for line in told.splitlines() if "again:" in line)
    again = subprocess.run(shlex.split(command), capture_output=True, text=True, check=False)
    assert again.returncode != 0
    assert "heap-buffer-overflow" in again.stderr


@pytest.mark.verifies("SWR-VER-010", technique="error_guessing", polarity="violation")
def test_harness_that_does_not_compile_fails_with_the_reason(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "fuzz" / "sum_fuzz.cpp").write_text("int f() { return g(); }\n", encoding="utf-8")

    assert run(root) == 1
    assert "use of undeclared identifier 'g'" in capsys.readouterr().err


@pytest.mark.verifies("SWR-VER-010", technique="interface")
def test_new_inputs_are_kept_when_asked_only(root: Path) -> None:
    assert run(root) == 0
    assert not (root / "fuzz" / "corpus").exists()

    assert run(root, keep=True) == 0
    kept = read_corpus(root / "fuzz" / "corpus" / "sum.txt")
    assert len(kept) > 0

    assert run(root, keep=True) == 0
    assert kept.items() <= read_corpus(root / "fuzz" / "corpus" / "sum.txt").items()


@pytest.mark.verifies("SWR-VER-011")
def test_every_shipped_harness_is_found_and_has_a_corpus(tmp_path: Path) -> None:
    harnesses = find_harnesses(FOLDER, tmp_path)

    assert {harness.name for harness in harnesses} >= {"event_log"}
    assert [harness.name for harness in harnesses if not read_corpus(harness.corpus)] == []
    assert FOLDER.is_relative_to(ROOT)


@pytest.mark.verifies("SWR-VER-011", technique="error_guessing", polarity="violation")
def test_no_harness_at_all_is_a_failure(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "fuzz" / "sum_fuzz.cpp").unlink()

    assert run(root) == 1
    assert "nothing was fuzzed" in capsys.readouterr().err


@pytest.mark.verifies("SWR-VER-011", technique="equivalence_classes", polarity="violation")
def test_unknown_harness_is_refused_with_the_nearest(root: Path) -> None:
    with pytest.raises(InputError, match=r"there is no harness 'summ'.*sum"):
        run(root, "summ")


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [("a QUI=\nb Q?I=\n", 2, "is not an input"), ("a QUI=\n../b QUI=\n", 2, "'../b' is no name"), ("QUI=\n", 1, "'QUI=' is no name"),
     ("a QUI=\na QQ==\n", 2, "input a is there twice")],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-011", technique="equivalence_classes", polarity="violation")
def test_a_corpus_that_is_damaged_is_refused_with_its_line(root: Path, text: str, line: int, reason: str) -> None:
    file = root / "fuzz" / "corpus" / "sum.txt"
    file.parent.mkdir()
    file.write_text(text, encoding="utf-8")

    with pytest.raises(InputError, match=f"sum.txt:{line}: .*{reason}"):
        run(root)
