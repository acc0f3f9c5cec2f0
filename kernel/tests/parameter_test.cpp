// SPDX-License-Identifier: Apache-2.0
// Goal: a parameter never has a value that its constraint refuses, and changes at the commit only.
// Method: both sides of each limit through each way in; requests and commits in every order; a component that
// compares what it reads at the beginning and at the end of its cycle while another thread sends requests.
#include "mamori/kernel/parameter/parameter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>

#include "mamori/kernel/base/constant_init.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

enum class Gear : std::uint8_t { kNeutral, kFirst, kSecond };

class Drive final : public Component {
  public:
    constexpr Drive() noexcept : Component("drive") {}

    Parameter<double> limit_rad_s{*this, "limit_rad_s", 1.0, between(0.1, 3.0)};
    Parameter<std::array<float, 3U>> gains{*this,       "gains",     {1.0F, 2.0F, 0.0F},
                                           above(0.0F), any_value(), one_of(0.0F, 1.0F)};
    Parameter<std::uint8_t> retries{*this, "retries", 3U};
    Parameter<bool> is_reversed{*this, "is_reversed", false};
    Parameter<Gear> gear{*this, "gear", Gear::kFirst, one_of(Gear::kFirst, Gear::kSecond)};
    Parameter<int, 6U> baud{*this, "baud", 9600, one_of(1200, 2400, 4800, 9600, 19200, 38400)};
};
MAMORI_CONSTINIT Drive g_drive;

class ParameterTest : public ::testing::Test {
  protected:
    Drive sut_;
};

TEST_F(ParameterTest, AParameterBeginsWithItsDefaultAndKnowsItsDeclaration) {
    verifies("SWR-PAR-003");

    EXPECT_EQ(g_drive.limit_rad_s.get(), 1.0);
    EXPECT_STREQ(sut_.limit_rad_s.get_name(), "limit_rad_s");
    EXPECT_EQ(sut_.limit_rad_s.get_element_count(), 1U);
    EXPECT_EQ(sut_.gains.get_element_count(), 3U);
    EXPECT_EQ(sut_.gains.get()[1], 2.0F);
}

TEST_F(ParameterTest, ValuesAtTheLimitsAreAdmittedInEachWayIn) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues);

    for (const double value : {0.1, 3.0}) {
        EXPECT_TRUE(sut_.limit_rad_s.admits(value));
        EXPECT_EQ(sut_.limit_rad_s.check(std::array{to_scalar(value)}), Status::kOk);
        EXPECT_EQ(sut_.limit_rad_s.request(value), Status::kOk);
        EXPECT_EQ(sut_.limit_rad_s.request_scalars(std::array{to_scalar(value)}), Status::kOk);
        EXPECT_EQ(sut_.limit_rad_s.activate(std::array{to_scalar(value)}), Status::kOk);
        EXPECT_EQ(sut_.limit_rad_s.get(), value);
    }
    EXPECT_EQ(sut_.gains.request({1.0F, -5.0e3F, 0.0F}), Status::kOk);
    EXPECT_EQ(sut_.is_reversed.request(true), Status::kOk);
    EXPECT_EQ(sut_.gear.request(Gear::kSecond), Status::kOk);
    EXPECT_EQ(sut_.baud.request(38400), Status::kOk);
}

TEST_F(ParameterTest, ValuesBeyondTheLimitsAreRefusedInEachWayIn) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues, Polarity::kViolation);

    for (const double value :
         {std::nextafter(0.1, 0.0), std::nextafter(3.0, 4.0), -1.0, std::numeric_limits<double>::quiet_NaN(),
          std::numeric_limits<double>::infinity()}) {
        EXPECT_FALSE(sut_.limit_rad_s.admits(value));
        EXPECT_EQ(sut_.limit_rad_s.check(std::array{to_scalar(value)}), Status::kBadParameter);
        EXPECT_EQ(sut_.limit_rad_s.request(value), Status::kBadParameter);
        EXPECT_EQ(sut_.limit_rad_s.request_scalars(std::array{to_scalar(value)}), Status::kBadParameter);
        EXPECT_EQ(sut_.limit_rad_s.activate(std::array{to_scalar(value)}), Status::kBadParameter);
    }
    EXPECT_EQ(sut_.baud.request(9601), Status::kBadParameter);
    EXPECT_EQ(sut_.gear.request(Gear::kNeutral), Status::kBadParameter);
    EXPECT_FALSE(sut_.limit_rad_s.commit());
    EXPECT_EQ(sut_.limit_rad_s.get(), 1.0);
}

