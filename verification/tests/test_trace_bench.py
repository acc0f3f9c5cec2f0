# SPDX-License-Identifier: Apache-2.0
# Goal: the large project is clean and reproducible; usage is measured; missing reference implementations and wrong arguments are reported.
# Method: small sizes, child processes with known usage, a host without the reference implementations.
from __future__ import annotations

import sys
from pathlib import Path

import pytest

from mamori_trace.command import main as trace
from verification.trace_bench import command, peers
from verification.trace_bench.large_project import LEAST, Plan, write_native
from verification.trace_bench.peer_projects import write_openfasttrace, write_strictdoc
from verification.trace_bench.usage import Usage, run_measured, take_median

MEGA = 1_000_000


def read_tree(root: Path) -> dict[str, bytes]:
    return {path.relative_to(root).as_posix(): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()}


@pytest.mark.verifies("SWR-TRC-090")
def test_plan_has_three_levels_and_all_parents_exist() -> None:
    plan = Plan(10_000)

    ids = {item.id for item in plan.all}
    assert (len(ids), len(plan.needs), len(plan.system), len(plan.software)) == (10_000, 1_000, 3_000, 6_000)
    assert {parent for item in plan.all for parent in item.parents} <= ids
    assert (len(plan.sources), len(plan.tests)) == (1_200, 120)


@pytest.mark.verifies("SWR-TRC-090")
@pytest.mark.parametrize("with_git", [False, True])
def test_project_is_clean(tmp_path: Path, capsys: pytest.CaptureFixture[str], with_git: bool) -> None:
    write_native(Plan(40), tmp_path / "project", with_git)

    assert trace(["check", "--root", str(tmp_path / "project")]) == 0
    assert "40 items: 40 verified" in capsys.readouterr().out


@pytest.mark.verifies("SWR-TRC-090")
def test_same_size_gives_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        write_native(Plan(60), tmp_path / name)
        write_openfasttrace(Plan(60), tmp_path / f"{name}_oft")
        write_strictdoc(Plan(60), tmp_path / f"{name}_sdoc")

    for kind in ("", "_oft", "_sdoc"):
        assert read_tree(tmp_path / f"one{kind}") == read_tree(tmp_path / f"two{kind}")


@pytest.mark.verifies("SWR-TRC-090")
def test_peers_get_every_item_and_tag(tmp_path: Path) -> None:
    plan = Plan(60)
    write_openfasttrace(plan, tmp_path / "oft")
    write_strictdoc(plan, tmp_path / "sdoc")

    oft = b"".join(read_tree(tmp_path / "oft").values()).decode()
    sdoc = b"".join(read_tree(tmp_path / "sdoc").values()).decode()
    assert oft.count("Needs: ") == sdoc.count("\nUID: ") == 60
    assert oft.count("[impl->") == oft.count("[utest->") == sdoc.count("scope=function") == len(plan.software)


@pytest.mark.verifies("SWR-TRC-090", polarity="violation")
def test_too_small_project_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match="at least 20"):
        write_native(Plan(LEAST - 1), tmp_path / "project")
    with pytest.raises(SystemExit) as ended:
        command.main(["--requirements", str(LEAST - 1)])
    assert ended.value.code == 2
    assert "at least 20" in capsys.readouterr().err
    assert not (tmp_path / "project").exists()


@pytest.mark.verifies("SWR-TRC-090")
def test_usage_counts_children_of_children(tmp_path: Path) -> None:
    burn = "import subprocess,sys; subprocess.run([sys.executable,'-c','x=bytearray(50_000_000)\\nfor i in range(3_000_000): pass'])"

    usage = run_measured([sys.executable, "-c", burn], tmp_path / "log.txt", 60.0)
    assert usage.status == 0 and usage.ended
    assert usage.cpu_s > 0.02
    assert usage.peak_bytes > 50 * MEGA


@pytest.mark.verifies("SWR-TRC-090", polarity="violation")
def test_run_beyond_the_limit_is_ended_and_marked(tmp_path: Path) -> None:
    usage = run_measured([sys.executable, "-c", "while True: pass"], tmp_path / "log.txt", 0.2)

    assert not usage.ended and usage.status != 0
    assert "stopped at the limit" in command.format_table(Plan(LEAST), [command.Row("Peer", usage)])


@pytest.mark.verifies("SWR-TRC-090", polarity="violation")
def test_absent_peers_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(peers.shutil, "which", lambda _program: None)
    monkeypatch.setattr(peers, "_run", lambda _command: "ERROR: nothing answered")

    rows = command.measure_peers(Plan(LEAST), tmp_path, 1.0)
    text = command.format_table(Plan(LEAST), rows)
    assert all(row.usage is None for row in rows)
    assert text.count("not measured: java and mvn not found; install default-jre-headless and maven") == 2
    assert "not measured: pip did not install it: ERROR: nothing answered" in text


@pytest.mark.verifies("SWR-TRC-090")
def test_median_row_is_one_run() -> None:
    usages = [Usage(0, cpu_s, 2 * cpu_s, 7) for cpu_s in (3.0, 1.0, 2.0, 9.0)]

    assert take_median(usages) == usages[2]
