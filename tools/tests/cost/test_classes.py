# SPDX-License-Identifier: Apache-2.0
# Goal: input classes are read correctly, and an invalid description is rejected in one line. Method: written descriptions.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.cost.classes import COUNTED_MAX, CYCLES_MAX, CostPlan, choose, read_plan
from mamori_tools.host.project import ROOT, Project
from mamori_tools.timing.system import find_system
from mamori_trace.base.errors import InputError

PROGRAM = 'program = "a"\ntarget = "b"\n'
CLASS = '[[cost.class]]\nname = "still"\ncycles = 100\n'
WHOLE = f"{PROGRAM}[cost]\nmargin_percent = 20\n{CLASS}"


def read(folder: Path, text: str) -> CostPlan:
    (folder / "timing.toml").write_text(text, encoding="utf-8")
    (folder / "CMakeLists.txt").write_text("find_package(mamori)\n", encoding="utf-8")
    project = Project(ROOT)
    return read_plan(find_system(str(folder), project, "cost"), project)


@pytest.mark.verifies("SWR-TIM-031")
def test_classes_are_read_as_they_are_declared(tmp_path: Path) -> None:
    plan = read(tmp_path, f'{WHOLE}every = 3\nfirst = 99\narguments = ["--motion", "{{root}}/m.txt"]\n[[cost.class]]\nname = "other"\ncycles = 1\n')

    assert (plan.margin_percent, plan.growth_percent) == (20.0, 2.0)
    still, other = plan.classes
    assert (still.name, still.cycles, still.first, still.every) == ("still", 100, 99, 3)
    assert still.arguments == ("--motion", "{root}/m.txt")
    assert still.words == ("--motion", f"{ROOT}/m.txt")
    assert (other.first, other.every, other.words) == (0, 1, ())


@pytest.mark.verifies("SWR-TIM-031")
def test_example_is_in_order_and_bounded() -> None:
    project = Project(ROOT)
    plan = read_plan(find_system("examples/safe_arm", project, "cost"), project)

    assert [one.name for one in plan.classes] == ["still", "motion", "encoder_fault", "message_lost"]
    assert all(Path(word).is_file() for one in plan.classes for word in one.words if word.startswith("/"))


@pytest.mark.parametrize(("text", "complaint"), [
    (PROGRAM, "has no [cost]"),
    (f"cost = 3\n{PROGRAM}", "'cost' must be a table"),
    (f"{PROGRAM}[cost]\nmargin_percent = 20\n", "no [[cost.class]]"),
    (f"{PROGRAM}[cost]\nmargin_percent = 20\nclass = [1]\n", "no [[cost.class]]"),
    (f"{PROGRAM}[cost]\n{CLASS}", "no margin_percent"),
    (WHOLE.replace("20", "-1"), "'margin_percent' must be a number of 0 .. 1000"),
    (WHOLE.replace("20", "nan"), "'margin_percent' must be a number"),
    (WHOLE.replace("20", "true"), "'margin_percent' must be a number"),
    (WHOLE.replace("[[", "growth_percent = 'x'\n[["), "'growth_percent' must be a number"),
    (WHOLE.replace("margin_percent = 20", "margin_percent = 20\nmargn = 1"), "unknown key 'margn'; nearest: margin_percent"),
    (WHOLE.replace('"still"', '"a b"'), "no name of 1 to 40 letters"),
    (WHOLE.replace('name = "still"\n', ""), "no name of 1 to 40 letters"),
    (WHOLE + "cycle = 3\n", "class 'still' has an unknown key 'cycle'; nearest: cycles"),
    (WHOLE.replace("cycles = 100\n", ""), "'cycles' must be an integer"),
    (WHOLE.replace("= 100", "= 0"), f"'cycles' must be an integer of 1 .. {CYCLES_MAX}"),
    (WHOLE.replace("= 100", f"= {CYCLES_MAX + 1}"), "'cycles' must be an integer"),
    (WHOLE.replace("= 100", "= 1.5"), "'cycles' must be an integer"),
    (WHOLE + "first = 100\n", "'first' must be an integer of 0 .. 99"),
    (WHOLE + "every = 0\n", "'every' must be an integer of 1"),
    (WHOLE.replace("= 100", f"= {COUNTED_MAX + 1}"), f"would count {COUNTED_MAX + 1} cycles, at most {COUNTED_MAX}"),
    (WHOLE + 'arguments = "--x"\n', "'arguments' of class 'still' must be a list of strings"),
    (WHOLE + CLASS, "two classes of inputs have the name 'still'"),
])  # fmt: skip
@pytest.mark.verifies("SWR-TIM-031", technique="equivalence_classes", polarity="violation")
def test_description_that_is_not_in_order_is_refused_with_one_line(tmp_path: Path, text: str, complaint: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)

    assert complaint in str(caught.value)
    assert str(tmp_path / "timing.toml") in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.verifies("SWR-TIM-031", technique="boundary_values")
def test_greatest_numbers_are_taken(tmp_path: Path) -> None:
    assert read(tmp_path, WHOLE.replace("= 100", f"= {COUNTED_MAX}")).classes[0].cycles == COUNTED_MAX
    assert read(tmp_path, WHOLE.replace("= 100", f"= {CYCLES_MAX}\nevery = 50")).classes[0].every == 50


@pytest.mark.verifies("SWR-TIM-031", polarity="violation")
def test_unknown_class_is_refused_with_the_nearest_name(tmp_path: Path) -> None:
    plan = read(tmp_path, WHOLE)

    assert choose(plan, ()) == choose(plan, ("still",)) == plan.classes
    with pytest.raises(InputError, match="there is no class of inputs 'stil'; nearest: still"):
        choose(plan, ("stil",))


@pytest.mark.verifies("SWR-TIM-031", polarity="violation")
def test_program_without_a_description_has_no_classes(tmp_path: Path) -> None:
    program = tmp_path / "program"
    program.write_text("", encoding="utf-8")
    program.chmod(0o755)
    project = Project(ROOT)
    with pytest.raises(InputError, match="cost: 'program' has no input classes"):
        read_plan(find_system(str(program), project, "cost"), project)
