# SPDX-License-Identifier: Apache-2.0
"""Steps that several commands share, and the step tables of `demo`, `build` and `verify`.

@satisfies SWR-CLI-006, SWR-CLI-012      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

from mamori_tools.host.project import RELEASE, ROOT, Project
from mamori_tools.host.project_run import run_project_tests
from mamori_tools.host.records import record_evidence
from mamori_tools.host.steps import Action, Step, Tier

PYTHON = ("{python}", "-P", "-m")
COMMAND = (*PYTHON, "mamori_tools.command")

BUILD = f"build {RELEASE}"
INSTALL = "install the package"
BUILD_USER = "build the project"
REPORT = "report"
TIMING_CYCLES = "2000"
EXAMPLE_TARGET = "safe_arm"


def build_step(preset: str, tier: Tier = Tier.QUICK, targets: tuple[str, ...] = ("all",)) -> Step:
    """Mamori itself, or only its `targets` and their dependencies."""
    return Step(
        name=f"build {preset}",
        commands=(
            ("cmake", "-S", str(ROOT), "--preset", preset),
            ("cmake", "--build", str(Project(ROOT, preset).build), "--parallel", "{jobs}", "--target", *targets),
        ),
        tier=tier,
    )


def trace_steps(*options: str) -> tuple[Step, ...]:
    """Records, trace check and report: the end of every plan. `--quick` omits the report. The report is also written after a failure."""
    return (
        Step(name="evidence records", function=record_evidence, tier=Tier.QUICK),
        Step(
            name="trace check",
            commands=((*COMMAND, "trace", "check", "--no-cache", "--root", "{root}", *options),),
            tier=Tier.QUICK,
        ),
        Step(
            name=REPORT,
            commands=((*COMMAND, "trace", "report", "--root", "{root}", *options),),
            produces="report/index.html",
            accepted=(0, 1),  # 1 means findings, which the check above has evaluated
        ),
    )


def campaign_step(campaign: Action) -> Step:
    return Step(name="fault campaign", function=campaign, needs=(BUILD,), tier=Tier.QUICK)


def timing_step() -> Step:
    """A short real-time run for the report. Its findings fail nothing, because a shared host causes lateness and may deny privileges. Only
    a missing result is a failure."""
    return Step(
        name="timing run",
        commands=((*COMMAND, "timing", "examples/safe_arm", "--cycles", TIMING_CYCLES, "--jobs", "{jobs}"),),
        needs=(BUILD,),
        produces=f"build/{RELEASE}/evidence/timing/safe_arm/timing.json",
        accepted=(0, 1, 4),  # 1 means findings, 4 denied privileges; the report contains both
    )


def demo_plan(campaign: Action) -> tuple[Step, ...]:
    """The example arm: builds only its program and runs no test. Results of other plans may be missing."""
    return (
        build_step(RELEASE, targets=(EXAMPLE_TARGET,)),
        campaign_step(campaign),
        timing_step(),
        *trace_steps("--allow-missing"),
    )


def find_not_run(plan: tuple[Step, ...], whole: tuple[Step, ...]) -> list[str]:
    """Names of the steps of `whole` that are not in `plan`, in order."""
    names = {step.name for step in plan}
    return [step.name for step in whole if step.name not in names]


def build_plan(project: Project, target: str = "all") -> tuple[Step, ...]:
    """`project` is Mamori itself, or a user project, whose `target` is built against the installed package."""
    if project.root == ROOT:
        return (build_step(project.preset),)
    shipped = build_step(project.preset, targets=("mamori_package",))
    prefix = str(ROOT / "build" / "install")
    return (
        shipped,
        Step(
            name=INSTALL,
            commands=(("cmake", "--install", str(Project(ROOT, project.preset).build), "--prefix", prefix),),
            needs=(shipped.name,),
        ),
        Step(
            name=BUILD_USER,
            commands=(
                ("cmake", "-S", "{root}", "-B", "{build}", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
                 "-DCMAKE_BUILD_TYPE=Release"),
                ("cmake", "--build", "{build}", "--target", target, "--parallel", "{jobs}"),
            ),
            needs=(INSTALL,),
        ),
    )  # fmt: skip


def verify_plan(project: Project) -> tuple[Step, ...]:
    """A user project."""
    tests = Step(name="tests of the project", function=run_project_tests, needs=(BUILD_USER,))
    return (*build_plan(project), tests, *trace_steps())
