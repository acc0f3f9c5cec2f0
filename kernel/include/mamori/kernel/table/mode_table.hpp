// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of the modes of a system: the components and parameters of each mode, and the events that lead to
/// other modes. Users call the functions of mode_part.hpp and never fill rows directly.
///
/// @satisfies SWR-MOD-001      Design: docs/design/modes.md#the-table
/// Source:   Dynamic Deployment and Configuration for RTC (OMG DDC4RTC): static application configurations
///           and the supervisor state machine that switches between them
#ifndef MAMORI_KERNEL_MODE_TABLE_HPP
#define MAMORI_KERNEL_MODE_TABLE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/table/mode_mask.hpp"
#include "mamori/kernel/table/table_index.hpp"

namespace mamori {

class Component;

/// One mode. A system starts in the first mode of its table.
struct SystemModeRow {
    const char* name{nullptr};      ///< static storage, as all names of these rows
    const char* set_name{nullptr};  ///< configuration set; nullptr: the mode changes no parameter
    std::size_t set{kNoIndex};      ///< index of the set in the configuration; kNoIndex: none
    bool is_safe{false};            ///< a failed mode switch ends in this mode
};
/// A component runs in a mode.
struct ModeMemberRow {
    Component* component{nullptr};
    std::size_t mode{0U};         ///< row of the mode
    std::size_t index{kNoIndex};  ///< index of the component in the system table; kNoIndex: none
};
/// In mode `source`, `event` leads to mode `target`.
struct ModeTransitionRow {
    const char* source_name{nullptr};
    const char* target_name{nullptr};
    std::uint32_t event{0U};       ///< its number in the enumeration of the application
    std::size_t source{kNoIndex};  ///< row of the mode; kNoIndex: no mode has this name
    std::size_t target{kNoIndex};  ///< row of the mode; kNoIndex: no mode has this name
};
/// A connection is active in a mode. A connection without such a row is active in all modes.
struct ConnectionModeRow {
    const char* mode_name{nullptr};
    std::size_t connection{0U};  ///< row of the connection in the system table
    std::size_t mode{kNoIndex};  ///< row of the mode; kNoIndex: no mode has this name
};

/// Rows with their number in the type.
template <std::size_t kModes, std::size_t kMembers, std::size_t kTransitions, std::size_t kConnectionModes>
struct ModeTable {
    std::array<SystemModeRow, kModes> modes{};
    std::array<ModeMemberRow, kMembers> members{};
    std::array<ModeTransitionRow, kTransitions> transitions{};
    std::array<ConnectionModeRow, kConnectionModes> connection_modes{};
    const std::uint8_t* event_enumeration{nullptr};  ///< tag of the enumeration of all events
    const std::uint8_t* mode_enumeration{nullptr};   ///< tag of the enumeration of all modes; nullptr: none
};

/// The same rows without their number in the type; refers to the table, which must outlive the view.
struct ModeView {
    Span<const SystemModeRow> modes{};
    Span<const ModeMemberRow> members{};
    Span<const ModeTransitionRow> transitions{};
    Span<const ConnectionModeRow> connection_modes{};
    const std::uint8_t* event_enumeration{nullptr};  ///< nullptr: rows filled directly, any enumeration
    const std::uint8_t* mode_enumeration{nullptr};   ///< nullptr: the modes have names only
};

/// @param[in] table must outlive the view.
template <std::size_t kM, std::size_t kC, std::size_t kT, std::size_t kN>
constexpr ModeView make_view(const ModeTable<kM, kC, kT, kN>& table) noexcept {
    return {table.modes,
            table.members,
            table.transitions,
            table.connection_modes,
            table.event_enumeration,
            table.mode_enumeration};
}

/// Mode in which a failed mode switch ends; kNoIndex: the table declares none. O(modes).
constexpr std::size_t find_safe_mode(const ModeView& view) noexcept {
    for (std::size_t m = 0U; m < view.modes.size(); ++m) {
        if (view.modes[m].is_safe) {
            return m;
        }
    }
    return kNoIndex;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_TABLE_HPP
