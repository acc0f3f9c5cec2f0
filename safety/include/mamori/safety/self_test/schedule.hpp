// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs self tests one after the other, one step per cycle: once at power-up, and then over and over within
/// the test interval. A test that finds a fault, is too late, or does not do all its steps is a failure.
///
/// @satisfies SWR-SLF-001, SWR-SLF-002, SWR-SLF-003, SWR-SLF-004      Design:
/// docs/design/self_tests.md#schedule Source:   IEC 61508-4:2010 3.8.7 (diagnostic test interval)
#ifndef MAMORI_SAFETY_SELF_TEST_SCHEDULE_HPP
#define MAMORI_SAFETY_SELF_TEST_SCHEDULE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

/// Why a schedule failed.
enum class SelfTestFailure : std::uint8_t {
    kNone,
    kFault,      ///< the test found a fault
    kOverdue,    ///< the pass did not end within the interval, or the clock ran backwards
    kStepCount,  ///< the test ended before or after its declared number of steps: it did not do its work
};

/// Schedule of self tests.
///
/// Thread safety: none; call step() once per cycle. Time: that of one step of one test. Memory: no heap.
class SelfTestSchedule final {
  public:
    /// @param[in] tests    in the order in which they run; they and the span must outlive this object;
    ///                     size >= 1, none is nullptr.
    /// @param[in] interval in which every test ends a pass, from the end of one pass of all to that of the
    ///                     next: > 0.
    constexpr SelfTestSchedule(Span<SelfTest* const> tests, Duration interval) noexcept
        : tests_(tests), interval_(interval) {
        MAMORI_REQUIRE(1, !tests.empty() && interval > Duration{0});
    }

    /// Begins the power-up pass; also that of a restart.
    /// @param[in] period distance between two calls of step().
    /// @return kOk; kBadParameter (period <= 0, or a pass would not end within the interval: no step would be
    ///         wrong, and all would be too late); kPreconditionNotMet (a failure is latched).
    Status start(Instant now, Duration period) noexcept;

    /// Does one step.
    /// @return kRunning until the first pass since start() has ended; then kPassed, while passes follow one
    ///         another; kFailed from a failure on, for good.
    SelfTestStatus step(Instant now) noexcept;

    constexpr SelfTestStatus get_status() const noexcept { return status_; }
    constexpr SelfTestFailure get_failure() const noexcept { return failure_; }
    /// @return number of the test that runs, or that failed; of the one that was late, when the pass was.
    constexpr std::size_t get_test() const noexcept { return test_; }
    /// @return whole passes since power-up; wraps.
    constexpr std::uint32_t get_pass_count() const noexcept { return passes_; }
    /// @return steps of one pass of all tests.
    std::size_t calc_step_count() const noexcept;

  private:
    void begin(std::size_t test) noexcept;
    void end_test(Instant now) noexcept;
    SelfTestStatus fail(SelfTestFailure failure) noexcept;

    Span<SelfTest* const> tests_;
    Duration interval_;
    Instant pass_began_{};
    std::size_t test_{0U};
    std::size_t steps_{0U};
    std::uint32_t passes_{0U};
    SelfTestStatus status_{SelfTestStatus::kRunning};
    SelfTestFailure failure_{SelfTestFailure::kNone};
    bool is_started_{false};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_SCHEDULE_HPP
