# SPDX-License-Identifier: Apache-2.0
"""Checks the layer table of CONTRIBUTING.md: permitted includes, links and imports, order of the component folders of a layer, permitted
content of target code. Also checks that death tests state the cause of the death.

    python -m verification.checks.check_layers [--root FOLDER]

Prints one line per finding, `file:line: rule: message`. Exit status 0 without findings, 1 with findings, 2 for wrong arguments.

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

from verification.checks.code_size import check_share, count_code, list_tracked
from verification.checks.component_folders import check_order, check_place
from verification.checks.death_tests import check_death_tests
from verification.checks.deviations import check_deviations
from verification.checks.layer_table import HOST_SOURCES, LISTED_C, LISTED_STD, TEST_INCLUDES, Layer, find_package, get_layer, get_module
from verification.checks.manual_samples import check_samples
from verification.checks.target_limits import MEASURED_HEADERS, check_headers, check_size, check_words
from verification.checks.unused_headers import check_unused
from verification.checks.wording import WORDING, check_wording

ROOT = Path(__file__).resolve().parents[2]
SUFFIXES = (".hpp", ".cpp", ".h", ".c")
FOLDERS = ("kernel", "safety", "ports", "simbody_sim", "examples", "tools", "verification", "trace")
INCLUDE = re.compile(r'^\s*#\s*include\s*(?P<open>[<"])(?P<path>[^>"]+)[>"]', re.MULTILINE)
POSIX = re.compile(r"(?:sys/)?[a-z]+\.h")
CMAKE_LIBRARY = re.compile(r"mamori_library\s*\((?P<body>[^)]*)\)")
CMAKE_TARGET = re.compile(r"\bmamori(?:::|_)(?P<layer>\w+)")


@dataclass(frozen=True, order=True)
class Finding:
    """One violation, with its location and rule."""

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


def check_texts(root: Path) -> list[Finding]:
    """Findings about the wording of all texts below `root`, according to the list of that tree, and about lists and samples of its manual."""
    file = root / WORDING
    wording = [Finding(name, line, "wording", message) for name, line, message in check_wording(root, file)] if file.exists() else []
    unused = [Finding(name, line, "unused", message) for name, line, message in check_unused(root)]
    return wording + unused + [Finding(name, line, "sample", message) for name, line, message in check_samples(root)]


def _is_target_code(root: Path, path: Path) -> bool:
    parts = path.relative_to(root).parts
    layer = get_layer(parts)
    return path.suffix in SUFFIXES and layer is not None and layer.target and "tests" not in parts


def _check_file(root: Path, path: Path) -> Iterator[Finding]:
    parts = path.relative_to(root).parts
    name = "/".join(parts)
    if path.suffix == ".py":
        for line, message in _check_imports(parts, path.read_text(encoding="utf-8")):
            yield Finding(name, line, "import", message)
        return
    layer = get_layer(parts)
    if layer is None:
        if path.suffix in SUFFIXES:
            yield Finding(name, 1, "include", "this folder has no C++; see the layer table of CONTRIBUTING.md")
        return
    if path.suffix in SUFFIXES:
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
        elif not _is_outside_header_allowed(layer, include, is_test) and not _is_named_header(root, path, include):
            yield line, f"{layer.name} may not include '{include}'"


def _find_beside(root: Path, path: Path, include: str) -> tuple[str, ...]:
    """Path parts of the file that a quoted include without a layer names: in the folder of `path` or a folder above. Empty if there is
    none."""
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


def _is_named_header(root: Path, path: Path, include: str) -> bool:
    """Headers that the table permits for single files."""
    if path.suffix == ".h" and include in LISTED_C:
        return True
    return path.relative_to(root).as_posix() in HOST_SOURCES and POSIX.fullmatch(include) is not None


def _check_links(layer: Layer, layers: set[str], text: str) -> Iterator[tuple[int, str]]:
    """Checks libraries only, because tests may link test libraries."""
    if layer.name in ("examples", "verification", "trace"):
        return
    forbidden = layers - {*layer.links, layer.name.rpartition("/")[2]}
    for library in CMAKE_LIBRARY.finditer(text):
        for target in CMAKE_TARGET.finditer(library["body"]):
            if target["layer"] in forbidden:
                line = text.count("\n", 0, library.start("body") + target.start()) + 1
                yield line, f"{layer.name} may not link mamori::{target['layer']}"


def _check_imports(path: tuple[str, ...], text: str) -> Iterator[tuple[int, str]]:
    module = "mamori_trace" if path[:2] == ("trace", "tests") else get_module(path)
    if module is None:
        return
    try:
        if (own := find_package(module)) is None:
            return
        for line, imported in _list_imports(text):
            other = find_package(imported)
            if other is not None and other[0] != own[0] and other[1] >= own[1]:
                yield line, f"{own[0]} (level {own[1]}) may not import {imported} (level {other[1]}); only lower levels"
    except KeyError as error:
        yield 1, f"package {error.args[0]} has no level; add it to PACKAGE_LEVELS in verification/checks/layer_table.py"


def _list_imports(text: str) -> Iterator[tuple[int, str]]:
    """@return line and dotted name of each import."""
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.Import(names=names):
                yield from ((node.lineno, alias.name) for alias in names)
            case ast.ImportFrom(module=str(source), names=names):
                yield from ((node.lineno, f"{source}.{alias.name}") for alias in names)


def main(argv: list[str] | None = None) -> int:
    """Prints all findings. @return the exit status."""
    parser = argparse.ArgumentParser(description="Proves the layer table of CONTRIBUTING.md.", allow_abbrev=False)
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree to check; default: this project")
    root = parser.parse_args(argv).root
    if not (root / "kernel").is_dir():
        parser.error(f"'{root}' has no folder kernel; give the root of the source tree")
    size = count_code(root, list_tracked(root))
    findings = check_tree(root) + check_texts(root) + [Finding("verification", 1, "size", message) for message in check_share(size)]
    for finding in findings:
        print(finding)
    print(size)
    print(f"layer check: {len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
