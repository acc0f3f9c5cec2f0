// SPDX-License-Identifier: Apache-2.0
/// @file
/// Row of a system table for a simulation: the modelled execution time of a component. No executive reads it.
///
/// @satisfies SWR-KRN-064      Design: docs/design/kernel.md#identity
#ifndef MAMORI_KERNEL_MODELLED_TIME_ROW_HPP
#define MAMORI_KERNEL_MODELLED_TIME_ROW_HPP

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/table/index_of.hpp"
#include "mamori/kernel/table/system_finding.hpp"

namespace mamori {

/// Modelled execution time of one component.
struct ModelledTimeRow {
    const Component* component{nullptr};
    Duration duration{};  ///< of the first pass, >= 0
};

/// First of `rows` that violates a rule, or Rule::kNone. O(rows * components).
/// @param[in] components of the table.
constexpr Finding check_modelled_times(Span<const ModelledTimeRow> rows,
                                       Span<Component* const> components) noexcept {
    for (std::size_t i = 0U; i < rows.size(); ++i) {
        if (rows[i].duration < Duration{0}) {
            return {Rule::kModelledTimeNegative, i};
        }
        if (find_component(components, rows[i].component) == kNoIndex) {
            return {Rule::kModelledTimeOfUnknownComponent, i};
        }
        for (std::size_t earlier = 0U; earlier < i; ++earlier) {
            if (rows[earlier].component == rows[i].component) {
                return {Rule::kModelledTimeStatedTwice, i, earlier};
            }
        }
    }
    return {};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODELLED_TIME_ROW_HPP
