// SPDX-License-Identifier: Apache-2.0
/// @file
/// Two spies in one execution context, and a way to run whole cycles.
#ifndef MAMORI_KERNEL_TESTS_CONTEXT_FIXTURE_HPP
#define MAMORI_KERNEL_TESTS_CONTEXT_FIXTURE_HPP

#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/component/execution_context.hpp"
#include "support/spy_component.hpp"

namespace mamori::testing_support {

class ContextFixture : public ::testing::Test {
  protected:
    static constexpr std::int32_t kId = 7;

    /// Both alive and attached; the context is Stopped; nothing is recorded.
    void SetUp() override {
        ASSERT_EQ(a_.initialize(), Status::kOk);
        ASSERT_EQ(b_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.attach(kId, participants_, plan_), Status::kOk);
        calls_.clear();
    }
    /// Running, both Active; nothing is recorded.
    void start_and_activate() {
        ASSERT_EQ(sut_.start(now_), Status::kOk);
        ASSERT_EQ(sut_.activate_component(a_, now_), Status::kOk);
        ASSERT_EQ(sut_.activate_component(b_, now_), Status::kOk);
        calls_.clear();
    }
    /// a_ is in Error because on_execute failed once; b_ is Active; nothing is recorded.
    void bring_a_into_error() {
        a_.answers["on_execute"] = Status::kError;
        run_cycle();
        a_.answers.clear();
        ASSERT_EQ(get_state(a_), LifecycleState::kError);
        calls_.clear();
    }
    /// @return the actions that the cycle called.
    Calls run_cycle() {
        EXPECT_EQ(sut_.begin_cycle(now_), Status::kOk);
        for (std::size_t i = 0U; i < participants_.size(); ++i) {
            sut_.execute(i);
        }
        for (std::size_t i = 0U; i < participants_.size(); ++i) {
            sut_.update_state(i);
        }
        sut_.end_cycle();
        return take(calls_);
    }
    LifecycleState get_state(const Component& component) const {
        return sut_.get_component_state(component).get_value();
    }

    Calls calls_;
    SpyComponent a_{"a", calls_};
    SpyComponent b_{"b", calls_};
    SpyComponent stranger_{"stranger", calls_};
    std::array<Component*, 2> participants_{&a_, &b_};
    Instant now_{1000};
    ContextPlan plan_{1_ms};  ///< a derived fixture may change it in its constructor
    ExecutionContext sut_;
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_CONTEXT_FIXTURE_HPP
