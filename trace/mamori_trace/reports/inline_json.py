# SPDX-License-Identifier: Apache-2.0
"""JSON that is safe inside a script element, for any contained texts.

@satisfies SWR-TRC-062      Design: docs/design/trace.md#data-in-the-page
"""

from __future__ import annotations

import json

# Characters that could end the element, start a comment in it, or end a JavaScript line.
_ESCAPES = (("<", "\\u003c"), (">", "\\u003e"), ("&", "\\u0026"), ("\u2028", "\\u2028"), ("\u2029", "\\u2029"))


def format_inline(content: object) -> str:
    """`content` as compact JSON without any character that has a meaning in HTML."""
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":"))
    for character, escape in _ESCAPES:
        text = text.replace(character, escape)
    return text
