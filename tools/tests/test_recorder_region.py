# SPDX-License-Identifier: Apache-2.0
# Goal: exactly the written records are read. Method: handwritten files; the bytes that the C++ test expects from its writer; each kind of
# damage at each position; a generator that flips bits, whose seed is in the test name.
from __future__ import annotations

import random
from pathlib import Path

import pytest
from recorder_files import HEADER_BYTES, RECORD_BYTES, make_crash, make_file, make_header, make_record, write

from mamori_tools.log.region import MAX_BYTES, Crash, Recording, read_recording
from mamori_trace.base.errors import InputError

# The record of kernel/tests/flight_format_test.cpp, byte for byte.
GOLDEN = bytes.fromhex("0807060504030201feffffffffffffff8877665544332211a4a3a2a1b2b1c2c1020000c3fb5bb52d")
GOLDEN_SEQUENCE = 0x0102030405060708


def read(tmp_path: Path, data: bytes) -> Recording:
    return read_recording(write(tmp_path / "run.rec", data))


def sequences(recording: Recording) -> list[int]:
    return [record.sequence for record in recording.records]


def findings(recording: Recording) -> list[tuple[str, int]]:
    return [(finding.kind, finding.offset) for finding in recording.findings]


@pytest.mark.verifies("SWR-REC-011", technique="back_to_back")
def test_bytes_that_the_kernel_writes_are_read(tmp_path: Path) -> None:
    recording = read(tmp_path, make_file(5, [GOLDEN]))

    record = recording.records[0]
    assert record.sequence == GOLDEN_SEQUENCE
    assert (record.time_ns, record.argument, record.session) == (-2, 0x1122334455667788, 0xA1A2A3A4)
    assert (record.source, record.code, record.severity) == (0xB1B2, 0xC1C2, "fault")
    assert record.offset == HEADER_BYTES + RECORD_BYTES * ((GOLDEN_SEQUENCE - 1) % 5)


@pytest.mark.verifies("SWR-REC-011")
def test_ring_that_has_turned_is_read_in_the_order_of_its_numbers(tmp_path: Path) -> None:
    recording = read(tmp_path, make_file(3, [make_record(number, session=2) for number in (4, 5, 6, 7)], session=2))

    assert sequences(recording) == [5, 6, 7]
    assert recording.findings == ()
    assert (recording.capacity, recording.session, recording.overwritten) == (3, 2, 4)


@pytest.mark.verifies("SWR-REC-011", technique="boundary_values")
def test_recorder_without_a_record_is_in_order(tmp_path: Path) -> None:
    recording = read(tmp_path, make_file(3, []))

    assert (recording.records, recording.findings, recording.overwritten) == ((), (), 0)


