// SPDX-License-Identifier: Apache-2.0
/// @file
/// Tests what a stop relies on, before each operation, against closed brakes: both paths that switch the
/// drives off, and the torque of each brake (SBT).
///
/// @satisfies SWR-SAF-026, SWR-SAF-027      Design: docs/design/safe_arm.md#start-up-tests
#ifndef EXAMPLES_SAFE_ARM_START_UP_CHECK_HPP
#define EXAMPLES_SAFE_ARM_START_UP_CHECK_HPP

#include <cstdint>

#include "arm_limits.hpp"
#include "mamori/safety/base/self_test_status.hpp"
#include "messages.hpp"

namespace safe_arm {

/// In this order.
enum class StartUpStep : std::uint8_t {
    kQuiet,          ///< good frames in a row: nothing to report, brakes closed, torque off, relay closed
    kTorqueOn,       ///< the drives report torque
    kRelayOpens,     ///< the relay alone takes it away
    kRelayCloses,    ///< and gives it back
    kPushForwards,   ///< each brake holds
    kPushBackwards,  ///< likewise
    kTorqueOff,      ///< safe torque off alone takes torque away
    kPassed,
};

/// What one frame shows.
struct StartUpFacts {
    bool is_good{
        false};  ///< nothing to report, and the watchdog watches: one that was never served would not
    JointReading reading{};
};

/// Thread safety: none. Time: O(joints) per frame. Memory: no heap.
class StartUpCheck final {
  public:
    /// Begins at kQuiet. @param[in] now of the first frame.
    void begin(mamori::Instant now) noexcept;

    /// One frame. @return kFailed for good once a step did not end in its time, a brake yielded, or a frame
    /// after kQuiet was not good; kPassed at the end.
    mamori::safety::SelfTestStatus step(const StartUpFacts& facts, mamori::Instant now) noexcept;

    StartUpStep get_step() const noexcept { return step_; }
    /// @name Commands of this frame. Torque only against closed brakes.
    /// @{
    bool is_torque_wanted() const noexcept {
        return step_ >= StartUpStep::kTorqueOn && step_ < StartUpStep::kTorqueOff && !has_failed_;
    }
    bool is_relay_wanted() const noexcept { return step_ != StartUpStep::kRelayOpens; }
    /// Of the torque limit, -1 .. 1.
    double get_push() const noexcept { return push_; }
    /// @}

  private:
    bool is_reached(const StartUpFacts& facts, mamori::Instant now) noexcept;
    bool is_push_over(const JointReading& reading, mamori::Instant now) noexcept;
    mamori::Duration get_time_max() const noexcept;

    StartUpStep step_{StartUpStep::kQuiet};
    mamori::Instant step_began_{};
    JointVector place_rad_{};  ///< before the push
    double push_{0.0};
    std::uint32_t good_frames_{0U};
    bool has_failed_{false};
};

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_START_UP_CHECK_HPP
