# SPDX-License-Identifier: Apache-2.0
# Goal: the shipped tree complies with the layer table, and each kind of violation is found with its location.
# Method: a small tree with one seeded file per case.
from __future__ import annotations

import re
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.check_layers import check_tree, main
from verification.checks.component_folders import UMBRELLA_HEADERS
from verification.checks.layer_table import LISTED_C, LISTED_STD
from verification.checks.target_limits import MEASURED_HEADERS


def seed(root: Path, name: str, text: str) -> list[str]:
    """@return findings in a tree with three ports and the seeded file."""
    for port in ("conformance", "posix_rt", "virtual_time"):
        (root / "ports" / port).mkdir(parents=True)
    (root / "safety" / "src" / "reaction").mkdir(parents=True)
    for hidden in ("src/reaction/inner.hpp", "hidden.hpp"):
        (root / "safety" / hidden).touch()
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return [str(finding) for finding in check_tree(root)]


@pytest.mark.verifies("SWR-PRF-006")
def test_shipped_tree_keeps_the_table() -> None:
    assert [finding for finding in check_tree(ROOT) if finding.rule in ("include", "folder", "link", "import")] == []


@pytest.mark.verifies("SWR-PRF-007")
def test_shipped_target_code_keeps_the_limits() -> None:
    assert [finding for finding in check_tree(ROOT) if finding.rule in ("word", "size") and finding.file != MEASURED_HEADERS] == []


@pytest.mark.verifies("SWR-PRF-008")
def test_shipped_headers_of_the_kernel_are_short() -> None:
    assert len(list((ROOT / MEASURED_HEADERS).rglob("*.hpp"))) > 1
    assert [finding for finding in check_tree(ROOT) if finding.file == MEASURED_HEADERS] == []


