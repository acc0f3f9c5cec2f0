// SPDX-License-Identifier: Apache-2.0
// Goal: the compiler's residual errors are the published ones where they are exact, never below them where
// they are bounds, and channels over their budget are told from others. Method: the published table; every
// pattern of a short frame tried on the real code; both sides of each limit.
#include "mamori/safety/e2e/channel_budget.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "error_patterns.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

constexpr std::array<double, 3U> kErrorProbabilities{1e-2, 1e-3, 1e-5};
using Published = std::array<double, 3U>;

constexpr NibbleCounterChannel make_nibbles(std::size_t length, DataIdMode mode = DataIdMode::kBoth) {
    return {0x0123U, mode, length};
}
constexpr IdListChannel make_constant_list(std::size_t length) {
    IdListChannel channel{{}, length};
    for (std::uint8_t& id : channel.data_ids) {
        id = 0x5AU;
    }
    return channel;
}
constexpr KnownIdChannel make_known(std::size_t length) {
    return {0x1234U, length, length};
}
constexpr SentIdChannel make_sent(std::size_t length) {
    return {0x0A0B0C0DU, length, length};
}

template <typename Profile>
void expect_published(const typename Profile::Channel& channel, const Published& published) {
    for (std::size_t i = 0U; i < published.size(); ++i) {
        const double found = bound_residual_error<Profile>(channel, kErrorProbabilities[i]);
        EXPECT_NEAR(found / published[i], 1.0, 0.005) << kErrorProbabilities[i];
    }
}

TEST(E2eResidualErrorTest, EightBitProfilesHaveThePublishedResidualErrors) {
    verifies("SWR-E2E-022", Technique::kBackToBack);

    expect_published<E2eProfile01<>>(make_nibbles(8U), {1.22e-4, 1.89e-7, 1.98e-13});
    expect_published<E2eProfile11<>>(make_nibbles(30U), {1.70e-3, 7.54e-6, 8.98e-12});
    expect_published<E2eProfile01<>>(make_nibbles(30U, DataIdMode::kNibble), {1.70e-3, 7.54e-6, 8.98e-12});
    expect_published<E2eProfile02<>>(make_constant_list(8U), {2.80e-5, 4.77e-9, 5.06e-17});
    expect_published<E2eProfile22<>>(make_constant_list(16U), {4.82e-4, 7.13e-6, 7.99e-10});
    expect_published<E2eProfile02<>>(make_constant_list(32U), {2.42e-3, 1.07e-4, 1.37e-8});
}

TEST(E2eResidualErrorTest, PlaceOfTheHeaderChangesNothingWhereTheIdentifierIsConstant) {
    verifies("SWR-E2E-022", Technique::kEquivalenceClasses);

    NibbleCounterChannel moved = make_nibbles(8U);
    moved.crc_offset = 24U;
    moved.counter_offset = 60U;
    IdListChannel behind = make_constant_list(8U);
    behind.offset = 5U;
    expect_published<E2eProfile01<>>(moved, {1.22e-4, 1.89e-7, 1.98e-13});
    expect_published<E2eProfile22<>>(behind, {2.80e-5, 4.77e-9, 5.06e-17});
}

/// Sum over all patterns of up to `most` bits that the real code lets pass, with each counter in turn; the
/// worst. What a counter does beyond its range, and what is compared beside the checksum, is counted as
/// passing.
template <typename Profile>
double try_patterns(const typename Profile::Channel& channel, std::size_t length, unsigned most, double pe,
                    std::uint32_t counter) {
    rig::Frame frame = rig::protect<Profile>(channel, counter, length);
    const auto bits = static_cast<double>(length * 8U);
    struct Trial {
        const typename Profile::Channel& channel;
        rig::Frame& frame;
        std::size_t get_bit_count() const { return frame.size() * 8U; }
        void turn(std::size_t bit) { frame[bit / 8U] ^= std::byte{0x80U} >> (bit % 8U); }
        bool passes() const {
            std::uint32_t read = 0U;
            return Profile::read(channel, rig::view(frame), read) != FrameCause::kChecksum;
        }
    } trial{channel, frame};
    double sum = 0.0;
    for (unsigned weight = 1U; weight <= most; ++weight) {
        sum += static_cast<double>(rig::count_weight(trial, weight)) * std::pow(pe, weight) *
               std::pow(1.0 - pe, bits - weight);
    }
    return sum;
}

