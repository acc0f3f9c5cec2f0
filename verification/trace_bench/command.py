# SPDX-License-Identifier: Apache-2.0
"""Cost of checking a large project: cold, unchanged, with the report, and compared with OpenFastTrace and StrictDoc, in one run.

    python -P -m verification.trace_bench [--requirements N] [--repeats N] [--peers] [--limit S] [--out DIR]

Exit status: 0 if all runs of Mamori were clean, 1 if one was not, 2 for wrong arguments. Times are not checked, because hosts differ; tests
compare counts.

@satisfies SWR-TRC-090      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from verification.trace_bench.large_project import LEAST, Plan, get_folder, write_native
from verification.trace_bench.peer_projects import write_openfasttrace, write_strictdoc
from verification.trace_bench.peers import Peer, get_openfasttrace, get_strictdoc
from verification.trace_bench.usage import Usage, run_measured, take_median

ROOT = Path(__file__).resolve().parents[2]
_SETTLE_S = 2.2
"""The cache never treats a file as unchanged if it was written this shortly before a run (docs/design/trace.md#cache)."""
_MEGA = 1e6


@dataclass(frozen=True, slots=True)
class Row:
    """One row of the table: a run, or why it is missing."""

    title: str
    usage: Usage | None = None
    report_bytes: int = 0
    note: str = ""


def main(argv: Sequence[str] | None = None) -> int:
    """@return the exit status."""
    arguments = _parse(argv)
    plan = Plan(arguments.requirements)
    rows = measure_own(plan, arguments.out, arguments.repeats, arguments.limit)
    if arguments.peers:
        rows += measure_peers(plan, arguments.out, arguments.limit)
    print(format_table(plan, rows), end="")
    return 1 if any(row.usage is None or row.usage.status for row in rows[:_OWN_ROWS]) else 0


def measure_own(plan: Plan, base: Path, repeats: int, limit_s: float) -> list[Row]:
    """The runs of Mamori; each row is the run with the median CPU time."""
    root = get_folder(plan, "native", base)
    write_native(plan, root, with_git=True)
    time.sleep(_SETTLE_S)
    tool = [sys.executable, "-P", "-m", "mamori_trace"]
    check, report = [*tool, "check", "--root", str(root)], [*tool, "report", "--root", str(root)]
    cache, log = root / "build" / "trace_cache", base / "log"
    cold, unchanged, with_report = [], [], []
    for _ in range(repeats):
        shutil.rmtree(cache, ignore_errors=True)
        cold.append(run_measured(check, log / "cold.txt", limit_s))
        unchanged.append(run_measured(check, log / "unchanged.txt", limit_s))
        shutil.rmtree(cache, ignore_errors=True)
        with_report.append(run_measured(report, log / "report.txt", limit_s))
    return [
        Row("Mamori, check, cold", take_median(cold)),
        Row("Mamori, check, unchanged", take_median(unchanged)),
        Row("Mamori, check and report, cold", take_median(with_report), _count_bytes(root / "report")),
    ]


_OWN_ROWS = 3


def measure_peers(plan: Plan, base: Path, limit_s: float) -> list[Row]:
    """One run of each reference implementation, with check and report, because none has a separate check."""
    cache = base / "peers"
    oft_root, oft_out = get_folder(plan, "openfasttrace", base), base / "openfasttrace_report" / "index.html"
    sdoc_root, sdoc_out = get_folder(plan, "strictdoc", base), base / "strictdoc_report"
    write_openfasttrace(plan, oft_root)
    write_strictdoc(plan, sdoc_root)
    for path in (oft_out.parent, sdoc_out):
        shutil.rmtree(path, ignore_errors=True)
    oft_out.parent.mkdir(parents=True)
    oft, strictdoc = get_openfasttrace(cache), get_strictdoc(cache)
    code = ("trace", "-o", "html", "-f", str(oft_out), str(oft_root / "doc"), str(oft_root / "code"))
    text = ("trace", str(oft_root / "doc"), str(oft_root / "code"))
    return [
        _measure_peer(oft, "check", text, base / "log" / "openfasttrace_check.txt", limit_s),
        _measure_peer(oft, "check and report", code, base / "log" / "openfasttrace.txt", limit_s, oft_out.parent),
        _measure_peer(strictdoc, "check and report", ("export", "--output-dir", str(sdoc_out), str(sdoc_root)),
                      base / "log" / "strictdoc.txt", limit_s, sdoc_out),
    ]  # fmt: skip


def format_table(plan: Plan, rows: Sequence[Row]) -> str:
    """A Markdown table, with CPU time for each requirement."""
    sources, tests = len(plan.sources), len(plan.tests)
    lines = [
        f"{plan.count} requirements on 3 levels, {sources} C++ sources, {tests} test sources, {len(plan.software)} results",
        "",
        "| run | CPU s | wall s | peak MB | report MB | CPU us each | status |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        use = row.usage
        if use is None:
            lines.append(f"| {row.title} | not measured: {row.note} | | | | | |")
            continue
        more = "" if use.ended else "> "
        size = f"{row.report_bytes / _MEGA:.1f}" if row.report_bytes else "-"
        each = f"{more}{use.cpu_s / plan.count * 1e6:.0f}"
        status = str(use.status) if use.ended else "stopped at the limit"
        cells = (f"{more}{use.cpu_s:.2f}", f"{more}{use.wall_s:.2f}", f"{more}{use.peak_bytes / _MEGA:.0f}", size, each, status)
        lines.append(f"| {row.title} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _measure_peer(peer: Peer, what: str, arguments: tuple[str, ...], log: Path, limit_s: float, out: Path | None = None) -> Row:
    title = f"{peer.title}, {what}"
    if not peer.command:
        return Row(title, note=peer.reason)
    usage = run_measured((*peer.command, *arguments), log, limit_s)
    return Row(title, usage, _count_bytes(out) if out else 0)


def _count_bytes(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="trace_bench", description="Measure what judging a large project costs.")
    parser.add_argument("--requirements", type=int, default=10_000, metavar="N", help="size of the project (default: 10000)")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="runs of each row of ours; the median is shown (default: 3)")
    parser.add_argument("--peers", action="store_true", help="also OpenFastTrace (Maven) and StrictDoc (pip), fetched at the first time")
    parser.add_argument("--limit", type=float, default=600.0, metavar="S", help="seconds after which a run is ended (default: 600)")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "trace_bench", metavar="DIR", help="default: build/trace_bench")
    arguments = parser.parse_args(argv)
    if arguments.requirements < LEAST:
        parser.error(f"--requirements {arguments.requirements}: a project on three levels has at least {LEAST}")
    if arguments.repeats < 1 or not arguments.limit > 0:
        parser.error("--repeats and --limit are numbers above 0")
    return arguments
