// SPDX-License-Identifier: Apache-2.0
// Goal: corners of a window that the measurement of MC/DC found untested: an overrun that nobody listens to,
// and the input of a component in Error. Method: one window whose sink fails its first cycle.
#include <gtest/gtest.h>

#include <cstdint>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::FakeHost;
using namespace verification;

class FailingSink final : public Component {
  public:
    constexpr FailingSink() noexcept : Component("failing_sink") {}

    InPort<std::int64_t> in{*this, "in"};
    using Ports = mamori::Ports<&FailingSink::in>;

    Status on_execute(ContextHandle) noexcept override { return Status::kError; }
};

class ExecutiveCornerTest : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(sut_.initialize(), Status::kOk);
        ASSERT_EQ(sut_.start(), Status::kOk);
    }

    Counter counter_;
    FailingSink sink_;
    SystemTable<1U, 2U, 2U, 1U> table_ =
        system(frame(1000_ns), window("all", 0_ns, 400_ns, budget(300_ns), mamori::run(counter_, sink_)),
               connect(counter_.out, sink_.in, any_age()));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> sut_{table_};
};

TEST_F(ExecutiveCornerTest, AnOverrunThatNobodyListensToIsAnOverrunAllTheSame) {
    verifies("SWR-KRN-022", Technique::kErrorGuessing, Polarity::kViolation);
    host_.hangs[{0U, WindowHost::Pass::kExecute}] = true;

    EXPECT_EQ(sut_.run_window(0U, host_), WindowOutcome::kOverrun);
    EXPECT_EQ(counter_.out.get_sequence(), 0U);
}

TEST_F(ExecutiveCornerTest, AComponentInErrorHasReadItsInput) {
    verifies("SWR-KRN-016", Technique::kStateTransition);

    ASSERT_EQ(sut_.run_window(0U, host_), WindowOutcome::kCompleted);

    EXPECT_EQ(sut_.get_context(0U).get_component_state(sink_).get_value(), LifecycleState::kError);
    EXPECT_TRUE(sink_.in.has_value());
    EXPECT_FALSE(sink_.in.is_new());
}

}  // namespace
}  // namespace mamori
