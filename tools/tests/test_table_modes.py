# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori table` shows modes, parameters and sets as text and as a picture, and rejects invalid ones in one line.
# Method: the table that the test of the library writes (robot_with_modes.json), with changes. Pictures are parsed as XML, and their boxes
# and labels compared. The page of the manual is compared with that table and its source.
from __future__ import annotations

import copy
import itertools
import json
import re
import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.command.main import main
from mamori_tools.table.document import read_table
from mamori_tools.table.graph import make_dot
from mamori_tools.table.mode_graph import make_mode_dot
from mamori_tools.table.text import make_text
from mamori_trace.base.errors import InputError

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "tools" / "probe" / "table_dump" / "tests" / "robot_with_modes.hpp"
STORED = SOURCE.with_suffix(".json")
PAGE = ROOT / "docs" / "manual" / "table_with_modes.md"
ROBOT: dict[str, Any] = json.loads(STORED.read_text(encoding="utf-8"))
SVG = "{http://www.w3.org/2000/svg}"
needs_graphviz = pytest.mark.skipif(shutil.which("dot") is None, reason="graphviz is not installed")


def write(folder: Path, table: dict[str, Any]) -> Path:
    path = folder / "table.json"
    path.write_text(json.dumps(table), encoding="utf-8")
    return path


def changed(**changes: object) -> dict[str, Any]:
    """A copy of the robot; a key names a location, its parts separated by two underscores."""
    table = copy.deepcopy(ROBOT)
    for key, value in changes.items():
        *parents, last = (int(part) if part.isdigit() else part for part in key.split("__"))
        row: Any = table
        for part in parents:
            row = row[part]
        row[last] = value
    return table


def make_system(mode_count: int, transitions: list[tuple[int, int, str]]) -> dict[str, Any]:
    modes = [{"name": f"mode_{index}", "safe": index == mode_count - 1, "initial": index == 0, "components": [0, 1], "set": None}
             for index in range(mode_count)]  # fmt: skip
    rows = [{"from": {"index": source, "name": f"mode_{source}"}, "event": number, "event_name": event,
             "to": {"index": target, "name": f"mode_{target}"}} for number, (source, target, event) in enumerate(transitions)]  # fmt: skip
    connections = [{**row, "only_in": None, "modes": []} for row in ROBOT["connections"]]
    return {**ROBOT, "modes": modes, "transitions": rows, "connections": connections}


def read_lines(folder: Path, table: dict[str, Any]) -> list[str]:
    return [" ".join(line.split()) for line in make_text(read_table(write(folder, table))).splitlines()]


def section(lines: list[str], first: str) -> list[str]:
    """The rows below a heading, up to the next empty line."""
    start = lines.index(first) + 1
    return list(itertools.takewhile(lambda line: line != "", lines[start:]))


def draw_modes(folder: Path, table: dict[str, Any]) -> ElementTree.Element:
    assert main(["table", str(write(folder, table)), "--svg-modes", str(folder / "modes.svg")]) == 0
    return ElementTree.parse(folder / "modes.svg").getroot()


def texts_of(picture: ElementTree.Element) -> list[str]:
    return [text.text or "" for text in picture.iter(f"{SVG}text")]


@pytest.mark.verifies("SWR-TAB-011")
def test_text_shows_who_runs_in_which_mode(tmp_path: Path) -> None:
    lines = read_lines(tmp_path, ROBOT)

    assert section(lines, "4 modes, first idle, safe halt") == [
        "component idle work teach halt", "encoder x x x x", "monitor x x x x", "planner - x - -", "hand - - x -",
        "drive - x x -", "(configuration set) - fast slow -"]  # fmt: skip
    assert section(lines, "transitions") == [
        "from event to", "idle Start work", "idle Teach teach", "work Stop idle", "teach Stop idle"]  # fmt: skip


