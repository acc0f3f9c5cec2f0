// SPDX-License-Identifier: Apache-2.0
// Goal: every combination of state, operation, answer, running or stopped, and abort policy does what the
// standard says, with nothing sampled. Method: the oracle below is written by hand from the standard's text;
// each combination is run from a fresh component and compared in answer, actions, state and running.
#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <string>
#include <vector>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/kernel/component/multi_mode.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/every_status.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

/// What is done; the actions after the slash answer with the code that is enumerated, all others with kOk.
enum class Operation {
    kInitialize,        // / on_initialize
    kFinalize,          // / on_finalize
    kExit,              // / on_finalize
    kExitDeactivating,  // / on_deactivated
    kStart,             // / on_startup
    kStop,              // / on_shutdown
    kActivate,          // / on_activated
    kActivateAborting,  // / on_activated, on_deactivated, on_aborting
    kDeactivate,        // / on_deactivated
    kReset,             // / on_reset
    kDetach,            //
    kGetState,          //
    kAdd,               //
    kRemove,            //
    kSetRateZero,       //
    kSetRateForeign,    //
    kCycle,             // / on_execute
    kCycleUpdating,     // / on_state_update
    kCycleInError,      // / on_error
    kCycleAborting,     // / on_execute, on_deactivated, on_aborting
    kRateThenCycle,     // / on_rate_changed
    kModeThenCycle,     // / on_mode_changed
    kModeImmediately,   // / on_mode_changed
};
constexpr std::size_t kOperationCount = 23U;

/// Expectations are text: result, actions, state. Result: O kOk, B kBadParameter, U kUnsupported,
/// P kPreconditionNotMet, C the enumerated code. Actions: those in braces are called under kOpenRtmCompat
/// only. State: C I A E, or = as before.
struct Row {
    Operation operation;
    const char* states;   // of C I A E
    const char* running;  // of R S
    const char* good;     // the code is kOk
    const char* bad;      // the code is one of the five others
    char running_after;   // S, r (R when the code is kOk), or = as before
};

constexpr const char* kRefused = "P =";
constexpr const char* kBad = "B =";
constexpr const char* kUnsupported = "U =";
constexpr const char* kNothing = "O =";
using Op = Operation;

