# SPDX-License-Identifier: Apache-2.0
"""Stored results. Method: a campaign with a small program is killed by `kill -9` and restarted; stored files are changed and damaged."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from collections import Counter
from pathlib import Path
from typing import Any

import pyarrow.parquet
import pytest
from campaign_bench import Bench

from mamori_trace.base.errors import InputError, MissingError


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)


def kill_while_running(bench: Bench, pause_s: float, *options: str) -> None:
    """Starts a campaign and kills it by kill -9, `pause_s` after the start of its first case."""
    count = len(bench.read_starts())
    process = subprocess.Popen(bench.make_command(*options), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60.0
    while len(bench.read_starts()) == count and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    time.sleep(pause_s)
    process.send_signal(signal.SIGKILL)
    process.wait()


def check_kills(bench: Bench, kills: int, seed: int) -> None:
    """A campaign that is killed `kills` times keeps each finished case, repeats none of them, and gives the result of an uninterrupted
    one."""
    randomness = random.Random(seed)
    bench.write_long_plan(kills + 4)
    whole = bench.run(environment={})
    (bench.folder / "starts.txt").unlink()
    bench.evidence = bench.folder / "killed"
    finished: dict[str, tuple[int, int]] = {}
    for _ in range(kills):
        kill_while_running(bench, randomness.uniform(0.0, 0.3), "--jobs", "2")
        stored = bench.list_stored()
        assert finished.items() <= stored.items()  # none is lost or written again
        finished = stored
        starts = Counter(bench.read_starts())
    result = bench.run(environment={}, restart=False)

    assert result.kept == len(finished)
    assert finished.items() <= bench.list_stored().items()
    assert all(Counter(bench.read_starts())[case] == starts[case] for case in finished)
    assert [row["id"] for row in bench.read_parquet()] == [each.case.id for each in whole.cases]
    assert result.result_hash == whole.result_hash
    assert not list(bench.evidence.glob("campaign/.attempt-*"))


@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_a_killed_campaign_continues_without_a_lost_or_repeated_case(bench: Bench) -> None:
    check_kills(bench, 3, seed=1)


# No `verifies`: the CI gate does not run this test, so its result would be missing.
@pytest.mark.long
def test_a_campaign_that_is_killed_at_20_random_instants_loses_and_repeats_nothing(bench: Bench) -> None:
    check_kills(bench, 20, seed=2)


@pytest.mark.verifies("SWR-CMP-009")
def test_a_second_call_runs_nothing_and_writes_the_same_evidence(bench: Bench) -> None:
    first = bench.run()
    content, starts = bench.read_json(), bench.read_starts()
    second = bench.run(restart=False)

    assert (first.kept, second.kept) == (0, 3)
    assert second.result_hash == first.result_hash
    assert bench.read_json() == content
    assert bench.read_starts() == starts


@pytest.mark.verifies("SWR-CMP-009", technique="interface")
def test_all_cases_are_rows_of_one_parquet_file(bench: Bench) -> None:
    bench.run()
    path = bench.evidence / "campaign/campaign.parquet"
    rows = bench.read_parquet()

    assert pyarrow.parquet.read_schema(path).metadata[b"schema"] == b"mamori.case_result/1"
    assert [(row["id"], row["verdict"]) for row in rows] == [("none-1", "passed"), ("message_late-1", "passed"), ("message_late-2", "passed")]
    assert {"name": "final state", "wanted": "Safe", "measured": "Safe", "passed": True} in rows[1]["checks"]
    assert json.loads(rows[1]["run"]) == bench.read_json()["cases"][1]["run"]


@pytest.mark.parametrize(("part", "change"), [
    ("plan", lambda bench: bench.plan.write_text(bench.plan.read_text() + "# changed\n")),
    ("program", lambda bench: bench.program.write_text(bench.program.read_text() + "# changed\n")),
    ("model.yaml", lambda bench: bench.model.write_text(bench.model.read_text() + "# changed\n")),
    ("motion.txt", lambda bench: bench.motion.write_text("0.0 0.0\n4.0 0.3\n")),
])  # fmt: skip
@pytest.mark.verifies("SWR-CMP-009", technique="equivalence_classes", polarity="violation")
def test_results_of_another_campaign_are_kept_until_restart(bench: Bench, part: str, change) -> None:  # type: ignore[no-untyped-def]
    bench.run()
    stored = bench.list_stored()
    change(bench)

    with pytest.raises(InputError, match=f"another value of: .*{part}; add --restart"):
        bench.run(restart=False)
    assert bench.list_stored() == stored
    assert bench.run(restart=True).kept == 0


@pytest.mark.parametrize("options", [{"timeout_s": 60.0}, {"environment": {"commit": "def"}}])
@pytest.mark.verifies("SWR-CMP-009", technique="equivalence_classes", polarity="violation")
def test_other_settings_that_decide_results_are_another_campaign(bench: Bench, options: dict[str, Any]) -> None:
    bench.run()

    with pytest.raises(InputError, match="add --restart"):
        bench.run(restart=False, **options)


@pytest.mark.parametrize("size", [0, 4, 200])
@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_a_truncated_part_file_is_named(bench: Bench, size: int) -> None:
    bench.run()
    path = bench.evidence / "campaign/results/none-1.parquet"
    os.truncate(path, size)

    with pytest.raises(InputError, match=r"results/none-1.parquet: is no complete result of a case; remove the file"):
        bench.run(restart=False)
    path.unlink()
    assert bench.run(restart=False).kept == 2


@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_a_flipped_bit_in_a_part_file_is_named(bench: Bench) -> None:
    bench.run()
    path = bench.evidence / "campaign/results/none-1.parquet"
    content = path.read_bytes()
    place = content.index(b"No fault")
    path.write_bytes(content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])

    with pytest.raises(InputError, match="is no complete result of a case"):
        bench.run(restart=False)


@pytest.mark.parametrize("content", ["{", "[]", '{"schema": "other"}'])
@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_a_damaged_key_file_is_named(bench: Bench, content: str) -> None:
    bench.run()
    (bench.evidence / "campaign/results/key.json").write_text(content)

    with pytest.raises(InputError, match=r"results/key.json: .*add --restart"):
        bench.run(restart=False)


@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection")
def test_what_a_killed_campaign_left_half_written_is_removed(bench: Bench) -> None:
    bench.run()
    results = bench.evidence / "campaign/results"
    (results / ".none-2.parquet.1.part").write_bytes(b"half")
    (bench.evidence / "campaign/.attempt-x/none-1").mkdir(parents=True)
    bench.run(restart=False)

    assert sorted(path.name for path in results.iterdir()) == ["key.json", "message_late-1.parquet", "message_late-2.parquet", "none-1.parquet"]
    assert not list(bench.evidence.glob("campaign/.attempt-*"))


@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_parts_without_a_key_are_discarded(bench: Bench) -> None:
    bench.run()
    (bench.evidence / "campaign/results/key.json").unlink()

    assert bench.run(restart=False).kept == 0


@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_two_campaigns_in_one_folder_are_refused(bench: Bench) -> None:
    def start_another(*_: object) -> None:
        with pytest.raises(MissingError, match="another campaign writes there"):
            bench.run(restart=False)

    assert bench.run(progress=start_another).passed


@pytest.mark.verifies("SWR-CMP-009", technique="fault_injection", polarity="violation")
def test_a_folder_that_cannot_be_written_is_named(bench: Bench) -> None:
    file = bench.folder / "file"
    file.write_text("")
    bench.evidence = file / "evidence"  # Permissions do not restrict root.

    with pytest.raises(InputError, match="evidence cannot be written: Not a directory"):
        bench.run()


@pytest.mark.verifies("SWR-CMP-010")
def test_the_result_hash_does_not_depend_on_the_number_of_processes(bench: Bench) -> None:
    bench.write_long_plan(6)
    hashes = {bench.run(jobs=jobs).result_hash for jobs in (1, 2, 3)}

    assert len(hashes) == 1
    bench.write_plan(8)
    assert bench.run().result_hash not in hashes