@pytest.mark.verifies("SWR-PRF-006", technique="back_to_back")
def test_listed_headers_are_those_of_the_written_table() -> None:
    written = re.search(r"^\| kernel \|.*std: `([a-z_ ]+)`", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE)

    assert written is not None
    assert set(written[1].split()) == LISTED_STD
    in_c = re.search(r"^\| kernel \|.*headers in C: `([a-z_. ]+)`", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert in_c is not None
    assert set(in_c[1].split()) == LISTED_C


ALLOWED = {
    "kernel/include/mamori/kernel/run/a.hpp": "#include <array>\n#include <cstdint>\n#include \"mamori/kernel/base/span.hpp\"\n",
    "kernel/include/mamori/kernel/c/a.h": "#include <stdbool.h>\n#include <stdint.h>\n",
    "kernel/include/mamori/kernel/c/a.hpp": "#include \"mamori/kernel/c/a.h\"\n#include \"mamori/kernel/dataflow/data_port.hpp\"\n",
    "examples/a/main.c": "#include <math.h>\n#include \"mamori/kernel/c/a.h\"\n",
    "kernel/src/base/assert.cpp": "#include <unistd.h>\n",
    "kernel/tests/a_test.cpp": "#include <string>\n#include <gtest/gtest.h>\n#include \"mamori/trace/verifies.hpp\"\n",
    "kernel/tests/support/a.hpp": "#include <sys/wait.h>\n#include \"support/a.hpp\"\n",
    "safety/src/arm/a.cpp": "#include <Eigen/Core>\n#include \"mamori/kernel/base/span.hpp\"\n",
    "safety/src/reaction/a.cpp": "#include \"inner.hpp\"\n",
    "ports/virtual_time/src/a.cpp": "#include <vector>\n#include <time.h>\n#include \"mamori/virtual_time/clock.hpp\"\n",
    "safety/tests/a_test.cpp": "#include \"mamori/verification/failed_check.hpp\"\n",
    "ports/virtual_time/tests/a_test.cpp": "#include \"mamori/ports/conformance/host_contract.hpp\"\n",
    "ports/virtual_time/CMakeLists.txt": "mamori_library(virtual_time DEPENDS mamori::kernel)\nmamori_test(t DEPENDS mamori::conformance)\n",
    "simbody_sim/src/a.cpp": "#include <Simbody.h>\n#include <kdl/chain.hpp>\n#include \"mamori/virtual_time/clock.hpp\"\n",
    "examples/a/main.cpp": "#include <iostream>\n#include \"mamori/simbody_sim/arm.hpp\"\n",
    "trace/mamori_trace/a.py": "import mamori_trace.model\nfrom pathlib import Path\n",
    "trace/mamori_trace/checks/a.py": "import mamori_trace.readers.headings\n",
    "trace/mamori_trace/command.py": "from mamori_trace.actions import check\n",
    "tools/mamori_tools/timing/a.py": "import mamori_tools.host.steps\nfrom mamori_trace.actions import review\n",
    "tools/tests/a.py": "import verification.plan.gate\n",
    "verification/proofs/a.py": "from verification.checks import layer_table\n",
    "verification/proofs/test_a.py": "from verification.mutation import run\n",
    "kernel/tests/memory_model/a.hpp": "#include <relacy/relacy.hpp>\n",
    "tools/probe/timing/src/a.cpp": "#include <vector>\n#include \"mamori/table_dump/describe.hpp\"\n",
    "verification/a.py": "from mamori_tools.motion import read_motion\n",
    "safety/CMakeLists.txt": "mamori_library(safety DEPENDS mamori::kernel)\nmamori_test(t DEPENDS mamori::virtual_time)\n",
}  # fmt: skip


@pytest.mark.parametrize("name", ALLOWED)
@pytest.mark.verifies("SWR-PRF-006", technique="equivalence_classes")
def test_allowed_use_is_no_finding(tmp_path: Path, name: str) -> None:
    assert seed(tmp_path, name, ALLOWED[name]) == []


@pytest.mark.parametrize(
    ("name", "line", "message"),
    [
        ("kernel/src/run/a.cpp", "#include <vector>", "include: kernel may not include 'vector'"),
        ("kernel/src/run/a.cpp", "#  include <stdint.h>", "include: kernel may not include 'stdint.h'"),
        ("kernel/src/run/a.cpp", '#include "mamori/safety/arm.hpp"', "include: kernel may not include 'mamori/safety/arm.hpp'"),
        ("kernel/src/run/a.cpp", '#include "mamori/trace/verifies.hpp"', "include: kernel may not include"),
        ("kernel/tests/a.cpp", '#include "mamori/safety/arm.hpp"', "include: kernel may not include"),
        ("kernel/tests/a.cpp", "#include <Eigen/Core>", "include: kernel may not include 'Eigen/Core'"),
        ("kernel/src/run/a.cpp", "#include <unistd.h>", "include: kernel may not include 'unistd.h'"),
        ("kernel/src/run/a.cpp", '#include "safety/hidden.hpp"', "include: 'safety/hidden.hpp' belongs to another layer"),
        ("safety/src/reaction/a.cpp", "#include <Eigen/Core>", "include: safety may not include 'Eigen/Core'"),
        ("safety/src/reaction/a.cpp", '#include "mamori/virtual_time/clock.hpp"', "include: safety may not include"),
        ("ports/posix_rt/src/a.cpp", '#include "mamori/virtual_time/clock.hpp"', "include: ports/posix_rt may not include"),
        ("ports/posix_rt/src/a.cpp", '#include "mamori/ports/conformance/trial.hpp"', "include: ports/posix_rt may not include"),
        ("ports/posix_rt/tests/a.cpp", '#include "mamori/ports/virtual_time/virtual_host.hpp"', "include: ports/posix_rt may not"),
        ("ports/conformance/src/a.cpp", '#include "mamori/ports/posix_rt/mapped_file.hpp"', "include: ports/conformance may not"),
        ("safety/tests/a.cpp", '#include "mamori/ports/conformance/trial.hpp"', "include: safety may not include"),
        ("simbody_sim/src/a.cpp", '#include "mamori/posix_rt/clock.hpp"', "include: simbody_sim may not include"),
        ("simbody_sim/src/a.cpp", "#include <boost/any.hpp>", "include: simbody_sim may not include 'boost/any.hpp'"),
        ("examples/a/main.cpp", '#include "../../safety/src/reaction/inner.hpp"', "include: '../../safety/src/reaction/inner.hpp' reaches into"),
        ("examples/a/main.cpp", '#include "safety/src/reaction/inner.hpp"', "include: 'safety/src/reaction/inner.hpp' reaches into"),
        ("kernel/include/mamori/kernel/c/a.h", "#include <stdlib.h>", "include: kernel may not include 'stdlib.h'"),
        ("kernel/src/run/a.c", "#include <stdint.h>", "include: kernel may not include 'stdint.h'"),
        ("trace/a.cpp", "", "include: this folder has no C++"),
        ("kernel/CMakeLists.txt", "mamori_library(kernel DEPENDS mamori::safety)", "link: kernel may not link mamori::safety"),
        ("ports/posix_rt/CMakeLists.txt", "mamori_library(posix_rt DEPENDS mamori::virtual_time)", "link: ports/posix_rt may"),
        ("ports/posix_rt/CMakeLists.txt", "mamori_library(posix_rt DEPENDS mamori::conformance)", "link: ports/posix_rt may"),
        ("trace/mamori_trace/a.py", "import mamori_tools.command", "import: mamori_trace (level 6) may not import mamori_tools.command (level 11)"),
        ("trace/mamori_trace/a.py", "from verification import plan", "import: mamori_trace (level 6) may not import verification.plan"),
        ("trace/tests/a.py", "from mamori_tools.host import steps", "import: mamori_trace (level 6) may not import mamori_tools.host.steps"),
        ("trace/mamori_trace/readers/a.py", "from mamori_trace import checks", "import: mamori_trace.readers (level 2) may not import"),
        ("trace/mamori_trace/model/a.py", "import mamori_trace.cache.state", "import: mamori_trace.model (level 1) may not import"),
        ("trace/mamori_trace/actions/a.py", "import mamori_trace.command", "import: mamori_trace.actions (level 5) may not import"),
        ("tools/mamori_tools/host/a.py", "import mamori_tools.timing.run", "import: mamori_tools.host (level 7) may not import"),
        ("tools/mamori_tools/table/a.py", "from mamori_tools.command import demo", "import: mamori_tools.table (level 8) may not import"),
        ("tools/mamori_tools/command/a.py", "import verification.plan.gate", "import: mamori_tools.command (level 11) may not import"),
        ("verification/bench/a.py", "from verification.mutation import run", "import: verification.bench (level 13) may not import"),
        ("verification/checks/a.py", "import verification.proofs.depth", "import: verification.checks (level 12) may not import"),
        ("kernel/src/base/a.cpp", "#include <unistd.h>", "include: kernel may not include 'unistd.h'"),
        ("kernel/src/base/assert.cpp", "#include <vector>", "include: kernel may not include 'vector'"),
        ("tools/probe/timing/src/a.cpp", '#include "mamori/simbody_sim/arm.hpp"', "include: tools/probe may not include"),
        ("trace/include/mamori/trace/a.hpp", '#include "mamori/kernel/base/span.hpp"', "include: trace may not include"),
    ],
)
@pytest.mark.verifies("SWR-PRF-006", technique="fault_injection", polarity="violation")
def test_seeded_breach_of_the_table_is_found_with_its_line(tmp_path: Path, name: str, line: str, message: str) -> None:
    findings = seed(tmp_path, name, f"\n{line}\n")

    assert len(findings) == 1
    assert findings[0].startswith(f"{name}:{2 if line else 1}: {message}")


@pytest.mark.parametrize(
    ("name", "include"),
    [
        ("kernel/src/run/a.cpp", "mamori/kernel/table/system_table.hpp"), ("kernel/src/run/a.cpp", "mamori/kernel/run/detail/mode_plan.hpp"),
        ("kernel/include/mamori/kernel/dataflow/detail/a.hpp", "mamori/kernel/dataflow/connection.hpp"),
        ("kernel/tests/a_test.cpp", "mamori/kernel/run/detail/mode_plan.hpp"), ("kernel/tests/a_test.cpp", "mamori/kernel/system/system.hpp"),
        ("kernel/include/mamori/kernel.hpp", "mamori/kernel/system/system.hpp"), ("safety/src/base/a.cpp", "mamori/kernel/run/executive.hpp"),
        ("safety/src/assumptions/a.cpp", "mamori/safety/self_test/march.hpp"),
    ],
)  # fmt: skip
@pytest.mark.verifies("SWR-PRF-042", technique="equivalence_classes")
def test_include_of_the_own_folder_or_a_lower_level_is_no_finding(tmp_path: Path, name: str, include: str) -> None:
    assert seed(tmp_path, name, f'#include "{include}"\n') == []


@pytest.mark.parametrize(
    ("name", "include", "message"),
    [
        ("kernel/src/base/a.cpp", "mamori/kernel/run/executive.hpp", "include: kernel/base (level 0) may not include"),
        ("kernel/include/mamori/kernel/run/a.hpp", "mamori/kernel/system/system.hpp", "include: kernel/run (level 4) may not include"),
        ("safety/src/base/a.cpp", "mamori/safety/e2e/crc.hpp", "include: safety/base (level 0) may not include"),
        ("kernel/src/run/a.cpp", "mamori/kernel/payload/detail/cdr_size.hpp", "include: 'mamori/kernel/payload/detail/cdr_size.hpp' is a detail of"),
        ("safety/tests/a_test.cpp", "mamori/kernel/payload/detail/cdr_size.hpp", "include: 'mamori/kernel/payload/detail/cdr_size.hpp' is a detail"),
        ("examples/a/main.cpp", "mamori/kernel/payload/detail/cdr_size.hpp", "include: 'mamori/kernel/payload/detail/cdr_size.hpp' is a detail"),
        ("kernel/include/mamori/kernel/c/a.hpp", "mamori/kernel/system/system.hpp", "include: kernel/c (level 3) may not include"),
        ("kernel/include/mamori/kernel/a.hpp", "", "folder: kernel has component folders only"),
        ("kernel/src/a.cpp", "", "folder: kernel has component folders only"), ("safety/src/other/a.cpp", "", "folder: safety has component"),
    ],
)  # fmt: skip
@pytest.mark.verifies("SWR-PRF-042", technique="fault_injection", polarity="violation")
def test_include_of_a_higher_level_or_of_a_foreign_detail_is_found(tmp_path: Path, name: str, include: str, message: str) -> None:
    findings = seed(tmp_path, name, f'#include "{include}"\n' if include else "")

    assert len(findings) == 1
    assert findings[0].startswith(f"{name}:1: {message}")


@pytest.mark.verifies("SWR-PRF-042", technique="equivalence_classes")
def test_users_of_the_kernel_see_at_most_25_headers() -> None:
    umbrella = (ROOT / UMBRELLA_HEADERS[0]).read_text(encoding="utf-8")

    included = re.findall(r'^#include "(mamori/kernel/[a-z]+/[a-z0-9_]+\.hpp)"$', umbrella, re.MULTILINE)

    assert 0 < len(included) <= 25
    assert len(included) == umbrella.count("#include")


@pytest.mark.verifies("SWR-PRF-006", technique="fault_injection", polarity="violation")
def test_a_package_of_the_tools_without_a_level_is_found(tmp_path: Path) -> None:
    [finding] = seed(tmp_path, "tools/mamori_tools/other/a.py", "")

    assert finding.startswith("tools/mamori_tools/other/a.py:1: import: package mamori_tools.other has no level; add it")


def make_function(lines: int) -> str:
    return "int f() {\n" + "  g();\n" * (lines - 2) + "}\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("// FIXME: finish\n", "a.cpp:1: word: 'FIXME'"),
        ("// TODO: finish\n", "a.cpp:1: word: 'TODO'"),
        ("\nvoid f() { usleep(1); }\n", "a.cpp:2: word: 'usleep'"),
        ("int f() { return std::rand(); }\n", "a.cpp:1: word: 'rand'"),
        ('void f() { printf("x"); }\n', "a.cpp:1: word: 'printf'"),
        ("Eigen::MatrixXd m;\n", "a.cpp:1: word: 'MatrixXd'"),
        (f"\n{make_function(71)}", "a.cpp:2: size: f has 71 lines, 70 are the limit"),
        ("\n" * 501, "a.cpp:1: size: file has 501 lines, 500 are the limit"),
    ],
)
@pytest.mark.verifies("SWR-PRF-007", technique="boundary_values", polarity="violation")
def test_seeded_breach_of_the_limits_is_found(tmp_path: Path, text: str, message: str) -> None:
    findings = seed(tmp_path, "safety/src/reaction/a.cpp", text)

    assert len(findings) == 1
    assert message in findings[0]


