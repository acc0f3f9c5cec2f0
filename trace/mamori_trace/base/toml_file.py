# SPDX-License-Identifier: Apache-2.0
"""Reads one TOML file whole; whatever is wrong with it is an error of one kind.

@satisfies SWR-TRC-009      Design: docs/design/trace.md#rule-packs
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import FormatError, InputError
from mamori_trace.base.system_error import explain


def parse_toml(text: str) -> dict[str, Any]:
    """The table of `text`. Raises FormatError, also where the parser of the standard library gives up in another way."""
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise FormatError("values are nested too deeply") from None
    except ValueError as error:  # of its own, and of Python for a number of thousands of digits
        raise FormatError(str(error)) from None


def load_toml(path: Path) -> dict[str, Any]:
    """The table of a file without which nothing can be judged. Raises FileNotFoundError or InputError."""
    try:
        return parse_toml(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {explain(error)}") from None
    except ValueError as error:  # not UTF-8, or no TOML
        raise InputError(f"{path}: {error}") from None
