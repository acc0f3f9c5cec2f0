// SPDX-License-Identifier: Apache-2.0
/// @file
/// MAMORI_CHECK: rejects a constexpr system table that violates a rule of table_rules.hpp. The message names
/// the faulty element by its type, its port or its window, for example
/// `InputHasOneWriter<SpeedMonitor, &SpeedMonitor::joints, 0>`.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_RULES_HPP
#define MAMORI_KERNEL_SYSTEM_RULES_HPP

#include "mamori/kernel/system/detail/rule_messages.hpp"
#include "mamori/kernel/table/system_check.hpp"

/// Rejects the constexpr system table `table`, made by mamori::system(), if it violates a rule.
#define MAMORI_CHECK(table) \
    static_assert(::mamori::detail::keeps_rules<table>(), "the system table violates the rule named above")

#endif  // MAMORI_KERNEL_SYSTEM_RULES_HPP
