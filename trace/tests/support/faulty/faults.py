# SPDX-License-Identifier: Apache-2.0
"""The fault classes: each is one small function that seeds a fault into a plan and returns the expected finding.

To add a class: write the function, and add a row to FAULTS with the reporting rule and, for each format that cannot represent the fault,
why.
"""

from __future__ import annotations

import random
from collections.abc import Callable

from faulty.code_faults import CODE_FAULTS
from faulty.fault import Fault, Seed, pick
from faulty.judgement_faults import JUDGEMENT_FAULTS
from faulty.plan import BOTTOM, MIDDLE, TOP, Code, Plan, Requirement, Test

_OTHER_COMMIT = "fedcba9876543210fedcba9876543210fedcba98"
_NO_SIL = "the format has no word for a safety level"
_NO_ATTRIBUTE = "the format has no attributes of one's own"
_FOREIGN = ("strictdoc", "oft", "needs", "doorstop", "trlc")
_ONE_FILE = "one file per id: a second one takes its place"
_NO_DESIGN = "the format has no link to a heading of a design document"


def _tests_of(plan: Plan, requirements: list[Requirement]) -> list[Test]:
    wanted = {each.id for each in requirements}
    return [test for test in plan.tests if test.requirement in wanted]


def duplicate_id(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    plan.requirements += [Requirement(**vars(each)) for each in chosen]
    return [(each.id, each.id, ("item",)) for each in chosen]


def unknown_parent(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for number, each in enumerate(chosen):
        each.parents.insert(0, plan.make_id(MIDDLE, 901 + number))
    return [(each.parents[0], each.id, ("Parents",)) for each in chosen]


def unknown_in_code(plan: Plan, chance: random.Random) -> list[Seed]:
    unknown = [plan.make_id(BOTTOM, 901), plan.make_id(BOTTOM, 902)]
    plan.code += [Code(f"surplus_{number}", [each]) for number, each in enumerate(unknown)]
    return [(each, each, ("code",)) for each in unknown]


def unknown_in_test(plan: Plan, chance: random.Random) -> list[Seed]:
    unknown = [plan.make_id(BOTTOM, 901), plan.make_id(BOTTOM, 902)]
    plan.tests += [Test("SurplusTest", f"Surplus{number}", each) for number, each in enumerate(unknown)]
    return [(each, each, ("test",)) for each in unknown]


def unknown_in_result(plan: Plan, chance: random.Random) -> list[Seed]:
    unknown = [plan.make_id(BOTTOM, 901), plan.make_id(BOTTOM, 902)]
    plan.tests += [Test("SurplusTest", f"Surplus{number}", each, result_only=True, result_requirement=each) for number, each in enumerate(unknown)]
    return [(each, each, ("result",)) for each in unknown]


def bad_word(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.sil = "high"
    return [(each.id, each.id, ("SIL",)) for each in chosen]


def empty_statement(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.statement = ""
    return [(each.id, each.id, ("item",)) for each in chosen]


def retired_parent(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    old = Requirement(plan.make_id(MIDDLE, 801), MIDDLE, "Old", "The system shall stay old.", [plan.make_id(TOP, 1)], status="retired")
    plan.requirements.append(old)
    for each in chosen:
        each.parents.append(old.id)
    return [(each.id, each.id, ("Parents",)) for each in chosen]


def orphan(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.parents = []
    return [(each.id, each.id, ("Parents", "item")) for each in chosen]


def childless_top(plan: Plan, chance: random.Random) -> list[Seed]:
    added = [Requirement(plan.make_id(TOP, 801 + number), TOP, "Alone", "Operators shall stay alone.") for number in range(2)]
    plan.requirements += added
    return [(each.id, each.id, ("item",)) for each in added]


def childless_middle(plan: Plan, chance: random.Random) -> list[Seed]:
    parent = plan.make_id(TOP, 1)
    added = [Requirement(plan.make_id(MIDDLE, 801 + number), MIDDLE, "Alone", "The system shall stay alone.", [parent]) for number in range(2)]
    plan.requirements += added
    return [(each.id, each.id, ("Verify", "item")) for each in added]


def level_skipped(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.parents = [plan.make_id(TOP, 1)]
    return [(each.id, each.id, ("Parents",)) for each in chosen]


def cycle(plan: Plan, chance: random.Random) -> list[Seed]:
    first, second = pick(plan, chance, MIDDLE)
    first.parents.append(second.id)
    second.parents.append(first.id)
    return [(each.id, each.id, ("Parents",)) for each in (first, second)]


def sil_lower(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.sil = "1"
    return [(each.id, each.id, ("SIL",)) for each in chosen]


def no_shall(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.statement = each.statement.replace("shall report", "reports")
    return [(each.id, each.id, ("statement",)) for each in chosen]


def unfinished(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.statement = each.statement.replace("its range", "the range TBD")
    return [(each.id, each.id, ("statement",)) for each in chosen]


def design_gone(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.design = "docs/design/generated.md#gone"
    return [(each.id, each.id, ("Design",)) for each in chosen]


def no_code(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    gone = {each.id for each in chosen}
    plan.code = [code for code in plan.code if not gone & set(code.requirements)]
    return [(each.id, each.id, ("item",)) for each in chosen]


def no_test(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    gone = {each.id for each in chosen}
    plan.tests = [test for test in plan.tests if test.requirement not in gone]
    return [(each.id, each.id, ("Verify", "item")) for each in chosen]


def no_violation_test(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.polarity = "nominal, violation"
    return [(each.id, each.id, ("Polarity",)) for each in chosen]


def no_campaign(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for each in chosen:
        each.verify = "campaign"
    return [(each.id, each.id, ("Verify",)) for each in chosen]


def suspect_link(plan: Plan, chance: random.Random) -> list[Seed]:
    """A text that changed after its review. In OpenFastTrace, the revision in the id changes, and tests and code name the old revision."""
    chosen = pick(plan, chance)
    for each in chosen:
        if "~" in each.id:
            plan.revisions[each.id] = each.id.removesuffix("1") + "2"
        each.statement = each.statement.replace("leaves its range", "nears the end of its range")
    if "~" in chosen[0].id:
        return [(each.id, each.id, (part,)) for each in chosen for part in ("code", "test")]
    return [(each.id, each.id, ("Parents",)) for each in chosen]


def _set_outcome(outcome: str) -> Callable[[Plan, random.Random], list[Seed]]:
    def spoil(plan: Plan, chance: random.Random) -> list[Seed]:
        chosen = pick(plan, chance)
        for test in _tests_of(plan, chosen):
            test.outcome = outcome
        return [(each.id, each.id, ("test",)) for each in chosen]

    return spoil


def unlinked_test(plan: Plan, chance: random.Random) -> list[Seed]:
    plan.tests += [Test(f"Free{number}Test", f"Free{number}", "", result_only=True) for number in range(2)]
    return [(f"Free{number}", f"Free{number}", ("result",)) for number in range(2)]


def unknown_technique(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    for test in _tests_of(plan, chosen):
        test.technique = "guesswork"
    return [("guesswork", each.id, ("result",)) for each in chosen]


def stale(plan: Plan, chance: random.Random) -> list[Seed]:
    plan.commit = _OTHER_COMMIT
    return [(_OTHER_COMMIT[:12], "environment", ("result",))]


def results_cut_off(plan: Plan, chance: random.Random) -> list[Seed]:
    plan.broken_results = 2
    return [("whole", f"broken_{number}", ("result",)) for number in range(2)]


FAULTS = {
    "duplicate-id": Fault("duplicate-id", duplicate_id, {"doorstop": _ONE_FILE}),
    "unknown-parent": Fault("unknown-id", unknown_parent),
    "unknown-id-in-code": Fault("unknown-id", unknown_in_code),
    "unknown-id-in-test": Fault("unknown-id", unknown_in_test),
    "unknown-id-in-result": Fault("unknown-id", unknown_in_result),
    "bad-word": Fault("malformed-item", bad_word, {"oft": _NO_SIL}),
    "empty-statement": Fault("malformed-item", empty_statement),
    "retired-parent": Fault("retired-id", retired_parent),
    "orphan": Fault("parent-missing", orphan),
    "childless-top": Fault("child-missing", childless_top),
    "childless-middle": Fault("test-missing", childless_middle),
    "level-skipped": Fault("level-order", level_skipped),
    "cycle": Fault("cycle", cycle),
    "sil-lower": Fault("sil-lower", sil_lower, {"oft": _NO_SIL}),
    "no-shall": Fault("shall-count", no_shall),
    "unfinished": Fault("unfinished-text", unfinished),
    "design-gone": Fault("design-link", design_gone, dict.fromkeys(_FOREIGN, _NO_DESIGN)),
    "no-code": Fault("code-missing", no_code),
    "no-test": Fault("test-missing", no_test),
    "no-violation-test": Fault("polarity-missing", no_violation_test, {"oft": _NO_ATTRIBUTE}),
    "no-campaign": Fault("campaign-missing", no_campaign, {"oft": _NO_ATTRIBUTE}),
    "suspect-link": Fault("suspect-link", suspect_link, reviewed=True),
    "flaky": Fault("result-flaky", _set_outcome("flaky")),
    "failed": Fault("result-failed", _set_outcome("failed")),
    "crashed": Fault("result-failed", _set_outcome("error")),
    "skipped": Fault("result-skipped", _set_outcome("skipped")),
    "disabled": Fault("result-skipped", _set_outcome("disabled")),
    "not-run": Fault("result-missing", _set_outcome("")),
    "test-unlinked": Fault("test-unlinked", unlinked_test),
    "unknown-technique": Fault("unknown-word", unknown_technique),
    "stale": Fault("evidence-stale", stale, evidence=True),
    "results-cut-off": Fault("unreadable-input", results_cut_off),
    **CODE_FAULTS,
    **JUDGEMENT_FAULTS,
}
WITHOUT_FAULT = {
    "technique-unshown": "about the project's table of techniques, not about an item; seeded in tests/support/seeds",
    "refinement-missing": "off unless a pack of the project demands it; seeded in tests/support/seeds",
    "integration-missing": "off unless a pack of the project demands it; seeded in tests/support/seeds",
    "link-kind": "the generated projects have no schema of kinds; seeded in tests/support/seeds",
    "id-unrecorded": "its place is a line of the review lock, which the tool writes and sorts; seeded in tests/support/seeds",
    "evidence-altered": "seeded in test_evidence_records.py",
    "document-link": "about documents of the project itself, which no foreign format has",
    "result-flaky": "seeded in test_foreign_results.py",
    "not-verified": "speaks where no other rule does; seeded in test_demanded_results.py",
    "result-not-shown": "seeded in test_demanded_results.py",
    "result-unbound": "seeded in test_demanded_results.py and test_record.py",
    "analysis-finding": "seeded in test_analysis.py",
}
"""Rules that no class can seed, with the reason."""
