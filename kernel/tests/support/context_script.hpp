// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a scenario that is written as text: spies `a` and `b` in one execution context, `stranger` outside
/// it.
///
/// Steps are separated by `;`. A step is `command arguments [= result] [: actions]`. The result of an
/// operation is the initial of its code: O (the default), E kError, B kBadParameter, U kUnsupported, R
/// kOutOfResources, P kPreconditionNotMet, * the code of the run. The step must call exactly the listed
/// actions, in this order.
#ifndef MAMORI_KERNEL_TESTS_CONTEXT_SCRIPT_HPP
#define MAMORI_KERNEL_TESTS_CONTEXT_SCRIPT_HPP

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include "mamori/kernel/component/execution_context.hpp"
#include "support/every_status.hpp"
#include "support/spy_component.hpp"

namespace mamori::testing_support {

class ContextScript {
  public:
    /// Both participants are alive and Inactive, the context is Stopped, 500 Hz is the alternative to 1 kHz.
    explicit ContextScript(Status code) : code_(get_letter(code)) {
        plan_.alternative_periods = kAlternatives;
        EXPECT_EQ(a_.initialize(), Status::kOk);
        EXPECT_EQ(b_.initialize(), Status::kOk);
        EXPECT_EQ(sut_.attach(kId, participants_, plan_), Status::kOk);
        calls_.clear();
    }

    /// Runs `steps` once for each failure code if they contain a `*`, else once.
    static void run_all(const std::string& steps) {
        const bool is_for_each_code = steps.find('*') != std::string::npos;
        for (const Status code : kEveryStatus) {
            if (code == Status::kError || (is_for_each_code && code != Status::kOk)) {
                SCOPED_TRACE(get_name(code));
                ContextScript{code}.run(steps);
            }
        }
    }

  private:
    using Words = std::istringstream;

    static constexpr std::int32_t kId = 7;
    static constexpr std::array<Duration, 1> kAlternatives{2_ms};

    static std::string get_letter(Status code) { return {"OEBURP"[static_cast<std::size_t>(code)]}; }
    static Status find_status(char letter) { return static_cast<Status>(std::string("OEBURP").find(letter)); }
    static std::string get_letter(LifecycleState state) { return {"CIAE"[static_cast<std::size_t>(state)]}; }
    static std::string spell(bool value) { return value ? "yes" : "no"; }
    static std::string spell(const Result<std::size_t>& position) {
        return position.has_value() ? std::to_string(position.get_value()) : "none";
    }
    static std::string spell(double rate) {
        std::ostringstream text;
        text << rate;
        return rate < 0.0 ? "none" : text.str();
    }

    void run(const std::string& steps) {
        std::istringstream rest{steps};
        for (std::string step; std::getline(rest, step, ';');) {
            SCOPED_TRACE(step);
            const std::size_t colon = step.find(':');
            perform(step.substr(0U, colon));
            Calls expected;
            Words actions{colon == std::string::npos ? "" : step.substr(colon + 1U)};
            for (std::string action; actions >> action;) {
                expected.push_back(action.insert(action.find('.') + 1U, "on_"));
            }
            EXPECT_EQ(take(calls_), expected);
        }
    }
    /// One command without its actions.
    void perform(const std::string& command) {
        Words words{command};
        std::string verb;
        words >> verb;
        const auto operation = operations_.find(verb);
        const auto fact = facts_.find(verb);
        ASSERT_TRUE(operation != operations_.end() || fact != facts_.end()) << "unknown command " << verb;
        const std::string result =
            fact == facts_.end() ? get_letter(operation->second(words)) : fact->second(words);
        std::string equals;
        std::string expected{"O"};
        words >> equals >> expected;
        if (const std::size_t star = expected.find('*'); star != std::string::npos) {
            expected.replace(star, 1U, code_);
        }
        EXPECT_EQ(result, expected);
    }

