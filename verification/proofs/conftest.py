# SPDX-License-Identifier: Apache-2.0
"""Fixtures of the proofs: the source tree, its release build, compilation of a seeded violation."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project

SUBSET_FLAGS = ("-std=c++17", "-O2", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics")


@pytest.fixture(scope="session")
def project() -> Project:
    """The source tree; its release build must exist (`./mamori build`)."""
    project = Project(ROOT)
    if not (project.build / "CMakeCache.txt").exists():
        pytest.skip(f"{project.build} is not built; run ./mamori build")
    return project


@pytest.fixture
def compile_seeded(tmp_path: Path) -> Callable[..., Path]:
    """Compiles a text to an object file. @return its path."""

    def compile_text(text: str, *flags: str) -> Path:
        source, result = tmp_path / "seeded.cpp", tmp_path / "seeded.o"
        source.write_text(text, encoding="utf-8")
        subprocess.run(["g++", *(flags or SUBSET_FLAGS), "-c", str(source), "-o", str(result)], check=True)
        return result

    return compile_text
