# SPDX-License-Identifier: Apache-2.0
"""Worst-case stack of each entry point: the deepest path through the resolved call graph.

    python -P -m verification.proofs.stack [--out FOLDER]

prints the table of all entry points and, with --out, writes stack.json and stack.txt there. Exit status 1 with findings.

@satisfies SWR-PRF-020, SWR-PRF-022, SWR-PRF-023      Design: docs/design/proofs.md#stack
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import WorkError
from mamori_trace.base.text_file import write_text
from verification.proofs.call_graph import CallGraph, Finding, Rules, make_call_graph, read_rules, split_signature
from verification.proofs.depth import calc_deepest_paths, find_groups, is_recursive
from verification.proofs.image import find_includes, find_sources
from verification.proofs.object_code import read_unit
from verification.proofs.toolchain import CORTEX_M4, HOST, Toolchain, Unit, compile_units

EXECUTIVE = "mamori::Executive::"
COMPONENT = "Component"
DEFAULT_ACTIONS = "mamori::Component::"
PROGRAM = ("reset_handler", "main")


@dataclass(frozen=True)
class Entry:
    """A function that is called from outside: by the application, the executive or the processor."""

    kind: str
    key: str


@dataclass(frozen=True)
class Analysis:
    """Results for one toolchain."""

    toolchain: Toolchain
    graph: CallGraph
    paths: dict[str, tuple[str, ...]]  # deepest path of each function that has a bound
    entries: tuple[Entry, ...]
    findings: tuple[Finding, ...]

    def get_bound(self, key: str) -> int | None:
        """Maximum stack of a function including its callees [bytes]; None if it has no bound."""
        if key not in self.paths:
            return None
        return sum(self.graph.functions[name].bytes for name in self.paths[key]) + self.toolchain.red_zone_bytes


def analyse(toolchain: Toolchain, root: Path, units: Sequence[Unit], rules: Rules) -> Analysis:
    """The complete stack analysis of `units`. A function that may reach a recursion has no bound."""
    graph = make_call_graph(toolchain, root, [read_unit(toolchain, unit) for unit in units], rules)
    calls = {key: graph.calls.get(key, set()) for key in graph.functions}
    cycles = [group for group in find_groups(calls) if is_recursive(group, calls)]
    paths = calc_deepest_paths({key: function.bytes for key, function in graph.functions.items()}, calls)
    findings = (*graph.findings, *(_describe_cycle(graph, cycle) for cycle in cycles))
    return Analysis(toolchain, graph, paths, tuple(_find_entries(graph)), findings)


def analyse_image(toolchain: Toolchain, root: Path, folder: Path) -> tuple[Analysis, list[Unit]]:
    """Compiles the image of verification/proofs/target and analyses it."""
    units = compile_units(toolchain, root, find_sources(root, toolchain), find_includes(root), folder)
    return analyse(toolchain, root, units, read_rules()), units


def make_record(analyses: Sequence[Analysis]) -> dict[str, object]:
    """The evidence: entry points with bound and path, every indirect call with its targets, every listed function."""
    return {analysis.toolchain.name: _make_part(analysis) for analysis in analyses}


def make_table(analyses: Sequence[Analysis]) -> str:
    """The same data for readers: one line per entry point, the deepest first, then the findings."""
    lines = []
    for analysis in analyses:
        graph = analysis.graph
        lines += [f"{analysis.toolchain.name}: {len(graph.functions)} functions, {len(graph.resolved)} indirect calls resolved, "
                  f"{len(graph.outside)} functions listed, {len(analysis.findings)} findings", ""]  # fmt: skip
        rows = [(bound, entry.kind, [_get_short_name(graph, key) for key in analysis.paths[entry.key]])
                for entry in analysis.entries if (bound := analysis.get_bound(entry.key)) is not None]  # fmt: skip
        for bound, kind, (name, *path) in sorted(rows, key=lambda row: (-row[0], row[2])):
            lines.append(f"{bound:6d} B  {kind:9}  {' > '.join((name, *path))}")
        lines += ["", *map(str, analysis.findings)]
    return "\n".join(lines).rstrip() + "\n"


def write_evidence(analyses: Sequence[Analysis], folder: Path, **more: object) -> None:
    """Writes stack.json and stack.txt, each atomically."""
    folder.mkdir(parents=True, exist_ok=True)
    record = {**make_record(analyses), **more}
    for name, text in (("stack.json", json.dumps(record, indent=1) + "\n"), ("stack.txt", make_table(analyses))):
        write_text(folder / name, text)


def _find_entries(graph: CallGraph) -> list[Entry]:
    executive = {key for key, function in graph.functions.items() if function.name.startswith(EXECUTIVE)}
    inner = {target for key in executive for target in graph.calls[key]}
    inner.update(target for call in graph.resolved for target in call.targets)  # work that the executive passes to its platform host
    # Only the executive calls ComponentRun and its other inner classes.
    entries = [Entry("executive", key) for key in sorted(executive - inner)
               if "::" not in split_signature(graph.functions[key].name)[0].removeprefix(EXECUTIVE)]  # fmt: skip
    actions = {key for table, bases in graph.bases.items() if any(name == COMPONENT for name, _ in bases)
               for key in graph.tables.get(table, {}).values()
               if key in graph.functions and not graph.functions[key].name.startswith(DEFAULT_ACTIONS)}  # fmt: skip
    entries += [Entry("component", key) for key in sorted(actions)]
    entries += [Entry("program", key) for key in PROGRAM if key in graph.functions]
    entries += [Entry("vector", key) for key in sorted(graph.vectors - set(PROGRAM))]
    return entries


def _describe_cycle(graph: CallGraph, cycle: Sequence[str]) -> Finding:
    members = [graph.functions[key] for key in cycle]
    names = ", ".join(f"{function.name} ({function.place})" for function in members)
    return Finding("recursion", members[0].place, f"{names}; write it as a loop with a bound")


def _get_short_name(graph: CallGraph, key: str) -> str:
    name = split_signature(graph.functions[key].name)[0]
    return re.sub(r"^mamori::|(?<=[ <])mamori::", "", name)


def _make_part(analysis: Analysis) -> dict[str, object]:
    graph = analysis.graph
    names = {key: function.name for key, function in graph.functions.items()}
    return {
        "functions": len(graph.functions),
        "red_zone_bytes": analysis.toolchain.red_zone_bytes,
        "findings": [str(finding) for finding in analysis.findings],
        "entries": [
            {"kind": entry.kind, "function": names[entry.key], "place": graph.functions[entry.key].place,
             "bound_bytes": bound,
             "path": [{"function": names[key], "frame_bytes": graph.functions[key].bytes, "place": graph.functions[key].place}
                      for key in analysis.paths[entry.key]]}
            for entry in analysis.entries if (bound := analysis.get_bound(entry.key)) is not None
        ],
        "indirect_calls": [
            {"caller": names[call.caller], "place": call.place, "how": call.how, "targets": [names[key] for key in call.targets]}
            for call in graph.resolved
        ],
        "listed": [{"function": row.function, "bytes": row.bytes, "reason": row.reason} for row in graph.outside.values()],
    }  # fmt: skip


def main(argv: list[str] | None = None) -> int:
    """Prints the table. @return the exit status."""
    parser = argparse.ArgumentParser(description="Worst-case stack of the target image.", allow_abbrev=False)
    parser.add_argument("--out", type=Path, help="folder for stack.json and stack.txt")
    out = parser.parse_args(argv).out
    try:
        with tempfile.TemporaryDirectory() as folder:
            analyses = [analyse_image(toolchain, ROOT, Path(folder) / toolchain.name)[0] for toolchain in (CORTEX_M4, HOST)]
    except WorkError as error:
        print(f"stack proof: {error}", file=sys.stderr)
        return 1
    print(make_table(analyses), end="")
    if out is not None:
        write_evidence(analyses, out)
    return 1 if any(analysis.findings for analysis in analyses) else 0


if __name__ == "__main__":
    sys.exit(main())
