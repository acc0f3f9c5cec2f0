// SPDX-License-Identifier: Apache-2.0
/// @file
/// Function index_of(...): index of a component or window in a system table, so that no user counts rows.
///
/// @satisfies SWR-KRN-063      Design: docs/design/kernel.md#identity
#ifndef MAMORI_KERNEL_INDEX_OF_HPP
#define MAMORI_KERNEL_INDEX_OF_HPP

#include <cstddef>

#include "mamori/kernel/base/assert.hpp"
#include "mamori/kernel/base/text.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

class Component;

/// Index of `component` in `components`, an array or span of pointers to components; kNoIndex: not one of
/// them. O(components). Any calling context.
template <typename Components>
constexpr std::size_t find_component(const Components& components, const Component* component) noexcept {
    for (std::size_t i = 0U; i < components.size(); ++i) {
        if (components[i] == component) {
            return i;
        }
    }
    return kNoIndex;
}

namespace detail {

/// Index of the row with this name; kNoIndex: none.
template <typename Rows>
constexpr std::size_t find_named(const Rows& rows, const char* name) noexcept {
    for (std::size_t i = 0U; i < rows.size() && name != nullptr; ++i) {
        if (rows[i].name != nullptr && make_text(rows[i].name) == make_text(name)) {
            return i;
        }
    }
    return kNoIndex;
}

}  // namespace detail

/// Index of `component` in a SystemTable or SystemView, 0 .. number of components - 1. A constant expression
/// for a constexpr table; O(components). Any calling context.
/// @param[in] component of the table; any other is a compile error in a constant expression, else a contract
///                      violation.
template <typename Table>
constexpr std::size_t index_of(const Table& table, const Component& component) noexcept {
    const std::size_t index = find_component(table.components, &component);
    const bool is_component_of_the_table = index != kNoIndex;
    MAMORI_REQUIRE(1, is_component_of_the_table);
    return index;
}
/// Index of the window with this name, 0 .. number of windows - 1; otherwise as for a component. O(windows).
/// @param[in] window name of a window of the table; any other is a violation as above.
template <typename Table>
constexpr std::size_t index_of(const Table& table, const char* window) noexcept {
    const std::size_t index = detail::find_named(table.windows, window);
    const bool is_window_of_the_table = index != kNoIndex;
    MAMORI_REQUIRE(2, is_window_of_the_table);
    return index;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_INDEX_OF_HPP
