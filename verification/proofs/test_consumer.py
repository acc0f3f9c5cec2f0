# SPDX-License-Identifier: Apache-2.0
# Goal: a project in a foreign folder builds against the installed package alone, and runs. The installed tree is moved before
# it is used, so a path into the build or source tree that slipped into the package would show.
from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from mamori.verification.command.project import Project

BUILD_TIMEOUT_S = 300


def run(*argv: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(word) for word in argv], capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, timeout=BUILD_TIMEOUT_S)  # fmt: skip


@pytest.fixture
def prefix(project: Project, tmp_path: Path) -> Path:
    installed = run("cmake", "--install", project.build, "--prefix", tmp_path / "first")
    assert installed.returncode == 0, installed.stderr
    return (tmp_path / "first").rename(tmp_path / "prefix")


def configure(project: Project, prefix: Path, folder: Path,
              source: str = "verification/consumer") -> subprocess.CompletedProcess[str]:  # fmt: skip
    shutil.copytree(project.root / source, folder)
    return run("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
               "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")  # fmt: skip


@pytest.mark.verifies("SWR-PRF-004")
def test_consumer_outside_the_tree_builds_and_runs(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = tmp_path / "consumer"

    configured = configure(project, prefix, folder)
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout
    ran = run(folder / "build" / "consumer")
    assert ran.returncode == 0, ran.stdout
    assert "BAD_PARAMETER" in ran.stdout


@pytest.mark.verifies("SWR-PRF-004", technique="back_to_back")
def test_shipped_example_builds_against_the_package_and_gives_the_same_hash(
    project: Project, prefix: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "safe_arm"
    configured = configure(project, prefix, folder, "examples/safe_arm")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build", "--target", "safe_arm")
    assert built.returncode == 0, built.stdout

    motion = tmp_path / "motion.dat"
    motion.write_text("0 0 0.8 0 0.8 0 0.8 1.57\n1 0.2 0.9 0.2 0.9 0.2 0.9 1.7\n", encoding="utf-8")
    hashes = set()
    for program in (folder / "build" / "safe_arm", project.build / "examples" / "safe_arm" / "safe_arm"):
        out = tmp_path / "out"
        ran = run(program, "run", "--model", prefix / "share" / "mamori" / "models" / "pa10_like.yaml",
                  "--motion", motion, "--out", out, "--frames", "1000")  # fmt: skip
        assert ran.returncode == 0, ran.stderr
        hashes.add(json.loads((out / "run.json").read_text(encoding="utf-8"))["trace_hash"])
    assert len(hashes) == 1


@pytest.mark.verifies("SWR-PRF-004", technique="error_guessing", polarity="violation")
def test_consumer_without_the_package_is_told_so(project: Project, tmp_path: Path) -> None:
    refused = configure(project, tmp_path / "empty", tmp_path / "consumer")

    assert refused.returncode != 0
    assert "mamori" in refused.stderr
