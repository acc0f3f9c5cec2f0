// SPDX-License-Identifier: Apache-2.0
// Goal: a kill takes no record that was written, and spoils at most the one being written. Method: processes
// that write into a mapped file and are killed at random instants (the seed is printed on failure); and one
// process that is led through write(), open() and format() instruction by instruction, with the memory judged
// after each: a kill at that point would leave just this.
#include <sys/mman.h>
#include <sys/ptrace.h>
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

#include "mamori/kernel/flight_reader.hpp"
#include "mamori/kernel/flight_recorder.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/verification/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

namespace fs = std::filesystem;
using verification::Polarity;
using verification::Technique;
using verification::verifies;

using Bytes = std::vector<std::byte>;

Span<std::byte> view(Bytes& bytes) {
    return {bytes.data(), bytes.size()};
}
Span<const std::byte> view_const(const Bytes& bytes) {
    return {bytes.data(), bytes.size()};
}

/// What the record with this number carries.
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

/// Records between two reports: so most kills come between two of them, and many within one.
constexpr std::uint64_t kBurst = 50U;

/// Writes, and reports the newest number through the pipe when its write has returned; ends by being killed
/// only.
[[noreturn]] void write_for_ever(const char* path, std::size_t size, int report) {
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
        write_for_ever(path.c_str(), size, ends[1]);
    }
    static_cast<void>(::close(ends[1]));
    int reports = std::uniform_int_distribution<int>{1, 200}(generator);
    std::uint64_t last = 0U;
    while (reports > 0 && ::read(ends[0], &last, sizeof last) == sizeof last) {
        --reports;
    }
    EXPECT_EQ(reports, 0) << "the writer ended by itself";
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

TEST(RecorderKillTest, KillLosesNoRecordThatWasWrittenBefore) {
    verifies("SWR-REC-002", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 71977U;
    constexpr std::size_t kCapacity = 512U;
    constexpr std::uint32_t kRounds = 200U;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937 generator{kSeed};
    const std::string path = ::testing::TempDir() + "recorder_kill_" + std::to_string(::getpid());
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
        ASSERT_GE(reported, session.first_sequence);
        int torn_count = 0;
        for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
            FlightRecord record{};
            const SlotState state = reader.read(slot, record);
            ASSERT_NE(state, SlotState::kCorrupt);
            torn_count += state == SlotState::kTorn ? 1 : 0;
            if (state == SlotState::kWhole) {
                ASSERT_EQ(record.argument, calc_argument(record.sequence));
                ASSERT_EQ(record.session == round, record.sequence >= session.first_sequence);
            }
        }
        // Those of earlier rounds stay until the ring comes round to them.
        ASSERT_LE(torn_count, torn_before + 1);
        torn_rounds += torn_count > torn_before ? 1 : 0;
        torn_before = torn_count;
        // Behind the last report a burst may have taken the places of the oldest.
        const std::uint64_t newest_possible = reported + kBurst + 1U;
        const std::uint64_t first_kept = newest_possible > kCapacity ? newest_possible - kCapacity + 1U : 1U;
        for (std::uint64_t sequence = std::max(first_kept, session.first_sequence); sequence <= reported;
             ++sequence) {
            FlightRecord record{};
            const SlotState state = reader.read(flight::calc_slot(sequence, kCapacity), record);
            ASSERT_TRUE(state == SlotState::kWhole && record.sequence == sequence)
                << sequence << " of " << reported;
        }
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

/// Memory that a child shares with the test, and a child that is led through one action.
class RecorderStepTest : public ::testing::Test {
  protected:
    static constexpr std::size_t kCapacity = 3U;
    static constexpr std::size_t kSize = flight::calc_region_size(kCapacity);

    void SetUp() override {
        void* const memory =
            ::mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        ASSERT_NE(memory, MAP_FAILED);
        region_ = {static_cast<std::byte*>(memory), kSize};
        ASSERT_EQ(recorder_.open(region_), Status::kOk);
        for (int i = 0; i < 5; ++i) {
            write_next(recorder_);
        }
        before_ = Bytes(region_.begin(), region_.end());
    }
    void TearDown() override { ::munmap(region_.data(), kSize); }

    /// Runs `action` in a child, one machine instruction at a time.
    /// @return each different content of the memory, in order, the first being that before; empty where the
    /// machine does not let one process lead another.
    template <typename Action>
    std::vector<Bytes> step_through(Action action) {
        const pid_t child = ::fork();
        if (child == 0) {
            if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) {
                ::_exit(1);
            }
            static_cast<void>(::raise(SIGSTOP));
            action();
            ::_exit(0);
        }
        std::vector<Bytes> contents{before_};
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        if (!WIFSTOPPED(status)) {
            return {};
        }
        while (WIFSTOPPED(status)) {
            const Bytes now(region_.begin(), region_.end());
            if (now != contents.back()) {
                contents.push_back(now);
            }
            if (::ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0 ||
                ::waitpid(child, &status, 0) != child) {
                static_cast<void>(::kill(child, SIGKILL));
                return {};
            }
        }
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        return contents;
    }
    static bool holds(const Bytes& bytes, std::uint64_t sequence) {
        FlightReader reader;
        FlightRecord record{};
        return reader.open(view_const(bytes)) == Status::kOk &&
               reader.read(flight::calc_slot(sequence, kCapacity), record) == SlotState::kWhole &&
               record.sequence == sequence && record.argument == calc_argument(sequence);
    }
    static SlotState read_state(const Bytes& bytes, std::uint64_t sequence) {
        FlightReader reader;
        EXPECT_EQ(reader.open(view_const(bytes)), Status::kOk);
        FlightRecord record{};
        return reader.read(flight::calc_slot(sequence, kCapacity), record);
    }

    Span<std::byte> region_;
    FlightRecorder recorder_;
    Bytes before_;
};

