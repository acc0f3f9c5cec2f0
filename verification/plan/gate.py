# SPDX-License-Identifier: Apache-2.0
"""The verification steps of Mamori itself. A new check is a new row.

@satisfies SWR-CLI-006, SWR-CLI-012      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

from mamori_tools.host.environment import renew_environment
from mamori_tools.host.exit_status import EXIT_UNFINISHED
from mamori_tools.host.plans import BUILD, COMMAND, PYTHON, build_step, campaign_step, timing_step, trace_steps
from mamori_tools.host.project import CHECKED_LAYERS, LONG_LABEL, RELEASE, ROOT, SANITIZED, Project
from mamori_tools.host.steps import Action, Step, Tier

PYTEST = (*PYTHON, "pytest", "-q", "-p", "no:cacheprovider", "--junitxml={result}")
PARALLEL = ("-n", "{jobs}", "--dist", "worksteal")
FUZZ_S, LONG_FUZZ_S = 5, 600  # time for each harness


def ctest_step(preset: str, tier: Tier = Tier.QUICK, *options: str) -> Step:
    """@param options of ctest that select tests."""
    return Step(
        name=f"tests {preset}",
        commands=(("ctest", "--preset", preset, "--parallel", "{jobs}", "--no-tests=error", *options),),
        needs=(f"build {preset}",),
        junit=f"build/{preset}/evidence/junit",
        tier=tier,
    )


def faults_step(preset: str, tier: Tier = Tier.QUICK) -> Step:
    """A short run of each fault campaign in real time; repeated if the host disturbed it."""
    junit = f"build/{preset}/evidence/junit"
    return Step(
        name=f"faults in real time {preset}",
        commands=((*PYTHON, "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={junit}/faults.xml", "verification/faults", "--preset", preset),),
        needs=(f"build {preset}",),
        junit=junit,
        tier=tier,
    )


def race_steps() -> tuple[Step, ...]:
    """Data shared by two cores, under the thread sanitizer. Only these programs have threads."""
    preset = "host-tsan"
    targets = ("kernel_abandon_stress_test", "kernel_crossing_test", "kernel_introspection_stress_test", "kernel_mode_stress_test",
               "kernel_stimulus_stress_test", "lcm_link_test", "posix_rt_conformance_test", "posix_rt_guard_test", "posix_rt_watchdog_test",
               "supervision_log_test", "timing_test")  # fmt: skip
    build = Step(
        name=f"build {preset}",
        commands=(
            ("cmake", "-S", str(ROOT), "--preset", preset, "-DMAMORI_WITH_SIMBODY_SIM=OFF"),
            ("cmake", "--build", str(Project(ROOT, preset).build), "--parallel", "{jobs}", "--target", *targets),
        ),
    )
    run = Step(
        name=f"tests {preset}",
        commands=(("ctest", "--preset", preset, "--no-tests=error", "--tests-regex", f"^({'|'.join(targets)})$"),),
        needs=(build.name,),
        junit=f"build/{preset}/evidence/junit",
    )
    return build, run


def proof_step(name: str, file: str, needs: tuple[str, ...] = (BUILD,), tier: Tier = Tier.GATE) -> Step:
    """One proof: a pytest file of verification/proofs."""
    return Step(
        name=name,
        commands=((*PYTEST, f"verification/proofs/test_{file}.py"),),
        needs=needs,
        result=f"proof-{file}.xml",
        tier=tier,
    )


def benchmark_step() -> Step:
    """Exact counts compared with their baseline, and a short benchmark run. No test depends on times."""
    return Step(
        name="exact instruction counts",
        commands=(
            ("cmake", "--build", "{build}", "--target", "mamori_bench", "mamori_exact", "--parallel", "{jobs}"),
            (*PYTEST, "verification/proofs/test_exact_counts.py", "verification/proofs/test_benchmarks.py", "verification/proofs/test_cost.py"),
        ),
        needs=(BUILD,),
        result="proof-exact_counts.xml",
    )


def comparison_step() -> Step:
    """End-to-end protection compared with an independent implementation, on random messages."""
    return Step(
        name="comparison of end-to-end protection",
        commands=((*PYTEST, "verification/e2e/test_differential.py"),),
        needs=(BUILD,),
        result="e2e-comparison.xml",
    )


def safe_state_step() -> Step:
    """Properties of the compiled safe-state machine, proved by z3 and spin; one seeded defect for each."""
    return Step(
        name="proofs of the safe-state machine",
        commands=((*PYTEST, "verification/safe_state"),),
        needs=(BUILD,),
        result="proof-safe_state.xml",
    )


def hil_step() -> Step:
    """The arm as three processes: a motion, an error on a link, and one kill of each process. Skipped results state why this host has none."""
    return Step(
        name="hardware in the loop",
        commands=((*PYTEST, "verification/hil"),),
        needs=(BUILD,),
        result="hil.xml",
    )


HOST_TOOLS = Step(name="tests of the host tools", commands=((*PYTEST, *PARALLEL),), result="python-tools.xml")
REPORT_IN_BROWSER = Step(name="report in a browser", commands=((*PYTEST, "trace/tests/browser"),), result="report-browser.xml")
LAYERS = Step(name="layer check", commands=((*PYTHON, "verification.checks.check_layers"),), tier=Tier.QUICK)
PYTHON_CHECKS = Step(name="Python checks", commands=((*PYTHON, "verification.checks.check_python", "--root", "{root}"),), tier=Tier.QUICK)


def format_step(project: Project) -> Step:
    return Step(
        name="format check",
        commands=(("clang-format-19", "--dry-run", "--Werror", "{files}"),),
        lists={"{files}": project.cpp_sources()},
        tier=Tier.QUICK,
    )


def tidy_step() -> Step:
    layers = "|".join(CHECKED_LAYERS)
    return Step(
        name="clang-tidy",
        commands=(
            (
                "run-clang-tidy-19", "-quiet", "-use-color=0", "-j", "{jobs}", "-p", "{build}",
                f"-header-filter=.*/({layers})/(.*/)?include/.*", f".*/({layers})/(.*/)?src/.*",
            ),
        ),
        needs=(BUILD,),
    )  # fmt: skip


CPPCHECK = Step(
    name="cppcheck",
    commands=((*PYTHON, "verification.checks.check_cppcheck", "--root", "{root}", "--jobs", "{jobs}"),),
    tier=Tier.QUICK,
)


def strength_steps() -> tuple[Step, ...]:
    """Test adequacy: coverage, detected mutants, and fuzzing findings (test_strength.md)."""
    folder = "verification"
    return (
        Step(name="MC/DC of kernel, safety and ports", commands=((*PYTEST, f"{folder}/coverage/test_coverage.py"),),
             needs=(f"tests {SANITIZED}",), result="strength-coverage.xml"),
        Step(name="mutation", commands=((*PYTEST, f"{folder}/mutation"),), result="strength-mutation.xml"),
        Step(name=f"fuzz {FUZZ_S} s each", commands=((*PYTEST, f"{folder}/fuzz/test_fuzz.py"), make_fuzz_command(FUZZ_S)), result="strength-fuzz.xml"),
    )  # fmt: skip


def make_fuzz_command(seconds: int) -> tuple[str, ...]:
    return (*COMMAND, "fuzz", "--seconds", str(seconds), "--jobs", "{jobs}")


def long_steps() -> tuple[Step, ...]:
    """Steps that take hours or need an idle host. They run before a release, and their results are recorded with date and commit."""

    def campaign(kind: str, *arguments: str) -> Step:
        return Step(
            name=f"long run of {kind}_faults",
            commands=((*PYTHON, "verification.faults", kind, *arguments),),
            needs=(BUILD,),
            inconclusive=(EXIT_UNFINISHED,),
            tier=Tier.ALL,
        )

    return (
        Step(name="long tests", commands=((*PYTEST, "-m", "long", *(f"verification/{folder}" for folder in ("hil", "mutation", "proofs", "safe_state"))),),
             needs=(BUILD,), result="long-tests.xml", tier=Tier.ALL),
        Step(name=f"fuzz {LONG_FUZZ_S} s each", commands=(make_fuzz_command(LONG_FUZZ_S),), tier=Tier.ALL),
        Step(name="mutants of the example arm", commands=((*COMMAND, "mutate", "examples/safe_arm", "--sample", "400", "--jobs", "{jobs}"),),
             tier=Tier.ALL),
        Step(name="10,000 wrong controllers",
             commands=(("env", "MAMORI_CONTROLLERS=10000", "{build}/examples/safe_arm/safe_arm_controllers_test", "--gtest_filter=*NoneExceeds*"),),
             needs=(BUILD,), tier=Tier.ALL),
        campaign("time", "610000", "1000", "1", "storm"),
        campaign("partition", "1000", "1"),
        Step(name="verdicts in real time", commands=((*PYTHON, "verification.real_time", "--all"),), needs=(BUILD,), tier=Tier.ALL),
        Step(name="verdicts of the timing report", commands=((*PYTHON, "verification.real_time.timing_verdict"),), needs=(BUILD,),
             inconclusive=(EXIT_UNFINISHED,), tier=Tier.ALL),
    )


def cost_step() -> Step:
    """Instruction counts of the components of the safe arm, compared with budgets and baseline. Counts are exact, so each finding fails."""
    return Step(
        name="cost of components",
        commands=((*COMMAND, "cost", "examples/safe_arm", "--check", "examples/safe_arm/cost_baseline.toml", "--jobs", "{jobs}"),),
        needs=(BUILD,),
        produces=f"build/{RELEASE}/evidence/cost/safe_arm/cost.json",
    )


def list_verify_steps(campaign: Action) -> tuple[Step, ...]:
    """Mamori itself: tests, campaign and report."""
    return (
        build_step(RELEASE),
        ctest_step(RELEASE),
        faults_step(RELEASE),
        HOST_TOOLS,
        # Results that only `./mamori test` produces may be missing here; existing results must not be failures.
        campaign_step(campaign),
        timing_step(),
        *trace_steps("--allow-missing"),
    )


def list_test_steps(project: Project, campaign: Action, tier: Tier, mutation_minutes: int | None = None) -> tuple[Step, ...]:
    """@param mutation_minutes limit of the step that tries all mutants without a stored result; None: no limit."""
    # These tests take half of the time of all C++ tests.
    without_long = ("--label-exclude", LONG_LABEL)
    fewer = without_long if tier == Tier.QUICK else ()
    limit = () if mutation_minutes is None else ("--minutes", str(mutation_minutes))
    steps = (
        # First step, because it writes the stored rows: the inputs of all other results are recorded afterwards.
        Step(name="mutation rows", commands=((*COMMAND, "mutate", "--missing", "--store", *limit, "--jobs", "{jobs}"),),
             inconclusive=(EXIT_UNFINISHED,), function=renew_environment, tier=Tier.ALL),
        build_step(RELEASE),
        ctest_step(RELEASE, Tier.QUICK, *fewer),
        faults_step(RELEASE),
        HOST_TOOLS,
        REPORT_IN_BROWSER,
        LAYERS,
        format_step(project),
        PYTHON_CHECKS,
        tidy_step(),
        CPPCHECK,
        proof_step("symbol proof", "symbols", tier=Tier.QUICK),
        proof_step("bare-metal proof", "bare_metal", needs=()),
        proof_step("stack proof", "stack", needs=()),
        proof_step("size proof", "size", needs=()),
        proof_step("loop proof", "loops", needs=(), tier=Tier.QUICK),
        proof_step("consumer proof", "consumer"),
        proof_step("plain CMake proof", "plain_cmake"),
        proof_step("scale proof", "scale"),
        benchmark_step(),
        comparison_step(),
        safe_state_step(),
        build_step(SANITIZED, Tier.GATE),
        ctest_step(SANITIZED, Tier.GATE, *(() if tier == Tier.ALL else without_long)),
        faults_step(SANITIZED, Tier.GATE),
        *race_steps(),
        proof_step("determinism proof", "determinism", needs=(BUILD, f"build {SANITIZED}")),
        proof_step("labelled timing events", "timing_verdict"),
        *strength_steps(),
        campaign_step(campaign),
        timing_step(),
        hil_step(),
        cost_step(),
        *long_steps(),
        *trace_steps(*(("--allow-missing",) if tier == Tier.QUICK else ())),
    )
    return tuple(step for step in steps if step.tier <= tier)


