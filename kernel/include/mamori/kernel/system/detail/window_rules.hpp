// SPDX-License-Identifier: Apache-2.0
/// @file
/// What MAMORI_CHECK says of a frame or a window that breaks a rule. Not for users.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_WINDOW_RULES_HPP
#define MAMORI_KERNEL_WINDOW_RULES_HPP

#include <cstddef>

#include "mamori/kernel/system/detail/table_rule.hpp"

namespace mamori {

namespace rules {

template <typename Element>
struct FrameIsPositive {
    static_assert(kKept<Element>, "a frame has a positive length");
};
template <typename WindowRow>
struct WindowRowIsValid {
    static_assert(kKept<WindowRow>,
                  "a window has a name, a positive period and components, at least one event per cycle, a "
                  "trigger exactly when it is triggered, and slower rates only when it is periodic");
};
template <typename WindowName>
struct WindowHasANameOfItsOwn {
    static_assert(kKept<WindowName>, "windows are told apart by their names");
};
template <typename WindowName, typename OtherName>
struct TriggerServesOneWindow {
    static_assert(kKept<WindowName>, "an ExternalTrigger releases one window");
};
template <typename WindowName>
struct PeriodDividesFrame {
    static_assert(kKept<WindowName>, "the period of a window divides the frame");
};
template <typename WindowName>
struct WindowIsInsideItsPeriod {
    static_assert(kKept<WindowName>, "a window opens and closes within its period, at most the frame");
};
template <typename WindowName, typename OtherName>
struct WindowsAreDisjoint {
    static_assert(kKept<WindowName>, "windows of one core never overlap");
};
template <typename WindowName>
struct BudgetIsInsideWindow {
    static_assert(kKept<WindowName>, "the budget of a window is positive and not longer than the window");
};
template <typename WindowName>
struct WorstCasesFitBudget {
    static_assert(kKept<WindowName>, "the declared worst cases of a window together fit into its budget");
};
template <typename C, std::size_t kInstance>
struct WorstCaseIsNotNegative {
    static_assert(kKept<C>, "the declared worst case of a component is not negative");
};
template <typename WindowName>
struct RateEqualsOccurrences {
    static_assert(kKept<WindowName>, "the declared rate of a window is that of its openings");
};
template <typename WindowName>
struct AlternativeRateDividesRate {
    static_assert(kKept<WindowName>,
                  "a slower rate is reached by leaving openings out, so it divides the first");
};

}  // namespace rules

}  // namespace mamori

#endif  // MAMORI_KERNEL_WINDOW_RULES_HPP
