# SPDX-License-Identifier: Apache-2.0
"""Campaigns on a Dask cluster. Method: a small program under test; scheduler and workers are ended by `kill -9`."""

from __future__ import annotations

import hashlib
import json
import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from campaign_bench import Bench
from dask_cluster import Cluster

from mamori_tools.campaign import Settings, dask_pool, load_plan, run_campaign, select
from mamori_tools.campaign.work import Program, Work, read_program
from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError, WorkError


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    monkeypatch.delenv("MAMORI_COMMIT", raising=False)
    return Bench(tmp_path)


def wait_for_stored(bench: Bench, count: int, process: subprocess.Popen[str]) -> None:
    deadline = time.monotonic() + 300.0
    while len(bench.list_stored()) < count and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)


def start(bench: Bench, cluster: Cluster) -> subprocess.Popen[str]:
    return subprocess.Popen(bench.make_command("--dask", cluster.address), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.verifies("SWR-CMP-010")
def test_a_local_cluster_gives_the_result_and_the_files_of_one_process(bench: Bench) -> None:
    one = bench.run(jobs=1)
    bench.evidence = bench.folder / "dask"
    result = bench.run(dask="local", jobs=2)

    assert result.result_hash == one.result_hash
    assert bench.read_json()["cases"][0]["run"] == json.loads((bench.evidence / "campaign/none-1/run.json").read_text())
    assert (bench.evidence / "campaign/none-1/program.log").exists()


@pytest.mark.verifies("SWR-CMP-012", technique="fault_injection", polarity="violation")
def test_ctrl_c_ends_a_local_cluster_with_one_line(bench: Bench) -> None:
    bench.write_long_plan(60)
    process = subprocess.Popen(bench.make_command("--dask", "local", "--jobs", "2"), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               start_new_session=True)  # fmt: skip
    wait_for_stored(bench, 2, process)
    os.killpg(process.pid, signal.SIGINT)  # like a terminal
    output, errors = process.communicate(timeout=60.0)

    assert (process.returncode, output) == (130, "")
    assert [line for line in errors.splitlines() if line and not line.startswith("[")] == ["mamori: stopped; no report was written"]


# No `verifies`: the CI gate does not run this test, so its result would be missing.
@pytest.mark.long
@pytest.mark.skipif(not Project(ROOT).safe_arm.exists(), reason="the example arm is not built")
def test_the_example_arm_has_one_result_hash_on_one_process_two_processes_and_dask(tmp_path: Path) -> None:
    project = Project(ROOT)
    selection = select(load_plan(project.campaign_plan), instants=1)
    files = {"model": project.model, "motion": project.motion}
    ways: list[dict[str, Any]] = [{"jobs": 1}, {"jobs": 2}, {"jobs": 2, "dask": "local"}]
    results = [run_campaign(selection, Settings(project.safe_arm, files, tmp_path / str(number), environment={}, **way))
               for number, way in enumerate(ways)]  # fmt: skip

    assert [result.count("passed") for result in results] == [15, 15, 15]
    assert len({result.result_hash for result in results}) == 1


def check_killed_workers(bench: Bench, kills: int, seed: int) -> None:
    randomness = random.Random(seed)
    bench.write_long_plan(6 * kills)
    whole = bench.run(environment={})
    bench.evidence = bench.folder / "dask"
    with Cluster(bench.folder / "cluster") as cluster:
        workers = [cluster.add_worker(), cluster.add_worker()]
        process = start(bench, cluster)
        for number in range(1, kills + 1):
            wait_for_stored(bench, 3 * number, process)
            time.sleep(randomness.uniform(0.0, 0.1))
            workers.append(cluster.add_worker())
            cluster.kill(workers.pop(0))
        output, errors = process.communicate(timeout=120.0)

    assert process.returncode == 0, errors
    assert f"result hash: {whole.result_hash}" in output
    ids = [line.split()[2] for line in errors.splitlines()]
    assert sorted(ids) == sorted(each.case.id for each in whole.cases)  # each case is stored and shown once


@pytest.mark.verifies("SWR-CMP-011", technique="fault_injection", polarity="violation")
def test_the_case_of_a_killed_worker_is_run_by_another_worker(bench: Bench) -> None:
    check_killed_workers(bench, 1, seed=3)


# No `verifies`: the CI gate does not run this test, so its result would be missing.
@pytest.mark.long
def test_20_killed_workers_lose_and_repeat_nothing(bench: Bench) -> None:
    check_killed_workers(bench, 20, seed=4)


def check_killed_schedulers(bench: Bench, kills: int, seed: int) -> None:
    randomness = random.Random(seed)
    bench.write_long_plan(3 * kills + 3)
    whole = bench.run(environment={})
    bench.evidence = bench.folder / "dask"
    finished: dict[str, tuple[int, int]] = {}
    for number in range(kills):
        with Cluster(bench.folder / f"cluster{number}") as cluster:
            cluster.add_worker()
            process = start(bench, cluster)
            wait_for_stored(bench, len(finished) + 1, process)
            time.sleep(randomness.uniform(0.0, 0.2))
            cluster.kill(cluster.scheduler)
            output, errors = process.communicate(timeout=120.0)
        assert (process.returncode, output) == (1, "")
        assert errors.splitlines()[-1] == (f"mamori: campaign: --dask {cluster.address}: the connection to the scheduler was lost; start it "
                                           "again, the same command continues the campaign")  # fmt: skip
        assert "Traceback" not in errors
        stored = bench.list_stored()
        assert finished.items() < stored.items()
        finished = stored
    result = bench.run(environment={}, restart=False)

    assert result.kept == len(finished)
    assert result.result_hash == whole.result_hash


@pytest.mark.verifies("SWR-CMP-011", technique="fault_injection", polarity="violation")
def test_a_killed_scheduler_ends_the_campaign_with_one_line_and_the_next_call_continues(bench: Bench) -> None:
    check_killed_schedulers(bench, 1, seed=5)


# No `verifies`: the CI gate does not run this test, so its result would be missing.
@pytest.mark.long
def test_20_killed_schedulers_lose_and_repeat_nothing(bench: Bench) -> None:
    check_killed_schedulers(bench, 20, seed=6)


@pytest.mark.verifies("SWR-CMP-011", technique="fault_injection", polarity="violation")
def test_a_cluster_without_a_worker_is_named_at_the_start_and_after_the_last_one(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_pool, "NO_WORKER_S", 1.0)
    bench.write_long_plan(20)
    with Cluster(bench.folder / "cluster") as cluster:
        with pytest.raises(InputError, match=f"the scheduler has no worker; start one by: dask worker {cluster.address}"):
            bench.run(dask=cluster.address, jobs=None)
        worker = cluster.add_worker()

        with pytest.raises(WorkError, match="no worker for 1 s; start one by"):
            bench.run(lambda *_: cluster.kill(worker), dask=cluster.address, jobs=None)
    assert bench.run(restart=False).kept >= 1


@pytest.mark.verifies("SWR-CMP-011", technique="fault_injection", polarity="violation")
def test_a_worker_with_another_program_is_named_and_its_case_is_not_stored(bench: Bench) -> None:
    bench.write_long_plan(6)

    def replace_program(*_: object) -> None:
        bench.program.write_text(bench.program.read_text() + "# changed\n")

    with Cluster(bench.folder / "cluster") as cluster:
        cluster.add_worker()
        with pytest.raises(WorkError, match=r"worker tcp://\S+ on \S+: .*program: another program than at the start of the campaign"):
            bench.run(replace_program, dask=cluster.address, jobs=None)
    assert 1 <= len(bench.list_stored()) < 7


@pytest.mark.parametrize(("change", "words"), [
    ("remove", "no program that can be run; copy it there"),
    ("mode", "no program that can be run; copy it there"),
    ("content", "another program than at the start of the campaign"),
    ("interpreter", "cannot be started"),
])  # fmt: skip
@pytest.mark.verifies("SWR-CMP-011", technique="equivalence_classes", polarity="violation")
def test_a_worker_that_cannot_run_the_program_says_which_computer_and_why(bench: Bench, change: str, words: str) -> None:
    program = read_program(bench.program)
    match change:
        case "remove":
            bench.program.unlink()
        case "mode":
            bench.program.chmod(0o644)
        case "content":
            bench.program.write_text("#!/bin/sh\n")
        case "interpreter":
            bench.program.write_text("#!/nowhere/interpreter\n")
            program = Program(program.path, hashlib.sha256(bench.program.read_bytes()).hexdigest())

    with pytest.raises(WorkError, match=f"worker {socket.gethostname()}: .*{words}"):
        dask_pool.run_on_worker(Work("none-1", program, (str(program.path),), Path("none-1"), {}, 5.0), {})


@pytest.mark.parametrize(("bytes_max", "is_sent"), [(2, True), (1, False)])
@pytest.mark.verifies("SWR-CMP-011", technique="boundary_values", polarity="violation")
def test_the_files_of_a_case_are_sent_back_up_to_a_limit(bench: Bench, monkeypatch: pytest.MonkeyPatch, bytes_max: int, is_sent: bool) -> None:
    monkeypatch.setattr(dask_pool, "FILE_BYTES_MAX", bytes_max)
    bench.program.write_text("#!/bin/sh\nprintf ab > none-1/sub.txt\n")
    work = Work("none-1", read_program(bench.program), (str(bench.program),), Path("none-1"), {}, 5.0)

    if is_sent:
        assert dask_pool.run_on_worker(work, {})[1] == {"program.log": b"", "sub.txt": b"ab"}
    else:
        with pytest.raises(WorkError, match="none-1: the program wrote 2 bytes, at most 1 are sent back; run the campaign without --dask"):
            dask_pool.run_on_worker(work, {})


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense", "tcp://nowhere.invalid:8786"])
@pytest.mark.verifies("SWR-CMP-011", technique="error_guessing", polarity="violation")
def test_an_address_that_does_not_answer_is_named(bench: Bench, monkeypatch: pytest.MonkeyPatch, address: str) -> None:
    monkeypatch.setattr(dask_pool, "CONNECT_S", 1.0)

    with pytest.raises(InputError, match=f"--dask {address}: no Dask scheduler answers within 1 s"):
        bench.run(dask=address, jobs=None)


@pytest.mark.verifies("SWR-CMP-011", technique="error_guessing", polarity="violation")
def test_a_server_that_is_no_scheduler_is_named(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_pool, "CONNECT_S", 1.0)
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            while True:
                try:
                    connection, _ = server.accept()
                except OSError:
                    return
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\n" * 10)
                connection.close()

        threading.Thread(target=answer, daemon=True).start()
        with pytest.raises(InputError, match="no Dask scheduler answers within 1 s"):
            bench.run(dask=f"tcp://127.0.0.1:{server.getsockname()[1]}", jobs=None)


@pytest.mark.verifies("SWR-CMP-011", technique="interface", polarity="violation")
def test_without_the_package_the_command_ends_with_status_3(bench: Bench) -> None:
    code = ("import sys; sys.modules['distributed'] = None; from mamori_tools.command.main import main; "
            f"sys.exit(main({bench.make_command('--dask', 'local')[4:]!r}))")  # fmt: skip
    done = subprocess.run([sys.executable, "-P", "-c", code], env={**os.environ}, capture_output=True, text=True, check=False)

    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == "mamori: --dask needs the package dask[distributed]; install it by: .venv/bin/python -m pip install 'mamori[dask]'\n"
