# SPDX-License-Identifier: Apache-2.0
"""JSON that may stand inside a script element, whatever the texts in it are.

@satisfies SWR-TRC-062      Design: docs/design/trace.md#data-in-the-page
"""

from __future__ import annotations

import json

# What could end the element, begin a comment in it, or end a line where JavaScript counts lines.
_ESCAPES = (("<", "\\u003c"), (">", "\\u003e"), ("&", "\\u0026"), ("\u2028", "\\u2028"), ("\u2029", "\\u2029"))


def format_inline(content: object) -> str:
    """`content` as compact JSON without any character that HTML gives a meaning to."""
    text = json.dumps(content, ensure_ascii=False, separators=(",", ":"))
    for character, escape in _ESCAPES:
        text = text.replace(character, escape)
    return text