    static std::string read(Words& words) {
        std::string word;
        words >> word;
        return word;
    }
    SpyComponent& read_component(Words& words) {
        const std::string name = read(words);
        EXPECT_TRUE(name == "a" || name == "b" || name == "stranger") << name;
        return name == "a" ? a_ : name == "b" ? b_ : stranger_;
    }
    Status fail(Words& words) {
        std::string action = read(words);
        std::replace(action.begin(), action.end(), '.', ' ');
        Words parts{action};
        SpyComponent& component = read_component(parts);
        const std::string code = read(words);
        component.answers["on_" + read(parts)] = find_status(code == "*" ? code_[0U] : code[0U]);
        return Status::kOk;
    }
    Status heal() {
        for (SpyComponent* component : {&a_, &b_, &stranger_}) {
            component->answers.clear();
        }
        return Status::kOk;
    }
    /// The commands in braces, separated by commas, are performed within each action of the component.
    Status act_within(Words& words) {
        SpyComponent& component = read_component(words);
        std::string commands;
        std::getline(words, commands, '{');
        std::getline(words, commands, '}');
        component.inside = [this, commands](const std::string& action) {
            SCOPED_TRACE(action);
            std::istringstream rest{commands};
            for (std::string command; std::getline(rest, command, ',');) {
                perform(command);
            }
        };
        return Status::kOk;
    }
    Status attach_with(AbortPolicy policy, ExecutionKind kind) {
        EXPECT_EQ(sut_.detach(), Status::kOk);
        plan_ = ContextPlan{1_ms};
        plan_.abort_policy = policy;
        plan_.kind = kind;
        return sut_.attach(kId, participants_, plan_);
    }
    Status run_cycle() {
        const Status begun = sut_.begin_cycle(now_);
        if (begun == Status::kOk) {
            sut_.execute(0U);
            sut_.execute(1U);
            sut_.update_state(0U);
            sut_.update_state(1U);
            sut_.end_cycle();
        }
        return begun;
    }
    Status run_ranges() {
        const Status begun = sut_.begin_cycle(now_);
        sut_.execute_range(0U, 2U);
        sut_.update_range(0U, 2U);
        sut_.end_cycle();
        return begun;
    }
    /// Running, both Active; nothing is recorded.
    Status make_active() {
        EXPECT_EQ(sut_.start(now_), Status::kOk);
        EXPECT_EQ(sut_.activate_component(a_, now_), Status::kOk);
        EXPECT_EQ(sut_.activate_component(b_, now_), Status::kOk);
        calls_.clear();
        return Status::kOk;
    }
    /// a_ is in Error because on_execute failed once; nothing is recorded.
    Status break_a() {
        a_.answers["on_execute"] = Status::kError;
        EXPECT_EQ(run_cycle(), Status::kOk);
        a_.answers.clear();
        calls_.clear();
        return Status::kOk;
    }
    Status attach_other(Span<Component* const> participants) {
        return other_.attach(kId + 1, participants, ContextPlan{1_ms});
    }
    Status run_other() {
        EXPECT_EQ(stranger_.initialize(), Status::kOk);
        EXPECT_EQ(attach_other(Span<Component* const>{with_stranger_}.subspan(0U, 1U)), Status::kOk);
        EXPECT_EQ(other_.start(now_), Status::kOk);
        return other_.activate_component(stranger_, now_);
    }
    std::string get_states() {
        for (Component* component : participants_) {
            const Result<LifecycleState> state = sut_.get_component_state(*component);
            EXPECT_EQ(state.has_value(), component->is_alive());
            if (state.has_value()) {
                EXPECT_EQ(state.get_value(), sut_.get_state_at(component == &a_ ? 0U : 1U));
            }
        }
        return get_letter(sut_.get_state_at(0U)) + get_letter(sut_.get_state_at(1U));
    }
    std::string get_failure(Words& words) {
        const ActionFailure failure = read_component(words).get_last_failure();
        if (failure.status == Status::kOk) {
            return "none";
        }
        EXPECT_EQ(failure.at, now_);
        return get_name(failure.action) + std::string(",") + get_letter(failure.status);
    }

    std::string code_;
    Calls calls_;
    SpyComponent a_{"a", calls_};
    SpyComponent b_{"b", calls_};
    SpyComponent stranger_{"stranger", calls_};
    std::array<Component*, 2> participants_{&a_, &b_};
    std::array<Component*, 2> with_stranger_{&stranger_, &a_};
    Instant now_{1000};
    ContextPlan plan_{1_ms};
    ExecutionContext sut_;
    ExecutionContext other_;

