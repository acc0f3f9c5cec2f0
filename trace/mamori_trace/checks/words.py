# SPDX-License-Identifier: Apache-2.0
"""Functions that several word rules use.

@satisfies SWR-TRC-093      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

from collections.abc import Iterable


def may_hold(texts: Iterable[str], words: Iterable[str]) -> bool:
    """Whether the characters of any word occur in any text, ignoring case. False is certain; True may be wrong.

    A plain search takes a tenth of the time of a pattern. A project without such words then needs no pattern.
    """
    text, looked_for = "\n".join(texts), list(words)
    if not text.isascii() or not "".join(looked_for).isascii():  # only a pattern matches equivalent characters
        return True
    lower = text.lower()
    return any(word.lower() in lower for word in looked_for)
