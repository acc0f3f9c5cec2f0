# SPDX-License-Identifier: Apache-2.0
"""Counts lines of code and tests, words of documents, and files of the project. Limits the share of `verification` in the code.

    python -m verification.checks.code_size

All lines of a file count, including comments and empty lines. Data (requirements, TOML, JSON) count only as files.

Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import subprocess
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

CODE_SUFFIXES = frozenset((".cpp", ".hpp", ".c", ".h", ".py", ".rs", ".sh", ".cmake", ".S", ".ld", ".js", ".css", ".html"))
CODE_NAMES = frozenset(("mamori", "CMakeLists.txt"))
VERIFICATION_SHARE_MAX = 0.25
GENERATED = ("build", "report")


@dataclass
class Size:
    """`code` and `tests` by top folder, in lines; `words` of documents."""

    code: Counter[str] = field(default_factory=Counter)
    tests: Counter[str] = field(default_factory=Counter)
    words: int = 0
    files: int = 0

    @property
    def share(self) -> float:
        """Share of `verification` in the code."""
        return self.code["verification"] / max(1, self.code.total())

    def __str__(self) -> str:
        return (f"size: {self.code.total():,} lines of code ({self.share:.1%} in verification), {self.tests.total():,} of tests,"
                f" {self.words:,} words of documents, {self.files:,} files")  # fmt: skip


def list_tracked(root: Path) -> list[str]:
    """Files that git tracks; without a git checkout, all files that are not generated."""
    done = subprocess.run(("git", "-C", str(root), "ls-files", "-z"), capture_output=True, text=True, check=False)
    if done.returncode == 0 and done.stdout:
        return [name for name in done.stdout.split("\0") if name]
    names = (path.relative_to(root) for path in root.rglob("*") if path.is_file())
    return [str(name) for name in names if name.parts[0] not in GENERATED and not name.parts[0].startswith(".") and "__pycache__" not in name.parts]


def count_code(root: Path, names: Iterable[str]) -> Size:
    """@param names files relative to `root`."""
    size = Size()
    for name in names:
        path = root / name
        if not path.is_file():
            continue
        size.files += 1
        top = name.split("/")[0]
        if path.suffix == ".md":
            size.words += len(path.read_text(encoding="utf-8").split())
        elif path.suffix in CODE_SUFFIXES or path.name in CODE_NAMES:
            lines = path.read_bytes().count(b"\n")
            (size.tests if is_test(path.relative_to(root)) else size.code)[top] += lines
    return size


def is_test(path: Path) -> bool:
    return "tests" in path.parts or path.name.startswith(("test_", "conftest"))


def check_share(size: Size) -> list[str]:
    """@return the exceeded limits."""
    if size.share <= VERIFICATION_SHARE_MAX:
        return []
    return [f"verification has {size.share:.1%} of the code, {VERIFICATION_SHARE_MAX:.0%} are the limit; move what users run to tools/"]


if __name__ == "__main__":
    print(count_code(Path(), list_tracked(Path())))