constexpr std::array kOracle{
    Row{Op::kInitialize, "C", "RS", "O on_initialize I", "C on_initialize C", '='},
    Row{Op::kInitialize, "IAE", "RS", kRefused, kRefused, '='},
    Row{Op::kFinalize, "CIAE", "RS", kRefused, kRefused, '='},

    Row{Op::kExit, "C", "RS", kRefused, kRefused, '='},
    Row{Op::kExit, "IE", "RS", "O on_finalize C", "C on_finalize C", '='},
    Row{Op::kExit, "A", "RS", "O on_deactivated on_finalize C", "C on_deactivated on_finalize C", '='},
    Row{Op::kExitDeactivating, "C", "RS", kRefused, kRefused, '='},
    Row{Op::kExitDeactivating, "IE", "RS", "O on_finalize C", "O on_finalize C", '='},
    Row{Op::kExitDeactivating, "A", "RS", "O on_deactivated on_finalize C", "C on_deactivated on_finalize C",
        '='},

    Row{Op::kStart, "CIAE", "R", kRefused, kRefused, '='},
    Row{Op::kStart, "C", "S", kRefused, kRefused, '='},
    Row{Op::kStart, "IAE", "S", "O on_startup =", "C on_startup =", 'r'},
    Row{Op::kStop, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kStop, "C", "R", kNothing, kNothing, 'S'},
    Row{Op::kStop, "IAE", "R", "O on_shutdown =", "C on_shutdown =", 'S'},

    Row{Op::kActivate, "C", "RS", kBad, kBad, '='},
    Row{Op::kActivate, "I", "RS", "O on_activated A", "C on_activated {on_deactivated} on_aborting E", '='},
    Row{Op::kActivate, "AE", "RS", kRefused, kRefused, '='},
    Row{Op::kActivateAborting, "C", "RS", kBad, kBad, '='},
    Row{Op::kActivateAborting, "I", "RS", "O on_activated A", "C on_activated {on_deactivated} on_aborting E",
        '='},
    Row{Op::kActivateAborting, "AE", "RS", kRefused, kRefused, '='},
    Row{Op::kDeactivate, "C", "RS", kBad, kBad, '='},
    Row{Op::kDeactivate, "A", "RS", "O on_deactivated I", "C on_deactivated I", '='},
    Row{Op::kDeactivate, "IE", "RS", kRefused, kRefused, '='},
    Row{Op::kReset, "CIA", "RS", kRefused, kRefused, '='},
    Row{Op::kReset, "E", "RS", "O on_reset I", "C on_reset E", '='},

    Row{Op::kDetach, "CIAE", "R", kRefused, kRefused, '='},
    Row{Op::kDetach, "A", "S", kRefused, kRefused, '='},
    Row{Op::kDetach, "CI", "S", kNothing, kNothing, '='},
    Row{Op::kDetach, "E", "S", "O I", "O I", '='},
    Row{Op::kGetState, "C", "RS", kBad, kBad, '='},
    Row{Op::kGetState, "IAE", "RS", kNothing, kNothing, '='},
    Row{Op::kAdd, "CIAE", "RS", kUnsupported, kUnsupported, '='},
    Row{Op::kRemove, "CIAE", "RS", kUnsupported, kUnsupported, '='},
    Row{Op::kSetRateZero, "CIAE", "RS", kBad, kBad, '='},
    Row{Op::kSetRateForeign, "CIAE", "RS", kUnsupported, kUnsupported, '='},

    Row{Op::kCycle, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kCycle, "CI", "R", kNothing, kNothing, '='},
    Row{Op::kCycle, "A", "R", "O on_execute on_state_update A", "O on_execute {on_deactivated} on_aborting E",
        '='},
    Row{Op::kCycle, "E", "R", "O on_error E", "O on_error E", '='},
    Row{Op::kCycleUpdating, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kCycleUpdating, "CI", "R", kNothing, kNothing, '='},
    Row{Op::kCycleUpdating, "A", "R", "O on_execute on_state_update A",
        "O on_execute on_state_update {on_deactivated} on_aborting E", '='},
    Row{Op::kCycleUpdating, "E", "R", "O on_error E", "O on_error E", '='},
    Row{Op::kCycleInError, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kCycleInError, "CI", "R", kNothing, kNothing, '='},
    Row{Op::kCycleInError, "A", "R", "O on_execute on_state_update A", "O on_execute on_state_update A", '='},
    Row{Op::kCycleInError, "E", "R", "O on_error E", "O on_error E", '='},
    Row{Op::kCycleAborting, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kCycleAborting, "CI", "R", kNothing, kNothing, '='},
    Row{Op::kCycleAborting, "A", "R", "O on_execute on_state_update A",
        "O on_execute {on_deactivated} on_aborting E", '='},
    Row{Op::kCycleAborting, "E", "R", "O on_error E", "O on_error E", '='},

    Row{Op::kRateThenCycle, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kRateThenCycle, "C", "R", kNothing, kNothing, '='},
    Row{Op::kRateThenCycle, "I", "R", "O on_rate_changed I", "O on_rate_changed I", '='},
    Row{Op::kRateThenCycle, "A", "R", "O on_rate_changed on_execute on_state_update A",
        "O on_rate_changed {on_deactivated} on_aborting E", '='},
    Row{Op::kRateThenCycle, "E", "R", "O on_rate_changed on_error E", "O on_rate_changed on_error E", '='},
    Row{Op::kModeThenCycle, "CIAE", "S", kRefused, kRefused, '='},
    Row{Op::kModeThenCycle, "C", "R", kNothing, kNothing, '='},
    Row{Op::kModeThenCycle, "I", "R", "O on_mode_changed I", "O on_mode_changed I", '='},
    Row{Op::kModeThenCycle, "A", "R", "O on_mode_changed on_execute on_state_update A",
        "O on_mode_changed {on_deactivated} on_aborting E", '='},
    Row{Op::kModeThenCycle, "E", "R", "O on_mode_changed on_error E", "O on_mode_changed on_error E", '='},
    Row{Op::kModeImmediately, "C", "RS", kNothing, kNothing, '='},
    Row{Op::kModeImmediately, "I", "RS", "O on_mode_changed I", "C on_mode_changed I", '='},
    Row{Op::kModeImmediately, "A", "RS", "O on_mode_changed A",
        "C on_mode_changed {on_deactivated} on_aborting E", '='},
    Row{Op::kModeImmediately, "E", "RS", "O on_mode_changed E", "C on_mode_changed E", '='},
};

