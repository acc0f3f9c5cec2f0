# SPDX-License-Identifier: Apache-2.0
"""`mamori trace bundle`."""

from __future__ import annotations

import argparse
import importlib.metadata
import sys
import tempfile
from pathlib import Path

from mamori_trace.actions.common import add_input, add_output, get_status, print_outcome, read_input
from mamori_trace.actions.foreign import get_foreign
from mamori_trace.base.errors import InputError

HELP = "pack report, evidence and requirements with a manifest of hashes, signed on request"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_input(parser)
    add_output(parser)
    parser.add_argument("--out", type=Path, required=True, metavar="DIR|FILE.tar",
                        help="where to write the bundle; a folder must not be there yet")  # fmt: skip
    parser.add_argument("--key", type=Path, metavar="FILE", help="private SSH key that signs the manifest")


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.base.signature import demand_key
    from mamori_trace.model.bundle import Manifest
    from mamori_trace.readers.git import read_worktree
    from mamori_trace.reports.bundle import add_text, check_out, finish, stage
    from mamori_trace.reports.html import write_report
    from mamori_trace.reports.json_report import format_json

    if get_foreign(arguments) is not None:
        raise InputError("bundle: packs a project of Mamori's own format; leave --format out")
    if arguments.key is not None:
        demand_key(arguments.key)
    project = read_input(arguments)
    if not project.evidence.present:
        raise InputError(f"{arguments.root}: no evidence to bundle; run the tests first, or name the folder with --evidence")
    sources = [(Path(project.evidence.folder), "evidence"), (arguments.root / "requirements", "requirements")]
    check_out(arguments.out, [path for path, _ in sources])
    manifest = Manifest(project.head, read_worktree(arguments.root), importlib.metadata.version("mamori"))
    manifest.evidence_commit = str(project.evidence.environment.get("commit", ""))
    with tempfile.TemporaryDirectory(prefix="mamori-bundle-") as name:
        folder = Path(name)
        stage(sources, folder, manifest)
        findings, verdicts = write_report(project, folder / "report.part")
        add_text(folder, "report/index.html", (folder / "report.part").read_text(encoding="utf-8"), manifest)
        (folder / "report.part").unlink()
        add_text(folder, "trace.json", format_json(project, findings, verdicts), manifest)
        finish(folder, manifest, arguments.key, arguments.out)
    print_outcome(arguments, project, findings, verdicts)
    signed = "signed" if arguments.key else "not signed"
    stream = sys.stderr if arguments.output == "json" else sys.stdout
    print(f"bundle: {arguments.out}, {len(manifest.files)} files, {signed}", file=stream)
    return get_status(findings)
