# SPDX-License-Identifier: Apache-2.0
# Goal: the determinism proof accepts only complete, new records, and names each hash that differs.
# Method: a small program replaces the safe arm and writes the output of the case. verification/proofs runs the real arm.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_trace.base.errors import WorkError
from verification.proofs.determinism import Inputs, find_differences, get_trace_hash

HASH = "0123456789abcdef"


def make_program(folder: Path, body: str) -> Path:
    program = folder / "program"
    # The last argument is the folder for --out.
    program.write_text(f'#!/bin/bash\nout="${{@: -1}}"\nmkdir -p "$out"\n{body}\n', encoding="utf-8")
    program.chmod(0o755)
    return program


def run(folder: Path, body: str) -> str:
    inputs = Inputs(Path("m"), Path("t"), "", seed=1, frames=5)
    return get_trace_hash(make_program(folder, body), inputs, folder / "out")


@pytest.mark.verifies("SWR-PRF-005", technique="interface")
def test_hash_is_taken_from_the_record(tmp_path: Path) -> None:
    assert run(tmp_path, f"""echo '{{"trace_hash": "{HASH}", "frames": 5}}' >"$out/run.json" """) == HASH


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("exit 1", "ended with status 1"),
        ("exit 0", "no whole record"),
        ("""echo '{"trace_hash"' >"$out/run.json" """, "no whole record"),
        ("""echo '{"frames": 5}' >"$out/run.json" """, "no whole record"),
        ("""echo '{"trace_hash": "", "frames": 5}' >"$out/run.json" """, "no trace hash"),
        ("""echo '{"trace_hash": "0123456789abcdef", "frames": 4}' >"$out/run.json" """, "4 frames were run"),
    ],
)
@pytest.mark.verifies("SWR-PRF-005", technique="fault_injection", polarity="violation")
def test_run_without_a_whole_record_is_no_evidence(tmp_path: Path, body: str, reason: str) -> None:
    with pytest.raises(WorkError, match=reason):
        run(tmp_path, body)


@pytest.mark.verifies("SWR-PRF-005", technique="fault_injection", polarity="violation")
def test_each_different_hash_is_named() -> None:
    assert find_differences("a", ["a", "b", "a", "c"]) == ["2: b instead of a", "4: c instead of a"]
    assert find_differences("a", {"clang-O2": "b"}) == ["clang-O2: b instead of a"]
    assert find_differences("a", ["a"] * 20) == []
