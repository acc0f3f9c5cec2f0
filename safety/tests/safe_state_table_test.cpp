// SPDX-License-Identifier: Apache-2.0
// Goal: the compiled table is the wanted one in each of its 108 entries, and the design note shows the same.
// Method: every pair against an expectation written down independently; the diagram is read and compared.
#include <array>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "mamori/safety/reaction/safe_state.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using State = SafeState;
using Event = SafeStateEvent;
using Pair = std::pair<State, Event>;

constexpr std::array<State, kSafeStateCount> kStates{
    State::kSelfTest,          State::kStandby,           State::kOperational,    State::kDegraded,
    State::kProtectiveStopSs2, State::kProtectiveStopSs1, State::kStandstillHold, State::kSafe,
    State::kLockedOut,         State::kLockedHold};
constexpr std::array<Event, kSafeStateEventCount> kEvents{
    Event::kLockOut,      Event::kSelfTestFailed, Event::kDemandSto, Event::kDemandSs1,
    Event::kBrakesFailed, Event::kStopTimeout,    Event::kDemandSs2, Event::kStandstillConfirmed,
    Event::kDegrade,      Event::kReset,          Event::kRestore,   Event::kSelfTestPassed,
    Event::kStart};

/// What shall happen, said state by state; what is not named here leaves the state as it is.
std::map<Pair, State> make_expected_moves() {
    std::map<Pair, State> moves;
    for (const State state : kStates) {
        if (state != State::kLockedOut) {
            moves[{state, Event::kLockOut}] = State::kLockedOut;
            moves[{state, Event::kSelfTestFailed}] = State::kLockedOut;
            moves[{state, Event::kDemandSto}] = State::kSafe;
        }
    }
    moves[{State::kLockedHold, Event::kDemandSto}] = State::kLockedOut;
    moves[{State::kProtectiveStopSs1, Event::kBrakesFailed}] = State::kLockedHold;
    moves[{State::kSelfTest, Event::kSelfTestPassed}] = State::kStandby;
    moves[{State::kStandby, Event::kStart}] = State::kOperational;
    for (const State unpowered : {State::kSelfTest, State::kStandby}) {
        moves[{unpowered, Event::kDemandSs1}] = State::kSafe;
        moves[{unpowered, Event::kDemandSs2}] = State::kSafe;
    }
    for (const State moving : {State::kOperational, State::kDegraded}) {
        moves[{moving, Event::kDemandSs1}] = State::kProtectiveStopSs1;
        moves[{moving, Event::kDemandSs2}] = State::kProtectiveStopSs2;
    }
    moves[{State::kOperational, Event::kDegrade}] = State::kDegraded;
    moves[{State::kDegraded, Event::kRestore}] = State::kOperational;
    moves[{State::kProtectiveStopSs2, Event::kDemandSs1}] = State::kProtectiveStopSs1;
    moves[{State::kProtectiveStopSs2, Event::kStopTimeout}] = State::kProtectiveStopSs1;
    moves[{State::kProtectiveStopSs2, Event::kStandstillConfirmed}] = State::kStandstillHold;
    moves[{State::kProtectiveStopSs1, Event::kStopTimeout}] = State::kSafe;
    moves[{State::kProtectiveStopSs1, Event::kStandstillConfirmed}] = State::kSafe;
    moves[{State::kStandstillHold, Event::kDemandSs1}] = State::kProtectiveStopSs1;
    moves[{State::kStandstillHold, Event::kReset}] = State::kStandby;
    moves[{State::kSafe, Event::kReset}] = State::kSelfTest;
    return moves;
}

State get_expected(State state, Event event) {
    static const std::map<Pair, State> moves = make_expected_moves();
    const auto move = moves.find({state, event});
    return move == moves.end() || move->first.first == move->second ? state : move->second;
}

TEST(SafeStateTableTest, EveryStateAnswersEveryEventAsWanted) {
    verifies("SWR-FSM-001", Technique::kStateTransition);

    for (const State state : kStates) {
        for (const Event event : kEvents) {
            EXPECT_EQ(calc_next_state(state, event), get_expected(state, event))
                << get_name(state) << " on " << get_name(event) << " gives "
                << get_name(calc_next_state(state, event));
        }
    }
}

