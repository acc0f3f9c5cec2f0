# SPDX-License-Identifier: Apache-2.0
# Goal: the methods of README.md work for a project with its own build: package components, add_subdirectory, FetchContent, tests with
# sanitizers. Method: small projects from the code blocks of README.md and the sources of verification/consumer. One project uses an
# installed package. Another compiles the layers from source, without package manager and dpkg in PATH.
from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from mamori_tools.command.new_project import new
from mamori_tools.host.project import Project

BUILD_TIMEOUT_S = 600
HEAD = "cmake_minimum_required(VERSION 3.25)\nproject(my_robot LANGUAGES CXX)\n"
SANITIZED = "-DCMAKE_CXX_FLAGS=-fsanitize=undefined -fno-sanitize-recover=all"
COMPILERS = [name for name in ("g++", "clang++-19") if shutil.which(name)]


def run(*argv: str | Path, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(word) for word in argv], capture_output=True, text=True, check=False, env=env,
                          stdin=subprocess.DEVNULL, timeout=BUILD_TIMEOUT_S)  # fmt: skip


def configure(source: Path, build: Path, *options: str, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    return run("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF", *options, env=env)


def find_blocks(project: Project) -> dict[str, str]:
    """The CMake blocks of README.md by the beginning of their first line."""
    page = (project.root / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```cmake\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    return {re.split(r"[ )]", block)[0]: block for block in blocks}


def write_project(project: Project, folder: Path, *blocks: str) -> Path:
    folder.mkdir()
    consumer = project.root / "verification" / "consumer"
    shutil.copy(consumer / "main.cpp", folder)
    shutil.copy(consumer / "robot_test.cpp.in", folder / "robot_test.cpp")  # names a requirement of a user project, not of this one
    (folder / "CMakeLists.txt").write_text(HEAD + "".join(blocks), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def prefix(project: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("package") / "prefix"
    installed = run("cmake", "--install", project.build, "--prefix", folder)
    assert installed.returncode == 0, installed.stderr
    return folder


@pytest.fixture
def bare_path(tmp_path: Path) -> dict[str, str]:
    """An environment whose PATH contains a compiler cache and all programs except package tools."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for where in reversed(os.environ["PATH"].split(":")):
        for program in Path(where).glob("*"):
            if not program.name.startswith(("apt", "dpkg")):
                (folder / program.name).unlink(missing_ok=True)
                (folder / program.name).symlink_to(program)
    (folder / "ccache").unlink(missing_ok=True)
    (folder / "ccache").write_text('#!/bin/sh\nexec "$@"\n', encoding="utf-8")
    (folder / "ccache").chmod(0o755)
    kept = {name: value for name, value in os.environ.items() if not name.endswith("_COMPILER_LAUNCHER")}
    return {**kept, "PATH": str(folder)}


def find_launchers(build: Path) -> set[str]:
    """Programs through which a build calls its C++ compiler; an empty name means a direct call."""
    rules = (build / "CMakeFiles" / "rules.ninja").read_text(encoding="utf-8")
    calls = re.findall(r"^  command = (.*?)\S*c\+\+ .*-o \$out -c \$in$", rules, re.MULTILINE)
    return {Path(call.strip()).name for call in calls}


def get_version(project: Project) -> str:
    match = re.search(r"^project\(mamori VERSION (\S+)", (project.root / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE)
    assert match is not None
    return match[1]


@pytest.mark.verifies("SWR-PRF-039", technique="interface")
def test_components_of_the_package_are_found_by_name_with_version_and_licence(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = write_project(project, tmp_path / "robot", find_blocks(project)["find_package(mamori"])

    configured = configure(folder, folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout
    ran = run(folder / "build" / "my_robot")
    assert (ran.returncode, ran.stdout.splitlines()[0]) == (0, f"mamori {get_version(project)}")
    licence = (prefix / "share" / "licenses" / "mamori" / "LICENSE").read_bytes()
    assert licence == (project.root / "LICENSE").read_bytes()


@pytest.mark.verifies("SWR-PRF-039", technique="equivalence_classes")
def test_each_component_of_the_package_may_be_asked_for(project: Project, prefix: Path, tmp_path: Path) -> None:
    names = "kernel safety posix_rt lcm virtual_time conformance table_dump timing verifies simbody_sim"
    links = "".join(f"if(NOT TARGET mamori::{name})\nmessage(FATAL_ERROR {name})\nendif()\n" for name in names.split())
    folder = write_project(project, tmp_path / "robot", f"find_package(mamori 0.1 CONFIG REQUIRED COMPONENTS {names})\n", links)

    configured = configure(folder, folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}")

    assert configured.returncode == 0, configured.stderr


@pytest.mark.verifies("SWR-PRF-039", technique="error_guessing", polarity="violation")
def test_component_that_is_not_there_is_refused_with_the_reason(project: Project, prefix: Path, tmp_path: Path) -> None:
    smaller = tmp_path / "prefix"
    shutil.copytree(prefix, smaller)
    for file in smaller.rglob("mamori_simbody_simTargets*.cmake"):
        file.unlink()
    wanted = {"kernle": "mamori has no component 'kernle'; there are: kernel, safety,", "simbody_sim": "-DMAMORI_WITH_SIMBODY_SIM=OFF"}
    for component, reason in wanted.items():
        folder = write_project(project, tmp_path / component, f"find_package(mamori CONFIG REQUIRED COMPONENTS kernel {component})\n")

        refused = configure(folder, folder / "build", f"-DCMAKE_PREFIX_PATH={smaller}")

        assert refused.returncode != 0
        assert reason in " ".join(refused.stderr.split())
    folder = write_project(project, tmp_path / "optional", "find_package(mamori CONFIG REQUIRED OPTIONAL_COMPONENTS kernle)\n")
    assert configure(folder, folder / "build", f"-DCMAKE_PREFIX_PATH={smaller}").returncode == 0


@pytest.mark.verifies("SWR-PRF-040", technique="interface")
@pytest.mark.parametrize("compiler", COMPILERS)
def test_tests_of_a_user_link_with_the_undefined_behaviour_sanitizer_and_name_their_requirement(
    project: Project, prefix: Path, tmp_path: Path, compiler: str
) -> None:
    blocks = find_blocks(project)
    folder = write_project(project, tmp_path / "robot", blocks["find_package(mamori"], blocks["find_package(GTest"])

    configured = configure(folder, folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={compiler}", SANITIZED)
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build", "--target", "robot_test")
    assert built.returncode == 0, built.stdout
    result = tmp_path / "result.xml"
    ran = run(folder / "build" / "robot_test", f"--gtest_output=xml:{result}")
    assert ran.returncode == 0, ran.stdout
    text = result.read_text(encoding="utf-8")
    assert 'name="requirement" value="SWR-APP-001"' in text and 'name="technique" value="interface"' in text


@pytest.mark.verifies("SWR-PRF-041", technique="interface")
def test_source_tree_is_part_of_another_build_without_its_tests_simulation_and_strictness(
    project: Project, tmp_path: Path, bare_path: dict[str, str]
) -> None:
    folder = write_project(project, tmp_path / "robot", find_blocks(project)["add_subdirectory(mamori"])
    (folder / "mamori").symlink_to(project.root)
    build = folder / "build"

    configured = configure(folder, build, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", env=bare_path)
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", build, "--target", "my_robot", env=bare_path)
    assert built.returncode == 0, built.stdout
    assert run(build / "my_robot").returncode == 0

    commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    kernel = [one["command"] for one in commands if "/kernel/src/" in one["file"]]
    assert kernel and not any("-Werror" in command for command in kernel)
    assert find_launchers(build) == {""}
    assert not any("/tests/" in one["file"] or "/simbody_sim/" in one["file"] or "/examples/" in one["file"] for one in commands)
    installed = run("cmake", "--install", build, "--prefix", tmp_path / "prefix")
    assert installed.returncode == 0, installed.stderr
    assert not (tmp_path / "prefix" / "include" / "mamori").exists()


@pytest.mark.verifies("SWR-PRF-041", technique="interface")
def test_source_tree_is_fetched_content_of_another_build(project: Project, tmp_path: Path) -> None:
    block = find_blocks(project)["include(FetchContent"]
    place = re.compile(r"GIT_REPOSITORY \S+ GIT_TAG [^\s)]+")
    assert len(place.findall(block)) == 1
    folder = write_project(project, tmp_path / "robot", place.sub(f'SOURCE_DIR "{project.root}"', block))

    configured = configure(folder, folder / "build")

    assert configured.returncode == 0, configured.stderr
    assert "libmamori_kernel.a" in (folder / "build" / "build.ninja").read_text(encoding="utf-8")


@pytest.mark.verifies("SWR-PRF-041", technique="equivalence_classes")
@pytest.mark.parametrize(
    ("option", "launcher"),
    [("", "ccache"), ("-DMAMORI_USE_CCACHE=OFF", ""), ("-DCMAKE_CXX_COMPILER_LAUNCHER=env", "env"), ("-DCMAKE_CXX_COMPILER_LAUNCHER=", "")],
)
def test_compiler_cache_is_used_at_top_level_unless_the_caller_chose_otherwise(
    project: Project, tmp_path: Path, bare_path: dict[str, str], option: str, launcher: str
) -> None:
    options = ("-DMAMORI_WITH_SIMBODY_SIM=OFF", "-DMAMORI_BUILD_TESTS=OFF", "-DMAMORI_BUILD_EXAMPLES=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")

    configured = configure(project.root, tmp_path / "build", *options, *filter(None, [option]), env=bare_path)

    assert configured.returncode == 0, configured.stderr
    commands = json.loads((tmp_path / "build" / "compile_commands.json").read_text(encoding="utf-8"))
    assert commands and all("-Werror" in one["command"] for one in commands)
    assert find_launchers(tmp_path / "build") == {launcher}


@pytest.mark.verifies("SWR-PRF-041", technique="boundary_values")
def test_warnings_are_no_errors_where_the_option_is_off(project: Project, tmp_path: Path) -> None:
    options = ("-DMAMORI_WITH_SIMBODY_SIM=OFF", "-DMAMORI_BUILD_TESTS=OFF", "-DMAMORI_BUILD_EXAMPLES=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
               "-DMAMORI_WARNINGS_AS_ERRORS=OFF")  # fmt: skip

    assert configure(project.root, tmp_path / "build", *options).returncode == 0
    commands = json.loads((tmp_path / "build" / "compile_commands.json").read_text(encoding="utf-8"))
    assert commands and not any("-Werror" in one["command"] for one in commands)


@pytest.mark.verifies("SWR-CLI-024", technique="interface")
def test_new_project_builds_by_plain_cmake_and_its_tests_find_a_brake_that_is_late(prefix: Path, tmp_path: Path) -> None:
    assert new(tmp_path / "robot") == 0
    folder, build = tmp_path / "robot", tmp_path / "robot" / "build"
    junit = tmp_path / "evidence" / "junit"
    test = ("env", f"GTEST_OUTPUT=xml:{junit}/", "ctest", "--test-dir", build, "--output-on-failure", "--no-tests=error")

    configured = configure(folder, build, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Werror")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", build)
    assert built.returncode == 0, built.stdout
    assert run(build / "robot").stdout.startswith("after  40 ms: 4 rad/s, brake off")
    tested = run(*test)
    assert tested.returncode == 0, tested.stdout
    checked = run(sys.executable, "-P", "-m", "mamori_tools.command", "trace", "check", "--root", folder,
                  "--evidence", tmp_path / "evidence", "--allow-missing")  # fmt: skip
    assert checked.returncode == 0, checked.stdout
    assert "3 test results" in checked.stdout

    components = folder / "src" / "components.hpp"
    text = components.read_text(encoding="utf-8")
    assert text.count("8.0") == 1
    components.write_text(text.replace("8.0", "10.0"), encoding="utf-8")
    assert run("cmake", "--build", build, "--target", "robot_test").returncode == 0
    failed = run(*test)
    assert failed.returncode != 0
    assert failed.stdout.count("[  FAILED  ] SystemTest.") >= 3
