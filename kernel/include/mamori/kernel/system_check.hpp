// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rules that a system table must keep, as constant expressions: the compiler refuses a table that breaks one
/// and prints the rule and the index of the guilty row.
///
/// @satisfies SWR-KRN-018      Design: docs/design/kernel.md#system-table
#ifndef MAMORI_KERNEL_SYSTEM_CHECK_HPP
#define MAMORI_KERNEL_SYSTEM_CHECK_HPP

#include <cstddef>

#include "mamori/kernel/system_table.hpp"

namespace mamori {

/// Why a table is refused. `Finding::element` is the index of the row named here.
enum class Rule {
    kNone,                    ///< the table keeps every rule
    kFrameNotPositive,        ///< no row: element is 0
    kWindowOutsideFrame,      ///< window
    kWindowsOverlap,          ///< window that begins before the one listed before it has closed
    kBudgetExceedsWindow,     ///< window whose budget is not in 1 ns .. its length
    kComponentInTwoPlaces,    ///< component, second place
    kPortOfUnknownComponent,  ///< connection that names a port of no component in the table
    kInputNotConnected,       ///< port row: mandatory input without a connection
    kInputHasTwoWriters,      ///< connection, second one into the same input
};

struct Finding {
    Rule rule{Rule::kNone};
    std::size_t element{0U};
};

namespace detail {

constexpr Finding check_windows(const SystemView& view) noexcept {
    if (view.frame <= Duration{0}) {
        return {Rule::kFrameNotPositive, 0U};
    }
    for (std::size_t i = 0U; i < view.windows.size(); ++i) {
        const WindowRow& row = view.windows[i];
        // Written without sums, which could overflow.
        if (row.offset < Duration{0} || row.length <= Duration{0} || row.offset > view.frame ||
            row.length > view.frame - row.offset) {
            return {Rule::kWindowOutsideFrame, i};
        }
        if (row.budget <= Duration{0} || row.budget > row.length) {
            return {Rule::kBudgetExceedsWindow, i};
        }
        // Windows are listed in the order in which they run.
        if (i > 0U && view.windows[i - 1U].offset + view.windows[i - 1U].length > row.offset) {
            return {Rule::kWindowsOverlap, i};
        }
    }
    return {};
}

constexpr Finding check_components(const SystemView& view) noexcept {
    for (std::size_t i = 0U; i < view.components.size(); ++i) {
        for (std::size_t j = 0U; j < i; ++j) {
            if (view.components[i] == view.components[j]) {
                return {Rule::kComponentInTwoPlaces, i};
            }
        }
    }
    return {};
}

constexpr std::size_t count_writers(const SystemView& view, const InPortBase* input,
                                    std::size_t end) noexcept {
    std::size_t count = 0U;
    for (std::size_t i = 0U; i < end; ++i) {
        if (view.connections[i].sink == input) {
            ++count;
        }
    }
    return count;
}

constexpr Finding check_connections(const SystemView& view) noexcept {
    for (std::size_t i = 0U; i < view.connections.size(); ++i) {
        const ConnectionRow& row = view.connections[i];
        if (row.source_window == kNoIndex || row.sink_window == kNoIndex) {
            return {Rule::kPortOfUnknownComponent, i};
        }
        if (count_writers(view, row.sink, i) > 0U) {
            return {Rule::kInputHasTwoWriters, i};
        }
    }
    for (std::size_t i = 0U; i < view.ports.size(); ++i) {
        const PortRow& row = view.ports[i];
        if (row.input != nullptr && row.is_mandatory &&
            count_writers(view, row.input, view.connections.size()) == 0U) {
            return {Rule::kInputNotConnected, i};
        }
    }
    return {};
}

/// Instantiated by MAMORI_CHECK; a refused table shows its rule and element as the arguments of this
/// template.
template <Rule kRule, std::size_t kElement>
struct SystemTableKeeps {
    static_assert(kRule == Rule::kNone, "the system table breaks the rule named in the template arguments");
    static constexpr bool kValue = kRule == Rule::kNone;
};

}  // namespace detail

/// First broken rule, or kNone. Constant expression for a constexpr table; O(rows squared).
constexpr Finding check(const SystemView& view) noexcept {
    const Finding windows = detail::check_windows(view);
    if (windows.rule != Rule::kNone) {
        return windows;
    }
    const Finding components = detail::check_components(view);
    if (components.rule != Rule::kNone) {
        return components;
    }
    return detail::check_connections(view);
}

}  // namespace mamori

/// Refuses the constexpr system table `table` at compile time when it breaks a rule.
#define MAMORI_CHECK(table)                                                                  \
    static_assert(                                                                           \
        ::mamori::detail::SystemTableKeeps<::mamori::check(::mamori::make_view(table)).rule, \
                                           ::mamori::check(::mamori::make_view(table)).element>::kValue)

#endif  // MAMORI_KERNEL_SYSTEM_CHECK_HPP
