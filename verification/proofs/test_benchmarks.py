# SPDX-License-Identifier: Apache-2.0
# Goal: the benchmarks run, and their output can be evaluated. Method: one run of minimum effort; no time is checked.
from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from mamori_tools.host.project import Project
from verification.bench.bars import load_bars
from verification.bench.grid import METRIC as GRID
from verification.bench.judge import judge
from verification.bench.programs import Programs
from verification.bench.samples import Samples, read_samples

PEERS = ("Boost SPSC", "LCM memq", "CycloneDDS", "iceoryx2 local", "ETL message_bus", "F Prime synchronous port",
         "reactor-cpp with deadline", "vsomeip profile 4")  # fmt: skip


@pytest.fixture(scope="module")
def program(project: Project) -> Path:
    program = Programs(project).bench
    assert program.exists(), f"{program} is missing; run ./mamori bench --quick"
    return program


@pytest.fixture(scope="module")
def samples(program: Path, tmp_path_factory: pytest.TempPathFactory) -> Samples:
    out = tmp_path_factory.mktemp("bench") / "samples.json"
    words = ["--rounds", "5", "--batches", "1", "--batch-ns", "1000", "--only", "port", "e2e", "scheduler", "wake-up", "fifo"]
    subprocess.run([str(program), "--out", str(out), *words], check=True, capture_output=True, timeout=300)
    return read_samples(out)


@pytest.mark.verifies("SWR-BEN-001", technique="interface")
def test_every_bar_has_its_subjects(samples: Samples) -> None:
    bars = load_bars()
    results = judge(samples, bars)
    measured = {metric for metric, _ in samples.cases}

    assert set(bars.metrics) - measured == {GRID}, "which is measured by programs of its own"
    assert len(results) == sum(len(bar.limits) for bar in bars.ratios if bar.metric != GRID) + len(bars.growths)
    assert [one for one in results if one.ratio is None and one.against not in PEERS] == []


@pytest.mark.verifies("SWR-BEN-002")
def test_each_peer_is_measured_or_named_with_a_reason(samples: Samples) -> None:
    measured = set(samples.cases["port", 64].series)

    for peer in PEERS:
        assert (peer in measured) != bool(samples.absent.get(peer)), peer


@pytest.mark.verifies("SWR-BEN-004", technique="fault_injection", polarity="violation")
def test_samples_that_cannot_be_written_end_the_program_with_one_line(program: Path) -> None:
    words = ["--rounds", "1", "--batches", "1", "--batch-ns", "1", "--only", "wake-up"]

    done = subprocess.run([str(program), "--out", "/nowhere/samples.json", *words], capture_output=True, text=True,
                          check=False, timeout=60)  # fmt: skip

    assert done.returncode == 1
    assert done.stderr.startswith("/nowhere/samples.json: ")
    assert done.stderr.count("\n") == 1
