// SPDX-License-Identifier: Apache-2.0
// Goal: the components between links and safety components forward what is fresh, and close the outputs by
// themselves. Method: each component alone; both sides of the age limit.
#include "hil_components.hpp"

#include <gtest/gtest.h>

#include "hil_controller.hpp"
#include "hil_system.hpp"
#include "mamori/trace/verifies.hpp"
#include "tests/feed.hpp"

namespace safe_arm {
namespace {

using mamori::Instant;
using mamori::Status;
using mamori::safety::SafeState;
using namespace mamori::verification;

TEST(DeviceImageTest, KeepsTheImageUntilTheFirstAnswerAndThenCopiesEachOne) {
    verifies("SWR-HIL-002", Technique::kRequirementsBased, Polarity::kNominal);
    static mamori::safety::ArmInputs image;
    static DeviceImage sut{image};
    ASSERT_EQ(sut.on_execute({}), Status::kOk);
    EXPECT_FALSE(image.power_good);

    DeviceFrame answer{};
    answer.inputs.power_good = true;
    answer.inputs.encoder_a_counts[6] = -5;
    feed(sut.device, answer);
    ASSERT_EQ(sut.on_execute({}), Status::kOk);
    EXPECT_TRUE(image.power_good);
    EXPECT_EQ(image.encoder_a_counts[6], -5);
}

class ReadingFilterTest : public ::testing::Test {
  protected:
    bool is_forwarded(std::int64_t answered_ns, std::int64_t now_ns) {
        DeviceFrame answer{};
        answer.answered_ns = answered_ns;
        feed(sut_.device, answer);
        feed(sut_.in, JointReading{});
        EXPECT_EQ(sut_.on_execute({0, Instant{now_ns}}), Status::kOk);
        return sut_.out.publish(Instant{now_ns});
    }
    ReadingFilter sut_;
};

TEST_F(ReadingFilterTest, ForwardsAReadingUpToTheAgeLimitOfItsAnswer) {
    verifies("SWR-HIL-002", Technique::kBoundaryValues, Polarity::kNominal);
    EXPECT_TRUE(is_forwarded(0, 0));
    EXPECT_TRUE(is_forwarded(1'000'000, 1'000'000 + kDeviceAgeMax.ns));
}

TEST_F(ReadingFilterTest, ForwardsNothingOfAnOldOrFutureAnswerOrWithoutOne) {
    verifies("SWR-HIL-002", Technique::kBoundaryValues, Polarity::kViolation);
    static ReadingFilter fresh;
    feed(fresh.in, JointReading{});
    ASSERT_EQ(fresh.on_execute({0, Instant{0}}), Status::kOk);
    EXPECT_FALSE(fresh.out.publish(Instant{0}));

    EXPECT_FALSE(is_forwarded(1'000'000, 1'000'000 + kDeviceAgeMax.ns + 1));
    EXPECT_FALSE(is_forwarded(2'000'000, 1'000'000));
}

TEST(ControllerViewTest, TellsTheControllerStateAndDecision) {
    verifies("SWR-HIL-001", Technique::kRequirementsBased, Polarity::kNominal);
    static ControllerView sut;
    JointState state{};
    state.position_rad[2] = 0.25;
    state.velocity_rad_s[3] = -1.5;
    StopCommand stop{};
    stop.state = SafeState::kOperational;
    stop.torque_enable = true;
    feed(sut.state, state);
    feed(sut.stop, stop);

    ASSERT_EQ(sut.on_execute({0, Instant{7'400'000}}), Status::kOk);
    const ControllerInput& input = take(sut.out);
    EXPECT_EQ(input.sent_at_ns, 7'400'000);
    EXPECT_EQ(input.position_rad, state.position_rad);
    EXPECT_EQ(input.velocity_rad_s, state.velocity_rad_s);
    EXPECT_TRUE(input.is_operational);
    EXPECT_TRUE(input.torque_enable);
}

class DriveEncoderTest : public ::testing::Test {
  protected:
    const DriveFrame& encode() {
        StopCommand stop{};
        stop.torque_enable = true;
        feed(sut_.stop, stop);
        EXPECT_EQ(sut_.on_execute({0, Instant{12'600'000}}), Status::kOk);
        return take(sut_.out);
    }
    mamori::safety::ArmOutputs outputs_{};
    mamori::ports::virtual_time::VirtualWatchdog mirror_{kWatchdogTimeout};
    LinkWatchdog watchdog_{mirror_};
    DriveEncoder sut_{outputs_, watchdog_, hil::supervisor, hil::safety_state};
};

TEST_F(DriveEncoderTest, SendsTheOutputsWithFrameAndWatchdogServices) {
    verifies("SWR-HIL-002", Technique::kRequirementsBased, Polarity::kNominal);
    outputs_.torque_enable = true;
    outputs_.torque_nm[1] = 12.0;
    ASSERT_EQ(watchdog_.service(Instant{0}), Status::kOk);

    const DriveFrame& frame = encode();
    EXPECT_EQ(frame.frame, 12U);
    EXPECT_EQ(frame.watchdog_services, 1U);
    EXPECT_TRUE(frame.outputs.torque_enable);
    EXPECT_EQ(frame.outputs.torque_nm[1], 12.0);
    EXPECT_FALSE(frame.report.is_stopping);
    EXPECT_EQ(frame.report.first_fault, mamori::safety::kNoFault);
}

TEST_F(DriveEncoderTest, SendsSafeOutputsOnceTheyAreClosed) {
    verifies("SWR-HIL-002", Technique::kFaultInjection, Polarity::kViolation);
    outputs_.torque_enable = true;
    outputs_.brake_release = true;
    outputs_.torque_nm[1] = 12.0;
    sut_.close();

    const DriveFrame& frame = encode();
    EXPECT_FALSE(frame.outputs.torque_enable);
    EXPECT_FALSE(frame.outputs.brake_release);
    EXPECT_EQ(frame.outputs.torque_nm[1], 0.0);
    EXPECT_TRUE(frame.report.is_stopping);
}

TEST_F(DriveEncoderTest, AnExpiredWatchdogCountsNoService) {
    verifies("SWR-HIL-003", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(watchdog_.service(Instant{0}), Status::kOk);
    mirror_.check(Instant{} + kWatchdogTimeout + mamori::Duration{1});

    EXPECT_EQ(watchdog_.service(Instant{} + kWatchdogTimeout + kFrame), Status::kError);
    EXPECT_EQ(watchdog_.get_service_count(), 1U);
}

TEST(HangPointTest, ReturnsWithoutTheFaultBeforeItAndOnceReleased) {
    verifies("SWR-HIL-006", Technique::kFaultInjection, Polarity::kViolation);
    static HangPoint sut;
    EXPECT_EQ(sut.on_execute({0, Instant{0}}), Status::kOk);
    mamori::sim::FaultPlan fault{};
    fault.kind = mamori::sim::FaultKind::kSupervisorHang;
    fault.at = kFrame;
    sut.configure(fault);
    EXPECT_EQ(sut.on_execute({0, Instant{0}}), Status::kOk);

    sut.release();
    EXPECT_EQ(sut.on_execute({0, Instant{} + kFrame}), Status::kOk);
}

}  // namespace
}  // namespace safe_arm
