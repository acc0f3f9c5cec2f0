// SPDX-License-Identifier: Apache-2.0
/// @file
/// Functions that describe the modes of a system, as parts of mamori::system(...):
///
///     mamori::system_mode("idle", mamori::runs(encoder, drive)),             // initial mode
///     mamori::system_mode("work", mamori::runs(encoder, drive, planner), mamori::parameters("fast")),
///     mamori::system_mode("teach", mamori::runs(encoder, drive, hand), mamori::parameters("slow")),
///     mamori::safe_mode("halt", mamori::runs(encoder)),
///     mamori::mode_transition("idle", Command::kTeach, "teach"), ...
///     mamori::connect(planner.setpoint, drive.setpoint, mamori::only_in("work"), mamori::any_age()),
///     mamori::connect(hand.setpoint, drive.setpoint, mamori::any_age()),     // hand runs in "teach" only
///
/// @satisfies SWR-MOD-001      Design: docs/design/modes.md#the-table
#ifndef MAMORI_KERNEL_MODE_PART_HPP
#define MAMORI_KERNEL_MODE_PART_HPP

#include <array>
#include <cstddef>

#include "mamori/kernel/base/enumerator.hpp"
#include "mamori/kernel/system/detail/part_types.hpp"
#include "mamori/kernel/table/mode_table.hpp"

namespace mamori {

/// Made by runs().
template <typename... Cs>
struct Runs {
    std::array<Component*, sizeof...(Cs)> components{};
};
/// Components that are Active in a mode; all others are Inactive. They must outlive the table, and a window
/// of the table must run each of them.
template <typename... Cs>
constexpr Runs<Cs...> runs(Cs&... components) noexcept {
    return {{&components...}};
}

/// Made by parameters().
struct ModeParameters {
    const char* set_name{nullptr};
};
/// Configuration set of a mode. @param[in] set_name static storage, as in configuration_set().
constexpr ModeParameters parameters(const char* set_name) noexcept {
    return {set_name};
}

/// Made by system_mode() and safe_mode().
template <typename... Cs>
struct SystemModePart {
    struct Types : detail::NoTypes {
        using Members = detail::TypeList<Cs...>;
        static constexpr std::size_t kModes = 1U;
    };
    SystemModeRow row{};
    std::array<Component*, sizeof...(Cs)> members{};
};
/// One mode of the system, at most kSystemModeMax. The system starts in the first mode listed.
/// @param[in] name static storage; unique. @param[in] set without it, the mode changes no parameter.
template <typename... Cs>
constexpr SystemModePart<Cs...> system_mode(const char* name, const Runs<Cs...>& members,
                                            ModeParameters set = {}) noexcept {
    return {{name, set.set_name, kNoIndex, false}, members.components};
}
/// Mode in which a failed mode switch ends. Its components run in every mode, so that the switch to it
/// activates no component. No transition leaves it, only SystemModes::reset(). Parameters as in
/// system_mode().
template <typename... Cs>
constexpr SystemModePart<Cs...> safe_mode(const char* name, const Runs<Cs...>& members,
                                          ModeParameters set = {}) noexcept {
    return {{name, set.set_name, kNoIndex, true}, members.components};
}

/// Made by mode_transition().
template <typename Event>
struct ModeTransitionPart {
    struct Types : detail::NoTypes {
        using Events = detail::TypeList<Event>;
        static constexpr std::size_t kModeTransitions = 1U;
    };
    ModeTransitionRow row{};
};
/// In mode `source`, `event` leads to mode `target`. Each pair of mode and event has at most one transition.
/// SystemModes::request() rejects an event for which the current mode has no transition.
/// @param[in] source, target names of modes, static storage. @param[in] event enumerator of the application,
///                           at most 32 bits; all events of a table are of the same enumeration.
template <typename Event>
constexpr ModeTransitionPart<Event> mode_transition(const char* source, Event event,
                                                    const char* target) noexcept {
    return {{source, target, detail::to_number(event), kNoIndex, kNoIndex}};
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_MODE_PART_HPP