template <typename Profile>
void expect_counted(const typename Profile::Channel& channel, std::size_t length) {
    constexpr double kPe = 1e-6;  // patterns of more bits weigh less than 1e-6 of those of two or three
    double worst = 0.0;
    for (std::uint32_t counter = 0U; counter <= Profile::kCounterMax; ++counter) {
        const double sum = try_patterns<Profile>(channel, length, 3U, kPe, counter);
        worst = sum > worst ? sum : worst;
    }
    EXPECT_NEAR(bound_residual_error<Profile>(channel, kPe) / worst, 1.0, 1e-3) << length;
}

TEST(E2eResidualErrorTest, IdentifiersThatTheCounterPicksAreCalculatedAsTheyAre) {
    verifies("SWR-E2E-022", Technique::kBackToBack);

    expect_counted<E2eProfile02<>>(rig::P02::make(6U), 6U);
    expect_counted<E2eProfile02<>>(rig::P02::make(8U), 8U);
    IdListChannel moved = rig::P22::make(9U);
    moved.offset = 4U;
    expect_counted<E2eProfile22<>>(moved, 9U);
    expect_counted<E2eProfile01<>>(make_nibbles(8U, DataIdMode::kAlternating), 8U);
    expect_counted<E2eProfile01<>>(make_nibbles(12U, DataIdMode::kAlternating), 12U);
}

TEST(E2eResidualErrorTest, ListOfDifferentIdentifiersIsNotTakenForAConstantOne) {
    verifies("SWR-E2E-022", Technique::kErrorGuessing, Polarity::kViolation);

    constexpr double kPe = 1e-3;
    EXPECT_GT(bound_residual_error<E2eProfile02<>>(rig::P02::make(8U), kPe), 2.8e-6);
    EXPECT_LT(bound_residual_error<E2eProfile02<>>(make_constant_list(8U), kPe), 4.8e-9);
    // Found by trying the error patterns: one pair of bits passes at 30 bytes.
    EXPECT_GT(bound_residual_error<E2eProfile01<>>(make_nibbles(30U, DataIdMode::kAlternating), 1e-5), 1e-10);
}

TEST(E2eResidualErrorTest, ListThatHidesATurnedCounterBitIsFound) {
    verifies("SWR-E2E-022", Technique::kErrorGuessing, Polarity::kViolation);

    // For one of 256 second identifiers, the checksum of the other identifier is that of the other counter
    // bit.
    IdListChannel channel{{}, 8U};
    std::size_t hiding = 0U;
    for (unsigned id = 0U; id < 256U; ++id) {
        channel.data_ids[1] = static_cast<std::uint8_t>(id);
        if (bound_residual_error<E2eProfile22<>>(channel, 1e-3) > 9e-4) {
            ++hiding;
            expect_counted<E2eProfile22<>>(channel, 8U);
        }
    }
    EXPECT_EQ(hiding, 4U);
}

TEST(E2eResidualErrorTest, CounterWithTheGreatestResidualErrorCounts) {
    verifies("SWR-E2E-022", Technique::kBoundaryValues, Polarity::kViolation);

    constexpr double kPe = 1e-3;
    // Two of its neighbours hide a turned bit of `counter`, and of the neighbours each hides one only.
    for (const std::uint32_t counter : {0U, 15U}) {
        IdListChannel channel{{}, 8U};
        for (const std::uint32_t bit : {1U, 2U}) {
            const double before = try_patterns<E2eProfile22<>>(channel, 8U, 1U, kPe, counter);
            std::uint8_t& id = channel.data_ids[counter ^ bit];
            while (try_patterns<E2eProfile22<>>(channel, 8U, 1U, kPe, counter) <= before && id < 255U) {
                ++id;
            }
        }
        const double worst = bound_residual_error<E2eProfile22<>>(channel, kPe);
        EXPECT_NEAR(worst / (2.0 * kPe * std::pow(1.0 - kPe, 63.0)), 1.0, 0.01) << counter;
    }
}