@pytest.mark.verifies("SWR-REC-011", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("slot", range(4))
def test_torn_and_corrupt_slots_are_named_with_their_offset_and_number(tmp_path: Path, slot: int) -> None:
    whole = make_file(4, [make_record(number) for number in (5, 6, 3, 4)])
    offset = HEADER_BYTES + slot * RECORD_BYTES
    # Slot 2 was the next slot for 7; without 6, slot 1 is the next slot for 6.
    number = ("5", "6 or 2", "7 or 3", "4")[slot]
    for kind, at, value in (("torn", 35, 0), ("corrupt", 35, 1), ("corrupt", 0, 77), ("corrupt", 39, 77)):
        data = bytearray(whole)
        data[offset + at] = value

        recording = read(tmp_path, bytes(data))

        assert findings(recording) == [(kind, offset)]
        assert f"record {number}, slot {slot}" in recording.findings[0].text
        assert len(recording.records) == 3


@pytest.mark.verifies("SWR-REC-011", technique="fault_injection", polarity="violation")
def test_numbers_that_are_missing_are_named_in_one_piece(tmp_path: Path) -> None:
    recording = read(tmp_path, make_file(20, [make_record(number) for number in (1, 2, 5, 9, 10)]))

    assert findings(recording) == [("missing", HEADER_BYTES + 2 * RECORD_BYTES), ("missing", HEADER_BYTES + 5 * RECORD_BYTES)]
    assert [finding.text for finding in recording.findings] == ["records 3 to 4 are missing", "records 6 to 8 are missing"]


@pytest.mark.verifies("SWR-REC-011", technique="fault_injection", polarity="violation")
def test_record_of_an_earlier_turn_shows_that_its_successor_is_missing(tmp_path: Path) -> None:
    recording = read(tmp_path, make_file(3, [make_record(number) for number in (7, 5, 9)]))

    assert sequences(recording) == [5, 7, 9]
    assert [finding.kind for finding in recording.findings] == ["stale", "missing"]
    assert recording.findings[1].text == "record 8 is missing"


@pytest.mark.verifies("SWR-REC-011", technique="fault_injection", polarity="violation")
def test_whole_record_in_a_foreign_slot_is_corrupt(tmp_path: Path) -> None:
    data = make_header(3) + make_record(2) + bytes(2 * RECORD_BYTES)

    assert findings(read(tmp_path, data)) == [("corrupt", HEADER_BYTES)]


@pytest.mark.verifies("SWR-REC-013", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize("length", [*range(HEADER_BYTES, HEADER_BYTES + 4 * RECORD_BYTES, 7)])
def test_cut_file_gives_what_is_left(tmp_path: Path, length: int) -> None:
    whole = make_file(4, [make_record(number) for number in (1, 2, 3, 4)])

    recording = read(tmp_path, whole[:length])

    assert sequences(recording) == [1, 2, 3, 4][: (length - HEADER_BYTES) // RECORD_BYTES]
    assert ("cut", length) in findings(recording)


@pytest.mark.verifies("SWR-REC-013", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize("newest", range(1, 25))
@pytest.mark.parametrize("slots", range(8))
def test_cut_file_claims_nothing_about_the_slots_that_are_gone(tmp_path: Path, newest: int, slots: int) -> None:
    whole = make_file(8, [make_record(number) for number in range(1, newest + 1)])

    recording = read(tmp_path, whole[: HEADER_BYTES + slots * RECORD_BYTES + 17])

    assert [finding.kind for finding in recording.findings] == ["cut"]
    assert f"{8 - slots} of 8 slots are cut off" in recording.findings[0].text
    assert "may be older or newer than those shown" in recording.findings[0].text
    assert recording.overwritten is None


@pytest.mark.verifies("SWR-REC-013", technique="fault_injection", polarity="violation")
def test_cut_file_still_names_what_is_missing_before_the_cut(tmp_path: Path) -> None:
    numbers = [number for number in range(9, 17) if number not in (10, 12)]
    data = bytearray(make_file(8, [make_record(number) for number in numbers])[: HEADER_BYTES + 5 * RECORD_BYTES])
    data[HEADER_BYTES] ^= 1

    recording = read(tmp_path, bytes(data))

    assert sequences(recording) == [11, 13]
    assert [finding.text for finding in recording.findings if finding.kind == "missing"] == ["record 10 is missing", "record 12 is missing"]
    assert recording.findings[0].text == "slot 0: its bytes are not what was written", "it may have held 9 or 17"


@pytest.mark.verifies("SWR-REC-013", technique="boundary_values", polarity="violation")
def test_gap_that_begins_in_one_turn_and_ends_in_the_next_is_named_up_to_the_cut(tmp_path: Path) -> None:
    data = make_file(8, [make_record(number) for number in (4, 11)])[: HEADER_BYTES + 6 * RECORD_BYTES]

    recording = read(tmp_path, data)

    assert [finding.text for finding in recording.findings if finding.kind == "missing"] == [
        "records 5 to 6 are missing", "records 9 to 10 are missing"]  # fmt: skip


@pytest.mark.verifies("SWR-REC-013", technique="fault_injection", polarity="violation")
def test_bytes_behind_the_end_are_named(tmp_path: Path) -> None:
    data = make_file(2, [make_record(1)])

    assert findings(read(tmp_path, data + b"x")) == [("trailing", len(data))]


@pytest.mark.verifies("SWR-REC-013", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("place", [0, 3, 10, 12, 16, 20])
def test_records_behind_a_damaged_header_are_read(tmp_path: Path, place: int) -> None:
    data = bytearray(make_file(4, [make_record(number) for number in (1, 2, 3)]))
    data[place] ^= 0x40

    recording = read(tmp_path, bytes(data))

    assert sequences(recording) == [1, 2, 3]
    assert recording.findings[0].kind == "header"


@pytest.mark.verifies("SWR-REC-013", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "is empty"),
        (bytes(500), "zeros only"),
        (b"PK\x03\x04" + b"\x55" * 500, "is no recorder file"),
        (b"x", "is no recorder file"),
        (make_header(4)[:40], "is cut in its header, after 40 bytes"),
        (make_header(4)[:8], "is cut in its header, after 8 bytes"),
        (make_file(4, [make_record(1)], version=1), "is of format version 1, this release reads 2"),
    ],
)
def test_file_without_anything_to_print_is_refused_with_its_cause(tmp_path: Path, data: bytes, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence) as caught:
        read(tmp_path, data)
    assert "\n" not in str(caught.value)
    assert str(tmp_path / "run.rec") in str(caught.value)


@pytest.mark.verifies("SWR-REC-013", technique="boundary_values", polarity="violation")
def test_file_that_is_too_large_is_refused_before_it_is_read(tmp_path: Path) -> None:
    with (tmp_path / "run.rec").open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)

    with pytest.raises(InputError, match="at most"):
        read_recording(tmp_path / "run.rec")


@pytest.mark.verifies("SWR-REC-013", technique="fault_injection", polarity="violation")
def test_capacity_that_no_file_has_costs_no_time(tmp_path: Path) -> None:
    data = make_header(0xFFFF_FFFF) + make_record(1)

    recording = read(tmp_path, data)
    assert sequences(recording) == [1]
    assert [finding.kind for finding in recording.findings] == ["cut"]


@pytest.mark.verifies("SWR-REC-013", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("seed", range(20))
def test_flipped_bytes_never_invent_a_record(tmp_path: Path, seed: int) -> None:
    generator = random.Random(seed)
    written = {number: make_record(number, session=1 + number // 9, argument=number * 7) for number in range(21, 41)}
    whole = make_file(20, list(written.values()), session=5)
    originals = {record.offset: record for record in read(tmp_path, whole).records}
    assert len(originals) == 20

    for _ in range(50):
        data = bytearray(whole)
        touched = {generator.randrange(len(data)) for _ in range(generator.randint(1, 30))}
        for place in touched:
            data[place] ^= generator.randint(1, 255)
        try:
            recording = read(tmp_path, bytes(data))
        except InputError:
            assert any(place < HEADER_BYTES for place in touched)
            continue
        spoiled = {(place - HEADER_BYTES) // RECORD_BYTES for place in touched if place >= HEADER_BYTES}
        wanted = [record for offset, record in sorted(originals.items(), key=lambda item: item[1].sequence)
                  if (offset - HEADER_BYTES) // RECORD_BYTES not in spoiled]  # fmt: skip
        assert list(recording.records) == wanted, f"seed {seed}"
        named = {(finding.offset - HEADER_BYTES) // RECORD_BYTES for finding in recording.findings
                 if finding.kind in ("torn", "corrupt")}  # fmt: skip
        assert named == spoiled, f"seed {seed}"


# The note of ports/posix_rt/tests/crash_note_test.cpp, byte for byte.
GOLDEN_NOTE = bytes.fromhex("feffffffffffffff8877665544332211a4a3a2a1b2b1c2c10b01ab7863ca")


@pytest.mark.verifies("SWR-PRT-028", technique="back_to_back")
def test_note_that_the_port_writes_is_read(tmp_path: Path) -> None:
    data = make_file(2, [make_record(1)])
    recording = read(tmp_path, data + GOLDEN_NOTE)

    assert recording.crash == Crash(session=0xA1A2A3A4, time_ns=-2, signal="SIGSEGV", is_sent=True, address=0x1122334455667788,
                                    window=0xB1B2, component=0xC1C2, is_watchdog=False, offset=len(data))
    assert (sequences(recording), recording.findings, recording.capacity) == ([1], (), 2)


@pytest.mark.verifies("SWR-PRT-028", technique="boundary_values")
def test_places_that_are_none_the_watchdog_and_signals_without_a_name_are_told_apart(tmp_path: Path) -> None:
    nowhere = read(tmp_path, make_file(1, []) + make_crash()).crash
    watchdog = read(tmp_path, make_file(1, []) + make_crash(component=0xFFFE, number=200)).crash

    assert nowhere is not None and (nowhere.window, nowhere.component, nowhere.is_watchdog) == (None, None, False)
    assert watchdog is not None and (watchdog.component, watchdog.is_watchdog, watchdog.signal) == (None, True, "signal 200")


@pytest.mark.verifies("SWR-PRT-028")
def test_room_for_a_note_without_a_crash_is_in_order(tmp_path: Path) -> None:
    recording = read(tmp_path, make_file(3, [make_record(1)]) + bytes(30))

    assert (recording.crash, recording.findings) == (None, ())


@pytest.mark.verifies("SWR-PRT-028", technique="fault_injection", polarity="violation")
def test_each_damaged_byte_of_a_note_is_found(tmp_path: Path) -> None:
    data = make_file(2, [make_record(1)])
    for place in range(len(GOLDEN_NOTE)):
        note = bytearray(GOLDEN_NOTE)
        note[place] ^= 0x10
        recording = read(tmp_path, data + bytes(note))
        assert recording.crash is None
        assert findings(recording) == [("corrupt", len(data))]
        assert sequences(recording) == [1]


@pytest.mark.verifies("SWR-PRT-028", technique="boundary_values", polarity="violation")
def test_a_byte_more_or_less_than_a_note_is_no_note(tmp_path: Path) -> None:
    data = make_file(2, [make_record(1)])
    for tail in (GOLDEN_NOTE[:-1], GOLDEN_NOTE + bytes(1)):
        recording = read(tmp_path, data + tail)
        assert recording.crash is None
        assert findings(recording) == [("trailing", len(data))]