@pytest.mark.verifies("SWR-TAB-011")
def test_text_shows_parameters_and_sets(tmp_path: Path) -> None:
    lines = read_lines(tmp_path, changed(parameters__1__values=[1, -2, 18446744073709551615]))

    assert section(lines, "parameters") == [
        "parameter type value constraint", "monitor.limit_rad_s real 1 0.1<=x<=3",
        "drive.gain whole[3] 1, -2, 18446744073709551615 1<=x<=40"]  # fmt: skip
    assert section(lines, "configuration sets") == [
        "set parameter value", "fast monitor.limit_rad_s 2", "fast drive.gain 25", "slow monitor.limit_rad_s 0.25", "slow drive.gain 5"]  # fmt: skip


@pytest.mark.verifies("SWR-TAB-011")
def test_text_shows_the_modes_of_connections(tmp_path: Path) -> None:
    lines = read_lines(tmp_path, changed(connections__1__modes=[0, 1, 2], connections__2__modes=[]))

    assert section(lines, "connections") == [
        "from to arrives works in declared for", "encoder.angle monitor.angle same window",
        "encoder.angle planner.angle later window all but halt", "encoder.angle hand.angle later window no mode",
        "planner.setpoint drive.setpoint later window work work", "hand.setpoint drive.setpoint later window teach"]  # fmt: skip


@pytest.mark.verifies("SWR-TAB-011", technique="boundary_values")
def test_matrix_of_many_modes_keeps_to_the_width_of_a_line(tmp_path: Path) -> None:
    text = make_text(read_table(write(tmp_path, make_system(32, []))))

    headings = [line.split()[1:] for line in text.splitlines() if line.startswith("  component ")]
    assert len(headings) == 3
    assert list(itertools.chain(*headings)) == [f"mode_{index}" for index in range(32)]
    assert max(len(line) for line in text.splitlines() if "mode_" in line) <= 120


@pytest.mark.verifies("SWR-TAB-011", technique="boundary_values")
def test_table_without_modes_says_nothing_of_them(tmp_path: Path) -> None:
    empty = {**make_system(0, []), "parameters": [], "configuration_sets": []}
    lines = read_lines(tmp_path, empty)
    assert not {"transitions", "parameters", "configuration sets"} & set(lines)
    assert not [line for line in lines if "mode" in line or "declared" in line]


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-012")
def test_picture_shows_modes_events_the_first_and_the_safe_one(tmp_path: Path) -> None:
    picture = draw_modes(tmp_path, ROBOT)

    texts = texts_of(picture)
    assert {"idle", "work", "teach", "halt", "Start", "Teach", "set fast", "2 of 5 components", "failed switch or request"} <= set(texts)
    assert texts.count("Stop") == 2
    assert texts.count("safe mode") == 1
    titles = [title.text for title in picture.iter(f"{SVG}title")]
    assert [title for title in titles if title and "->" in title and ("start" in title or "any" in title)] == ["start0->m0", "any3->m3"]
    assert make_mode_dot(read_table(STORED)).count("peripheries=2") == 1


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-012", technique="boundary_values")
def test_picture_of_many_modes_has_no_two_things_in_one_place(tmp_path: Path) -> None:
    transitions = [(source, (source * step + step) % 15, f"Event{source}_{step}") for source in range(15) for step in (1, 2, 4)]
    picture = draw_modes(tmp_path, make_system(16, transitions))

    labels = [text for group in picture.iter(f"{SVG}g") if group.get("class") == "labels" for text in group.iter(f"{SVG}text")]
    nodes = [group for group in picture.iter(f"{SVG}g") if group.get("class") == "node"]
    assert len(labels) == 45 + 1
    boxes = [box_of(text) for text in labels] + [box_of(text) for node in nodes for text in node.iter(f"{SVG}text")]
    assert [(a, b) for a, b in itertools.combinations(boxes, 2) if overlap(a, b)] == []


def box_of(text: ElementTree.Element) -> tuple[float, float, float, float]:
    """Left, right, top, bottom of a centred text with narrow characters, so that touching texts do not count as overlap."""
    size = float(text.get("font-size", "0"))
    x, y, half = float(text.get("x", "0")), float(text.get("y", "0")), 0.25 * size * len(text.text or "")
    return x - half, x + half, y - 0.7 * size, y


