// SPDX-License-Identifier: Apache-2.0
/// @file
/// The static description of a state machine: states, messages and transitions as constants of the program,
/// and who acts on which of them. The rules that a table must keep: fsm_check.hpp.
///
/// @satisfies SWR-RTC-006      Design: docs/design/rtc_semantics.md#state-machines
/// Source:   OMG RTC 1.0, FsmProfile, FsmBehavior; OMG FSM4RTC, FsmEventProfile
#ifndef MAMORI_KERNEL_FSM_TABLE_HPP
#define MAMORI_KERNEL_FSM_TABLE_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"

namespace mamori {

class Component;
class FsmComponent;

/// Row of a state or message in its table.
using FsmIndex = std::uint16_t;

/// One message on its way to a state machine.
struct FsmEvent {
    FsmIndex message{0U};      ///< row of the table
    std::int64_t argument{0};  ///< meaning depends on the message; larger data goes through a data port
};

/// One state; its number is its row.
struct FsmState {
    const char* name{nullptr};  ///< static storage; unique in the table
};
/// One message that the machine knows; its number is its row.
struct FsmMessage {
    const char* name{nullptr};  ///< static storage; unique in the table
    const char* data_type{""};  ///< what the argument means, for tools
};
/// May the transition be taken? Pure: it changes nothing and is asked at most once per event, by the core
/// that runs the machine.
using FsmGuard = bool (*)(const FsmComponent& machine, const FsmEvent& event) noexcept;
/// In state `source`, `message` leads to state `target`.
struct FsmTransition {
    FsmIndex source{0U};
    FsmIndex message{0U};
    FsmIndex target{0U};
    FsmGuard guard{nullptr};  ///< nullptr: it may always be taken
};

/// The rows outlive every machine that runs them. Of several transitions for one state and message, the first
/// whose guard allows it is taken.
struct FsmTable {
    const char* name{nullptr};  ///< static storage
    Span<const FsmState> states{};
    Span<const FsmMessage> messages{};
    Span<const FsmTransition> transitions{};
    FsmIndex initial{0U};  ///< row of the first state
};

/// What a participant acts on: a state (its exit and its entry) or a transition (while it is taken).
struct FsmElement {
    enum class Kind : std::uint8_t { kState, kTransition };
    Kind kind{Kind::kState};
    std::size_t index{0U};  ///< row of the table
};
/// The participant whose on_action is called for the element; it is in the context of the machine.
struct FsmBehavior {
    Component* action_component{nullptr};
    FsmElement id{};
};
/// All participants of one machine; the rows outlive it.
using FsmProfile = Span<const FsmBehavior>;

}  // namespace mamori

#endif  // MAMORI_KERNEL_FSM_TABLE_HPP
