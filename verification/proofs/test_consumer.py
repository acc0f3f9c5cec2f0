# SPDX-License-Identifier: Apache-2.0
# Goal: a project in another folder builds only against the installed package, and runs. The installed tree is moved before use, to detect
# paths to the build or source tree in the package.
from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from mamori_tools.host.project import Project

BUILD_TIMEOUT_S = 300


def run(*argv: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(word) for word in argv], capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, timeout=BUILD_TIMEOUT_S)  # fmt: skip


@pytest.fixture
def prefix(project: Project, tmp_path: Path) -> Path:
    installed = run("cmake", "--install", project.build, "--prefix", tmp_path / "first")
    assert installed.returncode == 0, installed.stderr
    return (tmp_path / "first").rename(tmp_path / "prefix")


def configure(project: Project, prefix: Path, folder: Path,
              source: str = "verification/consumer") -> subprocess.CompletedProcess[str]:  # fmt: skip
    shutil.copytree(project.root / source, folder)
    return run("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
               "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")  # fmt: skip


@pytest.mark.verifies("SWR-PRF-004")
def test_consumer_outside_the_tree_builds_and_runs(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = tmp_path / "consumer"

    configured = configure(project, prefix, folder)
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout
    ran = run(folder / "build" / "consumer")
    assert ran.returncode == 0, ran.stdout
    assert "BAD_PARAMETER" in ran.stdout


@pytest.mark.verifies("SWR-PRF-004", technique="back_to_back")
def test_shipped_example_builds_against_the_package_and_gives_the_same_hash(
    project: Project, prefix: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "safe_arm"
    configured = configure(project, prefix, folder, "examples/safe_arm")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build", "--target", "safe_arm")
    assert built.returncode == 0, built.stdout

    motion = tmp_path / "motion.dat"
    motion.write_text("0 0 0.8 0 0.8 0 0.8 1.57\n1 0.2 0.9 0.2 0.9 0.2 0.9 1.7\n", encoding="utf-8")
    hashes = set()
    for program in (folder / "build" / "safe_arm", project.build / "examples" / "safe_arm" / "safe_arm"):
        out = tmp_path / "out"
        ran = run(program, "run", "--model", prefix / "share" / "mamori" / "models" / "pa10_like.yaml",
                  "--motion", motion, "--out", out, "--frames", "1000")  # fmt: skip
        assert ran.returncode == 0, ran.stderr
        hashes.add(json.loads((out / "run.json").read_text(encoding="utf-8"))["trace_hash"])
    assert len(hashes) == 1


@pytest.mark.verifies("SWR-TAB-009", technique="back_to_back")
def test_first_system_builds_against_the_package_and_prints_what_the_manual_says(
    project: Project, prefix: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "minimal"
    configured = configure(project, prefix, folder, "examples/minimal")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout

    page = (project.root / "docs" / "manual" / "first_system.md").read_text(encoding="utf-8")
    shown = "".join(f"{line.strip()}\n" for line in page.splitlines() if line.startswith("    after "))
    assert shown.count("\n") == 5
    for program in (folder / "build" / "minimal", project.build / "examples" / "minimal" / "minimal"):
        ran = run(program)
        assert (ran.returncode, ran.stdout) == (0, shown)


@pytest.mark.verifies("SWR-REC-011", technique="back_to_back")
def test_tour_builds_against_the_package_and_log_prints_its_recorder_file_as_the_manual_shows(
    project: Project, prefix: Path, tmp_path: Path
) -> None:
    folder, file = tmp_path / "tour", tmp_path / "tour.rec"
    configured = configure(project, prefix, folder, "examples/tour")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout

    for _ in range(2):
        assert run(folder / "build" / "tour_recorder", file).returncode == 0
    shown = run(sys.executable, "-P", "-m", "mamori_tools.command", "log", file)

    assert (shown.returncode, shown.stderr) == (0, "")
    assert f"```text\n{shown.stdout}```" in (project.root / "docs" / "manual" / "recorder.md").read_text(encoding="utf-8")


def build_page(project: Project, prefix: Path, folder: Path, name: str, library: str) -> Path:
    """The first system with the ending from a page of the manual, linked to the library that the page names. @return `folder`."""
    configure(project, prefix, folder, "examples/minimal")
    source, lists = folder / "main.cpp", folder / "CMakeLists.txt"
    page = (project.root / "docs" / "manual" / name).read_text(encoding="utf-8")
    (block,) = [text for text in re.findall(r"^```cpp\n(.*?)^```$", page, re.DOTALL | re.MULTILINE) if "int main(" in text]
    text = source.read_text(encoding="utf-8").replace('#include "mamori/ports/virtual_time/machine.hpp"\n', "")
    source.write_text(text[: text.index("static mamori::ports::virtual_time::Machine")] + block, encoding="utf-8")
    lists.write_text(lists.read_text(encoding="utf-8").replace("mamori::virtual_time", library), encoding="utf-8")

    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout
    return folder


@pytest.mark.verifies("SWR-PRT-005", technique="interface")
def test_first_system_runs_in_real_time_as_the_manual_says(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = build_page(project, prefix, tmp_path / "minimal", "real_time.md", "mamori::posix_rt")
    ran = run(folder / "build" / "minimal")
    form = r"40 openings, (\d+) overran, (\d+) missed, latest by \d+\.\d{3} ms; priority (fixed|not granted), memory (locked|not locked)\n"
    # On a busy host, a run may report lateness; its last window may then still be running at the stop.
    counts = re.fullmatch(form, ran.stdout)
    assert counts is not None, (ran.stdout, ran.stderr)
    assert ran.returncode == 0 or int(counts[1]) > 0


@pytest.mark.verifies("SWR-PRT-021", technique="interface", polarity="violation")
def test_first_system_hangs_and_is_told_as_the_manual_says(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = build_page(project, prefix, tmp_path / "minimal", "last_resort.md", "mamori::posix_rt")
    program = folder / "build" / "minimal"
    orderly = run("env", "-C", tmp_path, program)
    assert orderly.stderr == "outputs closed\n"
    # If the host stalls for a tenth of a second, the watchdog or the schedule watch also acts in this run.
    by_host = orderly.returncode == -signal.SIGABRT or (orderly.returncode == 1 and "schedule watch" in orderly.stdout)
    assert by_host or (orderly.returncode, orderly.stdout) == (0, "no failure\n"), (orderly.stdout, orderly.stderr)

    hanging = run("env", "-C", tmp_path, program, "hang")
    assert (-hanging.returncode, hanging.stderr) == (signal.SIGABRT, "outputs closed\n")
    shown = run(sys.executable, "-P", "-m", "mamori_tools.command", "log", tmp_path / "run.rec")
    assert re.search(r"crash in session 2 at \d\.\d{9} s: SIGABRT, sent by a program; thread of the watchdog", shown.stdout)
    assert shown.returncode == 0, shown.stderr


@pytest.mark.verifies("SWR-PRT-013", technique="interface")
def test_system_of_two_processes_runs_as_the_manual_says(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = tmp_path / "split"
    folder.mkdir()
    page = (project.root / "docs" / "manual" / "partitions.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```cpp\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    for name, block in zip(("plan.hpp", "planner.cpp", "main.cpp"), blocks, strict=True):
        (folder / name).write_text(block, encoding="utf-8")
    lists = "cmake_minimum_required(VERSION 3.25)\nproject(split LANGUAGES CXX)\nfind_package(mamori CONFIG REQUIRED)\n"
    for name in ("planner", "main"):
        lists += f"add_executable({name} {name}.cpp)\ntarget_link_libraries({name} PRIVATE mamori::posix_rt)\n"
    (folder / "CMakeLists.txt").write_text(lists, encoding="utf-8")
    configured = run("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
                     "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")  # fmt: skip
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout

    shown = "".join(f"{line.strip()}\n" for line in page.splitlines() if line.startswith("    planner "))
    assert shown.count("\n") == 2
    ran = run(folder / "build" / "main", folder / "build" / "planner")
    assert (ran.returncode, ran.stdout) == (0, shown)
    missing = run(folder / "build" / "main", folder / "build" / "no_planner")
    assert missing.returncode == 1
    assert "cannot be executed" in missing.stdout


@pytest.mark.verifies("SWR-TIM-003", technique="interface")
def test_first_system_is_measured_as_the_manual_says(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = build_page(project, prefix, tmp_path / "minimal", "timing.md", "mamori::timing")
    out = tmp_path / "times"
    shown = run(sys.executable, "-P", "-m", "mamori_tools.command", "timing", folder / "build" / "minimal",
                "--cycles", "50", "--out", out)  # fmt: skip
    # A busy host may delay a window (1), and not every host grants the privileges (4).
    assert shown.returncode in (0, 1, 4), shown.stderr
    assert "drive" in shown.stdout and "monitor" in shown.stdout
    measured = json.loads((out / "timing.json").read_text(encoding="utf-8"))
    assert measured["cycles"] == {"asked": 50, "run": 50}


@pytest.mark.verifies("SWR-TIM-029", technique="interface")
def test_folders_of_a_users_project_are_built_and_measured_by_their_names(project: Project, prefix: Path, tmp_path: Path) -> None:
    robot = tmp_path / "robot"
    build_page(project, prefix, robot, "timing.md", "mamori::timing")
    shutil.rmtree(robot / "build")
    shutil.copy(project.root / "tools/probe/timing/tests/cost_subject.cpp", robot / "counted.cpp")
    with (robot / "CMakeLists.txt").open("a", encoding="utf-8") as lists:
        lists.write("add_executable(counted counted.cpp)\ntarget_link_libraries(counted PRIVATE mamori::timing)\n")
    for name, text in (("timed", 'program = "minimal"\ntarget = "minimal"\n'),
                       ("counted", 'program = "counted"\ntarget = "counted"\n[cost]\nmargin_percent = 50\n'
                                   '[[cost.class]]\nname = "all"\ncycles = 20\n')):  # fmt: skip
        (robot / name).mkdir()
        (robot / name / "timing.toml").write_text(text, encoding="utf-8")

    for command, name, words in (("timing", "timed", ("--cycles", "50")), ("cost", "counted", ())):
        shown = run(sys.executable, "-P", "-m", "mamori_tools.command", command, robot / name, "--json", *words)
        # A busy host may delay a window (1), and not every host grants the privileges (4).
        assert shown.returncode in (0, 1, 4), shown.stderr
        record = json.loads(shown.stdout)
        assert (record["schema"], record["system"]) == (f"mamori.{command}/1", name)
        stored = robot / "build" / "host-release" / "evidence" / command / name / f"{command}.json"
        assert json.loads(stored.read_text(encoding="utf-8")) == record
        assert "build the project" in shown.stderr


@pytest.mark.verifies("SWR-TAB-001", technique="interface")
def test_program_of_a_user_writes_its_table_and_the_command_shows_it(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = tmp_path / "minimal"
    configure(project, prefix, folder, "examples/minimal")
    source, lists = folder / "main.cpp", folder / "CMakeLists.txt"
    text = source.read_text(encoding="utf-8")
    save = 'return mamori::table_dump::save_json("table.json", mamori::make_view(kSystem)).empty() ? 0 : 1;'
    source.write_text('#include "mamori/table_dump/table_dump.hpp"\n' + text[: text.index("int main")] + f"int main() {{ {save} }}\n",
                      encoding="utf-8")  # fmt: skip
    lists.write_text(lists.read_text(encoding="utf-8").replace("mamori::virtual_time)", "mamori::virtual_time mamori::table_dump)"),
                     encoding="utf-8")  # fmt: skip

    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout
    ran = run("env", "-C", tmp_path, folder / "build" / "minimal")
    assert ran.returncode == 0
    shown = run(sys.executable, "-P", "-m", "mamori_tools.command", "table", tmp_path / "table.json")
    assert shown.returncode == 0, shown.stderr
    assert "wheel.speed    monitor.speed  later window" in shown.stdout
    assert "monitor.brake  wheel.brake    next frame" in shown.stdout


@pytest.mark.verifies("SWR-CIF-006", technique="back_to_back")
def test_components_in_c_build_against_the_package_and_print_what_the_manual_shows(project: Project, prefix: Path, tmp_path: Path) -> None:
    folder = tmp_path / "c_components"
    configured = configure(project, prefix, folder, "examples/c_components")
    assert configured.returncode == 0, configured.stderr
    built = run("cmake", "--build", folder / "build")
    assert built.returncode == 0, built.stdout

    pages = [(project.root / "docs" / "manual" / name).read_text(encoding="utf-8") for name in ("c_components.md", "rtmsafety.md")]
    shown = re.findall(r"^```text\n(.*?)^```$", "".join(pages), re.DOTALL | re.MULTILINE)
    for programs in (folder / "build", project.build / "examples" / "c_components"):
        for name, text in zip(("c_simple_io", "c_seq_io", "c_my_data_io", "c_rtmsafety"), shown, strict=True):
            ran = subprocess.run([programs / name], input="5 7 -3 2147483647", capture_output=True, text=True, check=False)
            assert (ran.returncode, ran.stdout) == (0, text)


@pytest.mark.parametrize("compiler", ["gcc", "clang-19"])
@pytest.mark.verifies("SWR-CIF-006", technique="interface")
def test_components_in_c_compile_as_c99_without_a_warning(project: Project, compiler: str) -> None:
    examples = project.root / "examples" / "c_components"
    for source in sorted(examples.rglob("*.c")):
        compiled = run(compiler, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", project.root / "kernel" / "include", source)
        assert (compiled.returncode, compiled.stderr) == (0, "")
        assert source.read_text(encoding="utf-8").count("\n") <= 80


OTHER_TYPES = {"output": "static const int number = 1; void f(void) { MAMORI_WRITE(ports->out, &number); }",
               "sign": "static const unsigned long number = 1; void f(void) { MAMORI_WRITE(ports->sum, &number); }",
               "input": "int f(void) { const int* const number = MAMORI_READ(ports->in); return *number; }"}  # fmt: skip


@pytest.mark.parametrize("compiler", ["gcc", "clang-19"])
@pytest.mark.parametrize("case", OTHER_TYPES)
@pytest.mark.verifies("SWR-CIF-003", technique="interface", polarity="violation")
def test_value_of_another_type_does_not_compile_in_c_with_the_flags_of_the_example(project: Project, compiler: str, case: str, tmp_path: Path) -> None:
    lists = (project.root / "examples" / "c_components" / "CMakeLists.txt").read_text(encoding="utf-8")
    flags = re.findall(r"-Werror=[\w-]+", lists)
    (tmp_path / "part.c").write_text('#include "mamori/kernel/c/component.h"\n'
                                     "struct Ports { MAMORI_IN_PORT(double) in; MAMORI_OUT_PORT(double) out; MAMORI_OUT_PORT(long) sum; };\n"
                                     f"extern const struct Ports* ports;\n{OTHER_TYPES[case]}\n", encoding="utf-8")  # fmt: skip
    command = (compiler, "-std=c99", "-fsyntax-only", "-I", project.root / "kernel" / "include", tmp_path / "part.c")

    assert run(*command).returncode == 0
    compiled = run(*command, *flags)

    assert compiled.returncode != 0 and "error: " in compiled.stderr and "-Werror" in compiled.stderr


SPEED_CHECK = """
#include <stdio.h>
#include <stdlib.h>
#include "SPEED.h"
static double speed;
static bool has_new, is_standing = true;
static const double* read(const void* port) { (void)port; return &speed; }
static bool is_new(const void* port) { (void)port; return has_new; }
static void write(void* port, const bool* value) { (void)port; is_standing = *value; }
const SpeedPorts speed_ports = {{0, &read, &is_new, 0}, {0, &write}};
int main(int count, char** words) {
    SPEED_t part;
    speed = strtod(words[1], NULL);
    has_new = count > 2;
    if (SPEED_create(&part) != RTC_OK) { return 1; }
    const int code = part.onExecute();
    printf("%d %d", code, is_standing);
    return 0;
}
"""


@pytest.mark.verifies("SWR-CIF-011", technique="boundary_values", polarity="violation")
def test_speed_check_fails_in_both_directions_and_without_a_new_value(project: Project, tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text(SPEED_CHECK, encoding="utf-8")
    folder = project.root / "examples" / "c_components" / "rtmsafety"
    built = run("gcc", "-std=c99", "-I", project.root / "kernel" / "include", "-I", folder, folder / "SPEED.c", tmp_path / "main.c", "-o", tmp_path / "main")
    assert built.returncode == 0, built.stderr

    speeds = {"0": "0 1", "0.0999": "0 1", "-0.0999": "0 1", "0.1": "0 0", "-0.1": "0 0", "6": "0 0", "-6": "0 0", "6.001": "1 0", "-6.001": "1 0",
              "nan": "1 0"}  # fmt: skip
    for speed, shown in speeds.items():
        assert run(tmp_path / "main", speed, "new").stdout == shown
        assert run(tmp_path / "main", speed).stdout == "1 0"


@pytest.mark.verifies("SWR-CIF-011", technique="interface")
def test_supervised_component_of_rtmsafety_runs(project: Project) -> None:
    ran = run(project.build / "examples" / "c_components" / "c_rtmsafety")

    assert re.search(r"^ 100 ms: Operational .*speed check: RTC_OK$", ran.stdout, re.MULTILINE)


@pytest.mark.verifies("SWR-CIF-011", technique="fault_injection", polarity="violation")
def test_failed_callback_of_rtmsafety_leads_to_the_stated_reaction(project: Project) -> None:
    ran = run(project.build / "examples" / "c_components" / "c_rtmsafety")

    assert ran.stdout.splitlines()[-1].startswith(" 260 ms: Safe ") and ran.stdout.endswith("speed check: RTC_ERROR\n")


@pytest.mark.verifies("SWR-PRF-004", technique="error_guessing", polarity="violation")
def test_consumer_without_the_package_is_told_so(project: Project, tmp_path: Path) -> None:
    refused = configure(project, tmp_path / "empty", tmp_path / "consumer")

    assert refused.returncode != 0
    assert "mamori" in refused.stderr
