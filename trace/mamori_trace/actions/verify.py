# SPDX-License-Identifier: Apache-2.0
"""`mamori trace verify BUNDLE`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from mamori_trace.actions.common import EXIT_CLEAN, EXIT_FINDINGS, add_output
from mamori_trace.base.errors import InputError

if TYPE_CHECKING:
    from mamori_trace.base.signature import Opinion

HELP = "compare a bundle with its manifest and its signature; end with status 1 when something differs"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_output(parser)
    parser.add_argument("bundle", type=Path, metavar="BUNDLE", help="folder or .tar file")
    parser.add_argument("--signers", type=Path, metavar="FILE",
                        help="require a signature of a signer in this file of allowed signers (ssh-keygen)")  # fmt: skip


def run(arguments: argparse.Namespace) -> int:
    from mamori_trace.base.errors import FormatError
    from mamori_trace.base.signature import Opinion, check_signature
    from mamori_trace.model.bundle import MANIFEST, compare, parse_manifest
    from mamori_trace.readers.bundle import read_bundle

    content = read_bundle(arguments.bundle)
    if content.manifest is None:
        raise InputError(f"{arguments.bundle}: holds no {MANIFEST}; this is no bundle")
    try:
        manifest = parse_manifest(content.manifest)
    except FormatError as error:
        raise InputError(f"{arguments.bundle}: {MANIFEST} {error}") from None
    differences = compare(manifest, content)
    opinion = Opinion()
    if content.signature is not None:
        opinion = check_signature(content.manifest, content.signature, arguments.signers)
    elif arguments.signers is not None:
        opinion = Opinion(fault="the bundle is not signed, and --signers demands a signature")
    faults = differences + ([opinion.fault] if opinion.fault else [])
    signature = _describe(content.signature is not None, opinion)
    if arguments.output == "json":
        facts = {"schema": "mamori.verify/1", "commit": manifest.commit, "worktree": manifest.worktree, "version": manifest.version,
                 "evidence_commit": manifest.evidence_commit, "files": len(manifest.files), "signature": signature,
                 "signer": opinion.signer, "faults": faults}  # fmt: skip
        print(json.dumps(facts, indent=1, ensure_ascii=False))
    else:
        print("".join(f"{arguments.bundle}: error: {fault}\n" for fault in faults), end="")
        print(f"bundle of commit {manifest.commit or 'unknown'} ({manifest.worktree} worktree), mamori {manifest.version}")
        print(f"{len(manifest.files)} files listed, {len(differences) or 'no'} differences, {signature}")
    return EXIT_FINDINGS if faults else EXIT_CLEAN


def _describe(signed: bool, opinion: Opinion) -> str:
    """Result of the signature check, in words."""
    if not signed:
        return "not signed"
    if opinion.fault:
        return "signature refused"
    return f"signed by {opinion.signer}" if opinion.signer else "signed by a key that was held against no list of signers"