template <typename Profile>
void expect_bounded(const typename Profile::Channel& channel, const Published& published, double loosest) {
    for (std::size_t i = 0U; i < published.size(); ++i) {
        const double ratio = bound_residual_error<Profile>(channel, kErrorProbabilities[i]) / published[i];
        EXPECT_GT(ratio, 0.995) << kErrorProbabilities[i];
        EXPECT_LT(ratio, loosest) << kErrorProbabilities[i];
    }
}

TEST(E2eResidualErrorTest, BoundsAreNeverBelowThePublishedResidualErrorsAndNotFarAbove) {
    verifies("SWR-E2E-023", Technique::kBackToBack);

    expect_bounded<E2eProfile05<>>(make_known(16U), {1.67e-6, 4.97e-10, 5.61e-18}, 3.0);
    expect_bounded<E2eProfile06<>>(make_known(32U), {5.31e-6, 4.20e-9, 5.38e-17}, 12.0);
    expect_bounded<E2eProfile05<>>(make_known(64U), {1.25e-5, 5.08e-8, 8.33e-16}, 8.0);
    expect_bounded<E2eProfile04<>>(make_sent(16U), {2.54e-14, 7.42e-22, 8.35e-38}, 1.5);
    expect_bounded<E2eProfile08<>>(make_sent(32U), {1.69e-12, 1.48e-19, 1.89e-35}, 150.0);
    expect_bounded<E2eProfile44<>>(make_sent(64U), {8.78e-11, 4.29e-15, 7.04e-27}, 15.0);
}

TEST(E2eResidualErrorTest, BoundsAreThoseOfTheDesignNote) {
    verifies("SWR-E2E-023");

    expect_published<E2eProfile05<>>(make_known(16U), {4.87e-6, 5.29e-10, 5.62e-18});
    expect_published<E2eProfile06<>>(make_known(32U), {5.83e-5, 4.73e-9, 5.38e-17});
    expect_published<E2eProfile05<>>(make_known(64U), {3.65e-5, 5.92e-8, 8.34e-16});
    expect_published<E2eProfile44<>>(make_sent(16U), {3.41e-14, 7.50e-22, 8.35e-38});
    expect_published<E2eProfile04<>>(make_sent(32U), {7.38e-12, 1.54e-19, 1.89e-35});
    expect_published<E2eProfile08<>>(make_sent(64U), {1.11e-9, 6.13e-15, 7.06e-27});
}

/// Residual error of a 16-bit checksum, by following how likely turned bits add up to each of 65536 sums.
double calc_exact(std::size_t length, double pe) {
    std::vector<double> turned(65536U);
    double untouched = 1.0;
    std::size_t power = 1U;
    for (std::size_t place = 0U; place < length * 8U + 16U; ++place) {
        if (place < 16U || place >= 32U) {  // between them lie the bits of the identifier, which is not sent
            for (std::size_t sum = 0U; sum < turned.size(); ++sum) {
                const std::size_t other = sum ^ power;
                if (sum < other) {
                    const double here = turned[sum];
                    turned[sum] = (1.0 - pe) * here + pe * turned[other];
                    turned[other] = (1.0 - pe) * turned[other] + pe * here;
                }
            }
            turned[power] += pe * untouched;
            untouched *= 1.0 - pe;
        }
        power = ((power << 1U) ^ ((power & 0x8000U) != 0U ? 0x1021U : 0U)) & 0xFFFFU;
    }
    return turned[0];
}

