# SPDX-License-Identifier: Apache-2.0
# Goal: the libraries of the target subset use no heap, exceptions, RTTI or dynamic initialisation; a seeded use is found.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from verification.proofs.symbols import count_symbols, scan_sections, scan_symbols
from verification.proofs.target_layers import TargetLayer, find_target_layers

LAYERS = find_target_layers(ROOT)
EVERY_LAYER = pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.name)


def get_library(project: Project, layer: TargetLayer) -> Path:
    library = layer.library(project.root, project.build)
    assert library.exists(), f"{library} is missing; run ./mamori build"
    assert count_symbols(library) > 0
    return library


@pytest.mark.verifies("SWR-PRF-001", technique="error_guessing")
def test_kernel_and_safety_are_among_the_layers_looked_at() -> None:
    assert {"kernel", "safety"} <= {layer.name for layer in LAYERS}


@EVERY_LAYER
@pytest.mark.verifies("SWR-PRF-001")
def test_library_needs_neither_heap_nor_exceptions_nor_rtti(project: Project, layer: TargetLayer) -> None:
    assert [str(finding) for finding in scan_symbols(get_library(project, layer))] == []


@EVERY_LAYER
@pytest.mark.verifies("SWR-PRF-002")
def test_library_runs_no_code_before_main(project: Project, layer: TargetLayer) -> None:
    assert [str(finding) for finding in scan_sections(get_library(project, layer))] == []


SEEDED = {
    "new": ("int* make() { return new int{1}; }", "heap"),
    "delete": ("void drop(int* p) { delete p; }", "heap"),
    "malloc": ("#include <cstdlib>\nvoid* make() { return std::malloc(8); }", "heap"),
    "aligned new": ("struct alignas(64) A { char b[64]; };\nA* make() { return new A; }", "heap"),
    "array delete": ("void drop(int* p) { delete[] p; }", "heap"),
    "realloc": ("#include <cstdlib>\nvoid* grow(void* p) { return std::realloc(p, 8); }", "heap"),
    "copied text": ("#include <cstring>\nchar* copy(const char* p) { return strdup(p); }", "heap"),
    "newlib's malloc": ("extern \"C\" void* _malloc_r(void*, unsigned);\nvoid* make() { return _malloc_r(nullptr, 8); }", "heap"),
    "break of the heap": ("extern \"C\" void* _sbrk(int);\nvoid* make() { return _sbrk(8); }", "heap"),
    "growing container": ("#include <vector>\nvoid add(std::vector<int>& v) { v.push_back(1); }", "heap"),
    "virtual destructor": ("struct A { virtual ~A(); };\nA::~A() {}", "heap"),
    "throw": ("void stop() { throw 1; }", "exceptions"),
    "catch": ("void f();\nint g() { try { f(); } catch (...) { return 1; } return 0; }", "exceptions"),
    "noexcept": ("void f();\nvoid g() noexcept { f(); }", "exceptions"),
    "rethrow": ("void f() { throw; }", "exceptions"),
    "library throw": ("#include <array>\nint get(std::array<int, 2>& a, unsigned i) { return a.at(i); }", "exceptions"),
    "virtual class": ("struct A { virtual void f(); };\nvoid A::f() {}", "RTTI"),
    "typeid": ("#include <typeinfo>\nconst char* f(int a) { return typeid(a).name(); }", "RTTI"),
    "dynamic_cast": ("struct A { virtual void f(); };\nstruct B : A { void f() override; };\n"
                     "B* cast(A* a) { return dynamic_cast<B*>(a); }", "RTTI"),
    "guarded static": ("int f();\nint g() { static int a = f(); return a; }", "dynamic initialisation"),
    "thread-local": ("int f();\nthread_local int a = f();\nint g() { return a; }", "dynamic initialisation"),
    "at exit": ("#include <cstdlib>\nvoid f();\nvoid g() { std::atexit(f); }", "dynamic initialisation"),
    "static destructor": ("struct A { ~A(); };\nA a;", "dynamic initialisation"),
}


@pytest.mark.parametrize("name", SEEDED)
@pytest.mark.verifies("SWR-PRF-001", technique="fault_injection", polarity="violation")
def test_seeded_use_is_found(compile_seeded: Callable[..., Path], name: str) -> None:
    text, kind = SEEDED[name]
    assert kind in {finding.kind for finding in scan_symbols(compile_seeded(text, "-std=c++17", "-O1"))}


@pytest.mark.parametrize(
    "text",
    ["int f();\nint a = f();", "struct A { A(); };\nA a;",
     "int a;\n[[gnu::constructor]] void f() { a = 1; }", "int a;\n[[gnu::destructor]] void f() { a = 1; }",
     "int f();\ntemplate <typename T> struct A { static int a; };\ntemplate <typename T> int A<T>::a = f();\n"
     "template struct A<int>;"],
    ids=["variable", "object", "constructor function", "destructor function", "template member"],
)  # fmt: skip
@pytest.mark.verifies("SWR-PRF-002", technique="fault_injection", polarity="violation")
def test_seeded_initialiser_is_found(compile_seeded: Callable[..., Path], text: str) -> None:
    seeded = compile_seeded(text)
    assert {finding.kind for finding in scan_sections(seeded)} == {"dynamic initialisation"}


@pytest.mark.verifies("SWR-PRF-001", technique="error_guessing")
def test_interface_with_protected_destructor_is_no_finding(compile_seeded: Callable[..., Path]) -> None:
    interface = "struct I { virtual int get() = 0; protected: ~I() = default; };\n"
    seeded = compile_seeded(interface + "struct A final : I { int get() override { return 1; } };\nA a; I& i = a;")
    assert scan_symbols(seeded) == []
    assert scan_sections(seeded) == []