    const std::map<std::string, std::function<Status(Words&)>> operations_{
        {"initialize", [this](Words& words) { return read_component(words).initialize(); }},
        {"finalize", [this](Words& words) { return read_component(words).finalize(); }},
        {"exit", [this](Words& words) { return read_component(words).exit(now_); }},
        {"start", [this](Words&) { return sut_.start(now_); }},
        {"stop", [this](Words&) { return sut_.stop(now_); }},
        {"attach", [this](Words&) { return sut_.attach(kId, participants_, plan_); }},
        {"detach", [this](Words&) { return sut_.detach(); }},
        {"add", [this](Words& words) { return sut_.add_component(read_component(words)); }},
        {"remove", [this](Words& words) { return sut_.remove_component(read_component(words)); }},
        {"activate", [this](Words& words) { return sut_.activate_component(read_component(words), now_); }},
        {"deactivate",
         [this](Words& words) { return sut_.deactivate_component(read_component(words), now_); }},
        {"reset", [this](Words& words) { return sut_.reset_component(read_component(words), now_); }},
        {"get_state",
         [this](Words& words) { return sut_.get_component_state(read_component(words)).get_status(); }},
        {"get_handle",
         [this](Words& words) { return read_component(words).get_context_handle(sut_).get_status(); }},
        {"set_rate",
         [this](Words& words) { return sut_.set_rate(std::strtod(read(words).c_str(), nullptr)); }},
        {"begin", [this](Words&) { return sut_.begin_cycle(now_); }},
        {"execute", [this](Words& words) { return sut_.execute(std::stoul(read(words))), Status::kOk; }},
        {"update", [this](Words& words) { return sut_.update_state(std::stoul(read(words))), Status::kOk; }},
        {"end", [this](Words&) { return sut_.end_cycle(), Status::kOk; }},
        {"cycle", [this](Words&) { return run_cycle(); }},
        {"ranges", [this](Words&) { return run_ranges(); }},
        {"fail", [this](Words& words) { return fail(words); }},
        {"heal", [this](Words&) { return heal(); }},
        {"within", [this](Words& words) { return act_within(words); }},
        {"active", [this](Words&) { return make_active(); }},
        {"broken", [this](Words&) { return break_a(); }},
        {"compatible",
         [this](Words&) { return attach_with(AbortPolicy::kOpenRtmCompat, ExecutionKind::kPeriodic); }},
        {"event_driven",
         [this](Words&) { return attach_with(AbortPolicy::kSpecOnly, ExecutionKind::kEventDriven); }},
        {"share", [this](Words&) { return attach_other(with_stranger_); }},
        {"other", [this](Words&) { return run_other(); }},
    };
    const std::map<std::string, std::function<std::string(Words&)>> facts_{
        {"states", [this](Words&) { return get_states(); }},
        {"is_alive", [this](Words& words) { return spell(read_component(words).is_alive()); }},
        {"is_active",
         [this](Words& words) {
             return spell(sut_.get_component_state(read_component(words)).get_value() ==
                          LifecycleState::kActive);
         }},
        {"is_running", [this](Words&) { return spell(sut_.is_running()); }},
        {"is_busy", [this](Words&) { return spell(sut_.is_busy()); }},
        {"turn", [this](Words&) { return spell(sut_.take_turn()); }},
        {"apply", [this](Words&) { return spell(sut_.apply_pending_rate()); }},
        {"rate", [this](Words&) { return spell(sut_.get_rate()); }},
        {"divisor", [this](Words&) { return std::to_string(sut_.get_divisor()); }},
        {"kind", [this](Words&) { return std::to_string(static_cast<std::uint32_t>(sut_.get_kind())); }},
        {"refusing", [this](Words&) { return spell(sut_.get_refusing_position()); }},
        {"acting", [this](Words&) { return spell(sut_.get_acting_position()); }},
        {"participants", [this](Words&) { return std::to_string(sut_.get_participant_count()); }},
        {"failure", [this](Words& words) { return get_failure(words); }},
        {"other_state",
         [this](Words&) { return get_letter(other_.get_component_state(stranger_).get_value()); }},
        {"is_other_running", [this](Words&) { return spell(other_.is_running()); }},
    };
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_CONTEXT_SCRIPT_HPP
