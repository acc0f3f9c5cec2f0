# SPDX-License-Identifier: Apache-2.0
"""Evidence uses only files of the repository: a test that reads other files verifies no requirement.

Method: searches the sources of all tests for paths to `../shared`; the search itself is tested on written samples.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
OUTSIDE = "/".join(("..", "shared"))
LAYERS = ("kernel", "safety", "ports", "simbody_sim", "examples", "profiles", "trace", "verification")


def find_tagged_readers(source: str) -> list[str]:
    """Tagged tests of a Python source that read a file outside the project, directly or by a constant."""
    tree = ast.parse(source)
    constants: set[str] = set()
    for node in tree.body:
        if isinstance(node, ast.Assign) and (OUTSIDE in ast.unparse(node.value) or constants & get_names(node.value)):
            constants |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    readers = [node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))
               and (OUTSIDE in ast.unparse(node) or constants & get_names(node))]  # fmt: skip
    return [node.name for node in readers if ".verifies" in ast.unparse(node) or "verifies_with" in ast.unparse(node)]


def get_names(tree: ast.AST) -> set[str]:
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}


@pytest.mark.parametrize(("tests", "found"), [
    ("@pytest.mark.verifies('X')\ndef test_a():\n    read(FOLDER)", ["test_a"]),
    ("@needs(FOLDER)\ndef test_a():\n    read(FOLDER)", []),
    ("@pytest.mark.verifies('X')\ndef test_a():\n    read('here')", []),
    ("FILE = FOLDER / 'a'\n@verifies_with(FILE, 'X')\ndef test_a():\n    pass", ["test_a"]),
    ("@pytest.mark.verifies('X')\ndef test_a():\n    read('" + OUTSIDE + "/a')", ["test_a"]),
])
def test_a_tagged_test_that_reads_outside_is_found(tests: str, found: list[str]) -> None:
    assert find_tagged_readers(f"FOLDER = ROOT / '{OUTSIDE}/data'\n{tests}\n") == found


def test_no_python_test_with_a_requirement_reads_outside_of_the_repository() -> None:
    files = [path for layer in LAYERS for path in (ROOT / layer).rglob("test_*.py")]
    assert len(files) > 50

    assert [(path.name, found) for path in files if (found := find_tagged_readers(path.read_text()))] == []


def test_no_test_program_reads_outside_of_the_repository() -> None:
    files = [path for layer in LAYERS for name in ("*.cpp", "*.hpp", "CMakeLists.txt") for path in (ROOT / layer).rglob(name)]
    assert len(files) > 200

    assert [path for path in files if OUTSIDE in path.read_text()] == []
