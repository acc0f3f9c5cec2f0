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
/// @satisfies SWR-MOD-001, SWR-MOD-010      Design: docs/design/modes.md#the-table
#ifndef MAMORI_KERNEL_MODE_PART_HPP
#define MAMORI_KERNEL_MODE_PART_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/base/enumerator.hpp"
#include "mamori/kernel/base/type_list.hpp"
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

/// Enumerator of a mode, as a type.
template <auto kMode>
struct ModeEnumerator {};
/// Made by system_mode<kMode>() and safe_mode<kMode>().
template <auto kMode, typename... Cs>
struct EnumeratedModePart : SystemModePart<Cs...> {
    struct Types : SystemModePart<Cs...>::Types {
        using ModeEnumerators = detail::TypeList<ModeEnumerator<kMode>>;
    };
};
/// The same with an enumerator, which SystemModes::get_mode<Mode>() returns.
/// @tparam kMode its number is the index of the mode in the table, 0 for the first; all modes of a table are
/// of
///               the same enumeration, or none has an enumerator.
template <auto kMode, typename... Cs>
constexpr EnumeratedModePart<kMode, Cs...> system_mode(const char* name, const Runs<Cs...>& members,
                                                       ModeParameters set = {}) noexcept {
    return {system_mode(name, members, set)};
}
template <auto kMode, typename... Cs>
constexpr EnumeratedModePart<kMode, Cs...> safe_mode(const char* name, const Runs<Cs...>& members,
                                                     ModeParameters set = {}) noexcept {
    return {safe_mode(name, members, set)};
}

namespace detail {

/// Whether the numbers of `kModes` are 0, 1, ...
template <typename Sequence, auto... kModes>
inline constexpr bool kAreNumbered = false;
template <std::size_t... kIndices, auto... kModes>
inline constexpr bool kAreNumbered<std::index_sequence<kIndices...>, kModes...> =
    ((to_number(kModes) == kIndices) && ...);

/// Enumeration of the modes of a description.
template <typename List>
struct ModesOf {
    static constexpr bool kAreInOrder = true;
    static constexpr const std::uint8_t* kTag = nullptr;
};
template <auto kFirst, auto... kRest>
struct ModesOf<TypeList<ModeEnumerator<kFirst>, ModeEnumerator<kRest>...>> {
    static constexpr bool kAreInOrder =
        (std::is_same_v<decltype(kFirst), decltype(kRest)> && ...) &&
        kAreNumbered<std::make_index_sequence<1U + sizeof...(kRest)>, kFirst, kRest...>;
    static constexpr const std::uint8_t* kTag = &kEnumerationTag<std::remove_const_t<decltype(kFirst)>>;
};

}  // namespace detail

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
