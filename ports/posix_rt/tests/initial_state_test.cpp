// SPDX-License-Identifier: Apache-2.0
// Goal: limits and defaults have the values of the manual, and an object that was not used reports nothing.
// Method: comparison with literal values, since a test that uses a constant of the port cannot find a wrong
// one.
#include <gtest/gtest.h>

#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/ports/posix_rt/crash_stack.hpp"
#include "mamori/ports/posix_rt/grid_watch.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/mapped_file.hpp"
#include "mamori/ports/posix_rt/partition_news.hpp"
#include "mamori/ports/posix_rt/partition_output.hpp"
#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/ports/posix_rt/provisions.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/ports/posix_rt/shared_frame.hpp"
#include "mamori/ports/posix_rt/shared_memory.hpp"
#include "mamori/ports/posix_rt/software_watchdog.hpp"
#include "mamori/ports/posix_rt/watchdog_device.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;

TEST(InitialStateTest, ThreadsHaveTheStacksOfTheManual) {
    verifies("SWR-PRT-060", Technique::kInterface);
    EXPECT_EQ(kThreadStack, 262'144U);
    EXPECT_EQ(kThreadStackMin, 32'768U);
    EXPECT_EQ(kThreadStackGuard, 65'536U);
    EXPECT_EQ(CrashStack::kSize, 32'768U);
    const ThreadPlace place{};
    EXPECT_EQ(place.priority, 0);
    EXPECT_EQ(place.processor, -1);
    EXPECT_EQ(place.stack_size, 262'144U);
    const WindowThread thread;
    EXPECT_EQ(thread.get_stack_size(), 0U);
}

TEST(InitialStateTest, ARightThatWasNotRequestedIsNotGranted) {
    verifies("SWR-PRT-002", Technique::kStateTransition);
    const ThreadRights rights{};
    for (const Right& right : {rights.priority, rights.processor}) {
        EXPECT_FALSE(right.is_granted);
        EXPECT_EQ(right.system_error, 0);
    }
    EXPECT_EQ(combine({true, 0}, {false, 5}).system_error, 5);
    EXPECT_EQ(combine({false, 4}, {false, 5}).system_error, 4) << "the first denial";
    EXPECT_EQ(combine({false, 4}, {true, 0}).system_error, 4);
}

TEST(InitialStateTest, SharedFramesHaveTheLayoutOfTheirFormat) {
    verifies("SWR-PRT-010", Technique::kInterface);
    EXPECT_EQ(kFrameCapacityMax, 1'048'576U);
    // A word for the number, and four slots of three words and the content.
    EXPECT_EQ(calc_frame_region_size(1U), 136U);
    EXPECT_EQ(calc_frame_region_size(8U), 136U);
    EXPECT_EQ(calc_frame_region_size(9U), 168U);
    EXPECT_EQ(calc_frame_region_size(kFrameCapacityMax), 4'194'408U);
    EXPECT_EQ(FrameReader::kTries, 3);
    const FrameFacts facts{};
    EXPECT_EQ(facts.number, 0U);
    EXPECT_EQ(facts.published_at, Instant{0});
    EXPECT_EQ(facts.length, 0U);
}

TEST(InitialStateTest, NewsOfNoMessageAreZero) {
    verifies("SWR-PRT-013", Technique::kStateTransition);
    const PartitionNews news{};
    EXPECT_EQ(news.outcome, FrameOutcome::kNothingNew);
    EXPECT_EQ(news.number, 0U);
    EXPECT_EQ(news.skipped, 0U);
    EXPECT_EQ(news.age_ns, 0);
    EXPECT_EQ(news.refused, 0U);
}

TEST(InitialStateTest, APartitionHasTheLimitsOfTheManual) {
    verifies("SWR-PRT-016", Technique::kInterface);
    const PartitionLimits limits{};
    EXPECT_EQ(limits.niceness, 10);
    EXPECT_EQ(limits.memory_max, 0U);
    EXPECT_EQ(limits.process_max, 0U);
    EXPECT_EQ(limits.file_max, 64U);
    EXPECT_EQ(limits.processor, -1);
    EXPECT_EQ(limits.user, 4'294'967'295U);
    EXPECT_EQ(kFirstPartitionDescriptor, 3);
    EXPECT_EQ(PartitionOrder::kArgumentMax, 16U);
    EXPECT_EQ(PartitionOrder::kDescriptorMax, 8U);
    const PartitionOrder order{};
    EXPECT_EQ(order.output, -1);
    EXPECT_EQ(order.errors, -1);
    EXPECT_EQ(PartitionOutput::kNameMax, 32U);
    EXPECT_EQ(PartitionOutput::kLineMax, 512U);
    EXPECT_EQ(PartitionOutput::kForwardMax, 65'536U);
    const PartitionOutput output{"p"};
    EXPECT_EQ(output.get_output(), -1);
    EXPECT_EQ(output.get_errors(), -1);
    EXPECT_EQ(output.get_lost_count(), 0U);
}

TEST(InitialStateTest, APartitionThatWasNotStartedHasNoProcess) {
    verifies("SWR-PRT-015", Technique::kStateTransition);
    PartitionProcess sut;
    EXPECT_EQ(sut.get_pid(), -1);
    EXPECT_EQ(sut.get_exit_status(), -1);
    EXPECT_EQ(sut.get_signal(), 0);
    EXPECT_EQ(sut.get_system_error(), 0);
    EXPECT_EQ(sut.get_error(), PartitionError::kNone);
    EXPECT_EQ(sut.check(), PartitionState::kNone);
}

TEST(InitialStateTest, ACrashNoteStatesNothing) {
    verifies("SWR-PRT-027", Technique::kStateTransition);
    const CrashNote note{};
    EXPECT_EQ(kCrashNoteSize, 30U);
    EXPECT_EQ(calc_recorder_file_size(2U), flight::calc_region_size(2U) + 30U);
    EXPECT_EQ(note.time, Instant{0});
    EXPECT_EQ(note.address, 0U);
    EXPECT_EQ(note.session, 0U);
    EXPECT_EQ(note.place.window, 65'535U);
    EXPECT_EQ(note.place.component, 65'535U);
    EXPECT_EQ(CrashPlace::kWatchdog, 65'534U);
    EXPECT_EQ(note.signal, 0U);
    EXPECT_FALSE(note.is_sent);
}

TEST(InitialStateTest, AFileAndASharedMemoryThatWereNotOpenedAreEmpty) {
    verifies("SWR-PRT-012", Technique::kStateTransition);
    MappedFile file;
    EXPECT_FALSE(file.is_open());
    EXPECT_TRUE(file.get_region().empty());
    EXPECT_EQ(file.get_error(), MappedFileError::kNone);
    EXPECT_EQ(file.get_system_error(), 0);
    EXPECT_EQ(file.flush(), Status::kPreconditionNotMet);
    SharedMemory memory;
    EXPECT_FALSE(memory.is_open());
    EXPECT_EQ(memory.get_region().size(), 0U);
    EXPECT_EQ(memory.get_descriptor(), -1);
    EXPECT_EQ(memory.get_system_error(), 0);
}

TEST(InitialStateTest, AWatchdogThatWasNotOpenedHasNotExpired) {
    verifies("SWR-PRT-020", Technique::kStateTransition);
    const WatchdogDevice device;
    EXPECT_FALSE(device.is_open());
    EXPECT_FALSE(device.has_reset_machine());
    EXPECT_EQ(device.get_timeout(), Duration{0});
    EXPECT_EQ(device.get_system_error(), 0);
    const WatchdogReaction reaction{nullptr};
    EXPECT_FALSE(reaction.ends_process);
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    const SoftwareWatchdog sut{clock, {Duration{0}, Duration{1}}, {[](void*) noexcept {}}};
    EXPECT_FALSE(sut.has_expired());
    EXPECT_FALSE(sut.is_watching());
    EXPECT_FALSE(sut.get_priority_right().is_granted);
}

TEST(InitialStateTest, AGuardThatWasNotSetIsNotAbove) {
    verifies("SWR-AOU-014", Technique::kStateTransition, Polarity::kViolation);
    GuardAbove sut;
    EXPECT_EQ(sut.look(), Status::kPreconditionNotMet);
    EXPECT_EQ(MemoryLocked::kKernelBytes, 65'536U);
}

TEST(InitialStateTest, LimitsOfAWatchHaveNoDefault) {
    verifies("SWR-PRT-032", Technique::kStateTransition);
    const GridLimits limits{};
    EXPECT_EQ(limits.lateness, Duration{0});
    EXPECT_EQ(limits.period, Duration{0});
    EXPECT_EQ(limits.rate.span, Duration{0});
    EXPECT_EQ(limits.rate.limit_ppm, 0);
    const ClockPair pair{};
    EXPECT_EQ(pair.reference_ns, 0);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
