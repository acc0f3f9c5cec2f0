# SPDX-License-Identifier: Apache-2.0
# Goal: every source and header of kernel and safety compiles for a bare Cortex-M4 without a warning, and the objects comply with the rules
# of the target subset. Each header is compiled alone, so each must include its dependencies.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.proofs.bare_metal import TOOL_PREFIX, compile_for_controller
from verification.proofs.symbols import scan_sections, scan_symbols
from verification.proofs.target_layers import find_target_layers

LAYERS = [layer for layer in find_target_layers(ROOT) if layer.name in ("kernel", "safety")]
INCLUDES = [layer.include for layer in LAYERS]
SOURCES = [path for layer in LAYERS for path in layer.sources()]
HEADERS = [path for layer in LAYERS for path in layer.headers()]


def get_id(path: Path) -> str:
    return str(path.relative_to(ROOT))


@pytest.mark.verifies("SWR-PRF-003", technique="error_guessing")
def test_both_layers_have_sources_and_headers() -> None:
    for name in ("kernel", "safety"):
        assert any(get_id(path).startswith(name) for path in SOURCES)
        assert any(get_id(path).startswith(name) for path in HEADERS)


@pytest.mark.parametrize("source", SOURCES, ids=get_id)
@pytest.mark.verifies("SWR-PRF-003")
def test_source_compiles_for_the_controller(tmp_path: Path, source: Path) -> None:
    result = tmp_path / "source.o"

    assert compile_for_controller(source, INCLUDES, result) == ""
    assert scan_symbols(result, TOOL_PREFIX) == []
    assert scan_sections(result, TOOL_PREFIX) == []


@pytest.mark.parametrize("header", HEADERS, ids=get_id)
@pytest.mark.verifies("SWR-PRF-003")
def test_header_compiles_alone_for_the_controller(tmp_path: Path, header: Path) -> None:
    source = tmp_path / "alone.cpp"
    source.write_text(f'#include "{header}"\n', encoding="utf-8")

    assert compile_for_controller(source, INCLUDES, tmp_path / "alone.o") == ""


@pytest.mark.parametrize(
    "text",
    ["int f(long long a) { return a; }\n", "void f(int a) {}\n", "void f() { throw 1; }\n"],
    ids=["narrowing", "unused", "throw"],
)
@pytest.mark.verifies("SWR-PRF-003", technique="fault_injection", polarity="violation")
def test_seeded_breach_is_refused(tmp_path: Path, text: str) -> None:
    source = tmp_path / "seeded.cpp"
    source.write_text(text, encoding="utf-8")

    assert "seeded.cpp:1" in compile_for_controller(source, [], tmp_path / "seeded.o")