TEST(SafeStateTableTest, CorruptedStateOrEventGivesLockedOut) {
    verifies("SWR-FSM-001", Technique::kFaultInjection, Polarity::kViolation);
    // As a constant, so that a look past the end of the table does not compile.
    constexpr State kBehindTheTable =
        calc_next_state(State::kOperational, static_cast<Event>(kSafeStateEventCount));
    static_assert(kBehindTheTable == State::kLockedOut);

    for (unsigned value = 0U; value <= 255U; ++value) {
        const auto state = static_cast<State>(value);
        const auto event = static_cast<Event>(value);
        if (value == 0U || value > kSafeStateCount) {
            EXPECT_EQ(calc_next_state(state, Event::kStart), State::kLockedOut) << value;
            EXPECT_STREQ(get_name(state), "Invalid");
        }
        if (value >= kSafeStateEventCount) {
            EXPECT_EQ(calc_next_state(State::kOperational, event), State::kLockedOut) << value;
            EXPECT_STREQ(get_name(event), "Invalid");
        }
    }
}

TEST(SafeStateTableTest, NamesAreThoseOfTheReports) {
    verifies("SWR-FSM-001", Technique::kInterface);
    constexpr std::array<const char*, kSafeStateCount> kNames{
        "SelfTest",          "Standby",        "Operational", "Degraded",  "ProtectiveStopSs2",
        "ProtectiveStopSs1", "StandstillHold", "Safe",        "LockedOut", "LockedHold"};

    for (std::size_t i = 0U; i < kSafeStateCount; ++i) {
        EXPECT_STREQ(get_name(kStates[i]), kNames[i]);
    }
}

/// Moves drawn in the design note, as "From --> To: Event, Event".
std::set<std::string> read_diagram() {
    std::ifstream file{std::string{MAMORI_SOURCE_FOLDER} + "/docs/design/safe_state.md"};
    std::set<std::string> moves;
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words{line};
        std::string from;
        std::string arrow;
        std::string to;
        if (!(words >> from >> arrow >> to) || arrow != "-->" || from == "[*]") {
            continue;
        }
        to.erase(to.find_last_not_of(':') + 1U);
        std::string event;
        while (words >> event) {
            event.erase(event.find_last_not_of(',') + 1U);
            moves.insert(from + " --> " + to + ": " + event);
        }
    }
    return moves;
}

TEST(SafeStateTableTest, DiagramOfTheDesignNoteShowsExactlyTheCompiledMoves) {
    verifies("SWR-FSM-001", Technique::kBackToBack);
    std::set<std::string> compiled;
    for (const State state : kStates) {
        for (const Event event : kEvents) {
            const State next = calc_next_state(state, event);
            if (next != state) {
                compiled.insert(std::string{get_name(state)} + " --> " + get_name(next) + ": " +
                                get_name(event));
            }
        }
    }

    EXPECT_EQ(read_diagram(), compiled);
}

/// 0 no stop, 1 SS2, 2 SS1, 3 locked hold, 4 torque off, 5 locked out.
int get_stop_severity(State state) {
    switch (state) {
        case State::kSelfTest:
        case State::kStandby:
        case State::kOperational:
        case State::kDegraded:
            return 0;
        case State::kProtectiveStopSs2:
        case State::kStandstillHold:
            return 1;
        case State::kProtectiveStopSs1:
            return 2;
        case State::kLockedHold:
            return 3;
        case State::kSafe:
            return 4;
        case State::kLockedOut:
            return 5;
    }
    return -1;
}

TEST(SafeStateTableTest, ResetIsTheOnlyEventThatWeakensAStop) {
    verifies("SWR-FSM-002", Technique::kStateTransition, Polarity::kViolation);

    for (const State state : kStates) {
        for (const Event event : kEvents) {
            const State next = calc_next_state(state, event);
            if (get_stop_severity(next) < get_stop_severity(state)) {
                EXPECT_EQ(event, Event::kReset) << get_name(state);
                EXPECT_TRUE(next == State::kStandby || next == State::kSelfTest)
                    << "a reset must not move anything";
            }
        }
    }
}

