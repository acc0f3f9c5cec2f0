# SPDX-License-Identifier: Apache-2.0
"""Reads one complete TOML file; every error is of one kind.

@satisfies SWR-TRC-009      Design: docs/design/trace.md#rule-packs
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import FormatError, InputError
from mamori_trace.base.system_error import explain


def parse_toml(text: str) -> dict[str, Any]:
    """The table of `text`. Raises FormatError, also instead of other exceptions of the standard parser."""
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise FormatError("values are nested too deeply") from None
    except ValueError as error:  # errors of the parser, and of Python for an integer of thousands of digits
        raise FormatError(str(error)) from None


def load_toml(path: Path) -> dict[str, Any]:
    """The table of a file that every check needs. Raises FileNotFoundError or InputError."""
    try:
        return parse_toml(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {explain(error)}") from None
    except ValueError as error:  # not UTF-8, or not TOML
        raise InputError(f"{path}: {error}") from None
