# SPDX-License-Identifier: Apache-2.0
# Goal: equal inputs give equal bundle bytes; each later change is named; a malicious bundle causes no damage.
# Method: the sample project is bundled, then each change is made alone.
from __future__ import annotations

import io
import json
import os
import shutil
import subprocess
import tarfile
from collections.abc import Callable
from pathlib import Path

import pytest
from git_sample import start_history
from trace_sample import Sample, make_sample

from mamori_trace.command import main

needs_ssh = pytest.mark.skipif(shutil.which("ssh-keygen") is None, reason="the package openssh-client is not installed")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One bundle, created once, because its report dominates the run time."""
    folder = tmp_path_factory.mktemp("made")
    make_sample(folder / "project")
    assert main(["bundle", "--root", str(folder / "project"), "--out", str(folder / "bundle")]) == 0
    return folder / "bundle"


@pytest.fixture
def bundle(made: Path, tmp_path: Path) -> Path:
    """A copy that tests damage."""
    return shutil.copytree(made, tmp_path / "bundle")


def sign(bundle: Path, key: Path, namespace: str = "mamori-evidence") -> Path:
    """Signs with ssh-keygen only, without the tool."""
    subprocess.run(["ssh-keygen", "-q", "-Y", "sign", "-f", str(key), "-n", namespace, str(bundle / "manifest.json")], check=True)
    return bundle


@pytest.fixture
def key(tmp_path: Path) -> Path:
    return make_key(tmp_path / "key")


def make_key(path: Path) -> Path:
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-C", "sample", "-f", str(path)], check=True)
    return path


def write_signers(key: Path, name: str = "maintainers@example.invalid") -> Path:
    signers = key.with_suffix(".signers")
    signers.write_text(f"{name} {key.with_suffix('.pub').read_text()}")
    return signers


def list_faults(trace: Callable, bundle: Path, *options: object) -> list[str]:
    outcome = trace("verify", bundle, "--output", "json", *options)
    faults = outcome.content["faults"]
    assert outcome.status == (1 if faults else 0)
    return faults


def write_tar(path: Path, members: list[tuple[str, bytes, bytes]], tail: bytes = b"") -> Path:
    """(name, kind, data) in USTAR."""
    with tarfile.open(path, "w", format=tarfile.USTAR_FORMAT) as archive:
        for name, kind, data in members:
            info = tarfile.TarInfo(name)
            info.type = kind
            info.size = len(data)
            info.linkname = "/etc/passwd" if kind in (tarfile.SYMTYPE, tarfile.LNKTYPE) else ""
            archive.addfile(info, io.BytesIO(data))
    with path.open("ab") as file:
        file.write(tail)
    return path


@pytest.mark.verifies("SWR-TRC-074", technique="requirements_based", polarity="nominal")
def test_a_bundle_holds_report_evidence_requirements_and_facts(bundle: Path) -> None:
    manifest = json.loads((bundle / "manifest.json").read_text())

    paths = [row["path"] for row in manifest["files"]]
    assert paths == sorted(paths)
    for wanted in ("report/index.html", "trace.json", "evidence/junit/safety.xml", "evidence/campaign/campaign.json",
                   "requirements/trace.lock", "requirements/system/system.md", "requirements/schema/items.toml"):  # fmt: skip
        assert wanted in paths
    assert manifest["evidence_commit"] == "0123456789abcdef0123456789abcdef01234567"
    assert (manifest["commit"], manifest["worktree"]) == ("", "unknown")


@pytest.mark.verifies("SWR-TRC-074", technique="requirements_based", polarity="nominal")
def test_the_same_inputs_give_the_same_archive(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    commit = start_history(sample.root)
    one, two = tmp_path / "one.tar", tmp_path / "two.tar"
    trace("bundle", "--root", sample.root, "--out", one, "--allow-missing")
    for path in sample.root.rglob("*"):
        os.utime(path, (1, 1))
    trace("bundle", "--root", sample.root, "--out", two, "--allow-missing")

    assert one.read_bytes() == two.read_bytes()
    assert trace("verify", one, "--output", "json").content["commit"] == commit


@pytest.mark.verifies("SWR-TRC-074", technique="error_guessing", polarity="violation")
def test_what_cannot_be_bundled_leaves_nothing_behind(sample: Sample, trace: Callable, tmp_path: Path, bundle: Path) -> None:
    there = trace("bundle", "--root", sample.root, "--out", bundle)
    inside = trace("bundle", "--root", sample.root, "--out", sample.evidence / "x.tar")
    (sample.evidence / "link").symlink_to("/etc/passwd")
    link = trace("bundle", "--root", sample.root, "--out", tmp_path / "b.tar")
    no_evidence = trace("bundle", "--root", sample.root, "--evidence", tmp_path / "gone", "--out", tmp_path / "c.tar")

    for outcome, word in ((there, "there already"), (inside, "lies in"), (link, "link"), (no_evidence, "gone")):
        assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
        assert word in outcome.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bundle", "project"]
    assert not list(sample.evidence.glob("*.tar"))


@pytest.mark.verifies("SWR-TRC-074", technique="error_guessing", polarity="violation")
def test_a_bundle_of_a_failing_project_is_written_and_says_so(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    sample.replace("requirements/system/system.md", "The tool shall run", "The tool runs")

    outcome = trace("bundle", "--root", sample.root, "--out", tmp_path / "b.tar")

    assert outcome.status == 1
    assert list_faults(trace, tmp_path / "b.tar") == []


@pytest.mark.verifies("SWR-TRC-075", technique="requirements_based", polarity="nominal")
def test_a_bundle_that_was_left_alone_is_good(trace: Callable, bundle: Path) -> None:
    outcome = trace("verify", bundle)

    assert outcome.status == 0
    assert "no differences, not signed" in outcome.out


@pytest.mark.verifies("SWR-TRC-075", technique="fault_injection", polarity="violation")
def test_every_difference_is_named(trace: Callable, bundle: Path, tmp_path: Path) -> None:
    (bundle / "trace.json").unlink()
    (bundle / "more.txt").write_text("more")
    lock = bundle / "requirements" / "trace.lock"
    lock.write_bytes(lock.read_bytes() + b"#")
    needs = bundle / "requirements" / "stakeholder" / "needs.md"
    needs.write_text(needs.read_text().replace("reports", "reporte"))
    (bundle / "report" / "index.html").unlink()
    (bundle / "report" / "index.html").symlink_to(tmp_path / "elsewhere")
    os.mkfifo(bundle / "pipe")
    (bundle / "folder").symlink_to(tmp_path)

    faults = list_faults(trace, bundle)

    assert [fault.split()[0] for fault in faults] == ["folder", "more.txt", "pipe", "report/index.html", "requirements/stakeholder/needs.md",
                                                      "requirements/trace.lock", "trace.json"]  # fmt: skip
    assert faults[-1] == "trace.json is missing"
    assert "is a link" in faults[3]


@pytest.mark.parametrize("path", ["../outside", "/etc/passwd", "a/../../b", "a//b", "./a", "C:/x", "a\\b", "manifest.json", "a\nb", ""])
@pytest.mark.verifies("SWR-TRC-075", technique="error_guessing", polarity="violation")
def test_a_manifest_may_not_name_what_lies_elsewhere(trace: Callable, bundle: Path, path: str) -> None:
    manifest = json.loads((bundle / "manifest.json").read_text())
    manifest["files"].append({"path": path, "size": 0, "sha256": "0" * 64})
    (bundle / "manifest.json").write_text(json.dumps(manifest))

    faults = list_faults(trace, bundle)

    assert len(faults) == 1
    assert repr(path) in faults[0]


@pytest.mark.parametrize("row", [None, {}, {"path": "x"}, {"path": "x", "size": True, "sha256": "0" * 64}, {"path": "x", "size": 1, "sha256": "0"}])
@pytest.mark.verifies("SWR-TRC-075", technique="error_guessing", polarity="violation")
def test_an_entry_that_says_nothing_is_a_fault(trace: Callable, bundle: Path, row: object) -> None:
    manifest = json.loads((bundle / "manifest.json").read_text())
    manifest["files"].append(row)
    (bundle / "manifest.json").write_text(json.dumps(manifest))

    assert len(list_faults(trace, bundle)) == 1


@pytest.mark.parametrize("text", ["", "[]", "{", "[" * 100_000, '{"schema": "other/1"}', '{"schema": "a", "schema": "mamori.bundle/1"}', "\xff"])
@pytest.mark.verifies("SWR-TRC-075", technique="error_guessing", polarity="violation")
def test_no_manifest_is_one_error(trace: Callable, bundle: Path, text: str) -> None:
    (bundle / "manifest.json").write_bytes(text.encode("latin-1"))

    outcome = trace("verify", bundle)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)


@pytest.mark.verifies("SWR-TRC-075", technique="error_guessing", polarity="violation")
def test_what_is_no_bundle_is_one_error(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()

    for path in (tmp_path / "empty", tmp_path / "gone"):
        outcome = trace("verify", path)
        assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)


@pytest.mark.parametrize(
    ("members", "word"),
    [
        ([("/etc/passwd", tarfile.REGTYPE, b"x")], "leaves"),
        ([("../x", tarfile.REGTYPE, b"x")], "leaves"),
        ([("a/../../x", tarfile.REGTYPE, b"x")], "leaves"),
        ([("x", tarfile.SYMTYPE, b"")], "symbolic link"),
        ([("x", tarfile.LNKTYPE, b"")], "hard link"),
        ([("x", tarfile.CHRTYPE, b"")], "device"),
        ([("x", tarfile.BLKTYPE, b"")], "device"),
        ([("x", tarfile.FIFOTYPE, b"")], "pipe"),
        ([("x", tarfile.DIRTYPE, b"")], "folder"),
        ([("x", tarfile.GNUTYPE_SPARSE, b"")], "kind"),
        ([("x", tarfile.XHDTYPE, b"20 path=/etc/passwd\n")], "kind"),
        ([("x", tarfile.GNUTYPE_LONGNAME, b"/etc/passwd")], "kind"),
        ([("x", tarfile.REGTYPE, b"1"), ("x", tarfile.REGTYPE, b"2")], "twice"),
    ],
)
@pytest.mark.verifies("SWR-TRC-076", technique="fault_injection", polarity="violation")
def test_a_hostile_archive_is_refused(trace: Callable, tmp_path: Path, members: list, word: str) -> None:
    before = sorted(tmp_path.rglob("*"))
    archive = write_tar(tmp_path / "hostile.tar", members)

    outcome = trace("verify", archive)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert "refused" in outcome.err
    assert word in outcome.err
    assert sorted(tmp_path.rglob("*")) == sorted([*before, archive])


@pytest.mark.verifies("SWR-TRC-076", technique="fault_injection", polarity="violation")
def test_a_damaged_archive_is_refused(bundle: Path, trace: Callable, tmp_path: Path) -> None:
    names = ["manifest.json", "requirements/trace.lock", "trace.json"]
    write_tar(tmp_path / "b.tar", [(name, tarfile.REGTYPE, (bundle / name).read_bytes()) for name in names])
    whole = (tmp_path / "b.tar").read_bytes()
    for data in (b"", whole[:700], whole[:511], whole[: len(whole) // 2 // 512 * 512], b"\x1f\x8b" + whole, whole + b"x" * 512,
                 whole[:124] + b"77777777777\0" + whole[136:], whole[:150] + b"9" + whole[151:]):  # fmt: skip
        (tmp_path / "b.tar").write_bytes(data)

        outcome = trace("verify", tmp_path / "b.tar")

        assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)


@pytest.mark.verifies("SWR-TRC-076", technique="boundary_values", polarity="violation")
def test_a_manifest_of_any_size_does_not_fill_the_memory(trace: Callable, tmp_path: Path) -> None:
    info = tarfile.TarInfo("manifest.json")
    info.size = 1 << 32
    with (tmp_path / "huge.tar").open("wb") as file:
        file.write(info.tobuf(tarfile.USTAR_FORMAT))
        file.truncate(1 << 32)

    outcome = trace("verify", tmp_path / "huge.tar")

    assert (outcome.status, "refused" in outcome.err) == (2, True)


@needs_ssh
@pytest.mark.verifies("SWR-TRC-077", technique="requirements_based", polarity="nominal")
@pytest.mark.parametrize("name", ["signed", "signed.tar"])
def test_a_signed_bundle_names_its_signer(sample: Sample, trace: Callable, tmp_path: Path, key: Path, name: str) -> None:
    trace("bundle", "--root", sample.root, "--out", tmp_path / name, "--key", key)

    with_list = trace("verify", tmp_path / name, "--signers", write_signers(key))
    without = trace("verify", tmp_path / name)

    assert (with_list.status, without.status) == (0, 0)
    assert "signed by maintainers@example.invalid" in with_list.out
    assert "held against no list" in without.out


@needs_ssh
@pytest.mark.verifies("SWR-TRC-077", technique="fault_injection", polarity="violation")
def test_a_bundle_that_ought_to_be_signed_and_is_not_fails(trace: Callable, bundle: Path, key: Path) -> None:
    assert list_faults(trace, bundle, "--signers", write_signers(key)) == ["the bundle is not signed, and --signers demands a signature"]


@needs_ssh
@pytest.mark.verifies("SWR-TRC-077", technique="fault_injection", polarity="violation")
def test_a_signature_of_somebody_else_or_of_other_bytes_fails(bundle: Path, trace: Callable, tmp_path: Path, key: Path) -> None:
    signed = sign(bundle, key)
    stranger = write_signers(make_key(tmp_path / "stranger"))
    foreign = list_faults(trace, signed, "--signers", stranger)
    (signed / "manifest.json").write_bytes((signed / "manifest.json").read_bytes() + b"\n")
    changed = list_faults(trace, signed, "--signers", write_signers(key))
    changed_without = list_faults(trace, signed)
    (signed / "manifest.json.sig").write_bytes(b"no signature")
    garbage = list_faults(trace, signed, "--signers", write_signers(key))

    assert [len(each) for each in (foreign, changed, changed_without, garbage)] == [1, 1, 1, 1]
    assert "nobody of" in foreign[0]


@needs_ssh
@pytest.mark.parametrize(("content", "told"), [(b"\xff\xfe", "is no text in UTF-8"), (b"# who may\nsomebody\n", ":2: names no signer")])
@pytest.mark.verifies("SWR-TRC-077", technique="error_guessing", polarity="violation")
def test_a_broken_list_of_signers_is_an_input_that_cannot_be_read(
    bundle: Path, trace: Callable, tmp_path: Path, key: Path, content: bytes, told: str
) -> None:
    signers = tmp_path / "signers"
    signers.write_bytes(content)

    outcome = trace("verify", sign(bundle, key), "--signers", signers)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert told in outcome.err


@needs_ssh
@pytest.mark.verifies("SWR-TRC-077", technique="error_guessing", polarity="violation")
def test_a_signature_for_another_purpose_fails(bundle: Path, trace: Callable, key: Path) -> None:
    assert len(list_faults(trace, sign(bundle, key, "file"), "--signers", write_signers(key))) == 1


@needs_ssh
@pytest.mark.verifies("SWR-TRC-077", technique="error_guessing", polarity="violation")
def test_a_key_that_cannot_sign_is_one_error_and_writes_nothing(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "no_key").write_text("no key")
    (tmp_path / "no_key").chmod(0o600)
    absent = trace("bundle", "--root", sample.root, "--out", tmp_path / "b.tar", "--key", tmp_path / "gone")
    broken = trace("bundle", "--root", sample.root, "--out", tmp_path / "b.tar", "--key", tmp_path / "no_key")

    for outcome in (absent, broken):
        assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert not (tmp_path / "b.tar").exists()


@pytest.mark.verifies("SWR-TRC-077", technique="error_guessing", polarity="violation")
def test_without_ssh_keygen_the_package_is_named(sample: Sample, trace: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))

    outcome = trace("bundle", "--root", sample.root, "--out", tmp_path / "b.tar", "--key", tmp_path / "gone")

    assert (outcome.status, "openssh-client" in outcome.err) == (2, True)


@pytest.mark.verifies("SWR-TRC-075", technique="error_guessing", polarity="violation")
def test_a_folder_that_is_no_bundle_is_refused_without_reading_all_of_it(
    trace: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "large").write_bytes(b"")
    monkeypatch.setattr("mamori_trace.readers.bundle._take_file", lambda *_: pytest.fail("a file was read"))

    outcome = trace("verify", tmp_path)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert "no bundle" in outcome.err