TEST(E2eResidualErrorTest, BoundIsNeverBelowTheExactValue) {
    verifies("SWR-E2E-023", Technique::kBackToBack, Polarity::kViolation);

    for (const std::size_t length : {3U, 4U, 5U, 9U, 11U, 13U, 17U, 25U, 33U, 41U}) {
        for (const double pe : {1e-6, 1e-3, 1e-2, 0.1, 0.5}) {
            const double ratio =
                bound_residual_error<E2eProfile05<>>(make_known(length), pe) / calc_exact(length, pe);
            EXPECT_GT(ratio, 1.0 - 1e-9) << length << " bytes, " << pe;
        }
    }
    EXPECT_NEAR(calc_exact(32U, 1e-2) / 5.31e-6, 1.0, 0.005);
}

TEST(E2eResidualErrorTest, ChangedRowHasAnotherFingerprint) {
    verifies("SWR-E2E-023", Technique::kFaultInjection, Polarity::kViolation);

    const std::array<detail::ResidualFacts, 1U> row{detail::ResidualFacts{16U, 4U, 562U, 807U}};
    const std::uint32_t fingerprint = detail::calc_fingerprint(row);
    EXPECT_EQ(fingerprint, 0x713005D8U);
    for (const detail::ResidualFacts& changed :
         {detail::ResidualFacts{17U, 4U, 562U, 807U}, detail::ResidualFacts{16U, 5U, 562U, 807U},
          detail::ResidualFacts{16U, 4U, 563U, 807U}, detail::ResidualFacts{16U, 4U, 562U, 808U}}) {
        EXPECT_NE(detail::calc_fingerprint(std::array<detail::ResidualFacts, 1U>{changed}), fingerprint);
    }
}

TEST(E2eResidualErrorTest, BoundOfALengthBetweenTwoRowsIsThatOfTheLongerOne) {
    verifies("SWR-E2E-023", Technique::kBoundaryValues);

    constexpr double kPe = 1e-5;
    const double between = bound_residual_error<E2eProfile05<>>(make_known(17U), kPe);
    EXPECT_GT(between, bound_residual_error<E2eProfile05<>>(make_known(16U), kPe));
    EXPECT_NEAR(between / bound_residual_error<E2eProfile05<>>(make_known(20U), kPe), 1.0, 0.01);
    EXPECT_GT(between, 6.94e-18) << "what ./mamori e2e shows for 17 bytes";
    // So many bits are missing to the row that one of them is turned: nothing is known any more.
    EXPECT_EQ(bound_residual_error<E2eProfile05<>>(make_known(65U), 0.01), 1.0);
    EXPECT_EQ(bound_residual_error<E2eProfile05<>>(make_known(72U), 1.0 / 192.0), 1.0);
    EXPECT_EQ(bound_residual_error<E2eProfile05<>>(make_known(72U), std::nextafter(1.0 / 192.0, 0.0)), 1.0);
    EXPECT_LT(bound_residual_error<E2eProfile05<>>(make_known(72U), 1.0 / 193.0), 1.0);
    EXPECT_EQ(bound_residual_error<E2eProfile06<>>(KnownIdChannel{0x1234U, 65U, 128U}, 0.01), 1.0);
}

TEST(E2eResidualErrorTest, ChannelOfManyLengthsHasTheBoundOfItsWorst) {
    verifies("SWR-E2E-023", Technique::kBoundaryValues);

    constexpr double kPe = 1e-3;
    const auto bound = [](std::size_t least, std::size_t greatest) {
        return bound_residual_error<E2eProfile06<>>(KnownIdChannel{0x1234U, least, greatest}, kPe);
    };
    for (std::size_t length = 8U; length <= 64U; ++length) {
        EXPECT_GE(bound(8U, 64U), bound(length, length)) << length;
    }
    EXPECT_EQ(bound(8U, 64U), bound(57U, 57U)) << "the row of 64 bytes is loosest for its shortest frame";
    EXPECT_EQ(bound(16U, 17U), bound(17U, 17U));
    EXPECT_EQ(bound(16U, 16U), bound(16U, 16U));
}

