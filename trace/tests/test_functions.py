# SPDX-License-Identifier: Apache-2.0
# Goal: every function is known with its lines and owners, and a function of a traced layer without an owner is reported.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample

from mamori_trace.model.code import CodeBase, Function
from mamori_trace.readers.cpp_tags import read_cpp_tags
from mamori_trace.readers.python_sources import read_python

HEADER = """/// @file
/// Watching.
#pragma once
namespace a {
/// @satisfies SWR-ABC-001
class Watcher {
  public:
    Watcher() noexcept : count_(0) {}
    Watcher(const Watcher&) = delete;
    /// @satisfies SWR-ABC-002
    bool start(int count) noexcept;
    bool stop() noexcept;
    explicit operator bool() const { return count_ > 0; }
    struct Inner {
        int get() const { return 1; }
    };

  private:
    int count_;
};

/// @satisfies SWR-ABC-003
template <typename T>
T clamp(T value) {
    const auto twice = [](T one) { return one + one; };
    return twice(value);
}

bool operator<(const Watcher& a, const Watcher& b);
}  // namespace a
"""
SOURCE = """#include "a/watcher.hpp"
namespace a {
namespace {
int help() { return 1; }
}  // namespace
bool Watcher::start(int count) noexcept {
    return count > help();
}
bool a::Watcher::stop() noexcept try { return true; } catch (...) { return false; }
bool operator<(const Watcher& a, const Watcher& b) { return &a < &b; }
}  // namespace a
"""


def read(root: Path, files: dict[str, str]) -> dict[str, Function]:
    """Writes `files`. @return their functions by `file name` and name."""
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    code = CodeBase()
    read_cpp_tags(root, [], code)
    read_python(root, [], code)
    return {f"{function.file.rpartition('/')[2]} {function.name}": function for function in code.bind()}


@pytest.mark.verifies("SWR-TRC-030", technique="requirements_based", polarity="nominal")
def test_functions_of_cpp_are_found_with_lines_and_owners(tmp_path: Path) -> None:
    functions = read(tmp_path, {"a/include/a/watcher.hpp": HEADER, "a/src/watcher.cpp": SOURCE})

    assert {name: (one.first, one.last, one.requirements) for name, one in functions.items()} == {
        "watcher.hpp Watcher::Watcher": (8, 8, ("SWR-ABC-001",)),
        "watcher.hpp Watcher::operator bool": (13, 13, ("SWR-ABC-001",)),
        "watcher.hpp Watcher::Inner::get": (15, 15, ("SWR-ABC-001",)),
        "watcher.hpp clamp": (24, 27, ("SWR-ABC-003",)),
        "watcher.cpp help": (4, 4, ()),
        "watcher.cpp Watcher::start": (6, 8, ("SWR-ABC-002", "SWR-ABC-001")),
        "watcher.cpp a::Watcher::stop": (9, 9, ("SWR-ABC-001",)),
        "watcher.cpp operator<": (10, 10, ()),
    }


@pytest.mark.verifies("SWR-TRC-030", technique="requirements_based", polarity="nominal")
def test_the_tag_of_a_header_speaks_for_what_the_header_declares(tmp_path: Path) -> None:
    tagged = HEADER.replace("/// Watching.", "/// @satisfies SWR-ABC-009")
    other = '#include "unrelated.hpp"\n#include <a/watcher.hpp>\nbool a::Watcher::stop() { return true; }\nvoid help() {}\n'

    functions = read(tmp_path, {"a/include/a/watcher.hpp": tagged, "a/src/stopping.cpp": other, "b/src/user.cpp": '#include "a/watcher.hpp"\nvoid use() {}\n'})

    assert functions["stopping.cpp a::Watcher::stop"].requirements == ("SWR-ABC-001", "SWR-ABC-009")
    assert functions["stopping.cpp help"].requirements == ("SWR-ABC-009",)
    assert functions["user.cpp use"].requirements == ()


