// SPDX-License-Identifier: Apache-2.0
// Broken: a state machine has a state that no transition leads to.
#include "mamori/kernel/component/fsm_check.hpp"

namespace {
constexpr std::array<mamori::FsmState, 2> kStates{{{"off"}, {"on"}}};
constexpr std::array<mamori::FsmMessage, 1> kMessages{{{"press"}}};
#ifdef MAMORI_BREAK
constexpr std::array<mamori::FsmTransition, 1> kTransitions{{{0U, 0U, 0U}}};
#else
constexpr std::array<mamori::FsmTransition, 1> kTransitions{{{0U, 0U, 1U}}};
#endif
constexpr mamori::FsmTable kLamp{"lamp", kStates, kMessages, kTransitions, 0U};
MAMORI_CHECK_FSM(kLamp);
}  // namespace
