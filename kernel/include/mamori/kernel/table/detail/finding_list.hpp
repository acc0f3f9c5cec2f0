// SPDX-License-Identifier: Apache-2.0
/// @file
/// Storage for the findings of a check of a system table. Not for users.
///
/// @satisfies SWR-KRN-018, SWR-KRN-025      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_FINDING_LIST_HPP
#define MAMORI_KERNEL_FINDING_LIST_HPP

#include <cstddef>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/table/system_finding.hpp"

namespace mamori::detail {

/// Stores findings up to its capacity and counts all of them.
class FindingList final {
  public:
    constexpr explicit FindingList(Span<Finding> storage) noexcept : storage_(storage) {}
    constexpr void add(Rule rule, std::size_t element, std::size_t other = 0U) noexcept {
        if (count_ < storage_.size()) {
            storage_[count_] = {rule, element, other};
        }
        ++count_;
    }
    constexpr std::size_t get_count() const noexcept { return count_; }

  private:
    Span<Finding> storage_;
    std::size_t count_{0U};
};

}  // namespace mamori::detail

#endif  // MAMORI_KERNEL_FINDING_LIST_HPP
