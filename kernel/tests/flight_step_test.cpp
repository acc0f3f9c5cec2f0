// SPDX-License-Identifier: Apache-2.0
// Goal: a program that ends between any two of its instructions spoils at most the record being written.
// Method: a child process is led through write(), open() and format() instruction by instruction, with the
// memory that it shares judged after each: an end at that point would leave just this.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <vector>

#include "mamori/kernel/record/flight_reader.hpp"
#include "mamori/kernel/record/flight_recorder.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

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

/// Memory that a child shares with the test, and a child that is led through one action.
class FlightStepTest : public ::testing::Test {
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
            // It is killed where it stops: what comes after the action is not to be stepped through.
            static_cast<void>(::raise(SIGSTOP));
            ::_exit(1);
        }
        std::vector<Bytes> contents{before_};
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        if (!WIFSTOPPED(status)) {
            return {};
        }
        do {
            const Bytes now(region_.begin(), region_.end());
            if (now != contents.back()) {
                contents.push_back(now);
            }
            if (::ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) != 0 ||
                ::waitpid(child, &status, 0) != child) {
                static_cast<void>(::kill(child, SIGKILL));
                return {};
            }
        } while (WIFSTOPPED(status) && WSTOPSIG(status) == SIGTRAP);
        EXPECT_TRUE(WIFSTOPPED(status) && WSTOPSIG(status) == SIGSTOP);
        static_cast<void>(::kill(child, SIGKILL));
        EXPECT_EQ(::waitpid(child, &status, 0), child);
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

TEST_F(FlightStepTest, EachInstructionOfAWriteLeavesTheOldRecordATornOneOrTheNewOne) {
    verifies("SWR-REC-003", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents = step_through([this] { write_next(recorder_); });
    if (contents.empty()) {
        GTEST_SKIP() << "verdict=no-privilege: this machine does not let one process lead another (ptrace)";
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

TEST_F(FlightStepTest, ASessionGoesOnAfterEachInstructionOfAWrite) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents = step_through([this] { write_next(recorder_); });
    if (contents.empty()) {
        GTEST_SKIP() << "verdict=no-privilege: this machine does not let one process lead another (ptrace)";
    }

    for (std::size_t i = 0U; i < contents.size(); ++i) {
        Bytes bytes = contents[i];
        FlightRecorder next;
        ASSERT_EQ(next.open(view(bytes)), Status::kOk) << i;
        EXPECT_EQ(next.get_session(), 2U) << i;
        EXPECT_EQ(next.get_next_sequence(), i == 0U ? 6U : 7U) << i << ": 6 may have been written";
    }
}

TEST_F(FlightStepTest, NoNumberIsGivenAgainAfterEachInstructionOfAWriteAndTheLossOfAllRecords) {
    verifies("SWR-REC-006", Technique::kFaultInjection, Polarity::kViolation);
    for (std::uint64_t sequence = 6U; sequence < 6U + 2U * kCapacity; ++sequence) {
        before_ = Bytes(region_.begin(), region_.end());
        const std::vector<Bytes> contents = step_through([this] { write_next(recorder_); });
        if (contents.empty()) {
            GTEST_SKIP()
                << "verdict=no-privilege: this machine does not let one process lead another (ptrace)";
        }

        for (std::size_t i = 0U; i < contents.size(); ++i) {
            Bytes bytes = contents[i];
            const bool is_given = holds(bytes, sequence);
            for (std::size_t slot = 0U; slot < kCapacity; ++slot) {
                bytes[flight::calc_region_size(slot)] ^= std::byte{0x80U};
                bytes[flight::calc_region_size(slot) + flight::kCommitOffset] = std::byte{1U};
            }
            FlightRecorder next;
            ASSERT_EQ(next.open(view(bytes)), Status::kOk) << i;
            EXPECT_EQ(next.get_session(), 2U) << i;
            EXPECT_GE(next.get_next_sequence(), is_given ? sequence + 1U : sequence) << i;
            EXPECT_LE(next.get_next_sequence(), sequence + kCapacity) << i;
        }
        // What the child did went into the memory, but not into this process's recorder.
        write_next(recorder_);
    }
}

TEST_F(FlightStepTest, EachInstructionOfAnOpeningLeavesARecorderThatOpens) {
    verifies("SWR-REC-003", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents = step_through([this] {
        FlightRecorder second;
        static_cast<void>(second.open(region_));
    });
    if (contents.empty()) {
        GTEST_SKIP() << "verdict=no-privilege: this machine does not let one process lead another (ptrace)";
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

TEST_F(FlightStepTest, HalfFormattedRegionIsNoRecorder) {
    verifies("SWR-REC-003", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Bytes> contents =
        step_through([this] { static_cast<void>(FlightRecorder::format(region_)); });
    if (contents.empty()) {
        GTEST_SKIP() << "verdict=no-privilege: this machine does not let one process lead another (ptrace)";
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

TEST_F(FlightStepTest, AFirstFormatThatEndsAfterAnyInstructionIsDoneAgain) {
    verifies("SWR-REC-015", Technique::kFaultInjection, Polarity::kViolation);
    for (std::byte& byte : region_) {
        byte = std::byte{0U};
    }
    before_ = Bytes(kSize);
    const std::vector<Bytes> contents = step_through([this] {
        FlightRecorder first;
        static_cast<void>(first.open(region_));
    });
    if (contents.empty()) {
        GTEST_SKIP() << "verdict=no-privilege: this machine does not let one process lead another (ptrace)";
    }

    ASSERT_GT(contents.size(), flight::kSessionOffsets[0] / 2U) << "bytes of the header that are not 0";
    for (std::size_t i = 0U; i < contents.size(); ++i) {
        Bytes bytes = contents[i];
        FlightRecorder next;
        ASSERT_EQ(next.open(view(bytes)), Status::kOk) << i;
        EXPECT_EQ(next.get_next_sequence(), 1U) << i;
        write_next(next);
        EXPECT_TRUE(holds(bytes, 1U)) << i;
    }
}

TEST_F(FlightStepTest, WriteThatEndedIsWhole) {
    verifies("SWR-REC-003");
    write_next(recorder_);

    const Bytes bytes(region_.begin(), region_.end());
    EXPECT_TRUE(holds(bytes, 4U));
    EXPECT_TRUE(holds(bytes, 5U));
    EXPECT_TRUE(holds(bytes, 6U));
}

}  // namespace
}  // namespace mamori
