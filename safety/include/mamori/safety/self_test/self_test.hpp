// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a self test is: a pass over something in steps of bounded cost, so that it fits into the windows of a
/// running machine.
///
/// @satisfies SWR-SLF-001      Design: docs/design/self_tests.md#schedule
#ifndef MAMORI_SAFETY_SELF_TEST_SELF_TEST_HPP
#define MAMORI_SAFETY_SELF_TEST_SELF_TEST_HPP

#include <cstddef>

#include "mamori/safety/base/self_test_status.hpp"

namespace mamori::safety {

/// One self test. Called by a schedule, from one execution context.
class SelfTest {
  public:
    /// Begins a pass, whatever became of the one before.
    virtual void begin() noexcept = 0;
    /// Does the next step of the pass. Must not block.
    /// @return kRunning; kPassed (this was the last step, and nothing was found); kFailed.
    virtual SelfTestStatus step() noexcept = 0;
    /// @return steps of one pass that finds nothing, always the same number, >= 1.
    virtual std::size_t get_step_count() const noexcept = 0;

  protected:
    ~SelfTest() = default;
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_SELF_TEST_HPP