/// All states after a number of events other than kReset.
std::set<State> calc_reached_without_reset(State from, int steps) {
    std::set<State> reached{from};
    for (int i = 0; i < steps; ++i) {
        std::set<State> next;
        for (const State state : reached) {
            for (const Event event : kEvents) {
                if (event != Event::kReset) {
                    next.insert(calc_next_state(state, event));
                }
            }
        }
        reached = next;
    }
    return reached;
}

TEST(SafeStateTableTest, NoSequenceWithoutAResetLeavesTheSafeState) {
    verifies("SWR-FSM-002", Technique::kStateTransition, Polarity::kViolation);

    for (int steps = 0; steps <= 20; ++steps) {
        for (const State state : calc_reached_without_reset(State::kSafe, steps)) {
            EXPECT_TRUE(state == State::kSafe || state == State::kLockedOut) << get_name(state);
        }
        for (const State state : calc_reached_without_reset(State::kStandstillHold, steps)) {
            EXPECT_GE(get_stop_severity(state), 1) << get_name(state);
        }
    }
}

TEST(SafeStateTableTest, NoEventRestartsALockedHold) {
    verifies("SWR-FSM-037", Technique::kStateTransition, Polarity::kViolation);

    for (const Event event : kEvents) {
        const State next = calc_next_state(State::kLockedHold, event);
        EXPECT_TRUE(next == State::kLockedHold || next == State::kLockedOut) << get_name(event);
    }
}

TEST(SafeStateTableTest, SeverestDemandReachesTorqueOffFromEveryStateInOneStep) {
    verifies("SWR-FSM-002", Technique::kStateTransition);

    for (const State state : kStates) {
        EXPECT_GE(get_stop_severity(calc_next_state(state, Event::kDemandSto)), 4) << get_name(state);
        EXPECT_EQ(calc_next_state(state, Event::kLockOut), State::kLockedOut) << get_name(state);
    }
}

TEST(SafeStateTableTest, EveryStateCanBeReachedFromPowerUp) {
    verifies("SWR-FSM-001", Technique::kStateTransition);
    std::set<State> reached{State::kSelfTest};
    for (std::size_t i = 0U; i < kSafeStateCount; ++i) {
        for (const State state : std::set<State>{reached}) {
            for (const Event event : kEvents) {
                reached.insert(calc_next_state(state, event));
            }
        }
    }

    EXPECT_EQ(reached.size(), kSafeStateCount);
}

TEST(SafeStateTableTest, LockedOutIsEnteredOnDemandFromEveryState) {
    verifies("SWR-FSM-003", Technique::kStateTransition);

    for (const State state : kStates) {
        EXPECT_EQ(calc_next_state(state, Event::kSelfTestFailed), State::kLockedOut) << get_name(state);
    }
}

TEST(SafeStateTableTest, LockedOutIsLeftByNoEvent) {
    verifies("SWR-FSM-003", Technique::kStateTransition, Polarity::kViolation);

    for (const Event event : kEvents) {
        EXPECT_EQ(calc_next_state(State::kLockedOut, event), State::kLockedOut) << get_name(event);
    }
}

TEST(SafeStateTableTest, TableWithAForgottenEntryIsRefused) {
    verifies("SWR-FSM-001", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(detail::make_safe_state_table(), kSafeStateTable);
    ASSERT_TRUE(detail::is_complete(kSafeStateTable));

    for (std::size_t state = 0U; state < kSafeStateCount; ++state) {
        for (std::size_t event = 0U; event < kSafeStateEventCount; ++event) {
            SafeStateTable table = kSafeStateTable;
            table[state][event] = SafeState{};
            EXPECT_FALSE(detail::is_complete(table)) << state << ", " << event;
        }
    }
}

TEST(SafeStateTableTest, OnlyTheTwoStopsTimeOut) {
    verifies("SWR-FSM-004", Technique::kStateTransition);

    for (const State state : kStates) {
        const bool is_stop = state == State::kProtectiveStopSs2 || state == State::kProtectiveStopSs1;
        EXPECT_EQ(calc_next_state(state, Event::kStopTimeout) != state, is_stop) << get_name(state);
    }
}

}  // namespace
}  // namespace mamori::safety