def overlap(a: tuple[float, float, float, float], b: tuple[float, float, float, float]) -> bool:
    return a[0] < b[1] and b[0] < a[1] and a[2] < b[3] and b[2] < a[3]


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-012", technique="boundary_values")
def test_events_between_the_same_modes_share_an_arrow_and_hundreds_are_drawn(tmp_path: Path) -> None:
    pairs = [(source, target) for source in range(20) for target in range(20) if source != target]
    picture = draw_modes(tmp_path, make_system(20, [(*pair, event) for pair in pairs for event in ("Go", "Run")]))

    titles = [title.text or "" for title in picture.iter(f"{SVG}title")]
    assert sum("->m" in title and title.startswith("m") for title in titles) == len(pairs)
    assert texts_of(picture).count("Go") == texts_of(picture).count("Run") == len(pairs)


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-012", technique="boundary_values")
def test_picture_of_a_table_without_modes_says_so(tmp_path: Path) -> None:
    assert texts_of(draw_modes(tmp_path, make_system(0, [])))[-1] == "The table has no modes: all of its components run."


@pytest.mark.verifies("SWR-TAB-012")
def test_graph_marks_connections_that_hold_in_some_modes(tmp_path: Path) -> None:
    edges = [line for line in make_dot(read_table(STORED)).splitlines() if "[dir=" in line]
    assert ["odot" in edge for edge in edges] == [False, True, True, True, True]
    assert 'xlabel="setpoint\\n[work]", tooltip="planner.setpoint → drive.setpoint, in work"' in edges[3]

    backwards = changed(connections__0__modes=[0, 1])
    edge = next(line for line in make_dot(read_table(write(tmp_path, backwards))).splitlines() if "[dir=" in line)
    assert "arrowhead=odot" in edge  # within a window, dot gets the edge in reverse direction

    many = make_system(9, [])
    many["connections"][3]["modes"] = [0, 2, 4, 6]
    assert 'xlabel="setpoint\\n[4 of 9 modes]"' in make_dot(read_table(write(tmp_path, many)))
    assert "odot" not in make_dot(read_table(write(tmp_path, make_system(0, []))))


BROKEN = changed(
    modes__0__components=[0, None], modes__1__set={"index": None, "name": "fsat"}, modes__2__name="?",
    transitions__0={"from": {"index": None, "name": "?"}, "event": 9, "event_name": "9", "to": {"index": None, "name": "nowhere"}},
    connections__3__only_in=[None], parameters__0={"owner": {"index": None, "name": "?"}, "name": "?", "type": None, "constraint": "",
                                                   "values": None},
    configuration_sets__0={"name": "?", "assignments": None},
    configuration_sets__1__assignments=[{"parameter": {"index": None, "name": "speed"}, "values": [None]},
                                        {"parameter": {"index": 1, "name": "gain"}, "values": None}],
)  # fmt: skip


@pytest.mark.verifies("SWR-TAB-013", technique="error_guessing", polarity="violation")
def test_rows_that_point_nowhere_are_shown_with_a_question_mark(tmp_path: Path) -> None:
    lines = read_lines(tmp_path, BROKEN)

    assert "planner.setpoint drive.setpoint later window work ?" in lines
    assert section(lines, "4 modes, first idle, safe halt")[-2:] == ["? x - - -", "(configuration set) - fsat (?) slow -"]
    assert section(lines, "transitions")[1] == "? 9 nowhere (?)"
    assert section(lines, "parameters")[1] == "?.? ? ?"
    assert section(lines, "configuration sets")[1:] == ["? ? ?", "slow ?.speed ?", "slow drive.gain ?"]


