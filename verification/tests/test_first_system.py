# SPDX-License-Identifier: Apache-2.0
# Goal: the smallest example is short, and its page shows the compiler message. Method: the example without its connection.
from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "examples" / "minimal" / "main.cpp"
PAGE = ROOT / "docs" / "manual" / "first_system.md"
INCLUDES = [f"-I{ROOT / layer / 'include'}" for layer in ("kernel", "safety", "ports/virtual_time")]
CONNECTION = "mamori::connect(wheel.speed, monitor.speed, mamori::any_age()),"


def find_blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


def compile_text(compiler: str, text: str, folder: Path) -> subprocess.CompletedProcess[str]:
    (folder / "main.cpp").write_text(text, encoding="utf-8")
    return subprocess.run([compiler, "-std=c++17", "-fsyntax-only", *INCLUDES, str(folder / "main.cpp")], capture_output=True,
                          text=True, check=False, timeout=120)  # fmt: skip


@pytest.mark.verifies("SWR-TAB-009", technique="boundary_values")
def test_example_is_one_short_file() -> None:
    text = SOURCE.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 50
    assert text[text.index("int main()") :].count(";") <= 3
    assert sorted(path.name for path in SOURCE.parent.iterdir()) == ["CMakeLists.txt", "main.cpp"]


# Every command that builds provides g++; those that check also provide clang.
@pytest.mark.verifies("SWR-TAB-009", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("compiler", [name for name in ("g++", "clang++-19") if shutil.which(name) is not None])
def test_missing_connection_is_refused_with_the_message_of_the_page(compiler: str, tmp_path: Path) -> None:
    source = SOURCE.read_text(encoding="utf-8")
    assert source.count(CONNECTION) == 1

    assert compile_text(compiler, source, tmp_path).returncode == 0
    refused = compile_text(compiler, source.replace(CONNECTION, ""), tmp_path)

    assert refused.returncode == 1
    (message,) = find_blocks("text")
    assert [line for line in message.splitlines() if line not in refused.stderr] == []
