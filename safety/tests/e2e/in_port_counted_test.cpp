// SPDX-License-Identifier: Apache-2.0
// Goal: a protected input reads each frame once, and each reading is counted by one outcome that has a name.
// Method: ports that call a frame new twice, queues that hold several, lose one or cannot give it.
#include <array>

#include "mamori/trace/verifies.hpp"
#include "port_rig.hpp"

namespace e2e_port_test {
namespace {

using namespace mamori::verification;

// ---- Each frame once ----

TEST(E2eSourceTest, FrameThatThePortStillCallsNewIsNoSecondFrame) {
    verifies("SWR-E2E-036", Technique::kStateTransition);
    Ends<M04, kLoose<PlainSequence>> ends{kSafe};
    ends.synchronise();
    ends.deliver(ends.make({1.0, Gear::kDrive}));
    ASSERT_TRUE(ends.sut.has_frame());
    ASSERT_EQ(ends.sut.read(ends.now, ends.value),
              E2eWorth::kNew);  // and its cycle is cut off: no mark_read()

    EXPECT_FALSE(ends.sut.has_frame());
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);
    EXPECT_EQ(ends.sut.get_checker().get_count(FrameCause::kRepeated), 0U);
    EXPECT_EQ(ends.send({2.0, Gear::kDrive}), E2eWorth::kNew);
}

TEST(E2eSourceTest, QueueGivesEachFrameOnceInItsOrder) {
    verifies("SWR-E2E-036", Technique::kStateTransition);
    Ends<M04, kLoose<HardenedSequence>, Queue> ends{kSafe};
    ends.synchronise();
    ends.deliver(ends.make({1.0, Gear::kDrive}));
    ends.deliver(ends.make({2.0, Gear::kDrive}));

    EXPECT_EQ(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 1.0);
    ASSERT_TRUE(ends.sut.has_frame());
    EXPECT_EQ(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 2.0);
    EXPECT_FALSE(ends.sut.has_frame());
    EXPECT_EQ(ends.read(), E2eWorth::kHeld);  // not the last one again, though the queue would read it back
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kSilent);
}

TEST(E2eSourceTest, FrameThatGaveWayInAQueueIsALoss) {
    verifies("SWR-E2E-036", Technique::kBoundaryValues, Polarity::kViolation);
    Ends<M04, kLoose<HardenedSequence>, Queue> ends{kSafe};
    ends.synchronise();
    for (const double speed : {1.0, 2.0, 3.0}) {
        static_cast<void>(ends.in.push({ends.make({speed, Gear::kDrive}), ++ends.revision, ends.now}));
    }
    ends.in.open(ends.now);

    EXPECT_NE(ends.read(), E2eWorth::kNew);
    EXPECT_EQ(ends.sut.get_checker().get_cause(), FrameCause::kOutOfOrder);
}

/// A queue that says that a frame waits, and cannot give it.
struct BrokenQueue {
    using Payload = M04::Frame;
    static constexpr bool kIsQueue = true;

    bool has_waiting() noexcept { return is_waiting; }
    Status read(Payload& frame) noexcept {
        if (!is_broken) {
            frame = next;
        }
        return is_broken ? Status::kOutOfResources : Status::kOk;
    }
    Instant get_published_at() const noexcept { return Instant{}; }
    std::uint32_t get_restart_count() const noexcept { return 0U; }

    Payload next{};
    bool is_waiting{true};
    bool is_broken{false};
};

TEST(E2eSourceTest, FrameThatAQueueCannotGiveIsNone) {
    verifies("SWR-E2E-036", Technique::kFaultInjection, Polarity::kViolation);
    mamori::OutPort<M04::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<M04> sender{out};
    BrokenQueue queue;
    E2eInPort<M04, kLoose<PlainSequence>, BrokenQueue> sut{queue, kSafe};
    Speed value{};
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(sender.write({1.0, Gear::kDrive}), Status::kOk);
        static_cast<void>(out.publish(Instant{}));
        queue.next = out.get_published();
        static_cast<void>(sut.read(Instant{}, value));
    }
    ASSERT_EQ(sut.get_outcome(), E2eOutcome::kAccepted);

    queue.is_broken = true;
    EXPECT_EQ(sut.read(Instant{}, value), E2eWorth::kHeld);
    EXPECT_EQ(sut.get_checker().get_cause(), FrameCause::kTooShort);
    EXPECT_EQ(sut.get_checker().get_count(FrameCause::kRepeated), 0U);
}

TEST(E2eSourceTest, AgeOfAQueuedFrameIsItsOwn) {
    verifies("SWR-E2E-034", Technique::kBoundaryValues, Polarity::kViolation);
    Ends<M04, kYoung, Queue> ends{kSafe};
    ends.synchronise();
    const Instant start = ends.now;
    static_cast<void>(ends.in.push({ends.make({1.0, Gear::kDrive}), ++ends.revision, start}));
    static_cast<void>(ends.in.push({ends.make({2.0, Gear::kDrive}), ++ends.revision, start + 10_ms}));
    ends.in.open(start + 35_ms);

    EXPECT_EQ(ends.sut.read(start + 35_ms, ends.value), E2eWorth::kSubstitute);
    EXPECT_EQ(ends.sut.get_outcome(), E2eOutcome::kLate);
    EXPECT_EQ(ends.sut.read(start + 35_ms, ends.value), E2eWorth::kNew);
    EXPECT_EQ(ends.value.rad_s, 2.0);
}

// ---- Names ----

TEST(E2eOutcomeTest, EachOutcomeHasItsName) {
    verifies("SWR-E2E-035", Technique::kInterface);
    constexpr std::array<const char*, kE2eOutcomeCount> kOutcomes{
        "Accepted", "Silent", "Refused", "Malformed", "Early", "Late", "Unproven"};
    constexpr std::array<const char*, 3U> kWorths{"Substitute", "Held", "New"};

    for (std::size_t i = 0U; i < kOutcomes.size(); ++i) {
        EXPECT_STREQ(get_name(static_cast<E2eOutcome>(i)), kOutcomes[i]);
    }
    EXPECT_STREQ(get_name(static_cast<E2eOutcome>(kOutcomes.size())), "Invalid");
    for (std::size_t i = 0U; i < kWorths.size(); ++i) {
        EXPECT_STREQ(get_name(static_cast<E2eWorth>(i)), kWorths[i]);
    }
    EXPECT_STREQ(get_name(static_cast<E2eWorth>(kWorths.size())), "Invalid");
}

}  // namespace
}  // namespace e2e_port_test