@pytest.mark.verifies("SWR-TAB-008", technique="error_guessing", polarity="violation")
def test_constraint_that_is_not_in_the_notation_is_rejected_with_its_column(tmp_path: Path) -> None:
    path = write(tmp_path, changed(parameters__1__constraint="1<=x<=40a"))

    with pytest.raises(InputError, match=r"parameters\[1\]\.constraint is '1<=x<=40a': nothing or a comma is expected here \(column 9\)"):
        read_table(path)


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-013", technique="error_guessing", polarity="violation")
def test_picture_draws_what_is_no_mode_as_a_box_of_its_own(tmp_path: Path) -> None:
    texts = texts_of(draw_modes(tmp_path, BROKEN))
    assert {"?", "nowhere (?)", "9", "set fsat (?)"} <= set(texts)


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-013", technique="error_guessing", polarity="violation")
def test_names_of_modes_stay_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    odd = 'a"]; <b>&\\n{|}\x1b[31m\ud800'
    seen = odd.replace("\x1b", "\ufffd").replace("\ud800", "\ufffd")
    table = changed(modes__1__name=odd, transitions__0__event_name=odd)
    assert {seen} <= set(texts_of(draw_modes(tmp_path, table)))

    assert main(["table", str(tmp_path / "table.json")]) == 0
    out = capsys.readouterr().out
    assert seen in out
    assert "\x1b" not in out


@pytest.mark.verifies("SWR-TAB-013", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ({**ROBOT, "schema": "mamori.table/1"}, "has the schema 'mamori.table/1', this command reads 'mamori.table/5'; use a command"),
        ({**ROBOT, "schema": "mamori.table/6"}, "has the schema 'mamori.table/6', this command reads 'mamori.table/5'; use a command"),
        ({**ROBOT, "schema": 2}, "schema must be a text"),
        (changed(modes__0="idle"), "modes[0] must be an object"),
        (changed(modes__0__safe=0), "modes[0].safe must be true or false"),
        (changed(modes__0__components=[5]), "modes[0].components[0] is 5, beyond the 5 rows"),
        (changed(modes__0__components=None), "modes[0].components must be a list"),
        (changed(modes__1__set={"index": 2, "name": "fast"}), "modes[1].set.index is 2, beyond the 2 rows"),
        (changed(modes__1__set="fast"), "modes[1].set must be an object"),
        (changed(transitions__0__event=-1), "transitions[0].event must not be negative"),
        (changed(transitions__0__to={"index": -1, "name": "a"}), "transitions[0].to.index is -1, beyond the 4 rows"),
        (changed(transitions__0__from={"index": 0}), "transitions[0].from has no 'name'"),
        (changed(connections__0__modes=[None]), "connections[0].modes[0] must be an integer"),
        (changed(connections__0__modes=[4]), "connections[0].modes[0] is 4, beyond the 4 rows"),
        (changed(connections__0__only_in="work"), "connections[0].only_in must be a list"),
        (changed(parameters__0__type="reel"), "parameters[0].type is 'reel'; nearest: real"),
        (changed(parameters__0__values=["1"]), "parameters[0].values[0] must be a number or null"),
        (changed(parameters__0__values=[True]), "parameters[0].values[0] must be a number or null"),
        (changed(parameters__0__values=[2**64]), "parameters[0].values[0] must be an integer of 64 bits"),
        (changed(configuration_sets__0__assignments={}), "configuration_sets[0].assignments must be a list"),
        (changed(configuration_sets__0__assignments=[{}]), "configuration_sets[0].assignments[0] has no 'parameter'"),
    ],
)  # fmt: skip
def test_broken_modes_are_answered_with_one_line(
    tmp_path: Path, table: dict[str, Any], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path, table)

    assert main(["table", str(path), "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr()
    assert sentence in said.err
    assert str(path) in said.err
    assert said.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def find_blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@pytest.mark.verifies("SWR-TAB-014")
def test_page_shows_what_the_command_prints() -> None:
    text = make_text(read_table(STORED))

    assert len(find_blocks("text")) == 3
    assert [block for block in find_blocks("text") if block not in text] == []
