// SPDX-License-Identifier: Apache-2.0
// Goal: the life-cycle table allows exactly the transitions of the standard. Method: every cell, by hand.
#include "mamori/kernel/component/lifecycle.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

constexpr LifecycleState kCreated = LifecycleState::kCreated;
constexpr LifecycleState kInactive = LifecycleState::kInactive;
constexpr LifecycleState kActive = LifecycleState::kActive;
constexpr LifecycleState kErrorState = LifecycleState::kError;

struct Allowed {
    LifecycleState state;
    LifecycleEvent event;
    LifecycleState target;
};
constexpr std::array<Allowed, 6> kAllowed{{
    {kCreated, LifecycleEvent::kInitialize, kInactive},
    {kInactive, LifecycleEvent::kActivate, kActive},
    {kInactive, LifecycleEvent::kFail, kErrorState},
    {kActive, LifecycleEvent::kDeactivate, kInactive},
    {kActive, LifecycleEvent::kFail, kErrorState},
    {kErrorState, LifecycleEvent::kReset, kInactive},
}};

TEST(LifecycleTest, TheSixAllowedTransitionsLeadWhereTheStandardSays) {
    verifies("SWR-KRN-010", Technique::kStateTransition);

    for (const Allowed& allowed : kAllowed) {
        const LifecycleTransition cell = get_transition(allowed.state, allowed.event);
        EXPECT_EQ(cell.admission, Status::kOk) << get_name(allowed.state);
        EXPECT_EQ(cell.target, allowed.target) << get_name(allowed.state);
    }
}

TEST(LifecycleTest, EveryOtherPairOfStateAndEventIsRefusedWithItsCode) {
    verifies("SWR-KRN-010", Technique::kStateTransition, Polarity::kViolation);
    std::size_t refused = 0U;

    for (std::uint32_t state = 0U; state < kLifecycleStateCount; ++state) {
        for (std::uint32_t event = 0U; event < kLifecycleEventCount; ++event) {
            const auto from = static_cast<LifecycleState>(state);
            const auto what = static_cast<LifecycleEvent>(event);
            bool is_allowed = false;
            for (const Allowed& allowed : kAllowed) {
                is_allowed = is_allowed || (allowed.state == from && allowed.event == what);
            }
            if (is_allowed) {
                continue;
            }
            // Activation and deactivation of a component that is not alive are wrong arguments.
            const bool is_bad_argument = from == kCreated && (what == LifecycleEvent::kActivate ||
                                                              what == LifecycleEvent::kDeactivate);
            EXPECT_EQ(get_transition(from, what).admission,
                      is_bad_argument ? Status::kBadParameter : Status::kPreconditionNotMet)
                << get_name(from) << " event " << event;
            ++refused;
        }
    }
    EXPECT_EQ(refused, 14U);
}

TEST(LifecycleTest, NumbersAndNamesAreThoseOfTheStandard) {
    verifies("SWR-KRN-010", Technique::kInterface);

    EXPECT_EQ(static_cast<std::uint32_t>(kCreated), 0U);
    EXPECT_EQ(static_cast<std::uint32_t>(kInactive), 1U);
    EXPECT_EQ(static_cast<std::uint32_t>(kActive), 2U);
    EXPECT_EQ(static_cast<std::uint32_t>(kErrorState), 3U);
    EXPECT_EQ(std::string(get_name(kCreated)), "CREATED_STATE");
    EXPECT_EQ(std::string(get_name(kInactive)), "INACTIVE_STATE");
    EXPECT_EQ(std::string(get_name(kActive)), "ACTIVE_STATE");
    EXPECT_EQ(std::string(get_name(kErrorState)), "ERROR_STATE");
    EXPECT_EQ(std::string(get_name(static_cast<LifecycleState>(4U))), "INVALID_STATE");
}

TEST(LifecycleDeathTest, ACorruptedStateOrEventEndsInTheAssertion) {
    verifies("SWR-KRN-010", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_CHECK_FAILS(
        static_cast<void>(get_transition(static_cast<LifecycleState>(4U), LifecycleEvent::kReset)),
        "lifecycle.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(get_transition(kActive, static_cast<LifecycleEvent>(5U))),
                       "lifecycle.hpp", 1);
}

}  // namespace
}  // namespace mamori
