# SPDX-License-Identifier: Apache-2.0
"""Searches object code for symbols and sections of heap, exceptions, RTTI or dynamic initialisation.

@satisfies SWR-PRF-001, SWR-PRF-002      Design: docs/design/launcher.md#symbol-proof
"""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

# Mangled names (Itanium C++ ABI). Pure virtual calls trap in __cxa_pure_virtual of the image; this symbol is permitted.
FORBIDDEN_SYMBOLS = {
    "heap": r"_{0,2}(?:malloc|calloc|realloc|free|reallocarray|aligned_alloc|memalign|posix_memalign|strn?dup|sbrk)(?:_r)?"
    r"|brk|_Zn[wa].*|_Zd[la].*",
    "exceptions": r"__cxa_(?!pure_virtual$|(?:thread_)?atexit$|guard_|finalize$).*|_Unwind_.*|__gxx_personality.*"
    r"|_ZSt\d+__throw_.*|_ZSt9terminatev",
    "RTTI": r"_ZT[IS].*|_ZTVN10__cxxabiv1.*|__dynamic_cast",
    "dynamic initialisation": r"__cxa_(?:(?:thread_)?atexit|finalize|guard_.*)|_ZGV.*|_GLOBAL__(?:sub_)?[ID]_.*"
    r"|(?:__aeabi_)?atexit|_ZT[HW].*|__tls_(?:init|guard)"
    r"|_Z41__static_initialization_and_destruction_0.*",
}
FORBIDDEN_SECTIONS = re.compile(r"\.(?:preinit_array|init_array|fini_array|ctors|dtors)(?:\.\S+)?")


@dataclass(frozen=True, order=True)
class Finding:
    """One forbidden symbol or section in one object file."""

    kind: str
    member: str
    symbol: str

    def __str__(self) -> str:
        return f"{self.member}: {self.symbol} ({self.kind})"


def scan_symbols(path: Path, prefix: str = "") -> list[Finding]:
    """Forbidden symbols, defined or undefined, in an object file or archive. @param prefix of the binutils of its target."""
    findings = []
    for line in _run(f"{prefix}nm", "--print-file-name", "--format=posix", str(path)):
        location, _, rest = line.partition(": ")
        symbol = rest.split(" ", 1)[0]
        for kind, pattern in FORBIDDEN_SYMBOLS.items():
            if re.fullmatch(pattern, symbol):
                findings.append(Finding(kind, location, symbol))
    return sorted(findings)


def scan_sections(path: Path, prefix: str = "") -> list[Finding]:
    """Sections with code that runs before main(), in an object file or archive."""
    findings = []
    member = path.name
    for line in _run(f"{prefix}readelf", "--section-headers", "--wide", str(path)):
        if line.startswith("File: "):
            member = line.removeprefix("File: ")
        for name in FORBIDDEN_SECTIONS.findall(line):
            findings.append(Finding("dynamic initialisation", member, name))
    return sorted(findings)


def count_symbols(path: Path, prefix: str = "") -> int:
    """Number of symbols, because a search in a file without symbols would prove nothing."""
    return len(_run(f"{prefix}nm", "--format=posix", str(path)))


def _run(*argv: str) -> list[str]:
    done = subprocess.run(argv, capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL)
    return done.stdout.splitlines()
