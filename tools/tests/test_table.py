# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori table` shows the JSON of a table as text and pictures, and rejects an invalid file in one line.
# Method: the command in this process, on handwritten tables; pictures are parsed as XML and their boxes compared.
from __future__ import annotations

import copy
import json
import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from mamori_tools.command.main import main
from mamori_tools.table.document import read_table
from mamori_tools.table.graph import make_dot
from mamori_tools.table.svg import calc_width, shorten
from mamori_tools.table.words import format_time

SVG = "{http://www.w3.org/2000/svg}"
US, MS = 1_000, 1_000_000
needs_graphviz = pytest.mark.skipif(shutil.which("dot") is None, reason="graphviz is not installed")


def window(name: str, core: int, offset: int, length: int, period: int, budget: int, **more: object) -> dict[str, object]:
    return {"name": name, "core": core, "background_of": None, "partition": "", "kind": "periodic", "offset_ns": offset, "length_ns": length,
            "period_ns": period, "budget_ns": budget, "rate_hz": None, "slower_periods_ns": [], "events_per_cycle": None, **more}  # fmt: skip


def component(name: str, index: int, worst_case: int | None = None) -> dict[str, object]:
    return {"name": name, "window": index, "worst_case_ns": worst_case,
            "ports": [{"name": "in", "direction": "in", "mandatory": True, "payload_bytes": 8}]}  # fmt: skip


def connection(source: int, out: str, sink: int, into: str, way: str, fresh: int | None = None) -> dict[str, object]:
    return {"from": {"component": source, "port": out}, "to": {"component": sink, "port": into}, "way": way, "fresh_within_ns": fresh,
            "only_in": None, "modes": []}  # fmt: skip


TABLE: dict[str, object] = {
    "schema": "mamori.table/5", "frame_ns": 10 * MS, "abort_policy": "spec_only",
    "windows": [window("sense", 0, 0, 200 * US, MS, 150 * US, rate_hz=1000.0, slower_periods_ns=[2 * MS]),
                window("plan", 1, 1200 * US, 7 * MS, 10 * MS, 6 * MS, partition="open"),
                window("log", 1, 9 * MS, 500 * US, 10 * MS, 300 * US, kind="event_driven", events_per_cycle=3)],
    "components": [component("encoder", 0), component("monitor", 0, 40 * US), component("planner", 1), component("logger", 2)],
    "connections": [connection(0, "joints", 1, "joints", "same_window", 2 * MS), connection(1, "state", 2, "state", "crossing"),
                    connection(1, "state", 3, "records", "queue"), connection(2, "path", 3, "path", "later_window"),
                    connection(1, "trend", 0, "hint", "next_frame")],
    "faults": [{"number": 0, "name": "Overspeed"}, {"number": 1, "name": "TrackingLost"}],
    "reactions": [{"fault": 0, "reaction": "Ss1", "within_ns": 20 * MS, "modes": []}],
    "safety": None, "modes": [], "transitions": [], "parameters": [], "configuration_sets": [],
    "findings": [],
}  # fmt: skip


def write(folder: Path, **changes: object) -> Path:
    path = folder / "table.json"
    path.write_text(json.dumps({**TABLE, **changes}), encoding="utf-8")
    return path


def table(*words: object) -> int:
    return main(["table", *map(str, words)])


