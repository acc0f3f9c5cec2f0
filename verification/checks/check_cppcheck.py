# SPDX-License-Identifier: Apache-2.0
"""Analyses the sources of kernel, safety and ports with cppcheck.

    python -m verification.checks.check_cppcheck [--root FOLDER] [--jobs N]

Exit status 0 without findings, 1 with findings, 2 for wrong arguments, 3 if cppcheck is missing. Below build/, cppcheck stores the findings of
each file. It repeats them while the file and its headers are unchanged.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from mamori_tools.host.project import CHECKED_LAYERS, Project

ROOT = Path(__file__).resolve().parents[2]
# Each part of a table defines the constants that it changes. NoTypes defines the constants for parts that change nothing.
PARTS_HIDE_CONSTANTS = "--suppress=duplInheritedMember:kernel/include/mamori/kernel/*part*.hpp"
OPTIONS = ("--quiet", "--language=c++", "--std=c++17", "--enable=warning,performance,portability", "--suppress=missingIncludeSystem",
           PARTS_HIDE_CONSTANTS, "--inline-suppr")  # fmt: skip


def check(root: Path, files: Sequence[str], includes: Sequence[str], jobs: int) -> int:
    """@param files, includes relative to `root`. @return exit status."""
    tool = shutil.which("cppcheck")
    if tool is None:
        print("cppcheck is not installed; run ./mamori test --install, which installs it", file=sys.stderr)
        return 3
    version = subprocess.run([tool, "--version"], capture_output=True, text=True, check=True).stdout
    # cppcheck does not notice that its options changed.
    name = hashlib.sha256("\n".join([version, *OPTIONS]).encode()).hexdigest()[:12]
    folder = root / "build" / "cppcheck" / name
    folder.mkdir(parents=True, exist_ok=True)
    done = subprocess.run([tool, *OPTIONS, f"--cppcheck-build-dir={folder}", "-j", str(jobs), *includes, *files], cwd=root, capture_output=True,
                          text=True, check=False)  # fmt: skip
    findings = done.stdout + done.stderr
    print(findings, end="")
    # With several jobs, its exit status does not include findings about several files.
    return 1 if findings or done.returncode else 0


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="check_cppcheck", description="Analyses kernel, safety and ports with cppcheck.")
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree (default: the one of this file)")
    parser.add_argument("--jobs", type=int, default=1, help="parallel jobs (default: 1)")
    arguments = parser.parse_args(argv)
    root = arguments.root.resolve()
    files = [name for name in Project(root).cpp_sources(CHECKED_LAYERS) if "/src/" in name]
    includes = [f"-I{path.relative_to(root)}" for layer in CHECKED_LAYERS for path in sorted((root / layer).rglob("include")) if path.is_dir()]
    return check(root, files, includes, arguments.jobs)


if __name__ == "__main__":
    sys.exit(main())
