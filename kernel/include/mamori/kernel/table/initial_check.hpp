// SPDX-License-Identifier: Apache-2.0
/// @file
/// The check of a table before its first use: of each rule, or only of what the compiler cannot see when it
/// has checked the rest. Not for users.
///
/// @satisfies SWR-KRN-025, SWR-KRN-070      Design: docs/design/kernel.md#initial-check
#ifndef MAMORI_KERNEL_INITIAL_CHECK_HPP
#define MAMORI_KERNEL_INITIAL_CHECK_HPP

#include "mamori/kernel/table/system_check.hpp"
#include "mamori/kernel/table/system_finding.hpp"
#include "mamori/kernel/table/system_table.hpp"

namespace mamori::detail {

/// @return the first finding of a table, or one with Rule::kNone.
using InitialCheck = Finding (*)(const SystemView& view) noexcept;

/// Each rule: check().
Finding check_everything(const SystemView& view) noexcept;

/// @name What a constant expression cannot read: names, ports and parameters of the component objects,
/// functions in rows, and the number of elements of a parameter. Precondition: check() has no finding.
/// @{
/// For a table without parameters: none of its components may have one.
Finding check_objects(const SystemView& view) noexcept;
Finding check_objects_with_parameters(const SystemView& view) noexcept;
/// @}

/// The check that a table without a finding of check() still needs, if the compiler found none.
constexpr InitialCheck choose_check(const SystemView& view) noexcept {
    return view.configuration.parameters.empty() ? &check_objects : &check_objects_with_parameters;
}

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_INITIAL_CHECK_HPP
