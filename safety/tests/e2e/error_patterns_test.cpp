// SPDX-License-Identifier: Apache-2.0
// Goal: each profile lets pass exactly those error patterns that its definition lets pass.
// Method: every pattern of few bits and every burst at lengths of interest, read by the real code, counted
// beside a model
//         that divides the errors alone, and beside published counts. All lengths: mamori_e2e_errors.
#include "error_patterns.hpp"

#include "error_model.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

template <typename Case>
std::uint64_t count(std::size_t length, unsigned weight) {
    rig::RealTrial<Case> real{length};
    rig::ModelTrial model{rig::get_rules<Case>(), length};
    const std::uint64_t passed = rig::count_weight(real, weight);
    EXPECT_EQ(passed, rig::count_weight(model, weight)) << length << " bytes, " << weight << " bits";
    return passed;
}

template <typename Case>
std::uint64_t count_bursts(std::size_t length, unsigned width) {
    rig::RealTrial<Case> real{length};
    rig::ModelTrial model{rig::get_rules<Case>(), length};
    const std::uint64_t passed = rig::count_bursts(real, width);
    EXPECT_EQ(passed, rig::count_bursts(model, width)) << length << " bytes, bursts of " << width;
    return passed;
}

/// Profile 2 with the same identifier for each counter, which makes it linear: its published counts are for
/// that.
template <typename Profile>
struct Constant : rig::Listed<Profile> {
    static IdListChannel make(std::size_t length) {
        IdListChannel channel{{}, length};
        channel.data_ids.fill(0x5AU);
        return channel;
    }
};

TEST(E2eErrorPatternsTest, PublishedCountsComeOut) {
    verifies("SWR-E2E-012", Technique::kBackToBack);

    EXPECT_EQ(count<rig::P01Both>(8U, 3U), 198U);
    EXPECT_EQ(count<Constant<E2eProfile02<>>>(8U, 2U), 0U);
    EXPECT_EQ(count<Constant<E2eProfile02<>>>(14U, 2U), 0U);
    EXPECT_EQ(count<Constant<E2eProfile02<>>>(15U, 2U), 1U);
    EXPECT_EQ(count<Constant<E2eProfile02<>>>(16U, 2U), 8U);
    EXPECT_EQ(count<Constant<E2eProfile22<>>>(32U, 2U), 137U);
    EXPECT_EQ(count<rig::P05>(8U, 4U), 64U);
}

template <typename... Cases>
struct EachOf {
    template <typename Action>
    static void run(Action action) {
        (action(Cases{}), ...);
    }
};
using LinearEightBits = EachOf<rig::P01Both, rig::P01Low, rig::P01Nibble, rig::P11Both, rig::P11Nibble>;
using Wider = EachOf<rig::P04, rig::P05, rig::P06, rig::P07, rig::P08, rig::P44>;

TEST(E2eErrorPatternsTest, OneAndTwoBitsNeverPassWhereTheProfileIsMeantToSeeThem) {
    verifies("SWR-E2E-012", Technique::kFaultInjection, Polarity::kViolation);

    LinearEightBits::run([](auto example) {
        EXPECT_EQ(count<decltype(example)>(30U, 1U), 0U);
        EXPECT_EQ(count<decltype(example)>(30U, 2U), 0U);
    });
    Wider::run([](auto example) {
        EXPECT_EQ(count<decltype(example)>(64U, 1U), 0U);
        EXPECT_EQ(count<decltype(example)>(64U, 2U), 0U);
    });
}

TEST(E2eErrorPatternsTest, CounterThatSwitchesTheIdentifierIsCountedAsItIs) {
    verifies("SWR-E2E-012", Technique::kErrorGuessing, Polarity::kViolation);

    // Not linear: a turned counter bit changes a byte that is not sent. Compared with the model, without a
    // published count.
    for (const std::size_t length : {8U, 14U, 16U}) {
        static_cast<void>(count<rig::P02>(length, 2U));
        static_cast<void>(count<rig::P22>(length, 3U));
    }
}

TEST(E2eErrorPatternsTest, BurstsAreCountedUpToTheWidthOfTheChecksum) {
    verifies("SWR-E2E-012", Technique::kFaultInjection, Polarity::kViolation);

    LinearEightBits::run([](auto example) { static_cast<void>(count_bursts<decltype(example)>(8U, 8U)); });
    static_cast<void>(count_bursts<rig::P01Alternating>(8U, 8U));
    static_cast<void>(count_bursts<rig::P02>(8U, 8U));
    static_cast<void>(count_bursts<rig::P05>(8U, 16U));
    static_cast<void>(count_bursts<rig::P06>(8U, 16U));
    EXPECT_EQ(rig::count_dependent_windows<kCrc32P4>(64U, 8U), 0U) << "profiles 4 and 44";
    EXPECT_EQ(rig::count_dependent_windows<kCrc32P4>(64U, 0U), 0U) << "profile 8";
    EXPECT_EQ(rig::count_dependent_windows<kCrc64>(64U, 0U), 0U) << "profile 7";
}

}  // namespace
}  // namespace mamori::safety
