// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks of the assumptions that every system of this layer makes: a tick source that advances at its
/// declared rate, things of the platform that must be in effect, and whatever a self test can show.
///
/// @satisfies SWR-AOU-004, SWR-AOU-005, SWR-AOU-006      Design: docs/design/assumptions.md#checks
#ifndef MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_CHECKS_HPP
#define MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_CHECKS_HPP

#include "mamori/safety/assumptions/assumption_table.hpp"
#include "mamori/safety/redundancy/clock_ratio.hpp"
#include "mamori/safety/self_test/clock_check.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

/// The tick source advances at its declared rate, as a second clock measures it.
class TickSourceCheck final : public AssumptionCheck {
  public:
    /// @param[in] reference, tick of different causes; must outlive this object.
    constexpr TickSourceCheck(ClockSource& reference, ClockSource& tick,
                              const ClockRatioLimits& limits) noexcept
        : reference_(reference), tick_(tick), ratio_(limits) {}

    /// @return kRunning until a window is over; kFailed from the first one on that deviates.
    SelfTestStatus check() noexcept override;

  private:
    ClockSource& reference_;
    ClockSource& tick_;
    ClockRatio ratio_;
};

/// Something that the platform provides, and that can be asked whether it is in effect: a watchdog that is
/// armed and would cut the torque, memory protection that is switched on with the regions of this system, a
/// guard of budgets that is armed.
class Provision {
  public:
    /// Reads it back from where it takes effect, a register or the system, not from what was asked for.
    /// Must not block.
    virtual bool is_in_effect() noexcept = 0;

  protected:
    ~Provision() = default;
};

/// A provision is in effect.
class ProvisionCheck final : public AssumptionCheck {
  public:
    /// @param[in] provision must outlive this object.
    explicit constexpr ProvisionCheck(Provision& provision) noexcept : provision_(provision) {}

    /// @return kRunning while it was never in effect; kPassed; kFailed when it was, and is no more.
    SelfTestStatus check() noexcept override;

  private:
    Provision& provision_;
    bool was_in_effect_{false};
};

/// One pass of a self test, such as that of the processor for the mode of its floating-point unit.
class SelfTestCheck final : public AssumptionCheck {
  public:
    /// @param[in] test not one of a schedule; must outlive this object.
    explicit constexpr SelfTestCheck(SelfTest& test) noexcept : test_(test) {}

    /// Does one step until the pass has ended.
    SelfTestStatus check() noexcept override;

  private:
    SelfTest& test_;
    SelfTestStatus status_{SelfTestStatus::kRunning};
    bool has_begun_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_ASSUMPTIONS_ASSUMPTION_CHECKS_HPP
