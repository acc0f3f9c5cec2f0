// SPDX-License-Identifier: Apache-2.0
/// @file
/// Static description of a state machine: states, messages and transitions as constants, and the participants
/// of each state and transition. The rules for a table: fsm_check.hpp.
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

/// One message to a state machine.
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
    const char* data_type{""};  ///< meaning of the argument, for tools
};
/// Decides whether the transition may be taken. Pure. The core that runs the machine calls it at most once
/// per event.
using FsmGuard = bool (*)(const FsmComponent& machine, const FsmEvent& event) noexcept;
/// In state `source`, `message` leads to state `target`.
struct FsmTransition {
    FsmIndex source{0U};
    FsmIndex message{0U};
    FsmIndex target{0U};
    FsmGuard guard{nullptr};  ///< nullptr: always allowed
};

/// Table of a state machine. The rows must outlive every machine that uses them. If several transitions match
/// state and message, the machine takes the first one that its guard allows.
struct FsmTable {
    const char* name{nullptr};  ///< static storage
    Span<const FsmState> states{};
    Span<const FsmMessage> messages{};
    Span<const FsmTransition> transitions{};
    FsmIndex initial{0U};  ///< row of the initial state
};

/// Element that a participant acts on: a state (exit and entry) or a transition (while it is taken).
struct FsmElement {
    enum class Kind : std::uint8_t { kState, kTransition };
    Kind kind{Kind::kState};
    std::size_t index{0U};  ///< row of the table
};
/// The participant whose on_action is called for the element; it must be in the context of the machine.
struct FsmBehavior {
    Component* action_component{nullptr};
    FsmElement id{};
};
/// All participants of one machine; the rows must outlive it.
using FsmProfile = Span<const FsmBehavior>;

}  // namespace mamori

#endif  // MAMORI_KERNEL_FSM_TABLE_HPP
