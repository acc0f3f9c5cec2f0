# SPDX-License-Identifier: Apache-2.0
# Goal: one item is shown with all items above and below it, and with its history.
from __future__ import annotations

from collections.abc import Callable

import pytest
from git_sample import commit, git, start_history
from trace_sample import Sample

SOFTWARE = "requirements/software/software.md"


@pytest.mark.verifies("SWR-TRC-081", technique="requirements_based", polarity="nominal")
def test_the_chain_leads_from_the_hazard_to_the_result(sample: Sample, trace: Callable) -> None:
    text = trace("show", "HAZ-001", "--root", sample.root).out
    content = trace("show", "HAZ-001", "--root", sample.root, "--output", "json").content

    below = text[text.index("chain below") :].splitlines()
    assert below[1] == "    SWR-SUP-001 Silent  [verified]"
    assert "    SYS-001 Supervision  [verified]" in below
    assert "      SWR-SUP-001 Silent  [verified] (see above)" in below
    assert "        passed: AliveTest.SilenceIsReported" in below
    assert "        passed: encoder_freeze-1" in below
    assert [(row["id"], row["depth"]) for row in content["below"]] == [
        ("SWR-SUP-001", 0), ("SYS-001", 0), ("SWR-SUP-002", 1), ("SYS-002", 0)]  # fmt: skip


@pytest.mark.verifies("SWR-TRC-081", technique="requirements_based", polarity="nominal")
def test_the_chain_leads_back_up(sample: Sample, trace: Callable) -> None:
    content = trace("show", "SWR-SUP-002", "--root", sample.root, "--output", "json").content

    assert [(row["id"], row["depth"], row["verdict"]) for row in content["above"]] == [
        ("SYS-001", 0, "verified"), ("STK-001", 1, "verified"), ("HAZ-001", 1, "verified")]  # fmt: skip


@pytest.mark.verifies("SWR-TRC-081", technique="error_guessing", polarity="violation")
def test_a_cycle_is_shown_and_ends(sample: Sample, trace: Callable) -> None:
    sample.replace("requirements/system/system.md", "- Parents: STK-001\n", "- Parents: STK-001, SWR-TLS-001\n")

    outcome = trace("show", "SWR-TLS-001", "--root", sample.root)

    assert outcome.status == 0
    assert "SWR-TLS-001 Offline  [" in outcome.out[outcome.out.index("chain above") :]
    assert "(see above)" in outcome.out


@pytest.mark.verifies("SWR-TRC-081", technique="requirements_based", polarity="nominal")
def test_the_history_of_an_item_follows_it_through_the_files(sample: Sample, trace: Callable) -> None:
    start_history(sample.root)
    sample.replace(SOFTWARE, "report a late entity", "report each late entity")
    commit(sample.root, "Sharpen it")
    sample.append(SOFTWARE, "\n")
    commit(sample.root, "Touch the file only")
    git(sample.root, "mv", SOFTWARE, "requirements/software/moved.md")
    last = commit(sample.root, "Move the file")

    content = trace("show", "SWR-SUP-002", "--history", "--allow-missing", "--root", sample.root, "--output", "json").content
    text = trace("show", "SWR-SUP-002", "--history", "--allow-missing", "--root", sample.root).out

    assert [(row["subject"], row["what"]) for row in content["history"]] == [("Sharpen it", "changed: statement"), ("Start", "added")]
    assert "The Maintainers: changed: statement (Sharpen it)" in text
    assert last[:12] not in text


@pytest.mark.verifies("SWR-TRC-081", technique="error_guessing", polarity="violation")
def test_a_history_that_is_not_there_is_told(sample: Sample, trace: Callable) -> None:
    nowhere = trace("show", "SWR-SUP-002", "--history", "--root", sample.root)
    git(sample.root, "init", "-q")
    git(sample.root, "commit", "-q", "--allow-empty", "-m", "Nothing")
    not_yet = trace("show", "SWR-SUP-002", "--history", "--root", sample.root)

    assert (nowhere.status, nowhere.out, nowhere.err.count("\n")) == (2, "", 1)
    assert "no commit holds the item yet" in not_yet.out
