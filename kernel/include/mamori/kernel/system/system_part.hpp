// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parts of a description that apply to the whole system: major frame, abort policy, publication margin,
/// action budget, trace hash and modelled times; and groups of parts.
///
/// @satisfies SWR-KRN-017, SWR-KRN-050, SWR-KRN-051, SWR-KRN-064, SWR-KRN-092      Design:
/// docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_PART_HPP
#define MAMORI_KERNEL_SYSTEM_PART_HPP

#include <cstddef>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/table/modelled_time_row.hpp"

namespace mamori {

/// Length of the major frame, after which the schedule repeats; the same for all cores.
struct Frame {
    Duration length;
};
/// @param[in] length > 0; MAMORI_CHECK rejects any other.
constexpr Frame frame(Duration length) noexcept {
    return {length};
}

/// Made by parts().
template <typename... Parts>
struct PartGroup {
    using Types = detail::NoTypes;
};
template <typename First, typename... Rest>
struct PartGroup<First, Rest...> {
    using Types = detail::JoinedTypes<First, Rest...>;
    First first;
    PartGroup<Rest...> rest;
};
constexpr PartGroup<> parts() noexcept {
    return {};
}
/// Several parts as one, for parts that more than one table has, for example its faults and reactions.
/// @param[in] first, rest parts of a description, in this order.
template <typename First, typename... Rest>
constexpr PartGroup<First, Rest...> parts(const First& first, const Rest&... rest) noexcept {
    return {first, parts(rest...)};
}

/// Made by abort_policy().
struct AbortPolicyPart {
    using Types = detail::NoTypes;
    AbortPolicy policy;
};
/// Actions that are called when a component enters Error, for the whole system; default kSpecOnly.
constexpr AbortPolicyPart abort_policy(AbortPolicy policy) noexcept {
    return {policy};
}

/// Made by modelled_time().
template <typename C>
struct ModelledTimePart {
    struct Types : detail::NoTypes {
        using ModelledComponents = detail::TypeList<C>;
    };
    ModelledTimeRow row{};
};
/// Execution time of `component` in a simulation, for each first pass; without this part 0. Only a simulated
/// host reads it, for example VirtualHostFor.
/// @param[in] component run by a window; must outlive the table. @param[in] duration >= 0; MAMORI_CHECK
///                      rejects a negative one, another component and a second time of one component.
template <typename C>
constexpr ModelledTimePart<C> modelled_time(const C& component, Duration duration) noexcept {
    return {{&component, duration}};
}

/// Made by publication_margin().
struct PublicationMarginPart {
    using Types = detail::NoTypes;
    Duration margin;
};
/// Minimum time from the end of a window to the start of a window on another core that reads its outputs. In
/// virtual time, a window publishes exactly at its end, and the default of 0 is sufficient. In real time, its
/// work can return at the planned end. The publication follows after the wake-up of the runner and the
/// copies; state more than both.
/// @param[in] margin >= 0; MAMORI_CHECK rejects a negative one and a reader that starts earlier.
constexpr PublicationMarginPart publication_margin(Duration margin) noexcept {
    return {margin};
}

/// Made by action_budget().
struct ActionBudgetPart {
    struct Types : detail::NoTypes {
        static constexpr std::size_t kActionBudgets = 1U;
    };
    Duration budget;
};
/// Maximum time of each action that a machine calls outside windows, as on_startup; without this part 1 s
/// (kActionBudget). A machine closes the outputs when an action exceeds it.
/// @param[in] budget > 0, at most 1 h; MAMORI_CHECK rejects any other.
constexpr ActionBudgetPart action_budget(Duration budget) noexcept {
    return {budget};
}

/// Made by trace_hash().
struct TraceHashPart {
    struct Types : detail::NoTypes {
        static constexpr bool kHasTraceHash = true;
    };
};
/// Requests the hash over all publications, Executive::get_trace_hash(). Without this part, no payload is
/// hashed, and the functions for it are not linked.
constexpr TraceHashPart trace_hash() noexcept {
    return {};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_SYSTEM_PART_HPP
