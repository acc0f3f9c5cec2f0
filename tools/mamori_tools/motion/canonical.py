# SPDX-License-Identifier: Apache-2.0
"""The only format of motions for programs: a whitespace table with all digits and reproducible bytes."""

from __future__ import annotations

from pathlib import Path

from mamori_tools.motion.motion import Motion
from mamori_trace.base.text_file import write_text


def canonical_text(motion: Motion) -> str:
    """Three comment lines (source, SHA-256 of the source, columns), then `time q1 .. qn` per sample.

    Numbers are the shortest ones that convert back to the same value. The text contains no path, date or user.
    """
    name = motion.source_name.encode("unicode_escape").decode("ascii")
    columns = " ".join(f"q{joint}[rad]" for joint in range(1, len(motion.joint_names) + 1))
    lines = [f"# source {name}", f"# sha256 {motion.source_sha256}", f"# time[s] {columns}"]
    for time_s, row in zip(motion.time_s.tolist(), motion.position_rad.tolist(), strict=True):
        lines.append(" ".join(map(repr, [time_s, *row])))
    return "\n".join(lines) + "\n"


def write_canonical(motion: Motion, path: Path | str) -> None:
    """Writes the canonical table atomically. Raises InputError if the folder is not writable."""
    write_text(path, canonical_text(motion))
