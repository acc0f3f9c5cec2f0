# SPDX-License-Identifier: Apache-2.0
"""Proves the layer table of CONTRIBUTING.md: who includes, links and imports whom, in which order the component folders of a layer
are, what target code may contain, and that death tests state their cause.

    python -m mamori.verification.tools.check_layers [--root FOLDER]

One line per finding, `file:line: rule: message`; exit status 0 without findings, 1 with, 2 for wrong arguments.

@satisfies SWR-PRF-006, SWR-PRF-007, SWR-PRF-008, SWR-PRF-042      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mamori.verification.tools.component_folders import check_order, check_place
from mamori.verification.tools.death_tests import check_death_tests
from mamori.verification.tools.deviations import check_deviations
from mamori.verification.tools.layer_table import ALLOWED_IMPORTS, FORBIDDEN_IMPORTS, LISTED_STD, TEST_INCLUDES, Layer, get_layer
from mamori.verification.tools.target_limits import MEASURED_HEADERS, check_headers, check_size, check_words

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("kernel", "safety", "ports", "simbody_sim", "examples", "verification", "trace", "profiles")
INCLUDE = re.compile(r'^\s*#\s*include\s*(?P<open>[<"])(?P<path>[^>"]+)[>"]', re.MULTILINE)
POSIX = re.compile(r"(?:sys/)?[a-z]+\.h")
CMAKE_LIBRARY = re.compile(r"mamori_library\s*\((?P<body>[^)]*)\)")
CMAKE_TARGET = re.compile(r"\bmamori(?:::|_)(?P<layer>\w+)")


@dataclass(frozen=True, order=True)
class Finding:
    """One breach, where it is and which rule it breaks."""

    file: str
    line: int
    rule: str
    message: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.rule}: {self.message}"


def check_tree(root: Path) -> list[Finding]:
    """All findings below `root`, sorted."""
    findings: set[Finding] = set()
    target_code: dict[str, str] = {}
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file():
                findings.update(_check_file(root, path))
                if _is_target_code(root, path):
                    target_code[path.relative_to(root).as_posix()] = path.read_text(encoding="utf-8")
    headers = {path.name: path.read_text(encoding="utf-8").count("\n") for path in (root / MEASURED_HEADERS).rglob("*.hpp")}
    findings.update(Finding(MEASURED_HEADERS, *found) for found in check_headers(headers))
    findings.update(Finding(*found) for found in check_deviations(root, target_code))
    return sorted(findings)


def _is_target_code(root: Path, path: Path) -> bool:
    parts = path.relative_to(root).parts
    layer = get_layer(parts)
    return path.suffix in (".hpp", ".cpp") and layer is not None and layer.target and "tests" not in parts


def _check_file(root: Path, path: Path) -> Iterator[Finding]:
    parts = path.relative_to(root).parts
    name = "/".join(parts)
    if path.suffix == ".py":
        text = path.read_text(encoding="utf-8")
        for folder, forbidden in FORBIDDEN_IMPORTS.items():
            if name.startswith(f"{folder}/"):
                for line, message in _check_imports(folder, forbidden, text):
                    yield Finding(name, line, "import", message)
        return
    layer = get_layer(parts)
    if layer is None:
        if path.suffix in (".hpp", ".cpp"):
            yield Finding(name, 1, "include", "this layer has no C++; see the layer table of CONTRIBUTING.md")
        return
    if path.suffix in (".hpp", ".cpp"):
        text = path.read_text(encoding="utf-8")
        for line, message in _check_includes(root, path, layer, text, is_test="tests" in parts):
            yield Finding(name, line, "include", message)
        for message in check_place(parts):
            yield Finding(name, 1, "folder", message)
        for line, message in check_death_tests(text):
            yield Finding(name, line, "death", message)
        if _is_target_code(root, path):
            for line, rule, message in (*check_words(text), *check_size(text)):
                yield Finding(name, line, rule, message)
    elif path.name == "CMakeLists.txt":
        layers = {"kernel", "safety", "simbody_sim", *(port.name for port in (root / "ports").glob("*"))}
        for line, message in _check_links(layer, layers, path.read_text(encoding="utf-8")):
            yield Finding(name, line, "link", message)


def _check_includes(root: Path, path: Path, layer: Layer, text: str, is_test: bool) -> Iterator[tuple[int, str]]:
    for match in INCLUDE.finditer(text):
        include = match["path"]
        line = text.count("\n", 0, match.start("path")) + 1
        if ".." in include.split("/") or "src" in include.split("/"):
            yield line, f"'{include}' reaches into a src/ or parent folder; include a public header"
        elif include.startswith("mamori/"):
            is_for_tests = include in TEST_INCLUDES or include.startswith(layer.test_headers)
            if not include.startswith(layer.headers) and not (is_test and is_for_tests):
                yield line, f"{layer.name} may not include '{include}'"
            for message in check_order(path.relative_to(root).parts, include):
                yield line, message
        elif match["open"] == '"' and (found := _find_beside(root, path, include)):
            if get_layer(found) != layer:
                yield line, f"'{include}' belongs to another layer"
        elif not _is_outside_header_allowed(layer, include, is_test):
            yield line, f"{layer.name} may not include '{include}'"


def _find_beside(root: Path, path: Path, include: str) -> tuple[str, ...]:
    """Parts of the file that a quoted include without layer names: beside `path`, or in a folder above it. Else nothing."""
    for folder in path.parents:
        if (folder / include).is_file():
            return (folder / include).resolve().relative_to(root.resolve()).parts
        if folder == root:
            break
    return ()


def _is_outside_header_allowed(layer: Layer, include: str, is_test: bool) -> bool:
    if layer.any_library or include.startswith(layer.headers):
        return True
    if is_test and (include.startswith(TEST_INCLUDES) or POSIX.fullmatch(include)):
        return True
    is_std = re.fullmatch(r"[a-z_]+", include) is not None
    return is_std and (layer.any_std or is_test or include in LISTED_STD)


def _check_links(layer: Layer, layers: set[str], text: str) -> Iterator[tuple[int, str]]:
    """Of the libraries only: tests may link what they test with."""
    if layer.name in ("examples", "verification"):
        return
    forbidden = layers - {*layer.links, layer.name.rpartition("/")[2]}
    for library in CMAKE_LIBRARY.finditer(text):
        for target in CMAKE_TARGET.finditer(library["body"]):
            if target["layer"] in forbidden:
                line = text.count("\n", 0, library.start("body") + target.start()) + 1
                yield line, f"{layer.name} may not link mamori::{target['layer']}"


def _check_imports(folder: str, forbidden: tuple[str, ...], text: str) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.Import(names=names):
                modules = [alias.name for alias in names]
            case ast.ImportFrom(module=str(module), names=names):
                modules = [f"{module}.{alias.name}" for alias in names]
            case _:
                continue
        for module in modules:
            if module.startswith(ALLOWED_IMPORTS.get(folder, ())):
                continue
            if any(f"{module}.".startswith(f"{name}.") for name in forbidden):
                yield node.lineno, f"{folder} may not import {module}"


def main(argv: list[str] | None = None) -> int:
    """Prints all findings. @return the exit status."""
    parser = argparse.ArgumentParser(description="Proves the layer table of CONTRIBUTING.md.", allow_abbrev=False)
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree to check; default: this project")
    root = parser.parse_args(argv).root
    if not (root / "kernel").is_dir():
        parser.error(f"'{root}' has no folder kernel; give the root of the source tree")
    findings = check_tree(root)
    for finding in findings:
        print(finding)
    print(f"layer check: {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
