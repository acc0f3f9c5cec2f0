// SPDX-License-Identifier: Apache-2.0
// Goal: counts become radians, feedback is passed on, the mode of the system follows the selector. Method: a
// process image filled here; for the modes, a system in virtual time that runs the reader and a component
// that can hang.
#include "arm_reader.hpp"

#include <utility>
#include <vector>

#include "arm_faults.hpp"
#include "arm_safety.hpp"
#include "feed.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/trace/verifies.hpp"

namespace safe_arm {
namespace {

using mamori::Status;
using namespace mamori::verification;
namespace virtual_time = mamori::ports::virtual_time;

class Other final : public mamori::Component {
  public:
    constexpr Other() noexcept : Component("other") {}
    using Ports = mamori::Ports<>;
};
struct Parts {
    mamori::safety::ArmInputs inputs{};
    ArmReader reader{inputs};
    Other other{};
};
auto make_table(Parts& parts) {
    return mamori::system(
        mamori::frame(kFrame), make_arm_modes(parts.reader, parts.other),
        mamori::window("read", 0_us, 500_us, mamori::budget(500_us), mamori::run(parts.reader)),
        mamori::window("other", 500_us, 500_us, mamori::budget(500_us), mamori::run(parts.other)));
}
EncoderScale make_scale() {
    EncoderScale scale{};
    scale.a_counts_per_rad.fill(1000.0);
    scale.b_counts_per_rad.fill(100.0);
    return scale;
}

class ArmReaderTest : public ::testing::Test {
  protected:
    void SetUp() override { sut_.set_modes(modes_); }

