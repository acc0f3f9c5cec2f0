// SPDX-License-Identifier: Apache-2.0
// Goal: a crash record is read as it was written, any damage is detected, and the recorder before it is
// unchanged. Method: golden bytes, every change of one bit, and a recorder over the same file.
#include "mamori/ports/posix_rt/crash_note.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

constexpr CrashNote kNote{Instant{-2}, 0x1122334455667788U, 0xA1A2A3A4U, {0xB1B2U, 0xC1C2U}, SIGSEGV, true};
constexpr CrashNoteBytes kGolden{0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x88, 0x77,
                                 0x66, 0x55, 0x44, 0x33, 0x22, 0x11, 0xA4, 0xA3, 0xA2, 0xA1,
                                 0xB2, 0xB1, 0xC2, 0xC1, 0x0B, 0x01, 0xAB, 0x78, 0x63, 0xCA};

void expect_same(const CrashNote& actual, const CrashNote& expected) {
    EXPECT_EQ(actual.time, expected.time);
    EXPECT_EQ(actual.address, expected.address);
    EXPECT_EQ(actual.session, expected.session);
    EXPECT_EQ(actual.place.window, expected.place.window);
    EXPECT_EQ(actual.place.component, expected.place.component);
    EXPECT_EQ(actual.signal, expected.signal);
    EXPECT_EQ(actual.is_sent, expected.is_sent);
}

TEST(CrashNoteTest, BytesAreThoseOfTheFormat) {
    verifies("SWR-PRT-027", Technique::kInterface);
    EXPECT_EQ(encode_crash_note(kNote), kGolden);
}

TEST(CrashNoteTest, WrittenRecordIsRead) {
    verifies("SWR-PRT-027");
    for (const CrashNote& note : {kNote, CrashNote{{}, 0U, 1U, {}, SIGABRT, false}}) {
        CrashNote read;
        EXPECT_EQ(decode_crash_note(encode_crash_note(note), read), CrashNoteState::kWhole);
        expect_same(read, note);
    }
}

TEST(CrashNoteTest, ZerosAreNoCrashAndEachFlippedBitIsDamage) {
    verifies("SWR-PRT-027", Technique::kFaultInjection, Polarity::kViolation);
    CrashNote read = kNote;
    EXPECT_EQ(decode_crash_note({}, read), CrashNoteState::kEmpty);
    for (std::size_t bit = 0U; bit < 8U * kCrashNoteSize; ++bit) {
        CrashNoteBytes bytes = encode_crash_note(kNote);
        bytes[bit / 8U] = static_cast<std::uint8_t>(bytes[bit / 8U] ^ (1U << (bit % 8U)));
        EXPECT_EQ(decode_crash_note(bytes, read), CrashNoteState::kDamaged) << bit;
    }
    expect_same(read, kNote);
}

TEST(CrashNoteTest, FileWithoutRoomForANoteIsRejected) {
    verifies("SWR-PRT-033", Technique::kBoundaryValues, Polarity::kViolation);
    std::vector<std::byte> bytes(kCrashNoteSize);
    CrashNote note;
    const auto get_rest = [&](std::size_t size) {
        return get_recorder_region(Span<std::byte>{bytes.data(), size}).size();
    };
    const auto read = [&](std::size_t size) {
        return read_crash_note(Span<const std::byte>{bytes.data(), size}, note);
    };

    EXPECT_EQ(get_rest(kCrashNoteSize), 0U);
    EXPECT_EQ(read(kCrashNoteSize), CrashNoteState::kEmpty);
    EXPECT_CHECK_FAILS(static_cast<void>(get_rest(kCrashNoteSize - 1U)), "crash_note.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(read(kCrashNoteSize - 1U)), "crash_note.cpp", 1);
}

TEST(CrashNoteTest, NoteWithoutASignalIsDamaged) {
    verifies("SWR-PRT-027", Technique::kBoundaryValues, Polarity::kViolation);
    CrashNote note = kNote;
    note.signal = 0U;
    EXPECT_EQ(decode_crash_note(encode_crash_note(note), note), CrashNoteState::kDamaged);
}

TEST(CrashNoteTest, RecorderBeforeItIsUntouched) {
    verifies("SWR-PRT-027", Technique::kInterface);
    std::vector<std::byte> file(calc_recorder_file_size(2U));
    const Span<std::byte> bytes{file.data(), file.size()};
    FlightRecorder recorder;
    ASSERT_EQ(recorder.open(get_recorder_region(bytes)), Status::kOk);
    recorder.write(Instant{5}, Severity::kInfo, 1U, 2U, 3);
    const std::vector<std::byte> before = file;

    write_crash_note(bytes, kNote);

    CrashNote read;
    EXPECT_EQ(read_crash_note({file.data(), file.size()}, read), CrashNoteState::kWhole);
    expect_same(read, kNote);
    EXPECT_TRUE(std::equal(before.begin(), before.end() - kCrashNoteSize, file.begin()));
    FlightReader reader;
    EXPECT_EQ(reader.open({file.data(), file.size()}), Status::kOk)
        << "reader without support for crash records";
    EXPECT_EQ(reader.get_capacity(), 2U);
}

TEST(CrashNoteTest, PositionIsPerThreadAndAnIndexThatIsTooLargeIsNone) {
    verifies("SWR-PRT-027", Technique::kBoundaryValues);
    clear_crash_place();
    EXPECT_EQ(get_crash_place().window, CrashPlace::kNone);
    EXPECT_EQ(get_crash_place().component, CrashPlace::kNone);
    set_crash_place(3U, 0xFFFDU);
    EXPECT_EQ(get_crash_place().window, 3U);
    EXPECT_EQ(get_crash_place().component, 0xFFFDU);
    set_crash_place(0xFFFEU, 0x1'0000U);
    EXPECT_EQ(get_crash_place().window, CrashPlace::kNone);
    EXPECT_EQ(get_crash_place().component, CrashPlace::kNone);
    set_crash_place_of_watchdog();
    EXPECT_EQ(get_crash_place().window, CrashPlace::kNone);
    EXPECT_EQ(get_crash_place().component, CrashPlace::kWatchdog);
    clear_crash_place();
}

}  // namespace
}  // namespace mamori::ports::posix_rt
