// SPDX-License-Identifier: Apache-2.0
/// @file
/// For the tests of what compares clocks: a clock that goes on by a given distance with each reading.
#ifndef MAMORI_SAFETY_TESTS_SUPPORT_FAKE_CLOCK_HPP
#define MAMORI_SAFETY_TESTS_SUPPORT_FAKE_CLOCK_HPP

#include <cstdint>

#include "mamori/safety/self_test/clock_check.hpp"

namespace mamori::safety {

class FakeClock final : public ClockSource {
  public:
    /// @param[in] distance_ns from one reading to the next; 0: it stands; below 0: it runs backwards.
    explicit FakeClock(std::int64_t distance_ns) noexcept : step_ns(distance_ns) {}
    Instant read() noexcept override {
        now_.ns += step_ns;
        return now_;
    }
    std::int64_t step_ns;

  private:
    Instant now_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_TESTS_SUPPORT_FAKE_CLOCK_HPP