    Parts parts_;
    decltype(make_table(parts_)) table_{make_table(parts_)};
    mamori::SystemModes modes_{mamori::make_view(table_)};
    mamori::safety::ArmInputs& inputs_{parts_.inputs};
    ArmReader& sut_{parts_.reader};
};

TEST_F(ArmReaderTest, CountsBecomeRadiansAndFeedbackIsPassedOn) {
    verifies("SWR-SAF-004");
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    inputs_.encoder_a_counts[2] = -1500;
    inputs_.encoder_b_counts[6] = 25;
    inputs_.reference_closed[2] = true;
    inputs_.drive_clock_ns = 77;
    inputs_.brake_closed.fill(true);
    inputs_.power_good = true;
    inputs_.measured_torque_nm[1] = 4.5;

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    const JointReading reading = take(sut_.reading);
    EXPECT_EQ(reading.position_a_rad[2], -1.5);
    EXPECT_EQ(reading.position_b_rad[6], 0.25);
    EXPECT_TRUE(reading.brakes_closed);
    EXPECT_FALSE(reading.brakes_open);
    EXPECT_TRUE(reading.power_good);
    EXPECT_EQ(reading.measured_torque_nm[1], 4.5);
    EXPECT_TRUE(reading.reference_closed[2]);
    EXPECT_FALSE(reading.reference_closed[3]);
    EXPECT_EQ(reading.drive_clock_ns, 77);
}

TEST_F(ArmReaderTest, ThePanelIsEvaluatedInEachFrame) {
    verifies("SWR-SAF-030", Technique::kInterface);
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    inputs_.start_button = true;
    inputs_.enabling_closed.fill(true);
    inputs_.mode_selected[1] = true;
    const std::array<bool, 4U> pushed{false, true, true, false};
    for (std::size_t i = 0U; i < pushed.size(); ++i) {
        inputs_.reset_button = pushed[i];
        ASSERT_EQ(sut_.on_execute({0, mamori::Instant{} + kPushMin * static_cast<std::int64_t>(i)}),
                  Status::kOk);
    }
    const JointReading reading = take(sut_.reading);
    EXPECT_EQ(reading.panel_faults, to_bit(ArmFault::kEmergencyStop) | to_bit(ArmFault::kProtectiveStop) |
                                        to_bit(ArmFault::kRunReleased))
        << "an image that was not filled";
    EXPECT_TRUE(reading.is_mode_changing);
    EXPECT_TRUE(reading.reset_button);
    EXPECT_EQ(reading.mode, OperatingMode::kHoldToRun)
        << "the strictest one, until the system has another one";
    EXPECT_FALSE(reading.start_button);
}

TEST_F(ArmReaderTest, OneClosedBrakeIsNotOpenBrakes) {
    verifies("SWR-SAF-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_TRUE(take(sut_.reading).brakes_open);
    inputs_.brake_closed[0] = true;

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_FALSE(take(sut_.reading).brakes_open);
}

TEST_F(ArmReaderTest, OneOpenBrakeIsNotClosedBrakes) {
    verifies("SWR-SAF-004", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    inputs_.brake_closed.fill(true);
    inputs_.brake_closed[5] = false;

    ASSERT_EQ(sut_.on_execute({}), Status::kOk);
    EXPECT_FALSE(take(sut_.reading).brakes_closed);
}

TEST_F(ArmReaderTest, ReaderWithoutAUsableResolutionRefusesToStart) {
    verifies("SWR-SAF-004", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(sut_.on_activated({}), Status::kPreconditionNotMet);
    EncoderScale scale = make_scale();
    scale.b_counts_per_rad[3] = 0.0;
    EXPECT_EQ(sut_.configure(scale), Status::kBadParameter);
    EXPECT_EQ(sut_.on_activated({}), Status::kPreconditionNotMet);

    ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
    EXPECT_EQ(sut_.on_activated({}), Status::kOk);
    ArmReader without_modes{inputs_};
    ASSERT_EQ(without_modes.configure(make_scale()), Status::kOk);
    EXPECT_EQ(without_modes.on_activated({}), Status::kPreconditionNotMet);
}

/// Turns the selector in the middle of a run.
class ArmModesTest : public ArmReaderTest {
  protected:
    void run(OperatingMode first, OperatingMode second, std::uint64_t hangs_at = kFrames,
             std::uint64_t turned_back_at = kFrames) {
        ASSERT_EQ(sut_.configure(make_scale()), Status::kOk);
        sut_.set_modes(modes_);
        ASSERT_EQ(executive_.initialize(), Status::kOk);
        ASSERT_EQ(executive_.start(), Status::kOk);
        for (std::uint64_t frame = 0U; frame < kFrames; ++frame) {
            const bool is_hanging = frame >= hangs_at && frame < hangs_at + 20U;
            ASSERT_EQ(host_.set_duration(parts_.other, is_hanging ? virtual_time::kNever : 10_us),
                      Status::kOk);
            inputs_.mode_selected = {};
            const bool is_first = frame < kTurned || frame >= turned_back_at;
            inputs_.mode_selected[2U - static_cast<std::size_t>(is_first ? first : second)] = true;
            runner_.run_frame();
            const JointReading& now = sut_.reading.get_published();
            seen_.push_back(now.mode);
            is_fault_.push_back(now.is_mode_changing ||
                                (now.panel_faults & to_bit(ArmFault::kModeSelector)) != 0U);
        }
    }

    static constexpr std::uint64_t kFrames = 100U;
    static constexpr std::uint64_t kTurned = 50U;
    static constexpr std::size_t kSwitchFrames = 7U;  ///< docs/design/modes.md#the-switch
    mamori::ExecutiveFor<decltype(table_)> executive_{table_, modes_};
    virtual_time::VirtualHostFor<decltype(table_)> host_{table_};
    std::array<virtual_time::SimulatedCore, 1U> cores_{{{executive_, host_}}};
    mamori::NoDevices devices_;
    virtual_time::FrameRunner runner_{cores_, devices_};
    std::vector<OperatingMode> seen_;  ///< in each frame
    std::vector<bool> is_fault_;
};

class EachTransition : public ArmModesTest, public ::testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(EachTransition, OfTheSelectorIsOneOfTheSystemAndAFaultUntilThen) {
    verifies("SWR-SAF-061", Technique::kStateTransition);
    const auto first = static_cast<OperatingMode>(GetParam().first);
    const auto second = static_cast<OperatingMode>(GetParam().second);
    run(first, second);

    EXPECT_EQ(seen_[0], OperatingMode::kHoldToRun) << "the strictest mode first";
    for (std::size_t i = 0U; i < kFrames; ++i) {
        const std::size_t since_turn = i < kTurned ? i : i - kTurned;
        const OperatingMode before = i < kTurned ? OperatingMode::kHoldToRun : first;
        const OperatingMode shown = i < kTurned ? first : second;
        EXPECT_EQ(seen_[i], since_turn < kSwitchFrames ? before : shown) << i;
        EXPECT_EQ(is_fault_[i], seen_[i] != shown) << i;
    }
    EXPECT_EQ(modes_.get_failure().cause, mamori::ModeFailureCause::kNone);
}
INSTANTIATE_TEST_SUITE_P(ArmModes, EachTransition,
                         ::testing::Values(std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 0}, std::pair{1, 2},
                                           std::pair{2, 0}, std::pair{2, 1}));

TEST_F(ArmModesTest, ASwitchThatFailsEndsInTheSafeModeAndStaysAFault) {
    verifies("SWR-SAF-061", Technique::kFaultInjection, Polarity::kViolation);
    run(OperatingMode::kReducedSpeed, OperatingMode::kAutomatic, kTurned + 1U);

    EXPECT_NE(modes_.get_failure().cause, mamori::ModeFailureCause::kNone);
    EXPECT_EQ(seen_.back(), OperatingMode::kSwitchFailed);
    for (std::size_t i = kTurned; i < seen_.size(); ++i) {
        EXPECT_TRUE(is_fault_[i]) << i;
        EXPECT_NE(seen_[i], OperatingMode::kAutomatic) << i;
    }
}

TEST_F(ArmModesTest, ASelectorThatIsTurnedBackDuringAModeSwitchIsAFaultUntilTheSystemIsBack) {
    verifies("SWR-SAF-061", Technique::kErrorGuessing, Polarity::kViolation);
    run(OperatingMode::kReducedSpeed, OperatingMode::kAutomatic, kFrames, kTurned + 3U);

    for (std::size_t i = kTurned; i < kTurned + 2U * kSwitchFrames; ++i) {
        EXPECT_TRUE(is_fault_[i]) << i;
    }
    EXPECT_EQ(seen_.back(), OperatingMode::kReducedSpeed);
    EXPECT_FALSE(is_fault_.back());
}

TEST_F(ArmModesTest, AHangOutsideASwitchChangesNoMode) {
    verifies("SWR-SAF-061", Technique::kErrorGuessing);
    run(OperatingMode::kReducedSpeed, OperatingMode::kAutomatic, 20U);

    EXPECT_EQ(seen_.back(), OperatingMode::kAutomatic);
}

}  // namespace
}  // namespace safe_arm
