# SPDX-License-Identifier: Apache-2.0
# Goal: each C++ sample of the manual is compiled. Method: the check on the manual itself, and on small pages with one defect each.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.check_layers import main
from verification.checks.manual_samples import BUILT, COMPILED, check_samples, find_samples

SOURCE = "class Wheel {\n    int speed{0};\n};\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for folder in ("kernel", "docs/manual/ja", "examples/minimal"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "examples/minimal/main.cpp").write_text(SOURCE, encoding="utf-8")
    return tmp_path


def check(root: Path, page: str, name: str = "wheel.md") -> list[tuple[str, int, str]]:
    (root / "docs/manual" / name).write_text(page, encoding="utf-8")
    return list(check_samples(root))


OWNERS = {"first_system.md": "SWR-TAB-009", "table_with_modes.md": "SWR-TAB-014", "porting.md": "SWR-CNF-008", "supervision.md": "SWR-SUP-033",
          "integrity.md": "SWR-AOU-010", "e2e.md": "SWR-E2E-040"}  # fmt: skip
"""Pages that have their own requirement."""
PAGES = sorted(path.relative_to(ROOT / "docs/manual").as_posix() for path in (ROOT / "docs/manual").rglob("*.md"))


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.verifies(OWNERS.get(name, "SWR-PRF-050"), technique="interface")) for name in PAGES]
)
def test_each_sample_of_the_manual_is_compiled(name: str) -> None:
    samples = find_samples((ROOT / "docs/manual" / name).read_text(encoding="utf-8"))

    assert [each for each in check_samples(ROOT) if each[0] == f"docs/manual/{name}"] == []
    assert name not in OWNERS or any(each.language == "cpp" for each in samples)


@pytest.mark.verifies("SWR-PRF-050", technique="interface")
@pytest.mark.parametrize("name", COMPILED)
def test_the_build_compiles_each_source_of_samples(name: str) -> None:
    path = ROOT / name
    lists = [folder / "CMakeLists.txt" for folder in path.parents if (folder / "CMakeLists.txt").is_file()]
    if path.suffix in (".h", ".hpp"):
        users = [each for each in path.parent.glob("*.c*") if f'"{path.name}"' in each.read_text(encoding="utf-8")]
        assert users
    else:
        users = [path]
    text = lists[0].read_text(encoding="utf-8")
    assert [each.name for each in users if each.name in text]


@pytest.mark.verifies("SWR-PRF-050", technique="interface")
def test_the_consumer_proof_builds_each_page_of_programs() -> None:
    proof = (ROOT / "verification/proofs/test_consumer.py").read_text(encoding="utf-8")
    assert [page for page in BUILT if f'"{page}"' not in proof] == []


@pytest.mark.verifies("SWR-PRF-050")
@pytest.mark.parametrize("page", [f"```cpp\n{SOURCE}```\n", "```cpp\nint speed{0};\n```\n", "Run:\n\n    ./mamori demo\n", "```text\nerror: a;\n```\n"])
def test_a_sample_that_is_compiled_is_accepted(root: Path, page: str) -> None:
    assert check(root, page) == []


@pytest.mark.verifies("SWR-PRF-050", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("page", "line", "message"),
    [
        ("# Wheel\n\n```cpp\nint sped{0};\n```\n", 3, "no source compiles this sample"),
        ("```cpp\nint main() {}\n```\n", 1, "no source compiles this sample"),
        ("```c\nint sped;\n```\n", 1, "no source compiles this sample"),
        ("```cpp\nint speed{0};\n", 1, ""),
        ("```c++\nint speed{0};\n```\n", 1, "language 'c++' of a sample is unknown; valid: cpp, c, cmake, text"),
        ("Text:\n\n    wheel.set_speed(3);  // [rad/s]\n", 3, "C++ sample without a fence; begin it with ```cpp"),
        ("\n    #include <array>\n", 2, "C++ sample without a fence"),
    ],
)
def test_a_sample_that_nothing_compiles_is_found_with_its_line(root: Path, page: str, line: int, message: str) -> None:
    found = check(root, page, "ja/wheel.md")

    assert found == [] if not message else [(name, number) for name, number, _ in found] == [("docs/manual/ja/wheel.md", line)]
    assert not message or found[0][2].startswith(message)


@pytest.mark.verifies("SWR-PRF-050", technique="interface", polarity="violation")
def test_the_layer_check_reports_a_sample(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check(root, "```cpp\nint sped{0};\n```\n")

    assert main(["--root", str(root)]) == 1
    assert "docs/manual/wheel.md:1: sample: no source compiles this sample" in capsys.readouterr().out
