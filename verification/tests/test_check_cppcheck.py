# SPDX-License-Identifier: Apache-2.0
# Goal: the step "cppcheck" fails for each finding, also in a repeated run, which analyses only what changed. Method: cppcheck itself, on two
# small files with a finding in one file, in a header, and about both files together.
from __future__ import annotations

from pathlib import Path

import pytest

from verification.checks import check_cppcheck

CLEAN = '#include "a.hpp"\nint twice(int value) { return 2 * value; }\n'
NULL = "int read(const int* p) { if (p == nullptr) { return *p; } return 0; }\n"
FILES = ("a.cpp", "b.cpp")


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "a.hpp").write_text("#pragma once\n", encoding="utf-8")
    (tmp_path / "a.cpp").write_text(CLEAN, encoding="utf-8")
    (tmp_path / "b.cpp").write_text('#include "a.hpp"\nint thrice(int value) { return 3 * value; }\n', encoding="utf-8")
    return tmp_path


def check(root: Path) -> int:
    return check_cppcheck.check(root, FILES, ["-I."], 2)


@pytest.mark.parametrize(
    ("name", "content", "finding"),
    [
        ("a.cpp", CLEAN + NULL, "a.cpp:3"),
        ("a.hpp", "#pragma once\ninline " + NULL, "a.hpp:2"),
        ("a.cpp", CLEAN + "struct Twin { int value; };\nint f(Twin t) { return t.value; }\n", "ctuOneDefinitionRuleViolation"),
    ],
)
def test_each_finding_fails_the_step_again_until_it_is_corrected(
    root: Path, capsys: pytest.CaptureFixture[str], name: str, content: str, finding: str
) -> None:
    if "Twin" in content:
        (root / "b.cpp").write_text("struct Twin { double value; double other; };\ndouble g(Twin t) { return t.value; }\n", encoding="utf-8")
    before = (root / name).read_text(encoding="utf-8")
    assert check(root) == 0

    (root / name).write_text(content, encoding="utf-8")
    for _ in range(2):
        capsys.readouterr()
        assert check(root) == 1
        assert finding in capsys.readouterr().out

    (root / name).write_text(before, encoding="utf-8")
    assert check(root) == 0


def test_changed_options_analyse_all_files_again(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    only_17 = "#if __cplusplus >= 201703L\n" + NULL + "#endif\n"
    (root / "a.cpp").write_text(CLEAN + only_17, encoding="utf-8")
    options = check_cppcheck.OPTIONS
    monkeypatch.setattr(check_cppcheck, "OPTIONS", tuple(option.replace("c++17", "c++11") for option in options))
    assert check(root) == 0
    monkeypatch.setattr(check_cppcheck, "OPTIONS", options)

    assert check(root) == 1
