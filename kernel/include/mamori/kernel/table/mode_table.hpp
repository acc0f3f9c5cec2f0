// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rows of the modes of a system: which components run in a mode, with which parameters, and which event
/// leads to which other mode. Users write the words of mode_part.hpp and never fill rows by hand.
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

/// One mode. The first of a table is the one that a system starts in.
struct SystemModeRow {
    const char* name{nullptr};      ///< static storage, as all names of these rows
    const char* set_name{nullptr};  ///< configuration set of the mode; nullptr: it changes no parameter
    std::size_t set{kNoIndex};      ///< the set's place in the configuration
    bool is_safe{false};            ///< where a switch that fails ends
};
/// A component runs in a mode.
struct ModeMemberRow {
    Component* component{nullptr};
    std::size_t mode{0U};         ///< row of the mode
    std::size_t index{kNoIndex};  ///< the component's place in the system table
};
/// In mode `source`, `event` leads to mode `target`.
struct ModeTransitionRow {
    const char* source_name{nullptr};
    const char* target_name{nullptr};
    std::uint32_t event{0U};       ///< its number in the application's enumeration
    std::size_t source{kNoIndex};  ///< row of the mode; kNoIndex: there is none of that name
    std::size_t target{kNoIndex};  ///< likewise
};
/// A connection holds in a mode; one without such a row holds in all.
struct ConnectionModeRow {
    const char* mode_name{nullptr};
    std::size_t connection{0U};  ///< row of the system table
    std::size_t mode{kNoIndex};  ///< row of the mode; kNoIndex: there is none of that name
};

/// Rows with their sizes in the type.
template <std::size_t kModes, std::size_t kMembers, std::size_t kTransitions, std::size_t kConnectionModes>
struct ModeTable {
    std::array<SystemModeRow, kModes> modes{};
    std::array<ModeMemberRow, kMembers> members{};
    std::array<ModeTransitionRow, kTransitions> transitions{};
    std::array<ConnectionModeRow, kConnectionModes> connection_modes{};
    const std::uint8_t* event_enumeration{nullptr};  ///< tag of the enumeration of all events
};

/// The same rows without their sizes in the type; refers to the table, which must outlive it.
struct ModeView {
    Span<const SystemModeRow> modes{};
    Span<const ModeMemberRow> members{};
    Span<const ModeTransitionRow> transitions{};
    Span<const ConnectionModeRow> connection_modes{};
    const std::uint8_t* event_enumeration{nullptr};  ///< nullptr: rows filled by hand, for any enumeration
};

/// @param[in] table must outlive the view.
template <std::size_t kM, std::size_t kC, std::size_t kT, std::size_t kN>
constexpr ModeView make_view(const ModeTable<kM, kC, kT, kN>& table) noexcept {
    return {table.modes, table.members, table.transitions, table.connection_modes, table.event_enumeration};
}

/// Mode in which a failed switch ends; kNoIndex when the table declares none. O(modes).
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
