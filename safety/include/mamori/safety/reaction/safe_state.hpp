// SPDX-License-Identifier: Apache-2.0
/// @file
/// States of a guarded machine, the events that move it, and the one table of its transitions. The design
/// note shows the same table as a diagram; a test compares the two.
///
/// @satisfies SWR-FSM-001, SWR-FSM-002, SWR-FSM-003, SWR-FSM-037
/// Design:   docs/design/safe_state.md#states
/// Source:   IEC 61800-5-2 (STO, SS1, SS2, SOS), IEC 60204-1 (stop categories 0, 1, 2)
#ifndef MAMORI_SAFETY_SAFE_STATE_HPP
#define MAMORI_SAFETY_SAFE_STATE_HPP

#include <array>
#include <cstddef>
#include <cstdint>

namespace mamori::safety {

/// Where the machine is. 0 is no state, so that cleared memory is not taken for one.
enum class SafeState : std::uint8_t {
    kSelfTest = 1U,           ///< torque off, brakes closed, tests run
    kStandby = 2U,            ///< torque off, brakes closed, ready
    kOperational = 3U,        ///< moves
    kDegraded = 4U,           ///< moves with reduced limits
    kProtectiveStopSs2 = 5U,  ///< controlled stop under way, will be held under torque
    kProtectiveStopSs1 = 6U,  ///< controlled stop under way, torque will be cut
    kStandstillHold = 7U,     ///< stands, held under torque (SOS)
    kSafe = 8U,               ///< torque off, brakes closed, waits for a deliberate reset; see brakes_first()
    kLockedOut = 9U,          ///< torque off, brakes closed, until power is cycled
    kLockedHold = 10U,        ///< stands, held under torque because its brakes failed, until power is cycled
};
inline constexpr std::size_t kSafeStateCount = 10U;

/// What happens to it, the most urgent first: of several events at once the first that changes the state
/// wins.
enum class SafeStateEvent : std::uint8_t {
    kLockOut,              ///< the machine cannot trust itself any more
    kSelfTestFailed,       ///< a self test failed, at power-up or later
    kDemandSto,            ///< torque off is demanded
    kDemandSs1,            ///< controlled stop, then torque off, is demanded
    kBrakesFailed,         ///< the machine stands, and its brakes do not close
    kStopTimeout,          ///< a stop was not confirmed within its bound
    kDemandSs2,            ///< controlled stop, then hold, is demanded
    kStandstillConfirmed,  ///< the stop is confirmed
    kDegrade,              ///< reduced limits are demanded
    kReset,                ///< a person reset it, and its conditions hold
    kRestore,              ///< a person lifted the reduced limits, and their reason is gone
    kSelfTestPassed,       ///< the self test of this visit passed
    kStart,                ///< a person started it, and its conditions hold
};
inline constexpr std::size_t kSafeStateEventCount = 13U;

/// Transitions: row = state, column = event, value = next state.
using SafeStateTable = std::array<std::array<SafeState, kSafeStateEventCount>, kSafeStateCount>;

/// True for one of the ten states.
constexpr bool is_valid(SafeState state) noexcept {
    return state >= SafeState::kSelfTest && state <= SafeState::kLockedHold;
}

namespace detail {

constexpr SafeStateTable make_safe_state_table() noexcept {
    constexpr auto kTest = SafeState::kSelfTest;
    constexpr auto kStby = SafeState::kStandby;
    constexpr auto kOper = SafeState::kOperational;
    constexpr auto kDegr = SafeState::kDegraded;
    constexpr auto kStp2 = SafeState::kProtectiveStopSs2;
    constexpr auto kStp1 = SafeState::kProtectiveStopSs1;
    constexpr auto kHold = SafeState::kStandstillHold;
    constexpr auto kSafe = SafeState::kSafe;
    constexpr auto kLock = SafeState::kLockedOut;
    constexpr auto kLHld = SafeState::kLockedHold;
    // clang-format off
    return {{
    //           Lock   Test   Sto    Ss1    Brakes Time   Ss2    Stands Degr   Reset  Lift   Passed Start
    /* kTest */ {{kLock, kLock, kSafe, kSafe, kTest, kTest, kSafe, kTest, kTest, kTest, kTest, kStby, kTest}},
    /* kStby */ {{kLock, kLock, kSafe, kSafe, kStby, kStby, kSafe, kStby, kStby, kStby, kStby, kStby, kOper}},
    /* kOper */ {{kLock, kLock, kSafe, kStp1, kOper, kOper, kStp2, kOper, kDegr, kOper, kOper, kOper, kOper}},
    /* kDegr */ {{kLock, kLock, kSafe, kStp1, kDegr, kDegr, kStp2, kDegr, kDegr, kDegr, kOper, kDegr, kDegr}},
    /* kStp2 */ {{kLock, kLock, kSafe, kStp1, kStp2, kStp1, kStp2, kHold, kStp2, kStp2, kStp2, kStp2, kStp2}},
    /* kStp1 */ {{kLock, kLock, kSafe, kStp1, kLHld, kSafe, kStp1, kSafe, kStp1, kStp1, kStp1, kStp1, kStp1}},
    /* kHold */ {{kLock, kLock, kSafe, kStp1, kHold, kHold, kHold, kHold, kHold, kStby, kHold, kHold, kHold}},
    /* kSafe */ {{kLock, kLock, kSafe, kSafe, kSafe, kSafe, kSafe, kSafe, kSafe, kTest, kSafe, kSafe, kSafe}},
    /* kLock */ {{kLock, kLock, kLock, kLock, kLock, kLock, kLock, kLock, kLock, kLock, kLock, kLock, kLock}},
    /* kLHld */ {{kLock, kLock, kLock, kLHld, kLHld, kLHld, kLHld, kLHld, kLHld, kLHld, kLHld, kLHld, kLHld}},
    }};
    // clang-format on
}

}  // namespace detail

/// The table. Both the machine and the documentation are made from it.
inline constexpr SafeStateTable kSafeStateTable = detail::make_safe_state_table();

/// @return state after `event`; kLockedOut for a corrupted state or event.
constexpr SafeState calc_next_state(SafeState state, SafeStateEvent event) noexcept {
    const auto column = static_cast<std::size_t>(event);
    if (!is_valid(state) || column >= kSafeStateEventCount) {
        return SafeState::kLockedOut;
    }
    return kSafeStateTable[static_cast<std::size_t>(state) - 1U][column];
}

/// Spelling for logs, reports and the diagram; "Invalid" for a corrupted value, never nullptr.
const char* get_name(SafeState state) noexcept;
const char* get_name(SafeStateEvent event) noexcept;

namespace detail {

/// A forgotten entry of the table is 0, which is no state.
constexpr bool is_complete(const SafeStateTable& table) noexcept {
    for (const auto& row : table) {
        for (const SafeState next : row) {
            if (!is_valid(next)) {
                return false;
            }
        }
    }
    return true;
}

static_assert(is_complete(kSafeStateTable), "every state needs an answer to every event");
static_assert(static_cast<std::size_t>(SafeState::kLockedHold) == kSafeStateCount);
static_assert(static_cast<std::size_t>(SafeStateEvent::kStart) + 1U == kSafeStateEventCount);

}  // namespace detail

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_SAFE_STATE_HPP
