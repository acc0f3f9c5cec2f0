# SPDX-License-Identifier: Apache-2.0
"""Describes in words an error of the operating system and its correction; the system's own text has a number and no remedy.

@satisfies SWR-TRC-009      Design: docs/design/trace.md#input-errors
"""

from __future__ import annotations

import errno

_RIGHTS = "permission denied; give your user the right to it, or run as a user who has it"
_ROOM = "no room is left on the disk; make room, then call again"
_REASONS = {
    errno.EACCES: _RIGHTS,
    errno.EPERM: _RIGHTS,
    errno.ENOENT: "no such file or folder; check the path",
    errno.ENOTDIR: "a part of its path is no folder; check the path",
    errno.EEXIST: "a file is in the way; remove it, or name another place",
    errno.EISDIR: "it is a folder; name a file",
    errno.ELOOP: "it is a loop of links; mend the link",
    errno.ENAMETOOLONG: "its name is too long for the disk; choose a shorter one",
    errno.ENOSPC: _ROOM,
    errno.EDQUOT: _ROOM,
    errno.EROFS: "the disk may only be read; name another place",
    errno.EIO: "the disk failed; restore the file, or name another place",
    errno.EMFILE: "too many files are open; raise the limit (ulimit -n)",
}


def explain(error: OSError) -> str:
    """The error and the remedy, without the path."""
    if error.errno is None:  # an error of the project, which already has a text
        return str(error)
    is_telling = error.filename is not None or error.errno in (errno.ENOSPC, errno.EDQUOT)
    known = _REASONS.get(error.errno) if is_telling else None
    return known or f"{error.strerror}; mend it, then call again"


def describe(error: OSError) -> str:
    """The same after the path, if there is one."""
    path = error.filename2 or error.filename
    return explain(error) if path is None or error.errno is None else f"{path}: {explain(error)}"
