// SPDX-License-Identifier: Apache-2.0
/// @file
/// Parts of a description that apply to the whole system: major frame, abort policy, publication margin and
/// trace hash.
///
/// @satisfies SWR-KRN-017, SWR-KRN-050, SWR-KRN-051      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_PART_HPP
#define MAMORI_KERNEL_SYSTEM_PART_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/context_plan.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"

namespace mamori {

/// Length of the major frame, after which the schedule repeats; the same for all cores.
struct Frame {
    Duration length;
};
/// @param[in] length > 0; MAMORI_CHECK rejects any other.
constexpr Frame frame(Duration length) noexcept {
    return {length};
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
