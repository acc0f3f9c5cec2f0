# SPDX-License-Identifier: Apache-2.0
# Goal: each small system is within its limits of text and RAM, and no met aim is marked as missed. Method: images for the controller are
# linked and run in QEMU; exceeded limits and wrong marks must be findings.
from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from verification.proofs.image import QEMU, RUN_TIMEOUT_S
from verification.proofs.size import BASE, Limits, Size, list_findings, make_table, measure, read_limits, read_map, write_evidence
from verification.proofs.toolchain import CORTEX_M4, run_tool

ROWS = read_limits()
SIZE = Size(text=100, ram=50, data=40, parts={"kernel": 60, "application": 40})
LIMITS = Limits(BASE, "a title", text_max=100, ram_max=50)
EVERY_IMAGE = pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name.replace(" ", "_"))
# Function of an optional part -> images that use the part.
PARTS = {
    "mamori::detail::check_everything(": (),
    "mamori::SystemModes::": ("parameters", "modes"),
    "mamori::detail::ModeFollower::take_next_plan(": ("parameters", "modes"),
    "mamori::FsmMachine::": ("state machine",),
    "mamori::Introspection::": ("introspection",),
    "mamori::ExecutionContext::run_second_pass(": (),
    "mamori::detail::observe_pass(": ("eight", "supervision"),
    "mamori::FlightRecorder::open(": ("flight recorder",),
    "__aeabi_dmul": ("rates",),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("size")


@pytest.fixture(scope="module")
def sizes(folder: Path) -> dict[str, Size]:
    sizes = measure(ROWS, ROOT, folder)
    write_evidence(ROWS, sizes, Project(ROOT).evidence / "size")
    return sizes


@EVERY_IMAGE
@pytest.mark.verifies("SWR-VER-031")
def test_image_is_within_its_limits(sizes: dict[str, Size], row: Limits) -> None:
    assert list_findings(row, sizes[row.name]) == []


@EVERY_IMAGE
@pytest.mark.verifies("SWR-VER-031")
def test_measured_image_starts_and_stops(sizes: dict[str, Size], folder: Path, row: Limits) -> None:
    image = folder / f"{row.name.replace(' ', '_')}.elf"

    assert sizes[row.name].text > 0
    assert subprocess.run([*QEMU, str(image)], check=False, timeout=RUN_TIMEOUT_S, stdin=subprocess.DEVNULL).returncode == 0


@EVERY_IMAGE
@pytest.mark.verifies("SWR-VER-031", technique="back_to_back")
def test_parts_are_the_whole(sizes: dict[str, Size], row: Limits) -> None:
    assert sum(sizes[row.name].parts.values()) == pytest.approx(sizes[row.name].text, abs=32)


@pytest.mark.verifies("SWR-VER-031")
def test_evidence_names_limits_sizes_and_what_a_feature_adds(sizes: dict[str, Size], tmp_path: Path) -> None:
    write_evidence(ROWS, sizes, tmp_path)

    images = {image["name"]: image for image in json.loads((tmp_path / "size.json").read_text(encoding="utf-8"))["images"]}
    assert images["two"]["text"] == sizes["two"].text and images["eight"]["ram_aim"] == 4096
    assert f"{sizes['modes'].text - sizes['two'].text:+}" in (tmp_path / "size.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("limits", "finding"),
    [(replace(LIMITS, text_max=99), "text takes 100 bytes, 1 more than its limit of 99"),
     (replace(LIMITS, ram_max=49), "RAM takes 50 bytes, 1 more than its limit of 49"),
     (replace(LIMITS, text_aim=99), "text takes 100 bytes, more than the aim of 99"),
     (replace(LIMITS, ram_aim=49), "RAM takes 50 bytes, more than the aim of 49"),
     (replace(LIMITS, text_aim=100, missed=True), "every aim is met; remove the mark `missed` in size.toml"),
     (replace(LIMITS, missed=True), "every aim is met; remove the mark `missed` in size.toml")],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-031", technique="boundary_values", polarity="violation")
def test_size_beyond_a_limit_or_a_wrong_mark_is_a_finding(limits: Limits, finding: str) -> None:
    assert list_findings(limits, SIZE) == [finding]


@pytest.mark.parametrize("limits", [LIMITS, replace(LIMITS, text_aim=100, ram_aim=50), replace(LIMITS, text_aim=99, missed=True)])
@pytest.mark.verifies("SWR-VER-031", technique="boundary_values")
def test_size_at_its_limits_and_a_known_miss_are_no_finding(limits: Limits) -> None:
    assert list_findings(limits, SIZE) == []


@pytest.mark.verifies("SWR-VER-031")
def test_table_states_a_missed_aim() -> None:
    rows = [LIMITS, replace(LIMITS, name="more", text_aim=1, ram_aim=50, missed=True)]

    assert "aim: text 1 missed, RAM 50 met" in make_table(rows, {BASE: SIZE, "more": SIZE})


@pytest.mark.verifies("SWR-VER-031")
def test_map_with_a_long_name_and_merged_texts_is_read() -> None:
    text = (
        "Linker script and memory map\n\n.text           0x0000      0x30\n .text.short    0x0000       0x10 a.o\n"
        " .text.of_a_long_name_that_has_its_own_line\n                0x0010       0x1e b.o\n .text.merged   0x0010       0x1e c.o\n"
        " *fill*         0x002e        0x2 \n"
    )

    assert list(read_map(text)) == [(".text", "a.o", 16), (".text", "b.o", 0), (".text", "c.o", 30), (".text", "", 2)]


@EVERY_IMAGE
@pytest.mark.verifies("SWR-KRN-071")
def test_part_is_linked_only_where_it_is_used(sizes: dict[str, Size], folder: Path, row: Limits) -> None:
    assert row.name in sizes
    symbols = run_tool([f"{CORTEX_M4.prefix}nm", "-C", str(folder / f"{row.name.replace(' ', '_')}.elf")])
    linked = {part for part in PARTS if f" {part}" in symbols}

    assert linked == {part for part, images in PARTS.items() if row.name in images}


@pytest.mark.verifies("SWR-KRN-072")
def test_smallest_system_has_no_division_of_the_library(sizes: dict[str, Size], folder: Path) -> None:
    assert BASE in sizes
    assert "ldivmod" not in run_tool([f"{CORTEX_M4.prefix}nm", str(folder / f"{BASE}.elf")])
