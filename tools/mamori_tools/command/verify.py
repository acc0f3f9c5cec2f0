# SPDX-License-Identifier: Apache-2.0
"""`./mamori build` and `./mamori verify`: Mamori itself, or a user project.

@satisfies SWR-CLI-006      Design: docs/design/launcher.md#steps
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from mamori_tools.campaign.campaign_step import CampaignRequest
from mamori_tools.campaign.campaign_table import show_campaign
from mamori_tools.command.own_plans import load_own_plans
from mamori_tools.host import plans
from mamori_tools.host.arguments import Command, add_jobs
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.host.project import RELEASE, ROOT, Project
from mamori_tools.host.session import begin, finish, show_steps
from mamori_tools.host.steps import Context, all_passed, run_steps
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names


def build(jobs: int, folder: Path | None, preset: str) -> int:
    """Builds the shipped project, then the project in `folder` against its package. @return exit status."""
    check_preset(preset)
    project = Project(check_folder(folder) if folder else ROOT, preset)
    outcomes = run_steps(plans.build_plan(project), Context(project, jobs))
    if not all_passed(outcomes):
        return EXIT_FAILED
    print(f"built: {project.build}")
    return EXIT_OK


def verify(jobs: int, folder: Path | None) -> int:
    """Tests, campaign, trace check and report of the shipped project or of the project in `folder`. @return exit status."""
    if folder is None:
        return verify_own(jobs)
    project = Project(check_folder(folder))
    if not (project.root / "requirements").is_dir():
        raise InputError(f"'{folder}' has no folder requirements/; verify judges a project by its requirements, build builds it")
    context = begin(project, jobs, (RELEASE,))
    outcomes = run_steps(plans.verify_plan(project), context)
    show_steps(outcomes, context)
    return finish(outcomes, context)


def verify_own(jobs: int) -> int:
    """Tests, campaign, trace check and report of the shipped project. @return exit status."""
    project = Project(ROOT)
    request = CampaignRequest(project.motion)
    request.check(project)
    context = begin(project, jobs, (RELEASE,))
    outcomes = run_steps(load_own_plans().list_verify_steps(request.run), context)
    show_campaign(context)
    return finish(outcomes, context)


def check_folder(folder: Path) -> Path:
    """@return the absolute path of a project folder. @raise InputError if it is not a project."""
    if not (folder / "CMakeLists.txt").is_file():
        raise InputError(f"'{folder}' has no CMakeLists.txt; give the folder of a project that calls find_package(mamori)")
    return folder.resolve()


def check_preset(preset: str) -> None:
    """@raise InputError if CMakePresets.json has no such configuration."""
    presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
    names = [entry["name"] for entry in presets if not entry.get("hidden")]
    if preset not in names:
        raise InputError(f"there is no preset '{preset}'; {nearest_names(preset, names)}")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("project", nargs="?", type=Path, metavar="PROJECT", help="folder of a project; default: Mamori itself")
    add_jobs(parser)


def add_build_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--preset", default=RELEASE, metavar="NAME", help="configuration of CMakePresets.json; default: %(default)s")
    add_arguments(parser)


BUILD = Command(
    add_build_arguments, lambda arguments: build(arguments.jobs, arguments.project, arguments.preset),
    "build Mamori, or a project of yours against the installed package",
    "Configures and builds. PROJECT is a folder with a CMakeLists.txt that calls find_package(mamori). With PROJECT, the package is first "
    "installed to build/install. PROJECT is then built against it into PROJECT/build/.")  # fmt: skip
VERIFY = Command(
    add_arguments, lambda arguments: verify(arguments.jobs, arguments.project),
    "tests, trace check and report of a project",
    "Runs tests, trace check and report of PROJECT. Without PROJECT, does this for Mamori itself and runs its fault campaign.")  # fmt: skip