@pytest.mark.parametrize(
    "text",
    ["// TODO(#12): finish\n", "// a task that may sleep or call printf\n", 'const char* t = "rand";\n', "int sleepless;\n",
     make_function(70), "\n" * 500],
)  # fmt: skip
@pytest.mark.verifies("SWR-PRF-007", technique="boundary_values")
def test_what_keeps_the_limits_is_no_finding(tmp_path: Path, text: str) -> None:
    assert seed(tmp_path, "safety/src/reaction/a.cpp", text) == []


def seed_headers(root: Path, folder: str, lines: list[int]) -> list[str]:
    """@return findings in a tree whose headers below `folder` have these numbers of lines."""
    for number, count in enumerate(lines):
        path = root / folder / f"h{number}.hpp"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n" * count, encoding="utf-8")
    return [str(finding) for finding in check_tree(root)]


@pytest.mark.parametrize(
    ("lines", "median"),
    [([91], "91"), ([10, 91, 400], "91"), ([10, 90, 91, 400], "90.5")],
)
@pytest.mark.verifies("SWR-PRF-008", technique="boundary_values", polarity="violation")
def test_long_headers_of_the_kernel_are_found(tmp_path: Path, lines: list[int], median: str) -> None:
    findings = seed_headers(tmp_path, "kernel/include/mamori/kernel/run", lines)

    longest = f"the longest is h{len(lines) - 1}.hpp with {lines[-1]}"
    assert findings == [f"kernel/include:1: size: median of {len(lines)} headers is {median} lines, 90 are the limit; "
                        f"split long ones, {longest}"]  # fmt: skip


@pytest.mark.parametrize("lines", [[90], [10, 90, 400], [90, 90, 90, 400], [89, 91]])
@pytest.mark.verifies("SWR-PRF-008", technique="boundary_values")
def test_headers_of_the_kernel_at_the_limit_are_no_finding(tmp_path: Path, lines: list[int]) -> None:
    assert seed_headers(tmp_path, "kernel/include/mamori/kernel/run", lines) == []


@pytest.mark.verifies("SWR-PRF-008", technique="equivalence_classes")
def test_only_headers_of_the_kernel_count_for_the_median(tmp_path: Path) -> None:
    assert seed_headers(tmp_path, "safety/include/mamori/safety/base", [400]) == []
    assert seed_headers(tmp_path, "kernel/tests/support", [400]) == []


@pytest.mark.verifies("SWR-PRF-006", technique="interface")
def test_exit_status_tells_whether_there_were_findings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "kernel").mkdir()
    assert main(["--root", str(tmp_path)]) == 0

    seed(tmp_path, "kernel/src/run/a.cpp", "#include <map>\n")
    assert main(["--root", str(tmp_path)]) == 1
    assert capsys.readouterr().out.endswith("layer check: 1 findings\n")