constexpr std::array<std::array<const char*, 3>, kOperationCount> kAnswering{{
    {"on_initialize"},
    {"on_finalize"},
    {"on_finalize"},
    {"on_deactivated"},
    {"on_startup"},
    {"on_shutdown"},
    {"on_activated"},
    {"on_activated", "on_deactivated", "on_aborting"},
    {"on_deactivated"},
    {"on_reset"},
    {},
    {},
    {},
    {},
    {},
    {},
    {"on_execute"},
    {"on_state_update"},
    {"on_error"},
    {"on_execute", "on_deactivated", "on_aborting"},
    {"on_rate_changed"},
    {"on_mode_changed"},
    {"on_mode_changed"},
}};

constexpr std::array<Duration, 1> kAlternatives{2_ms};
constexpr Mode kFirst{"first"};
constexpr Mode kSecond{"second"};
constexpr std::array<const Mode*, 2> kModes{&kFirst, &kSecond};

class SpyModes final : public SpyActions<MultiModeComponent> {
  public:
    explicit SpyModes(Calls& calls) : SpyActions(calls, "c", kModes) {}
};

bool has(const char* letters, char letter) {
    return std::string(letters).find(letter) != std::string::npos;
}

/// One component in one context, brought into the state and run through the operation.
class Case {
  public:
    Case(char state, bool is_running, AbortPolicy policy) {
        plan_.alternative_periods = kAlternatives;
        plan_.abort_policy = policy;
        expect(component_.initialize());
        expect(context_.attach(0, participants_, plan_));
        expect(context_.start({}));
        if (state == 'A' || state == 'E') {
            expect(context_.activate_component(component_, {}));
        }
        if (state == 'E') {
            component_.answers["on_execute"] = Status::kError;
            expect(run_cycle());
            component_.answers.clear();
        }
        if (!is_running) {
            expect(context_.stop({}));
        }
        if (state == 'C') {
            expect(component_.exit({}));
        }
        calls_.clear();
        EXPECT_EQ(get_state(), state);
        EXPECT_EQ(context_.is_running(), is_running);
    }

    Status perform(Operation operation, Status code) {
        for (const char* action : kAnswering[static_cast<std::size_t>(operation)]) {
            if (action != nullptr) {
                component_.answers[action] = code;
            }
        }
        switch (operation) {
            case Operation::kInitialize:
                return component_.initialize();
            case Operation::kFinalize:
                return component_.finalize();
            case Operation::kExit:
            case Operation::kExitDeactivating:
                return component_.exit({});
            case Operation::kStart:
                return context_.start({});
            case Operation::kStop:
                return context_.stop({});
            case Operation::kActivate:
            case Operation::kActivateAborting:
                return context_.activate_component(component_, {});
            case Operation::kDeactivate:
                return context_.deactivate_component(component_, {});
            case Operation::kReset:
                return context_.reset_component(component_, {});
            case Operation::kDetach:
                return detach_and_attach();
            case Operation::kGetState:
                return context_.get_component_state(component_).get_status();
            case Operation::kAdd:
                return context_.add_component(component_);
            case Operation::kRemove:
                return context_.remove_component(component_);
            case Operation::kSetRateZero:
                return context_.set_rate(0.0);
            case Operation::kSetRateForeign:
                return context_.set_rate(999.0);
            case Operation::kRateThenCycle:
                expect(context_.set_rate(500.0));
                EXPECT_TRUE(context_.apply_pending_rate());
                return run_cycle();
            case Operation::kModeThenCycle:
                expect(component_.set_mode(kSecond, false, {}));
                return run_cycle();
            case Operation::kModeImmediately:
                return component_.set_mode(kSecond, true, {});
            case Operation::kCycle:
            case Operation::kCycleUpdating:
            case Operation::kCycleInError:
            case Operation::kCycleAborting:
                return run_cycle();
        }
        return Status::kError;
    }

    std::string get_actions() {
        std::string actions;
        for (const std::string& call : calls_) {
            actions += (actions.empty() ? "" : " ") + call.substr(2U);
        }
        return actions;
    }
    char get_state() const { return "CIAE"[static_cast<std::size_t>(context_.get_state_at(0U))]; }
    bool is_running() const { return context_.is_running(); }
    bool is_alive() const { return component_.is_alive(); }

