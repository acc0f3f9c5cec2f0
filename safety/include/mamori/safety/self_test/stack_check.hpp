// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks a stack that was painted before its use: guard words at its end that nobody may touch, and a margin
/// that nobody may use. What is still painted also tells how much was used at most.
///
/// @satisfies SWR-SLF-010      Design: docs/design/self_tests.md#stack
#ifndef MAMORI_SAFETY_SELF_TEST_STACK_CHECK_HPP
#define MAMORI_SAFETY_SELF_TEST_STACK_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/safety/self_test/ram_area.hpp"
#include "mamori/safety/self_test/self_test.hpp"

namespace mamori::safety {

/// Limits of one stack. Unit: words of RamArea.
struct StackLimits {
    std::size_t guard_words{1U};     ///< at the lowest addresses, looked at in each step: >= 1
    std::size_t used_words_max{0U};  ///< allowed, included; leaves the guard: 0 .. size - guard
    std::size_t words_per_step{1U};  ///< of the margin looked at in a step: >= 1
};

/// Check of one stack, which grows to lower addresses.
///
/// Thread safety: reads only, so the stack may be in use. Time: a step is O(guard + words per step),
///                calc_used_words() is O(size). Memory: no heap.
class StackCheck final : public SelfTest {
  public:
    /// @param[in] stack the whole stack, lowest address first.
    StackCheck(const RamArea& stack, const StackLimits& limits) noexcept : stack_(stack), limits_(limits) {
        MAMORI_REQUIRE(1, limits.guard_words >= 1U && limits.words_per_step >= 1U);
        MAMORI_REQUIRE(2, limits.guard_words <= stack.size());
        MAMORI_REQUIRE(3, limits.used_words_max <= stack.size() - limits.guard_words);
    }

    /// Paints the words that are not used yet. Before the stack is used, or from far enough below its top.
    /// @param[in] unused_words counted from the lowest address; at least what the limits do not allow to use.
    void paint(std::size_t unused_words) noexcept;

    void begin() noexcept override { next_ = 0U; }
    SelfTestStatus step() noexcept override;
    std::size_t get_step_count() const noexcept override {
        return (calc_margin() + limits_.words_per_step - 1U) / limits_.words_per_step;
    }

    /// @return words used at most since paint(), 0 .. size.
    std::size_t calc_used_words() const noexcept;

  private:
    std::size_t calc_margin() const noexcept { return stack_.size() - limits_.used_words_max; }
    bool is_painted(std::size_t from, std::size_t to) const noexcept;

    RamArea stack_;
    StackLimits limits_;
    std::size_t next_{0U};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SELF_TEST_STACK_CHECK_HPP
