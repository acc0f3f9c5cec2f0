# SPDX-License-Identifier: Apache-2.0
"""Suggests the nearest known names for an unknown name in an error message."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def nearest_names(wrong: str, known: Iterable[str], hint: str | None = None) -> str:
    """A closing sentence for an unknown name: the most similar known names. If none is similar: `hint`, which explains how to list names
    that are too many for one line; without a hint, all known names."""
    names = list(known)
    alike = difflib.get_close_matches(wrong, names, n=3, cutoff=0.5)
    if alike:
        return f"nearest: {', '.join(alike)}"
    if hint is not None:
        return hint
    return f"known: {', '.join(names)}" if names else "none is known"
