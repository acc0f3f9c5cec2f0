# SPDX-License-Identifier: Apache-2.0
# Goal: the list of safety headers that the example arm does not use is complete. Method: the check on the project itself, and on a small tree with one
# defect each.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.check_layers import main
from verification.checks.unused_headers import HEADING, LIMIT, PAGE, check_unused, find_used

FILES = {
    "examples/safe_arm/arm.cpp": '#include "arm.hpp"\n',
    "examples/safe_arm/arm.hpp": '#include "mamori/ports/clock.hpp"\n#include <vector>\n',
    "examples/safe_arm/tests/arm_test.cpp": '#include "mamori/safety/voter.hpp"\n',
    "ports/clock/include/mamori/ports/clock.hpp": '#include "mamori/safety/clock.hpp"\n',
    "safety/include/mamori/safety/clock.hpp": '#include "mamori/safety/elapsed.hpp"\n',
    "safety/include/mamori/safety/elapsed.hpp": '#include "mamori/safety/clock.hpp"\n',
    "safety/include/mamori/safety/voter.hpp": '#include "mamori/safety/clock.hpp"\n',
}
ROW = "| `mamori/safety/voter.hpp` | The arm has one channel |\n"
TAIL = "\n## Moved headers\n\n| `mamori/safety/clock.hpp` | moved |\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "kernel").mkdir()
    (tmp_path / PAGE).parent.mkdir(parents=True)
    return tmp_path


def check(root: Path, rows: str) -> list[tuple[int, str]]:
    (root / PAGE).write_text(f"# Headers\n\n{HEADING}\n\n| header | reason |\n|---|---|\n{rows}{TAIL}", encoding="utf-8")
    found = list(check_unused(root))
    assert {file for file, _, _ in found} <= {PAGE}
    return [(line, message) for _, line, message in found]


@pytest.mark.verifies("SWR-PRF-051", technique="interface")
def test_the_list_of_the_project_is_complete() -> None:
    assert list(check_unused(ROOT)) == []
    assert ROOT / "safety/include/mamori/safety/cycle/safety_cycle.hpp" in find_used(ROOT)


@pytest.mark.verifies("SWR-PRF-051")
def test_headers_that_are_used_through_others_need_no_row(root: Path) -> None:
    assert check(root, ROW) == []


@pytest.mark.verifies("SWR-PRF-051")
def test_a_tree_without_the_page_has_no_list(root: Path) -> None:
    assert list(check_unused(root)) == []


@pytest.mark.verifies("SWR-PRF-051", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("rows", "line", "message"),
    [
        ("", 3, "the example arm does not use 'mamori/safety/voter.hpp'; add a row with the reason"),
        ("| `mamori/safety/voter.hpp` | |\n", 3, "the example arm does not use 'mamori/safety/voter.hpp'"),
        (ROW + ROW, 8, "two rows for 'mamori/safety/voter.hpp'; keep one"),
        (ROW + "| `mamori/safety/elapsed.hpp` | Not needed |\n", 8, "'mamori/safety/elapsed.hpp' is used by the example arm; remove the row"),
        (ROW + "| `mamori/safety/voters.hpp` | Not needed |\n", 8, "'mamori/safety/voters.hpp' is not a safety header; remove the row"),
    ],
)
def test_a_wrong_row_is_found_with_its_line(root: Path, rows: str, line: int, message: str) -> None:
    ((number, text),) = check(root, rows)

    assert number == line
    assert text.startswith(message)


def list_headers(root: Path, count: int) -> str:
    """@return rows of voter.hpp and of as many new headers as make `count` rows."""
    names = [f"mamori/safety/unused_{number}.hpp" for number in range(1, count)]
    for name in names:
        (root / "safety/include" / name).write_text("", encoding="utf-8")
    return ROW + "".join(f"| `{name}` | Not needed |\n" for name in names)


@pytest.mark.verifies("SWR-PRF-051", technique="boundary_values")
def test_a_list_of_twelve_headers_is_accepted(root: Path) -> None:
    assert LIMIT == 12
    assert check(root, list_headers(root, 12)) == []


@pytest.mark.verifies("SWR-PRF-051", technique="boundary_values", polarity="violation")
def test_a_list_of_thirteen_headers_is_too_long(root: Path) -> None:
    message = "13 headers that the example arm does not use; the limit is 12: use a header in the example, or remove it"
    assert check(root, list_headers(root, 13)) == [(3, message)]


@pytest.mark.verifies("SWR-PRF-051", technique="fault_injection", polarity="violation")
def test_a_page_without_the_list_is_found(root: Path) -> None:
    (root / PAGE).write_text("# Headers\n", encoding="utf-8")

    assert [line for _, line, _ in check_unused(root)] == [1]


@pytest.mark.verifies("SWR-PRF-051", technique="interface", polarity="violation")
def test_the_layer_check_reports_an_unused_header(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check(root, "")

    assert main(["--root", str(root)]) == 1
    assert f"{PAGE}:3: unused: the example arm does not use" in capsys.readouterr().out
