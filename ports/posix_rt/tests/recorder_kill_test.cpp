// SPDX-License-Identifier: Apache-2.0
// Goal: after a kill, all written records are intact and at most the record in progress is corrupted. Method:
// processes that write into a mapped file and are killed at random instants (the seed is printed on failure).
// kernel/tests/flight_step_test.cpp tests an end after each single instruction.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

namespace fs = std::filesystem;
using namespace verification;

using Bytes = std::vector<std::byte>;

Span<const std::byte> view_const(const Bytes& bytes) {
    return {bytes.data(), bytes.size()};
}

/// Argument of the record with this number.
std::int64_t calc_argument(std::uint64_t sequence) {
    return static_cast<std::int64_t>(sequence * 0x9E3779B97F4A7C15U);
}

void write_next(FlightRecorder& recorder) {
    const std::uint64_t sequence = recorder.get_next_sequence();
    recorder.write(Instant{static_cast<std::int64_t>(sequence)}, Severity::kWarning, 1U, 2U,
                   calc_argument(sequence));
}

Bytes read_file(const std::string& path) {
    std::ifstream file{path, std::ios::binary};
    Bytes bytes(fs::file_size(path));
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return bytes;
}

/// Records between two reports. With this number, most kills occur between two writes, and many during a
/// write.
constexpr std::uint64_t kBurst = 50U;

/// Writes records until it is killed. After the write of the last record of a burst, reports its number
/// through the pipe.
[[noreturn]] void write_until_killed(const char* path, std::size_t size, int report) {
    MappedFile file;
    FlightRecorder recorder;
    if (file.open(path, size) != Status::kOk || recorder.open(file.get_region()) != Status::kOk) {
        ::_exit(1);
    }
    for (;;) {
        for (std::uint64_t i = 0U; i < kBurst; ++i) {
            write_next(recorder);
        }
        const std::uint64_t newest = recorder.get_next_sequence() - 1U;
        if (::write(report, &newest, sizeof newest) != sizeof newest) {
            ::_exit(2);
        }
    }
}

/// Runs a writer, kills it after some reports, and returns the last number that it reported.
std::uint64_t run_and_kill(const std::string& path, std::size_t size, std::mt19937& generator) {
    std::array<int, 2U> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        write_until_killed(path.c_str(), size, ends[1]);
    }
    static_cast<void>(::close(ends[1]));
    int reports = std::uniform_int_distribution<int>{1, 200}(generator);
    std::uint64_t last = 0U;
    while (reports > 0 && ::read(ends[0], &last, sizeof last) == sizeof last) {
        --reports;
    }
    EXPECT_EQ(reports, 0) << "the writer has exited";
    const int spins = std::uniform_int_distribution<int>{0, 20000}(generator);
    for (volatile int i = 0; i < spins; i = i + 1) {
    }
    EXPECT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status));
    while (::read(ends[0], &last, sizeof last) == sizeof last) {
    }
    static_cast<void>(::close(ends[0]));
    return last;
}

/// @return the number with which a recorder would continue these bytes; 0 if it rejects them.
std::uint64_t open_copy(Bytes bytes) {
    FlightRecorder recorder;
    EXPECT_EQ(recorder.open({bytes.data(), bytes.size()}), Status::kOk);
    return recorder.get_next_sequence();
}

TEST(RecorderKillTest, KillLosesNoWrittenRecord) {
    verifies("SWR-REC-002", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 71977U;
    constexpr std::size_t kCapacity = 512U;
    constexpr std::uint32_t kRounds = 200U;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 generator{kSeed};
    const std::string path = ::testing::TempDir() + "recorder_kill_" + std::to_string(::getpid());
    std::uint64_t first_of_round = 1U;
    int torn_rounds = 0;
    int torn_before = 0;

    for (std::uint32_t round = 1U; round <= kRounds; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const std::uint64_t reported = run_and_kill(path, flight::calc_region_size(kCapacity), generator);
        const Bytes bytes = read_file(path);
        FlightReader reader;
        ASSERT_EQ(reader.open(view_const(bytes)), Status::kOk);
        const FlightSession session = reader.calc_session();
        ASSERT_EQ(session.number, round);
        ASSERT_GE(session.next_sequence, first_of_round);
        ASSERT_GE(reported, first_of_round);
        int torn_count = 0;
        for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
            FlightRecord record{};
            const SlotState state = reader.read(slot, record);
            ASSERT_NE(state, SlotState::kCorrupt);
            torn_count += state == SlotState::kTorn ? 1 : 0;
            if (state == SlotState::kWhole) {
                ASSERT_EQ(record.argument, calc_argument(record.sequence));
                ASSERT_EQ(record.session == round, record.sequence >= first_of_round);
            }
        }
        // Torn slots of earlier rounds remain until the ring overwrites them.
        ASSERT_LE(torn_count, torn_before + 1);
        torn_rounds += torn_count > torn_before ? 1 : 0;
        torn_before = torn_count;
        // After the last report, a burst can have overwritten the oldest records.
        const std::uint64_t newest_possible = reported + kBurst + 1U;
        const std::uint64_t first_kept = newest_possible > kCapacity ? newest_possible - kCapacity + 1U : 1U;
        for (std::uint64_t sequence = std::max(first_kept, first_of_round); sequence <= reported;
             ++sequence) {
            FlightRecord record{};
            const SlotState state = reader.read(flight::calc_slot(sequence, kCapacity), record);
            ASSERT_TRUE(state == SlotState::kWhole && record.sequence == sequence)
                << sequence << " of " << reported;
        }
        first_of_round = open_copy(bytes);
        Bytes spoiled = bytes;
        for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
            spoiled[flight::calc_region_size(slot) + flight::kCommitOffset] = std::byte{1U};
        }
        ASSERT_GE(open_copy(spoiled), first_of_round) << "no record with a number remains";
    }
    RecordProperty("rounds_with_a_torn_record", torn_rounds);
    fs::remove(path);
}

TEST(RecorderKillTest, OrderlyEndKeepsEveryRecord) {
    verifies("SWR-REC-002");
    const std::string path = ::testing::TempDir() + "recorder_end_" + std::to_string(::getpid());
    const std::size_t size = flight::calc_region_size(8U);
    {
        MappedFile file;
        FlightRecorder recorder;
        ASSERT_EQ(file.open(path.c_str(), size), Status::kOk);
        ASSERT_EQ(recorder.open(file.get_region()), Status::kOk);
        for (int i = 0; i < 5; ++i) {
            write_next(recorder);
        }
    }

    MappedFile file;
    FlightRecorder recorder;
    ASSERT_EQ(file.open(path.c_str(), size), Status::kOk);
    ASSERT_EQ(recorder.open(file.get_region()), Status::kOk);
    EXPECT_EQ(recorder.get_session(), 2U);
    EXPECT_EQ(recorder.get_next_sequence(), 6U);
    fs::remove(path);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
