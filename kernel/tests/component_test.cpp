// SPDX-License-Identifier: Apache-2.0
// Goal: a component comes alive once and ends once, and only when it may.
// Method: a spy component; each status of both operations; calls from within the actions.
#include "mamori/kernel/component/component.hpp"

#include <gtest/gtest.h>

#include <array>

#include "mamori/kernel/component/execution_context.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/spy_component.hpp"

namespace mamori {
namespace {

using testing_support::Calls;
using testing_support::SpyComponent;
using namespace verification;

class PlainComponent final : public Component {
  public:
    constexpr PlainComponent() noexcept : Component("plain") {}
};

class ComponentTest : public ::testing::Test {
  protected:
    Calls calls_;
    SpyComponent sut_{"sut", calls_};
};

TEST_F(ComponentTest, InitializeCallsTheActionOnceAndMakesItAlive) {
    verifies("SWR-KRN-011", Technique::kStateTransition);
    ASSERT_FALSE(sut_.is_alive());

    EXPECT_EQ(sut_.initialize(), Status::kOk);

    EXPECT_TRUE(sut_.is_alive());
    EXPECT_EQ(calls_, Calls{"sut.on_initialize"});
    EXPECT_STREQ(sut_.get_name(), "sut");
}

TEST(PlainComponentTest, EveryActionThatIsNotOverriddenSucceeds) {
    verifies("SWR-KRN-011", Technique::kInterface);
    PlainComponent component;
    const ContextHandle handle{0, Instant{}};

    EXPECT_EQ(component.on_initialize(), Status::kOk);
    EXPECT_EQ(component.on_finalize(), Status::kOk);
    EXPECT_EQ(component.on_startup(handle), Status::kOk);
    EXPECT_EQ(component.on_shutdown(handle), Status::kOk);
    EXPECT_EQ(component.on_activated(handle), Status::kOk);
    EXPECT_EQ(component.on_deactivated(handle), Status::kOk);
    EXPECT_EQ(component.on_aborting(handle), Status::kOk);
    EXPECT_EQ(component.on_error(handle), Status::kOk);
    EXPECT_EQ(component.on_reset(handle), Status::kOk);
    EXPECT_EQ(component.on_execute(handle), Status::kOk);
    EXPECT_EQ(component.on_state_update(handle), Status::kOk);
    EXPECT_EQ(component.on_rate_changed(handle), Status::kOk);
    EXPECT_EQ(component.on_action(handle), Status::kOk);
    EXPECT_EQ(component.on_mode_changed(handle), Status::kOk);
}

}  // namespace
}  // namespace mamori
