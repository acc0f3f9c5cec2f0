# SPDX-License-Identifier: Apache-2.0
# Goal: code, tests, documents and data are counted separately, and the share of verification has a limit. Method: a small tree.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.code_size import check_share, count_code, list_tracked


def count(root: Path, files: dict[str, str]) -> str:
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return str(count_code(root, files))


@pytest.mark.verifies("SWR-PRF-042", technique="equivalence_classes")
def test_code_tests_documents_and_data_are_counted_apart(tmp_path: Path) -> None:
    files = {"kernel/src/a.cpp": "a\n\n// b\n", "kernel/tests/a_test.cpp": "a\n", "verification/a.py": "a\n", "verification/test_a.py": "a\nb\n",
             "docs/a.md": "one two\nthree\n", "a.toml": "a = 1\n", "CMakeLists.txt": "a\n"}  # fmt: skip

    assert count(tmp_path, files) == "size: 5 lines of code (20.0% in verification), 3 of tests, 3 words of documents, 7 files"


@pytest.mark.parametrize(("lines", "found"), [(1, 0), (2, 1)])
@pytest.mark.verifies("SWR-PRF-042", technique="boundary_values", polarity="violation")
def test_a_share_of_verification_over_the_limit_is_found(tmp_path: Path, lines: int, found: int) -> None:
    count(tmp_path, {"kernel/a.cpp": "a\n" * 3, "verification/a.py": "a\n" * lines})

    assert len(check_share(count_code(tmp_path, ["kernel/a.cpp", "verification/a.py"]))) == found


@pytest.mark.verifies("SWR-PRF-042", technique="equivalence_classes")
def test_a_tree_without_git_is_listed_without_what_is_generated(tmp_path: Path) -> None:
    count(tmp_path, {"kernel/a.cpp": "a\n", "build/a.cpp": "a\n", "report/a.cpp": "a\n", ".venv/a.py": "a\n", "tools/__pycache__/a.py": "a\n"})

    assert list_tracked(tmp_path) == ["kernel/a.cpp"]


@pytest.mark.verifies("SWR-PRF-042")
def test_the_project_keeps_the_limit() -> None:
    size = count_code(ROOT, list_tracked(ROOT))

    assert size.files > 1000
    assert check_share(size) == []
