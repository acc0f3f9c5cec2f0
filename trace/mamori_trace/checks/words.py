# SPDX-License-Identifier: Apache-2.0
"""What rules that look for words share.

@satisfies SWR-TRC-093      Design: docs/design/trace.md#cache
"""

from __future__ import annotations

from collections.abc import Iterable


def may_hold(texts: Iterable[str], words: Iterable[str]) -> bool:
    """Whether the letters of any word stand in any text, in whatever case: False is sure, True is not.

    Looking for plain letters in all texts at once takes a tenth of what a pattern takes, which a project without such words then never needs.
    """
    text, looked_for = "\n".join(texts), list(words)
    if not text.isascii() or not "".join(looked_for).isascii():  # letters that are equal to others for a pattern alone
        return True
    lower = text.lower()
    return any(word.lower() in lower for word in looked_for)