@pytest.mark.verifies("SWR-TRC-030", technique="requirements_based", polarity="nominal")
def test_functions_of_python_are_found_with_lines_and_owners(tmp_path: Path) -> None:
    text = (
        "import os\n\n\nclass Tool:\n    '''A tool.\n\n    @satisfies SWR-ABC-001\n    '''\n\n    @property\n    def name(self):\n"
        "        '''Its name.'''\n        def inner():\n            return 1\n        return inner()\n\n\n"
        "if os.name:\n    async def run(): pass\n"
    )

    functions = read(tmp_path, {"tool.py": text})

    assert {name: (one.first, one.last, one.body, one.requirements) for name, one in functions.items()} == {
        "tool.py Tool::name": (10, 15, 13, ("SWR-ABC-001",)),
        "tool.py run": (19, 19, 19, ()),
    }


@pytest.mark.verifies("SWR-TRC-030", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize("text", [
    "class {{{", "void f( {\n}", "bool operator", "#if 0\nvoid f() {\n#else\nvoid f() {\n#endif\n}\n", "\0\0{}", "int f() {" * 300,
])  # fmt: skip
def test_code_that_does_not_compile_is_no_crash(tmp_path: Path, text: str) -> None:
    functions = read(tmp_path, {"a.cpp": text})

    assert all(1 <= one.first <= one.last for one in functions.values())


def declare_traced(sample: Sample, text: str) -> None:
    (sample.root / "requirements/schema/code.toml").write_text(text, encoding="utf-8")


@pytest.mark.verifies("SWR-TRC-031", technique="fault_injection", polarity="violation")
def test_a_function_without_an_owner_is_told_in_a_traced_layer_only(sample: Sample, trace: Callable) -> None:
    declare_traced(sample, 'schema = "mamori.code/1"\ntraced = ["safety/", "tools/offline.py"]\n')
    for folder in ("safety/src", "safety_net"):
        (sample.root / folder).mkdir(parents=True)
        (sample.root / folder / "late.cpp").write_text('#include "alive.hpp"\n\nvoid forgotten() {\n}\n', encoding="utf-8")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.status == 1
    found = [(one["rule"], one["file"], one["line"]) for one in outcome.content["findings"]]
    assert found == [("untraced-function", "safety/src/late.cpp", 3)]
    assert "forgotten" in outcome.content["findings"][0]["message"]


@pytest.mark.verifies("SWR-TRC-031", technique="requirements_based", polarity="nominal")
def test_a_layer_whose_functions_are_all_owned_is_clean(sample: Sample, trace: Callable) -> None:
    declare_traced(sample, 'schema = "mamori.code/1"\ntraced = ["safety"]\n')
    (sample.root / "safety/src").mkdir()
    (sample.root / "safety/src/alive.cpp").write_text('#include "alive.hpp"\nvoid mamori::LateReporter::step() {}\n', encoding="utf-8")

    assert trace("check", "--root", sample.root).status == 0


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('schema = "mamori.code/2"\n', "mamori.code/1"),
        ('schema = "mamori.code/1"\ntraced = "safety"\n', "no list"),
        ('schema = "mamori.code/1"\ntraced = ["kernle"]\n', "kernle"),
        ('schema = "mamori.code/1"\ntracked = ["safety"]\n', "tracked"),
        ("schema = \n", "code.toml"),
    ],
    ids=["schema", "kind", "absent", "key", "toml"],
)
@pytest.mark.verifies("SWR-TRC-031", technique="error_guessing", polarity="violation")
def test_a_wrong_schema_of_code_is_one_clear_error(sample: Sample, trace: Callable, text: str, named: str) -> None:
    declare_traced(sample, text)

    outcome = trace("check", "--root", sample.root)

    assert (outcome.status, outcome.out) == (2, "")
    assert named in outcome.err and "code.toml" in outcome.err