TEST_F(RecorderStepTest, EachInstructionOfAWriteLeavesTheOldRecordATornOneOrTheNewOne) {
    verifies("SWR-REC-003", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents = step_through([this] { write_next(recorder_); });
    if (contents.empty()) {
        GTEST_SKIP() << "this machine does not let one process lead another (ptrace)";
    }

    ASSERT_TRUE(holds(contents.front(), 3U));
    ASSERT_TRUE(holds(contents.back(), 6U));
    ASSERT_GT(contents.size(), 10U) << "bytes are stored one by one";
    for (std::size_t i = 1U; i < contents.size(); ++i) {
        EXPECT_TRUE(holds(contents[i], 4U)) << i;
        EXPECT_TRUE(holds(contents[i], 5U)) << i;
        const bool is_last = i + 1U == contents.size();
        EXPECT_EQ(read_state(contents[i], 6U), is_last ? SlotState::kWhole : SlotState::kTorn) << i;
    }
}

TEST_F(RecorderStepTest, ASessionGoesOnAfterEachInstructionOfAWrite) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents = step_through([this] { write_next(recorder_); });
    if (contents.empty()) {
        GTEST_SKIP() << "this machine does not let one process lead another (ptrace)";
    }

    for (std::size_t i = 0U; i < contents.size(); ++i) {
        Bytes bytes = contents[i];
        FlightRecorder next;
        ASSERT_EQ(next.open(view(bytes)), Status::kOk) << i;
        EXPECT_EQ(next.get_session(), 2U) << i;
        EXPECT_EQ(next.get_next_sequence(), i == 0U ? 6U : 7U) << i << ": 6 may have been written";
    }
}

TEST_F(RecorderStepTest, EachInstructionOfAnOpeningLeavesARecorderThatOpens) {
    verifies("SWR-REC-003", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents = step_through([this] {
        FlightRecorder second;
        static_cast<void>(second.open(region_));
    });
    if (contents.empty()) {
        GTEST_SKIP() << "this machine does not let one process lead another (ptrace)";
    }

    ASSERT_GT(contents.size(), 5U);
    for (std::size_t i = 0U; i < contents.size(); ++i) {
        for (const std::uint64_t sequence : {3U, 4U, 5U}) {
            EXPECT_TRUE(holds(contents[i], sequence)) << i;
        }
        Bytes bytes = contents[i];
        FlightRecorder next;
        ASSERT_EQ(next.open(view(bytes)), Status::kOk) << i;
        const bool is_done = i + 1U == contents.size();
        EXPECT_EQ(next.get_session(), is_done ? 3U : 2U) << i;
        EXPECT_EQ(next.get_next_sequence(), 6U) << i;
    }
}

TEST_F(RecorderStepTest, HalfFormattedRegionIsNoRecorder) {
    verifies("SWR-REC-003", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents =
        step_through([this] { static_cast<void>(FlightRecorder::format(region_)); });
    if (contents.empty()) {
        GTEST_SKIP() << "this machine does not let one process lead another (ptrace)";
    }

    ASSERT_GT(contents.size(), kSize / 4U);
    for (std::size_t i = 1U; i + 1U < contents.size(); ++i) {
        FlightReader reader;
        EXPECT_EQ(reader.open(view_const(contents[i])), Status::kError) << i;
    }
    FlightReader reader;
    EXPECT_EQ(reader.open(view_const(contents.back())), Status::kOk);
    EXPECT_EQ(reader.calc_newest_sequence(), 0U);
}

TEST_F(RecorderStepTest, WriteThatEndedIsWhole) {
    verifies("SWR-REC-003");
    write_next(recorder_);

    const Bytes bytes(region_.begin(), region_.end());
    EXPECT_TRUE(holds(bytes, 4U));
    EXPECT_TRUE(holds(bytes, 5U));
    EXPECT_TRUE(holds(bytes, 6U));
}

}  // namespace
}  // namespace mamori::ports::posix_rt
