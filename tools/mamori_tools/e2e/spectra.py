# SPDX-License-Identifier: Apache-2.0
"""Weights of the dual codes of 32-bit checksums. They are stored in `spectra/`, because each takes nearly a minute to calculate.

    python -P -m mamori_tools.e2e.spectra [--again]

creates the missing files, or, with --again, all files. A file is accepted only with its own checksum, and its counts only if they are those
of a dual code: every resulting number of patterns is a non-negative integer.

@satisfies SWR-E2E-027      Design: docs/design/e2e.md#residual-error
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from mamori_tools.e2e.residual import CRC32, CRC32_P4, Checksum, Spectrum, calc_spectrum, count_patterns
from mamori_trace.base.text_file import write_text

FOLDER = Path(__file__).parent / "spectra"
# Bytes: the lengths of the published table, and lengths between and above for rows of residual_error.hpp. 38: the longest message with
# distance 8. 8191: the longest with distance 4; in longer messages, two flipped bits may pass.
P4_LENGTHS = (12, 16, 20, 24, 28, 32, 38, 48, 56, 64, 96, 128, 256, 512, 1024, 2048, 4096, 8191)
STORED = ((CRC32, 64), *((CRC32_P4, length) for length in P4_LENGTHS))
PATTERNS_CHECKED = 130  # weights from 0 on; each checks all counts together


def locate(checksum: Checksum, length: int) -> Path:
    """@param length of the frame [bytes]."""
    return FOLDER / f"{checksum.polynomial:08X}_{length:04}.json"


def load(checksum: Checksum, length: int) -> Spectrum | None:
    """@return None if it is not stored. @raise ValueError if the file is damaged."""
    path = locate(checksum, length)
    if (checksum, length) not in STORED or not path.exists():
        return None
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        counts = {int(weight): int(count) for weight, count in document["counts"].items()}
        spectrum = Spectrum(checksum, 8 * length, counts)
        if document != _describe(spectrum):
            raise ValueError("its content is not what its checksum says")
        check(spectrum)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"{path}: damaged ({error}); remove it and make it again: "
                         "python -P -m mamori_tools.e2e.spectra") from error  # fmt: skip
    return spectrum


def check(spectrum: Spectrum) -> None:
    """@raise ValueError if these are not weights of a dual code."""
    if sum(spectrum.counts.values()) != 1 << spectrum.checksum.width:
        raise ValueError(f"there are not 2^{spectrum.checksum.width} words")
    for _ in islice(count_patterns(spectrum), PATTERNS_CHECKED):
        pass


def store(spectrum: Spectrum) -> Path:
    """Writes the file atomically. @return its path."""
    path = locate(spectrum.checksum, spectrum.bits // 8)
    write_text(path, json.dumps(_describe(spectrum), separators=(",", ":")) + "\n")
    return path


def _describe(spectrum: Spectrum) -> dict[str, object]:
    checksum = spectrum.checksum
    counts = {str(weight): count for weight, count in sorted(spectrum.counts.items())}
    document: dict[str, object] = {
        "checksum": checksum.name, "width": checksum.width, "polynomial": f"{checksum.polynomial:X}", "gap": checksum.gap,
        "bytes": spectrum.bits // 8, "counts": counts,
    }  # fmt: skip
    return document | {"sha256": hashlib.sha256(json.dumps(document).encode()).hexdigest()}


def main(argv: Sequence[str] | None = None) -> int:
    """@return exit status 0."""
    parser = argparse.ArgumentParser(prog="mamori_tools.e2e.spectra", allow_abbrev=False,
                                     description="Weights of the dual codes of 32-bit checksums.")  # fmt: skip
    parser.add_argument("--again", action="store_true", help="make all files, not only those that are missing")
    arguments = parser.parse_args(argv)
    FOLDER.mkdir(exist_ok=True)
    for checksum, length in STORED:
        if arguments.again or not locate(checksum, length).exists():
            print(store(calc_spectrum(checksum, 8 * length)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