TEST(E2eResidualErrorTest, FramesThatNothingIsKnownOfMayAlwaysPass) {
    verifies("SWR-E2E-023", Technique::kBoundaryValues, Polarity::kViolation);

    const std::size_t known = detail::kResidualFacts32.back().length;
    EXPECT_LT(bound_residual_error<E2eProfile44<>>(make_sent(known), 1e-6), 1e-9);
    EXPECT_EQ(bound_residual_error<E2eProfile44<>>(make_sent(known + 1U), 1e-6), 1.0);
    EXPECT_LT(bound_residual_error<E2eProfile05<>>(make_known(4096U), 0.5), 1.0);
    EXPECT_EQ(bound_residual_error<E2eProfile05<>>(make_known(3000U), 0.5), 1.0);
}

TEST(E2eResidualErrorTest, BoundsDoNotFallBelowThoseOfSmallerProbabilities) {
    verifies("SWR-E2E-023", Technique::kBoundaryValues, Polarity::kViolation);

    for (const std::size_t length : {16U, 20U, 64U}) {
        double before = 0.0;
        for (double pe = 1e-9; pe <= 0.5; pe *= 1.1) {
            const double bound = bound_residual_error<E2eProfile05<>>(make_known(length), pe);
            EXPECT_GE(bound, before) << length << " bytes, " << pe;
            before = bound;
        }
    }
}

TEST(E2eResidualErrorTest, WidestChecksumHasTheUsualEstimate) {
    verifies("SWR-E2E-023");

    EXPECT_EQ(bound_residual_error<E2eProfile07<>>(make_sent(32U), 1e-2), std::pow(0.5, 64.0));
}

TEST(E2eResidualErrorTest, RateIsThatOfAllReceiversInAnHour) {
    verifies("SWR-E2E-024");

    constexpr ChannelUse kOnce{1000.0, 1e-2, 1U};
    constexpr ChannelUse kThrice{1000.0, 1e-2, 3U};
    EXPECT_NEAR(bound_residual_rate<E2eProfile01<>>(make_nibbles(8U), kOnce), 4.4e2, 5.0);
    EXPECT_NEAR(bound_residual_rate<E2eProfile01<>>(make_nibbles(8U), kThrice), 1.32e3, 15.0);
}

TEST(E2eResidualErrorTest, BudgetsAreOnePercentOfTheBandsOfTheLevels) {
    verifies("SWR-E2E-024");

    EXPECT_EQ(kSil1ChannelBudget, 1e-7);
    EXPECT_EQ(kSil2ChannelBudget, 1e-8);
    EXPECT_EQ(kSil3ChannelBudget, 1e-9);
    EXPECT_EQ(kSil4ChannelBudget, 1e-10);
}

TEST(E2eResidualErrorTest, BudgetIsKeptUpToItselfAndNotAbove) {
    verifies("SWR-E2E-024", Technique::kBoundaryValues, Polarity::kViolation);

    ChannelUse use{1000.0, 1e-3};
    const SentIdChannel channel = make_sent(64U);
    use.budget_per_hour = bound_residual_rate<E2eProfile04<>>(channel, use);
    EXPECT_EQ(judge_budget<E2eProfile04<>>(channel, use).fault, BudgetFault::kNone);

    use.budget_per_hour = std::nextafter(use.budget_per_hour, 0.0);
    const BudgetVerdict over = judge_budget<E2eProfile04<>>(channel, use);
    EXPECT_EQ(over.fault, BudgetFault::kBudget);
    EXPECT_EQ(over.times, 2U);

    use.budget_per_hour = 1e-300;
    EXPECT_EQ(judge_budget<E2eProfile04<>>(channel, use).times, 1000000001U);
}

