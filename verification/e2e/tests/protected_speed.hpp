// SPDX-License-Identifier: Apache-2.0
/// @file
/// The system of docs/manual/e2e.md, whose code blocks are parts of this file.
#ifndef MAMORI_VERIFICATION_E2E_PROTECTED_SPEED_HPP
#define MAMORI_VERIFICATION_E2E_PROTECTED_SPEED_HPP

#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/e2e/e2e.hpp"

struct Speed {
    double rad_s{0.0};
};
MAMORI_FIELDS(Speed, rad_s)

namespace mamori::protected_speed {

using namespace mamori::literals;
namespace safety = mamori::safety;

// 12 bytes of header, 8 of the stamp, 8 of the speed: 28 bytes, the shortest and the longest frame.
inline constexpr safety::SentIdChannel kSpeedChannel{0x0A0B0C0DU, 28U, 28U};
using SafeSpeed = safety::E2eMessage<safety::Stamped<Speed>, safety::E2eProfile04<>, kSpeedChannel>;

class Planner final : public mamori::Component {
  public:
    constexpr Planner() noexcept : Component("planner") {}
    mamori::OutPort<SafeSpeed::Frame> out{*this, "speed"};
    using Ports = mamori::Ports<&Planner::out>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override {
        wanted_rad_s += 0.5;
        return is_silent ? mamori::Status::kOk : speed_.write({context.now.ns, {wanted_rad_s}});
    }

    double wanted_rad_s{0.0};
    bool is_silent{false};

  private:
    safety::E2eOutPort<SafeSpeed> speed_{out};
};

inline constexpr safety::E2eInLimits<safety::HardenedSequence> kSpeedLimits{
    25_ms,                            // no value older than this is handed out
    {2U},                             // one lost frame is no break of the order
    10U,                              // the state of the channel looks back on so many readings, and demands:
    {{2U, 0U}, {2U, 2U}, {6U, 0U}}};  // good ones, damaged ones at most; to become, stay, be valid again

class Drive final : public mamori::Component {
  public:
    constexpr Drive() noexcept : Component("drive") {}
    mamori::InPort<SafeSpeed::Frame> in{*this, "speed"};
    using Ports = mamori::Ports<&Drive::in>;

    mamori::Status on_execute(mamori::ContextHandle context) noexcept override {
        SafeSpeed::Value speed{};
        worth = speed_.read(context.now, speed);  // in each cycle: silence is seen by reading
        setpoint_rad_s = speed.value.rad_s;       // standstill, where no speed may be used
        return mamori::Status::kOk;
    }

    double setpoint_rad_s{0.0};
    safety::E2eWorth worth{safety::E2eWorth::kSubstitute};
    const auto& get_protection() const noexcept { return speed_; }

  private:
    static constexpr SafeSpeed::Value kStandstill{};
    safety::E2eInPort<SafeSpeed, kSpeedLimits> speed_{in, kStandstill};
};

static Planner planner;
static Drive drive;
static constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("drive", 0_ms, 2_ms, mamori::budget(1_ms), mamori::run(drive)),
    mamori::window("plan", 5_ms, 2_ms, mamori::budget(1_ms), mamori::run(planner)),
    mamori::connect(planner.out, drive.in, mamori::any_age()));
MAMORI_CHECK(kSystem);

}  // namespace mamori::protected_speed

#endif  // MAMORI_VERIFICATION_E2E_PROTECTED_SPEED_HPP