TEST_F(ParameterTest, OneBadElementRefusesTheWholeArray) {
    verifies("SWR-PAR-003", Technique::kEquivalenceClasses, Polarity::kViolation);
    using Gains = std::array<float, 3U>;

    for (const Gains& gains : {Gains{0.0F, 0.0F, 0.0F}, Gains{1.0F, 0.0F, 0.5F},
                               Gains{1.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F}}) {
        EXPECT_EQ(sut_.gains.request(gains), Status::kBadParameter);
    }
    EXPECT_EQ(sut_.gains.request({1.0F, 0.0F, 1.0F}), Status::kOk);
}

TEST_F(ParameterTest, AWrongCountOrKindOfValuesIsRefused) {
    verifies("SWR-PAR-003", Technique::kErrorGuessing, Polarity::kViolation);
    std::array<Scalar, 2U> two{to_scalar(1.0), to_scalar(1.0)};

    EXPECT_EQ(sut_.limit_rad_s.check(two), Status::kBadParameter);
    EXPECT_EQ(sut_.limit_rad_s.check({}), Status::kBadParameter);
    EXPECT_EQ(sut_.gains.check(two), Status::kBadParameter);
    EXPECT_EQ(sut_.gains.read(two), Status::kBadParameter);
    EXPECT_EQ(sut_.limit_rad_s.check(std::array{to_scalar(1)}), Status::kBadParameter);
    EXPECT_EQ(sut_.retries.request_scalars(std::array{to_scalar(256)}), Status::kBadParameter);
    EXPECT_EQ(sut_.retries.activate(std::array{to_scalar(-1)}), Status::kBadParameter);
}

TEST_F(ParameterTest, TheActiveValueIsReadBackWithoutItsType) {
    verifies("SWR-PAR-003", Technique::kInterface);
    std::array<Scalar, 3U> gains{};
    std::array<Scalar, 1U> gear{};

    ASSERT_EQ(sut_.gains.read(gains), Status::kOk);
    ASSERT_EQ(sut_.gear.read(gear), Status::kOk);
    EXPECT_EQ(gains[1].real, 2.0);
    EXPECT_EQ(gear[0].whole.magnitude, 1U);
}

TEST_F(ParameterTest, ARequestBecomesActiveAtTheCommitAndOnlyOnce) {
    verifies("SWR-PAR-005");

    ASSERT_EQ(sut_.limit_rad_s.request(2.0), Status::kOk);
    EXPECT_EQ(sut_.limit_rad_s.get(), 1.0);
    EXPECT_TRUE(sut_.limit_rad_s.commit());
    EXPECT_EQ(sut_.limit_rad_s.get(), 2.0);
    EXPECT_FALSE(sut_.limit_rad_s.commit());
    EXPECT_EQ(sut_.limit_rad_s.get(), 2.0);
}

TEST_F(ParameterTest, OfSeveralRequestsTheLastOneCountsAndARefusedOneLeavesItAlone) {
    verifies("SWR-PAR-005", Technique::kStateTransition, Polarity::kViolation);

    ASSERT_EQ(sut_.limit_rad_s.request(2.0), Status::kOk);
    ASSERT_EQ(sut_.limit_rad_s.request(2.5), Status::kOk);
    ASSERT_EQ(sut_.limit_rad_s.request(99.0), Status::kBadParameter);
    EXPECT_TRUE(sut_.limit_rad_s.commit());
    EXPECT_EQ(sut_.limit_rad_s.get(), 2.5);
}

