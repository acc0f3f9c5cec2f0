# SPDX-License-Identifier: Apache-2.0
"""Writes a plan as Doorstop and TRLC."""

from __future__ import annotations

import json

from faulty.page import Pages
from faulty.plan import Plan
from faulty.sources import write_environment, write_results, write_sources

_PREFIXES = ("STK", "SYS", "SWR")
_KINDS = ("Need", "System_Requirement", "Software_Requirement")


def make_doorstop_id(level: int, number: int) -> str:
    return f"{_PREFIXES[level]}{number:03}"


def write_doorstop(plan: Plan, pages: Pages) -> None:
    for level, prefix in enumerate(_PREFIXES):
        file = f"docs/{prefix.lower()}/.doorstop.yml"
        parent = f"\n  parent: {_PREFIXES[level - 1]}" if level else ""
        for line in f"settings:\n  digits: 3{parent}\n  prefix: {prefix}\n  sep: ''".splitlines():
            pages.add(file, line)
    for each in plan.requirements:
        file = f"docs/{_PREFIXES[each.level].lower()}/{each.id}.yml"
        pages.files.pop(file, None)
        pages.add(file, f"active: {'false' if each.status == 'retired' else 'true'}", (each.id, "item"))
        pages.add(file, "derived: false")
        pages.add(file, f"header: {each.title}")
        pages.add(file, "level: 1.0")
        pages.add(file, "links:" if each.parents else "links: []")
        for number, parent in enumerate(each.parents):
            pages.add(file, f"- {parent}: null", *([(each.id, "Parents")] if number == 0 else []))
        pages.add(file, "normative: true")
        pages.add(file, f"sil: '{each.sil}'", (each.id, "SIL"))
        if each.verify != "test":
            pages.add(file, f"verify: {each.verify}", (each.id, "Verify"))
        if each.polarity != "nominal":
            pages.add(file, f"polarity: {each.polarity}", (each.id, "Polarity"))
        pages.add(file, f"text: {json.dumps(each.statement)}", (each.id, "statement"))
    write_sources(plan, pages, "// @satisfies {}", "// @verifies {}")
    write_results(plan, pages, "results", lambda test: {"requirement": test.result_requirement} if test.result_requirement else {})
    write_environment(plan, pages, "results")


def make_trlc_id(level: int, number: int) -> str:
    return f"Arm.{_PREFIXES[level].lower()}_{number:03}"


def write_trlc(plan: Plan, pages: Pages) -> None:
    model = ["package Arm", "", "enum Sil { QM S1 S2 S3 high }", ""]
    for level, kind in enumerate(_KINDS):
        model += [f"type {kind} {{", "  summary String", "  description optional String", "  sil String", "  status String",
                  "  verify optional String", "  polarity optional String", "  parents optional Requirement [0 .. *]" if level else "", "}", ""]  # fmt: skip
    for line in "\n".join(model).replace("type Need", "abstract type Requirement {\n}\n\ntype Need extends Requirement").replace(
        "type System_Requirement", "type System_Requirement extends Requirement"
    ).replace("type Software_Requirement", "type Software_Requirement extends Requirement").splitlines():
        pages.add("docs/arm.rsl", line)
    file = "docs/arm.trlc"
    pages.add(file, "package Arm")
    for each in plan.requirements:
        pages.add(file, "")
        pages.add(file, f"{_KINDS[each.level]} {each.id.partition('.')[2]} {{", (each.id, "item"))
        pages.add(file, f'  summary = "{each.title}"')
        if each.statement:
            pages.add(file, f'  description = "{each.statement}"', (each.id, "statement"))
        pages.add(file, f'  sil = "{each.sil}"', (each.id, "SIL"))
        pages.add(file, f'  status = "{each.status}"')
        if each.verify != "test":
            pages.add(file, f'  verify = "{each.verify}"', (each.id, "Verify"))
        if each.polarity != "nominal":
            pages.add(file, f'  polarity = "{each.polarity}"', (each.id, "Polarity"))
        if each.parents:
            names = ", ".join(parent.partition(".")[2] for parent in each.parents)
            pages.add(file, f"  parents = [{names}]", (each.id, "Parents"))
        pages.add(file, "}")
    write_sources(plan, pages, "// lobster-trace: {}", "// lobster-trace: {}")
    write_results(plan, pages, "results", lambda test: {"requirement": test.result_requirement} if test.result_requirement else {})
    write_environment(plan, pages, "results")