@pytest.mark.verifies("SWR-TAB-004")
def test_text_shows_windows_connections_and_reactions(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert table(write(tmp_path)) == 0

    said = capsys.readouterr()
    lines = [" ".join(line.split()) for line in said.out.splitlines()]
    assert lines[0] == "frame 10 ms, 2 cores, 3 windows, 4 components, 5 connections"
    assert "core 0, budgets take 15.0 %" in lines
    assert "sense 0 ns 200 µs 1 ms 150 µs 1000 (500) Hz periodic encoder, monitor (40 µs)" in lines
    assert "plan 1.2 ms 7 ms 10 ms 6 ms periodic open planner" in lines
    assert "log 9 ms 500 µs 10 ms 300 µs 3 events logger" in lines
    assert "encoder.joints monitor.joints same window 2 ms" in lines
    assert "monitor.state logger.records queue" in lines
    assert "Overspeed Ss1 20 ms" in lines
    assert "TrackingLost none" in lines
    assert lines[-1] == "the table keeps every rule"
    assert "\x1b" not in said.out


@pytest.mark.verifies("SWR-TAB-004")
def test_background_windows_follow_the_ordinary_windows_of_their_core(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    windows = [window("plan", 2, 0, 9 * MS, 10 * MS, 2 * MS, background_of=0), window("act", 1, 0, MS, MS, MS), window("sense", 0, 0, MS, MS, MS)]
    path = write(tmp_path, windows=windows, components=[], connections=[])

    assert table(path) == 0

    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("frame 10 ms, 2 cores, 3 windows")
    heads = [line for line in lines if "budgets take" in line]
    assert heads == ["core 0, budgets take 100.0 %", "background of core 0, budgets take 20.0 %", "core 1, budgets take 100.0 %"]


@pytest.mark.verifies("SWR-KRN-096")
def test_a_system_window_is_marked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, windows=[window("notice", 0, 0, MS, MS, MS, kind="system")], components=[component("send", 0)], connections=[])

    assert table(path) == 0
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert table(path, "--svg-time-line", tmp_path / "a.svg") == 0

    assert "notice 0 ns 1 ms 1 ms 1 ms system send" in lines
    assert "notice" in (tmp_path / "a.svg").read_text(encoding="utf-8")


@pytest.mark.verifies("SWR-TAB-004", technique="fault_injection", polarity="violation")
def test_every_finding_is_printed_and_the_status_tells(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert table(write(tmp_path, findings=["window 'a': too long", "fault 1 has no reaction"]), "--text") == 1

    out = capsys.readouterr().out
    assert "the table breaks 2 rules" in out
    assert "  window 'a': too long\n  fault 1 has no reaction\n" in out


@pytest.mark.parametrize(("findings", "status"), [([], 0), (["window 'a': too long"], 1)])
@pytest.mark.verifies("SWR-CLI-047", technique="interface")
def test_json_is_the_table_and_nothing_else(findings: list[str], status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert table(write(tmp_path, findings=findings), "--json", "--svg-time-line", tmp_path / "a.svg") == status

    assert json.loads(capsys.readouterr().out) == {**TABLE, "findings": findings}


@pytest.mark.verifies("SWR-TAB-004", technique="error_guessing", polarity="violation")
def test_names_do_not_steer_the_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    windows = copy.deepcopy(TABLE["windows"])
    windows[0]["name"] = "a\x1b[31m[bold]b\n"  # type: ignore[index]
    assert table(write(tmp_path, windows=windows)) == 0
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert "a\ufffd[31m[bold]b\ufffd" in out


@pytest.mark.verifies("SWR-TAB-004", technique="boundary_values")
def test_empty_table_is_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    empty: dict[str, object] = {key: [] for key, value in TABLE.items() if isinstance(value, list)}
    assert table(write(tmp_path, frame_ns=1, **empty), "--text", "--svg-time-line", tmp_path / "t.svg") == 0
    assert "0 windows" in capsys.readouterr().out
    ElementTree.parse(tmp_path / "t.svg")


@pytest.mark.verifies("SWR-TAB-004", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize("frame_ns", [0, -1, -(2**63)])
def test_frame_that_is_not_positive_is_shown_with_its_finding_and_status_1(
    tmp_path: Path, frame_ns: int, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path, frame_ns=frame_ns, findings=[f"the major frame of {frame_ns} ns is not positive"])
    assert table(path, "--text", "--svg-time-line", tmp_path / "t.svg") == 1
    assert "is not positive" in capsys.readouterr().out
    ElementTree.parse(tmp_path / "t.svg")


@pytest.mark.verifies("SWR-TAB-004", technique="boundary_values")
def test_times_keep_all_their_digits() -> None:
    times = [0, 1, 999, 1000, 1_500, 1_000_001, 10**9, -2_500_000]
    assert [format_time(time) for time in times] == ["0 ns", "1 ns", "999 ns", "1 µs", "1.5 µs", "1.000001 ms", "1 s", "-2.5 ms"]


@pytest.mark.verifies("SWR-TAB-005")
def test_time_line_has_a_box_for_each_opening_at_its_place(tmp_path: Path) -> None:
    assert table(write(tmp_path), "--svg-time-line", tmp_path / "t.svg") == 0

    root = ElementTree.parse(tmp_path / "t.svg").getroot()
    boxes = [box for box in root.iter(f"{SVG}rect") if (box.findtext(f"{SVG}title") or "").startswith("sense:")]
    widths = sorted({float(box.get("width", "0")) for box in boxes})
    assert len(boxes) == 10 * 2 * 2  # window instances x (window, budget) x (lane, row)
    assert widths == [15.0, 20.0]  # 1000 px are 10 ms
    lefts = sorted({float(box.get("x", "0")) for box in boxes})
    assert [round(left - lefts[0]) for left in lefts] == [100 * place for place in range(10)]
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert {"core 0", "core 1", "sense", "plan", "log", "time in the frame [ms]", "budget"} <= set(texts)


@pytest.mark.verifies("SWR-TAB-005", technique="boundary_values")
def test_time_line_stays_inside_and_small_for_any_times(tmp_path: Path) -> None:
    windows = [window("fast", 0, 0, 1, 10, 1), window("beyond", 1, 9 * MS, 5 * MS, 10 * MS, 5 * MS),
               window("none", 2, -5, 0, 0, 0), window("x" * 500, 3, 0, 1, 10 * MS, 1)]  # fmt: skip
    path = write(tmp_path, windows=windows, findings=["window 'none': row 2 needs a positive period"])
    assert table(path, "--svg-time-line", tmp_path / "t.svg") == 1

    root = ElementTree.parse(tmp_path / "t.svg").getroot()
    width = float(root.get("width", "0"))
    assert all(float(box.get("x", "0")) + float(box.get("width", "0")) <= width for box in root.iter(f"{SVG}rect"))
    texts = [text.text or "" for text in root.iter(f"{SVG}text")]
    assert "1000000 openings, every 10 ns" in texts
    assert max(map(len, texts)) < 100
    assert (tmp_path / "t.svg").stat().st_size < 20_000


@pytest.mark.verifies("SWR-TAB-005")
def test_long_name_keeps_both_ends_and_fits() -> None:
    short = shorten("left_arm_joint_position_controller_a", 100)
    assert calc_width(short) <= 100
    assert short.startswith("left")
    assert short.endswith("_a")
    assert shorten("name", 1) == ""


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-006")
def test_graph_shows_components_in_their_windows_and_ports_on_edges(tmp_path: Path) -> None:
    assert table(write(tmp_path), "--svg-graph", tmp_path / "g.svg") == 0

    texts = {text.text for text in ElementTree.parse(tmp_path / "g.svg").getroot().iter(f"{SVG}text")}
    assert {"encoder", "planner", "core 0", "core 1", "partition open", "sense, every 1 ms", "joints", "state → records"} <= texts


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-006", technique="boundary_values")
def test_graph_of_a_hundred_components_has_no_two_boxes_in_one_place(tmp_path: Path) -> None:
    windows = [window(f"window_{index}", index % 4, index // 4 * 130 * US, 120 * US, MS, 90 * US) for index in range(25)]
    components = [component(f"component_{index}_of_the_left_arm", index // 4) for index in range(100)]
    ways = {True: "same_window", False: "crossing"}
    links = [connection(index - 1, f"out_{index}", index, f"in_{index}", ways[index % 4 != 0]) for index in range(1, 100)]
    assert table(write(tmp_path, windows=windows, components=components, connections=links), "--svg-graph", tmp_path / "g.svg") == 0

    places = [group.find(f"{SVG}g/{SVG}a/{SVG}text") for group in ElementTree.parse(tmp_path / "g.svg").getroot().iter(f"{SVG}g")
              if group.get("class") == "node"]  # fmt: skip
    spots = sorted((float(text.get("x", "0")), float(text.get("y", "0"))) for text in places if text is not None)
    assert len(spots) == 100
    assert all(abs(a[0] - b[0]) >= 150 or abs(a[1] - b[1]) >= 20 for number, a in enumerate(spots) for b in spots[number + 1 :])


def _find_span(group: ElementTree.Element, shape: str, key: str) -> tuple[float, float]:
    """The minimum and the maximum x of the shape."""
    drawn = next(group.iter(f"{SVG}{shape}")).get(key, "")
    places = [float(pair.split(",")[0]) for pair in drawn.replace("M", "").replace("C", " ").split()]
    return min(places), max(places)


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-006", technique="error_guessing")
@pytest.mark.parametrize("column", [0, 1])
def test_connection_past_a_component_stays_in_the_box_of_its_window(tmp_path: Path, column: int) -> None:
    windows = [window("first", 0, 0, 200 * US, MS, 150 * US), window("second", 0, 300 * US, 200 * US, MS, 150 * US)]
    components = [component("other", 1 - column), *(component(name, column) for name in ("reader", "monitor", "supervisor"))]
    links = [connection(1, "reading", 2, "reading", "same_window"), connection(2, "state", 3, "arm_state", "same_window"),
             connection(1, "reading", 3, "reading", "same_window")]  # fmt: skip
    assert table(write(tmp_path, windows=windows, components=components, connections=links, reactions=[]), "--svg-graph", tmp_path / "g.svg") == 0

    groups = list(ElementTree.parse(tmp_path / "g.svg").getroot().iter(f"{SVG}g"))
    box = _find_span(next(group for group in groups if group.findtext(f"{SVG}title") == f"cluster_window_{column}"), "polygon", "points")
    edges = [_find_span(group, "path", "d") for group in groups if group.get("class") == "edge" and group.find(f".//{SVG}path") is not None]
    assert len(edges) == 3
    assert all(box[0] < left and right < box[1] for left, right in edges)


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-006", technique="error_guessing", polarity="violation")
def test_names_with_the_letters_of_the_graph_language_stay_names(tmp_path: Path) -> None:
    odd = 'a"]; <b>&\\n{|}\x07'
    components = [component(odd, 0), *copy.deepcopy(TABLE["components"])[1:]]  # type: ignore[index]
    assert table(write(tmp_path, components=components), "--svg-graph", tmp_path / "g.svg") == 0
    texts = {text.text for text in ElementTree.parse(tmp_path / "g.svg").getroot().iter(f"{SVG}text")}
    assert odd.replace("\x07", "\ufffd") in texts


@pytest.mark.verifies("SWR-TAB-006", technique="equivalence_classes")
def test_connection_with_an_unknown_end_is_left_to_the_findings(tmp_path: Path) -> None:
    links = copy.deepcopy(TABLE["connections"])
    links[0]["from"]["component"] = None  # type: ignore[index]
    assert 'label="joints"' in make_dot(read_table(write(tmp_path)))
    assert 'label="joints"' not in make_dot(read_table(write(tmp_path, connections=links)))


@pytest.mark.verifies("SWR-TAB-006", technique="fault_injection", polarity="violation")
def test_missing_graphviz_is_named_and_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert table(write(tmp_path), "--out", tmp_path / "out") == 2
    assert "apt-get install graphviz" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@needs_graphviz
@pytest.mark.verifies("SWR-TAB-007")
def test_folder_gets_all_five_files_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert table(write(tmp_path), "--out", tmp_path / "a" / "b") == 0
    assert sorted(path.name for path in (tmp_path / "a" / "b").iterdir()) == ["graph.svg", "modes.svg", "table.md", "table.txt", "time_line.svg"]
    assert capsys.readouterr().out == ""


@pytest.mark.verifies("SWR-TAB-007", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize(
    "words", [("--svg-time-line", "table.json"), ("--svg-time-line", "a.svg", "--svg-graph", "a.svg"), ("--out", "table.json")]
)
def test_input_and_outputs_never_share_a_file(
    tmp_path: Path, words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    before = write(tmp_path).read_bytes()
    monkeypatch.chdir(tmp_path)
    assert table("table.json", *words) == 2
    assert (tmp_path / "table.json").read_bytes() == before
    assert capsys.readouterr().err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["table.json"]


def without(key: str) -> str:
    return json.dumps({name: value for name, value in TABLE.items() if name != key})


def changed(key: str, value: object) -> str:
    return json.dumps({**TABLE, key: value})


@pytest.mark.verifies("SWR-TAB-008", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "table is empty"),
        ("hello", "is no whole JSON document"),
        (json.dumps(TABLE)[:-200], "is no whole JSON document"),
        ("[" * 100_000, "is no whole JSON document"),
        ("[]", "the table must be an object"),
        ("{}", "the table has no 'schema'"),
        (changed("schema", "mamori.log/1"), "has the schema 'mamori.log/1', this command reads 'mamori.table/5'"),
        (changed("frame_ns", True), "frame_ns must be an integer"),
        (changed("frame_ns", 10**30), "frame_ns must be an integer of 64 bits"),
        (changed("frame_ns", 0), "frame_ns is 0, must be positive, and no finding says that it is not"),
        (changed("frame_ns", -1), "frame_ns is -1, must be positive"),
        (changed("windows", [window("a", 0, 0, 1, 0, 1)] * 3), "windows[0].period_ns is 0, must be positive"),
        (changed("windows", [window("a", 0, 0, -1, 1, 1)] * 3), "windows[0].length_ns is -1, must be positive"),
        (changed("windows", [window("a", 0, 0, 1, 1, 0)] * 3), "windows[0].budget_ns is 0, must be positive"),
        (changed("reactions", [{"fault": 0, "reaction": "Ss1", "within_ns": 0, "modes": []}]), "reactions[0].within_ns is 0, must be positive"),
        (changed("windows", {}), "windows must be a list"),
        (changed("windows", [{"name": "a"}]), "windows[0] has no 'core'"),
        (changed("windows", [{**window("a", -1, 0, 1, 1, 1)}]), "windows[0].core must not be negative"),
        (changed("windows", [{**window("a", 0, 0, 1, 1, 1), "rate_hz": "fast"}]), "windows[0].rate_hz must be a number or null"),
        (changed("windows", [{**window("a", 0, 0, 1, 1, 1), "rate_hz": 10**400}]), "windows[0].rate_hz is greater than any number"),
        (changed("components", [component("a", 9)]), "components[0].window is 9, beyond the 3 rows"),
        (changed("connections", [connection(0, "a", 1, "b", "queeu")]), "connections[0].way is 'queeu'; nearest: queue"),
        (changed("findings", [1]), "findings[0] must be a text"),
        (changed("frame_ns", float("nan")), "NaN is no JSON number"),
        *((without(key), f"the table has no '{key}'") for key in TABLE if key != "schema"),
    ],
)  # fmt: skip
def test_broken_file_is_answered_with_one_line(tmp_path: Path, text: str, sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "table.json"
    path.write_text(text, encoding="utf-8")

    assert table(path, "--out", tmp_path / "out") == 2
    said = capsys.readouterr()
    assert sentence in said.err
    assert str(path) in said.err
    assert said.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.verifies("SWR-TAB-008")
def test_whole_file_of_the_schema_is_read(tmp_path: Path) -> None:
    read = read_table(write(tmp_path))
    assert [row.name for row in read.windows] == ["sense", "plan", "log"]
    assert read.components[1].worst_case_ns == 40 * US
    assert read.connections[0].fresh_within_ns == 2 * MS
