# SPDX-License-Identifier: Apache-2.0
# Goal: an expression of the list is found in every text, and an increase of its number is detected. Method: small trees.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.check_layers import main
from verification.checks.wording import WORDING, check_wording, lower, read_expressions

LIST = '[[expression]]\ntext = "at all"\ninstead = "(delete)"\nmax = {maximum}\n'


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "kernel").mkdir()
    (tmp_path / "docs" / "adr").mkdir(parents=True)
    (tmp_path / "docs" / "a.md").write_text("Nothing At\nall. A total all.\n", encoding="utf-8")
    (tmp_path / "kernel" / "a.hpp").write_text("// one\n/// at\n/// all\n", encoding="utf-8")
    (tmp_path / "docs" / "adr" / "0001-a.md").write_text("at all\n", encoding="utf-8")
    return tmp_path


def check(root: Path, maximum: int) -> list[tuple[str, int, str]]:
    file = root / "list.toml"
    file.write_text(LIST.format(maximum=maximum), encoding="utf-8")
    return list(check_wording(root, file))


@pytest.mark.verifies("SWR-PRF-043")
def test_the_texts_of_the_project_keep_the_list() -> None:
    assert list(check_wording(ROOT)) == []
    assert len(read_expressions()) >= 40


@pytest.mark.verifies("SWR-PRF-043", technique="boundary_values", polarity="violation")
def test_an_expression_that_became_more_frequent_is_found_with_its_lines(root: Path) -> None:
    assert check(root, 2) == []

    message = "'at all' occurs 2 times, at most {} are allowed; write: (delete)"
    assert check(root, 1) == [("docs/a.md", 1, message.format(1)), ("kernel/a.hpp", 2, message.format(1))]
    assert check(root, 0) == [("docs/a.md", 1, message.format(0)), ("kernel/a.hpp", 2, message.format(0))]


@pytest.mark.verifies("SWR-PRF-043", technique="boundary_values", polarity="violation")
def test_a_maximum_that_is_too_high_is_found_and_can_be_lowered(root: Path) -> None:
    assert check(root, 3) == [("list.toml", 1, "'at all' occurs 2 times; lower its max from 3")]

    lower(root, root / "list.toml")

    assert (root / "list.toml").read_text(encoding="utf-8") == LIST.format(maximum=2)
    assert list(check_wording(root, root / "list.toml")) == []


@pytest.mark.verifies("SWR-PRF-043", technique="interface", polarity="violation")
def test_the_layer_check_reports_wording(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = root / WORDING
    file.parent.mkdir(parents=True)
    file.write_text(LIST.format(maximum=2), encoding="utf-8")
    assert main(["--root", str(root)]) == 0

    (root / "docs" / "b.md").write_text("Not at all.\n", encoding="utf-8")

    assert main(["--root", str(root)]) == 1
    assert "docs/a.md:1: wording: 'at all' occurs 3 times, at most 2 are allowed; write: (delete)\n" in capsys.readouterr().out