  private:
    static void expect(Status status) { EXPECT_EQ(status, Status::kOk); }
    Status run_cycle() {
        const Status begun = context_.begin_cycle({});
        if (begun == Status::kOk) {
            context_.execute(0U);
            context_.update_state(0U);
            context_.end_cycle();
        }
        return begun;
    }
    Status detach_and_attach() {
        const Status result = context_.detach();
        if (result == Status::kOk) {
            EXPECT_EQ(context_.attach(0, participants_, plan_), Status::kOk);
        }
        return result;
    }

    Calls calls_;
    SpyModes component_{calls_};
    std::array<Component*, 1> participants_{&component_};
    ContextPlan plan_{1_ms};
    ExecutionContext context_;
};

/// The one row for the combination; more or less than one is a fault of the oracle.
const Row& find_row(Operation operation, char state, char running) {
    const Row* found = nullptr;
    for (const Row& row : kOracle) {
        if (row.operation == operation && has(row.states, state) && has(row.running, running)) {
            EXPECT_EQ(found, nullptr) << "two rows";
            found = &row;
        }
    }
    EXPECT_NE(found, nullptr) << "no row";
    return found == nullptr ? kOracle[0] : *found;
}

Status spell(char answer, Status code) {
    switch (answer) {
        case 'O':
            return Status::kOk;
        case 'B':
            return Status::kBadParameter;
        case 'U':
            return Status::kUnsupported;
        case 'P':
            return Status::kPreconditionNotMet;
        default:
            return code;
    }
}

std::string spell(const std::string& actions, AbortPolicy policy) {
    const std::size_t open = actions.find('{');
    if (open == std::string::npos) {
        return actions;
    }
    const std::size_t close = actions.find('}');
    const std::string optional = actions.substr(open + 1U, close - open - 1U);
    return actions.substr(0U, open) + (policy == AbortPolicy::kOpenRtmCompat
                                           ? optional + actions.substr(close + 1U)
                                           : actions.substr(close + 2U));
}

void compare(Operation operation, char state, bool is_running, AbortPolicy policy, Status code) {
    SCOPED_TRACE("operation " + std::to_string(static_cast<int>(operation)) + ", state " + state +
                 (is_running ? ", running, " : ", stopped, ") + get_name(code) +
                 (policy == AbortPolicy::kSpecOnly ? ", spec only" : ", OpenRTM compatible"));
    const Row& row = find_row(operation, state, is_running ? 'R' : 'S');
    const std::string expected = code == Status::kOk ? row.good : row.bad;
    const std::string actions = expected.size() > 3U ? expected.substr(2U, expected.size() - 4U) : "";
    Case sut{state, is_running, policy};

    EXPECT_EQ(sut.perform(operation, code), spell(expected.front(), code));

    EXPECT_EQ(sut.get_actions(), spell(actions, policy));
    const char state_after = expected.back() == '=' ? state : expected.back();
    EXPECT_EQ(sut.get_state(), state_after);
    EXPECT_EQ(sut.is_alive(), state_after != 'C');
    const bool is_started = row.running_after == 'r' && code == Status::kOk;
    const bool is_running_after = row.running_after == '=' ? is_running : is_started;
    EXPECT_EQ(sut.is_running(), is_running_after);
}

std::size_t compare_all(bool is_code_ok) {
    std::size_t count = 0U;
    for (std::size_t operation = 0U; operation < kOperationCount; ++operation) {
        for (const char state : {'C', 'I', 'A', 'E'}) {
            for (const bool is_running : {false, true}) {
                for (const AbortPolicy policy : {AbortPolicy::kSpecOnly, AbortPolicy::kOpenRtmCompat}) {
                    for (const Status code : kEveryStatus) {
                        if ((code == Status::kOk) == is_code_ok) {
                            compare(static_cast<Operation>(operation), state, is_running, policy, code);
                            ++count;
                        }
                    }
                }
            }
        }
    }
    std::cout << count << " combinations compared\n";
    return count;
}

TEST(RtcEnumerationTest, EveryCombinationWhoseActionsSucceed) {
    verifies("SWR-RTC-011", Technique::kStateTransition);

    EXPECT_EQ(compare_all(true), kOperationCount * 4U * 2U * 2U);
}

TEST(RtcEnumerationTest, EveryCombinationWhoseActionsFail) {
    verifies("SWR-RTC-011", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(compare_all(false), kOperationCount * 4U * 2U * 2U * 5U);
}

}  // namespace
}  // namespace mamori
