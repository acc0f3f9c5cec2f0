# SPDX-License-Identifier: Apache-2.0
"""Names that a user may have meant."""

from __future__ import annotations

import difflib
from collections.abc import Sequence


def nearest(word: str, names: Sequence[str]) -> str:
    """The best two of `names` by likeness, or all of them when none is like `word`."""
    return " or ".join(difflib.get_close_matches(word, names, n=2, cutoff=0.3) or names)