TEST_F(ParameterTest, AnArrayIsNeverSeenHalfChangedWhileThreadsSendRequests) {
    verifies("SWR-PAR-005", Technique::kFaultInjection, Polarity::kViolation);
    static Parameter<std::array<std::int64_t, 8U>> shared{kNoOwner, "shared", {}};
    std::atomic<bool> is_done{false};
    std::atomic<int> refused_count{0};
    const auto send = [&is_done, &refused_count](std::int64_t sign) {
        for (std::int64_t i = 1; !is_done.load(); ++i) {
            std::array<std::int64_t, 8U> value{};
            value.fill(sign * i);
            const Status status = shared.request(value);
            if (status == Status::kPreconditionNotMet) {
                ++refused_count;
            } else if (status != Status::kOk) {
                ADD_FAILURE() << get_name(status);
            }
        }
    };
    std::thread positive{send, 1};
    std::thread negative{send, -1};

    std::int64_t commit_count = 0;
    while (commit_count < 2000) {
        commit_count += shared.commit() ? 1 : 0;
        const auto at_begin = shared.get();
        for (const std::int64_t element : at_begin) {
            ASSERT_EQ(element, at_begin[0]);
        }
        ASSERT_EQ(shared.get(), at_begin);
    }
    is_done = true;
    positive.join();
    negative.join();
    EXPECT_EQ(shared.request({}), Status::kOk) << "no request leaves the parameter busy";
}

bool is_range(const Result<ScalarRange>& result, double lower, double upper, std::uint16_t element) {
    const ScalarRange& range = result.get_value();
    return result.has_value() && range.lower.real == lower && range.upper.real == upper &&
           range.element == element;
}

TEST_F(ParameterTest, TheRangesOfAConstraintAreReadWithoutTheirType) {
    verifies("SWR-PAR-003", Technique::kInterface);
    const ParameterBase& gains = sut_.gains;

    EXPECT_TRUE(is_range(sut_.limit_rad_s.get_range(0U), 0.1, 3.0, Range<double>::kEachElement));
    const ScalarRange first = gains.get_range(0U).get_value();
    EXPECT_EQ(first.element, 0U);
    EXPECT_TRUE(first.has_lower && first.is_lower_open);
    EXPECT_FALSE(first.has_upper || first.is_upper_open);
    const ScalarRange second = gains.get_range(1U).get_value();
    EXPECT_EQ(second.element, 1U);
    EXPECT_FALSE(second.has_lower || second.has_upper || second.is_lower_open || second.is_upper_open);
    EXPECT_TRUE(is_range(gains.get_range(2U), 0.0, 0.0, 2U));
    EXPECT_TRUE(is_range(gains.get_range(3U), 1.0, 1.0, 2U));
    EXPECT_TRUE(gains.get_range(3U).get_value().has_lower && gains.get_range(3U).get_value().has_upper);
}

TEST_F(ParameterTest, ARangeThatAConstraintDoesNotHaveIsNotRead) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_TRUE(sut_.retries.get_range(0U).has_value());
    EXPECT_EQ(sut_.retries.get_range(1U).get_status(), Status::kBadParameter);
    EXPECT_EQ(sut_.gains.get_range(4U).get_status(), Status::kBadParameter);
}

TEST_F(ParameterTest, ALimitAtTheEndOfTheTypeIsNoLimitUnlessItIsExcluded) {
    verifies("SWR-PAR-003", Technique::kBoundaryValues);
    using Sut = Parameter<std::uint8_t>;

    EXPECT_FALSE(Sut(kNoOwner, "p", 9U, at_least(0)).get_range(0U).get_value().has_lower);
    EXPECT_TRUE(Sut(kNoOwner, "p", 9U, at_least(1)).get_range(0U).get_value().has_lower);
    EXPECT_TRUE(Sut(kNoOwner, "p", 9U, above(0)).get_range(0U).get_value().has_lower);
    EXPECT_FALSE(Sut(kNoOwner, "p", 9U, at_most(255)).get_range(0U).get_value().has_upper);
    EXPECT_TRUE(Sut(kNoOwner, "p", 9U, at_most(254)).get_range(0U).get_value().has_upper);
    const ScalarRange below_max = Sut(kNoOwner, "p", 9U, below(255)).get_range(0U).get_value();
    EXPECT_TRUE(below_max.has_upper && below_max.is_upper_open);
}

TEST(ParameterConstantTest, AWellFormedParameterIsAConstant) {
    verifies("SWR-PAR-004", Technique::kInterface);
    static constexpr Drive kDrive{};
    static_assert(kDrive.limit_rad_s.get() == 1.0);
    static_assert(!kDrive.limit_rad_s.admits(0.05));

    EXPECT_TRUE(kDrive.gear.admits(Gear::kSecond));
}

}  // namespace
}  // namespace mamori
