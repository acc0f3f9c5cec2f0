// SPDX-License-Identifier: Apache-2.0
/// @file
/// Self test of a clock against a second one: their ratio over a window.
///
/// @satisfies SWR-SLF-011      Design: docs/design/self_tests.md#clocks
#ifndef MAMORI_SAFETY_SELF_TEST_CLOCK_CHECK_HPP
#define MAMORI_SAFETY_SELF_TEST_CLOCK_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/redundancy/clock_ratio.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

/// A clock as a port offers it.
class ClockSource {
  public:
    /// Must not block. @return time since some zero point of the clock.
    virtual Instant read() noexcept = 0;

  protected:
    ~ClockSource() = default;
};

/// Compares two clocks in each of its steps.
///
/// Thread safety: none. Time: a step reads each clock once. Memory: no heap.
class ClockCheck final : public SelfTest {
  public:
    /// @param[in] reference, checked of different causes, such as two crystals; must outlive this object.
    /// @param[in] step_count of a pass, in which a whole window must be over by at least one clock: >= 2.
    constexpr ClockCheck(ClockSource& reference, ClockSource& checked, const ClockRatioLimits& limits,
                         std::size_t step_count) noexcept
        : reference_(reference), checked_(checked), limits_(limits), ratio_(limits), step_count_(step_count) {
        MAMORI_REQUIRE(1, step_count >= 2U);
    }

    void begin() noexcept override;
    /// @return as any test; kFailed also when no window was over in all steps: then both clocks stand.
    SelfTestStatus step() noexcept override;
    std::size_t get_step_count() const noexcept override { return step_count_; }

  private:
    ClockSource& reference_;
    ClockSource& checked_;
    ClockRatioLimits limits_;
    ClockRatio ratio_;
    std::size_t step_count_;
    std::size_t step_{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_CLOCK_CHECK_HPP