TEST(E2eResidualErrorTest, UseOutOfRangeIsRefused) {
    verifies("SWR-E2E-024", Technique::kBoundaryValues, Polarity::kViolation);

    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const auto judge = [](const ChannelUse& use) {
        return judge_budget<E2eProfile04<>>(make_sent(16U), use).fault;
    };
    EXPECT_EQ(judge({}), BudgetFault::kUse) << "a use without a rate";
    EXPECT_EQ(ChannelUse{}.bit_error_probability, 1e-2);
    EXPECT_EQ(ChannelUse{}.receivers, 1U);
    EXPECT_EQ(ChannelUse{}.budget_per_hour, kSil3ChannelBudget);
    EXPECT_EQ(judge({1e-9, 1e-5, 1U, 1.0}), BudgetFault::kNone);
    EXPECT_EQ(judge({0.0, 1e-5, 1U, 1.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({kNone, 1e-5, 1U, 1.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({1e-9, 0.0, 1U, 1.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({1e-9, kNone, 1U, 1.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({1e-9, 0.5, 1U, 1.0}), BudgetFault::kNone);
    EXPECT_EQ(judge({1e-9, 0.5001, 1U, 1.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({1e-9, 1e-5, 0U, 1.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({1e-9, 1e-5, 1U, 0.0}), BudgetFault::kUse);
    EXPECT_EQ(judge({1e-9, 1e-5, 1U, kNone}), BudgetFault::kUse);
}

TEST(E2eResidualErrorTest, ChannelsThatCannotBeJudgedAreRefused) {
    verifies("SWR-E2E-024", Technique::kBoundaryValues, Polarity::kViolation);

    constexpr ChannelUse kUse{1e-3, 1e-9};
    const auto judge = [&kUse](auto profile, const auto& channel) {
        const BudgetVerdict verdict = judge_budget<decltype(profile)>(channel, kUse);
        EXPECT_EQ(verdict.times, 0U);
        return verdict.fault;
    };
    EXPECT_EQ(judge(E2eProfile04<>{}, make_sent(8U)), BudgetFault::kChannel);
    EXPECT_EQ(judge(E2eProfile02<>{}, make_constant_list(14U)), BudgetFault::kNone);
    EXPECT_EQ(judge(E2eProfile02<>{}, make_constant_list(15U)), BudgetFault::kShortDistance);
    EXPECT_EQ(judge(E2eProfile22<>{}, make_constant_list(15U)), BudgetFault::kShortDistance);
    EXPECT_EQ(judge(E2eProfile01<>{}, make_nibbles(30U)), BudgetFault::kNone);
    const std::size_t known = detail::kResidualFacts32.back().length;
    EXPECT_EQ(judge(E2eProfile44<>{}, make_sent(known)), BudgetFault::kNone);
    EXPECT_EQ(judge(E2eProfile44<>{}, make_sent(known + 1U)), BudgetFault::kUnknownLength);
    EXPECT_EQ(judge(E2eProfile08<>{}, make_sent(known + 1U)), BudgetFault::kUnknownLength);
    EXPECT_EQ(judge(E2eProfile07<>{}, make_sent(4194304U)), BudgetFault::kNone);
    EXPECT_EQ(judge(E2eProfile05<>{}, make_known(4096U)), BudgetFault::kNone);
    ChannelUse none = kUse;
    none.receivers = 0U;
    EXPECT_EQ(judge_budget<E2eProfile04<>>(make_sent(16U), none).times, 0U);
}

TEST(E2eResidualErrorTest, ChannelWithinItsBudgetIsProven) {
    verifies("SWR-E2E-024");

    static constexpr ChannelUse kUse{1000.0, 1e-3, 1U, kSil4ChannelBudget};
    static constexpr SentIdChannel kChannel{0x0A0B0C0DU, 16U, 16U};
    EXPECT_TRUE((is_within_budget<E2eProfile04<>, kChannel, kUse>()));
}

// What the manual shows.
constexpr SentIdChannel kManualChannel{0x0A0B0C0DU, 16U, 16U};
constexpr ChannelUse kManualUse{1000.0, 1e-3};
static_assert(is_within_budget<E2eProfile04<>, kManualChannel, kManualUse>());
// The compiler can also calculate where next to nothing is left.
static_assert(bound_residual_error<E2eProfile04<>>(kManualChannel, 1e-300) >= 0.0);
static_assert(bound_residual_error<E2eProfile01<>>(make_nibbles(30U), 0.5) < 4e-3);

}  // namespace
}  // namespace mamori::safety
