// SPDX-License-Identifier: Apache-2.0
// Goal: CONFORMANT judges the order of frames as AUTOSAR does, its rewind included; HARDENED accepts no frame
// of the past. Method: published status lists, both sides of each limit, the wrap of each counter, a million
// randomised replays.
#include <cstdint>
#include <random>
#include <vector>

#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/hardened_sequence.hpp"
#include "mamori/safety/e2e/sequence.hpp"
#include "mamori/trace/verifies.hpp"
#include "rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using Statuses = std::vector<CheckStatus>;
using Counters = std::vector<std::uint32_t>;

constexpr CheckStatus kOk = CheckStatus::kOk;
constexpr CheckStatus kLost = CheckStatus::kOkSomeLost;
constexpr CheckStatus kWrong = CheckStatus::kWrongSequence;
constexpr CheckStatus kRepeated = CheckStatus::kRepeated;
constexpr CheckStatus kSync = CheckStatus::kSync;
constexpr CheckStatus kInitial = CheckStatus::kInitial;

template <typename Sut>
Statuses judge(Sut& sut, const Counters& counters) {
    Statuses statuses;
    for (const std::uint32_t counter : counters) {
        statuses.push_back(sut.judge(counter));
    }
    return statuses;
}

TEST(PlainSequenceTest, PublishedStatusListComesOut) {
    verifies("SWR-E2E-006", Technique::kBackToBack);
    // Frames 3 4 5 are old: AUTOSAR's rule accepts them from the second one on, and so does this mode.
    E2eChecker<E2eProfile04<>> sut{rig::P04::make(16U), {2U}};
    Statuses statuses;
    for (const std::uint32_t counter : {0U, 1U, 2U, 3U, 100U, 101U, 3U, 4U, 5U}) {
        statuses.push_back(
            sut.check(rig::view(rig::protect<E2eProfile04<>>(rig::P04::make(16U), counter, 16U))));
    }

    EXPECT_EQ(statuses, (Statuses{kOk, kOk, kOk, kOk, kWrong, kOk, kWrong, kOk, kOk}));
}

TEST(PlainSequenceTest, StepIsJudgedAtItsLimit) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues, Polarity::kViolation);
    PlainSequence sut{{3U}, 255U};

    EXPECT_EQ(judge(sut, {0U, 3U}), (Statuses{kOk, kLost}));
    EXPECT_EQ(sut.get_lost_count(), 2U);
    EXPECT_EQ(judge(sut, {7U}), (Statuses{kWrong}));
    EXPECT_EQ(sut.get_lost_count(), 0U);
    EXPECT_EQ(judge(sut, {7U, 6U}), (Statuses{kRepeated, kWrong}));
}

TEST(PlainSequenceTest, CounterWraps) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues);
    for (const std::uint32_t most : {14U, 15U, 255U, 65535U, 0xFFFFFFFFU}) {
        PlainSequence sut{{2U}, most};

        EXPECT_EQ(judge(sut, {0U, most, most, 0U, 1U}), (Statuses{kOk, kWrong, kRepeated, kOk, kOk})) << most;
        EXPECT_EQ(judge(sut, {most - 1U, 0U}), (Statuses{kWrong, kLost})) << most;
        EXPECT_EQ(sut.get_lost_count(), 1U);
        EXPECT_EQ(judge(sut, {most - 1U, 1U}), (Statuses{kWrong, kWrong})) << "a step of three";
    }
}

TEST(PlainSequenceTest, RestartExpectsTheFirstFrame) {
    verifies("SWR-E2E-006", Technique::kStateTransition);
    PlainSequence sut{{1U}, 255U};
    ASSERT_EQ(judge(sut, {0U, 1U}), (Statuses{kOk, kOk}));

    sut.restart();
    EXPECT_EQ(judge(sut, {0U}), (Statuses{kOk}));
}

TEST(PlainSequenceTest, LimitsOutsideTheirRangeAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(PlainSequence::find_fault({0U}, 14U), ChannelFault::kLimits);
    EXPECT_EQ(PlainSequence::find_fault({1U}, 14U), ChannelFault::kNone);
    EXPECT_EQ(PlainSequence::find_fault({14U}, 14U), ChannelFault::kNone);
    EXPECT_EQ(PlainSequence::find_fault({15U}, 14U), ChannelFault::kLimits);
}

TEST(SynchronisingSequenceTest, FirstFrameIsInitialAndTheNextOk) {
    verifies("SWR-E2E-006", Technique::kStateTransition);
    SynchronisingSequence sut{{1U, 1U, 1U}, 14U};

    EXPECT_EQ(judge(sut, {9U, 10U, 11U}), (Statuses{kInitial, kOk, kOk}));
}

TEST(SynchronisingSequenceTest, ToleranceGrowsByOneWithEachCheck) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues, Polarity::kViolation);
    // A check widens the limit before it judges, so after a frame a step of two is within a limit of one.
    SynchronisingSequence sut{{1U, 14U, 1U}, 14U};

    EXPECT_EQ(judge(sut, {0U, 2U}), (Statuses{kInitial, kLost}));
    EXPECT_EQ(sut.get_lost_count(), 1U);
    EXPECT_EQ(judge(sut, {5U}), (Statuses{kWrong})) << "a step of three";
    EXPECT_EQ(judge(sut, {6U, 7U}), (Statuses{kSync, kOk}));
    sut.note_silence();
    sut.note_fault();
    EXPECT_EQ(judge(sut, {11U}), (Statuses{kLost})) << "one silence and one fault: a step of four";
    EXPECT_EQ(sut.get_lost_count(), 3U);
}

TEST(SynchronisingSequenceTest, LongSilenceWidensUpToTheWholePeriodAndNeedsNewProof) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues);
    SynchronisingSequence sut{{1U, 2U, 2U}, 14U};
    ASSERT_EQ(judge(sut, {0U, 1U}), (Statuses{kInitial, kOk}));

    for (int i = 0; i < 100; ++i) {
        sut.note_silence();
    }
    EXPECT_EQ(judge(sut, {0U}), (Statuses{kSync})) << "a step of fourteen";
    EXPECT_EQ(judge(sut, {1U, 2U, 3U}), (Statuses{kSync, kSync, kOk}));
}

TEST(SynchronisingSequenceTest, SilenceUpToTheLimitNeedsNoProof) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues);
    SynchronisingSequence sut{{1U, 2U, 1U}, 15U};
    ASSERT_EQ(judge(sut, {0U, 1U}), (Statuses{kInitial, kOk}));

    sut.note_silence();
    EXPECT_EQ(judge(sut, {1U, 2U}), (Statuses{kRepeated, kOk})) << "one silence and one repetition";
    sut.note_silence();
    EXPECT_EQ(judge(sut, {2U, 2U, 3U}), (Statuses{kRepeated, kRepeated, kSync})) << "one more of them";
}

TEST(SynchronisingSequenceTest, WithoutSynchronisationABreakKeepsItsBaseline) {
    verifies("SWR-E2E-006", Technique::kStateTransition, Polarity::kViolation);
    SynchronisingSequence sut{{0U, 0U, 0U}, 14U};

    EXPECT_EQ(judge(sut, {0U, 1U, 8U}), (Statuses{kInitial, kOk, kWrong}));
    EXPECT_EQ(judge(sut, {2U}), (Statuses{kOk})) << "2 follows 1, the last one in order";
}

TEST(SynchronisingSequenceTest, CounterWrapsAndRestartBeginsAnew) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues);
    SynchronisingSequence sut{{0U, 1U, 1U}, 14U};

    EXPECT_EQ(judge(sut, {13U, 14U, 0U, 1U}), (Statuses{kInitial, kOk, kOk, kOk}));
    sut.restart();
    EXPECT_EQ(judge(sut, {7U, 8U}), (Statuses{kInitial, kOk}));
}

TEST(SynchronisingSequenceTest, LimitsOutsideTheirRangeAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(SynchronisingSequence::find_fault({14U, 14U, 14U}, 14U), ChannelFault::kNone);
    EXPECT_EQ(SynchronisingSequence::find_fault({15U, 14U, 14U}, 14U), ChannelFault::kLimits);
    EXPECT_EQ(SynchronisingSequence::find_fault({14U, 15U, 14U}, 14U), ChannelFault::kLimits);
    EXPECT_EQ(SynchronisingSequence::find_fault({14U, 14U, 15U}, 14U), ChannelFault::kLimits);
}

TEST(HardenedSequenceTest, RewindIsRefusedForGood) {
    verifies("SWR-E2E-007", Technique::kErrorGuessing, Polarity::kViolation);
    HardenedSequence sut{{2U, 2U}, 65535U};

    EXPECT_EQ(judge(sut, {0U, 1U, 2U, 3U}), (Statuses{kWrong, kWrong, kOk, kOk}))
        << "two frames make the baseline";
    EXPECT_EQ(judge(sut, {65000U, 65001U, 65002U}), (Statuses{kWrong, kWrong, kWrong}));
    EXPECT_EQ(judge(sut, {1U, 2U, 3U}), (Statuses{kWrong, kWrong, kRepeated}));
    EXPECT_EQ(judge(sut, {4U, 6U}), (Statuses{kOk, kLost})) << "the sender was never lost";
    EXPECT_EQ(sut.get_lost_count(), 1U);
    EXPECT_EQ(sut.get_resync_count(), 1U);
}

TEST(HardenedSequenceTest, StepIsJudgedAtItsLimitAndAcrossTheWrap) {
    verifies("SWR-E2E-007", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::uint32_t most : {14U, 15U, 255U, 65535U, 0xFFFFFFFFU}) {
        HardenedSequence sut{{2U, 2U}, most};

        EXPECT_EQ(judge(sut, {most - 2U, most - 1U, most, 0U}), (Statuses{kWrong, kWrong, kOk, kOk})) << most;
        EXPECT_EQ(judge(sut, {most, 2U, 2U}), (Statuses{kWrong, kLost, kRepeated})) << most;
        EXPECT_EQ(judge(sut, {5U, 3U}), (Statuses{kWrong, kWrong})) << most << ": 3 steps close the channel";
    }
}

/// A channel that has just accepted frame 3.
HardenedSequence make_synchronised(std::uint32_t max_delta, std::uint32_t counter_max) {
    HardenedSequence sut{{max_delta, 2U}, counter_max};
    EXPECT_EQ(judge(sut, {1U, 2U, 3U}), (Statuses{kWrong, kWrong, kOk}));
    return sut;
}

TEST(HardenedSequenceTest, ALossWithinTheLimitDoesNotCloseTheChannel) {
    verifies("SWR-E2E-028", Technique::kBoundaryValues);
    HardenedSequence sut = make_synchronised(2U, 65535U);

    EXPECT_EQ(judge(sut, {5U, 6U, 8U}), (Statuses{kLost, kOk, kLost}));
    EXPECT_FALSE(sut.is_closed());
}

TEST(HardenedSequenceTest, ALargerGapClosesTheChannelThroughEveryWrapOfTheCounter) {
    verifies("SWR-E2E-028", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::uint32_t most : {14U, 15U, 255U, 65535U}) {
        for (const std::uint32_t max_delta : {1U, 2U, 7U}) {
            for (const std::uint32_t gap : {max_delta + 1U, most / 2U}) {
                if (gap <= max_delta || gap > most / 2U) {
                    continue;  // profile 1 at its greatest limit: every step forward is accepted
                }
                HardenedSequence sut = make_synchronised(max_delta, most);
                std::uint32_t usable = 0U;
                for (std::uint32_t i = 0U; i < 3U * (most + 1U); ++i) {
                    usable += is_usable(sut.judge((3U + gap + i) % (most + 1U))) ? 1U : 0U;
                }
                EXPECT_EQ(usable, 0U) << most << " " << max_delta << " " << gap;
                EXPECT_TRUE(sut.is_closed());
                EXPECT_FALSE(sut.is_synchronised());

                sut.restart();
                EXPECT_FALSE(sut.is_closed());
                EXPECT_EQ(judge(sut, {4U, 5U, 6U}), (Statuses{kWrong, kWrong, kOk})) << "a run, as at first";
            }
        }
    }
}

TEST(HardenedSequenceTest, AGapOfMoreThanHalfTheCounterClosesTheChannelAfterTheSilence) {
    verifies("SWR-E2E-028", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::uint32_t most : {14U, 15U, 255U, 65535U}) {
        const std::uint32_t half = most / 2U;
        const std::uint32_t silence_max = half < 255U ? half : 255U;
        for (const std::uint32_t silence : {silence_max - 1U, silence_max, silence_max + 300U}) {
            HardenedSequence sut = make_synchronised(1U, most);
            for (std::uint32_t i = 0U; i < silence; ++i) {
                sut.note_silence();
            }
            EXPECT_EQ(judge(sut, {(3U + half + 1U) % (most + 1U)}), Statuses{kWrong});
            EXPECT_EQ(sut.is_closed(), silence >= silence_max) << most;
        }
    }
}

TEST(HardenedSequenceTest, ASenderThatComesBackFromFarAheadStaysOut) {
    verifies("SWR-E2E-028", Technique::kErrorGuessing, Polarity::kViolation);
    HardenedSequence sut = make_synchronised(1U, 65535U);
    std::uint32_t usable = 0U;
    for (std::uint32_t i = 0U; i < 70000U; ++i) {
        usable += is_usable(sut.judge((40000U + i) % 65536U)) ? 1U : 0U;
    }
    EXPECT_EQ(usable, 0U) << "without any silent check before it";
}

TEST(HardenedSequenceTest, ReplaysWhileTheSenderIsHeardCloseNothing) {
    verifies("SWR-E2E-028", Technique::kFaultInjection);
    HardenedSequence sut = make_synchronised(1U, 65535U);
    for (std::uint32_t next = 4U; next < 3000U; ++next) {
        ASSERT_EQ(judge(sut, {next - 2U, next - 1U}), (Statuses{kWrong, kRepeated}));
        ASSERT_EQ(judge(sut, {next}), Statuses{kOk});
    }
    EXPECT_FALSE(sut.is_closed());
}

TEST(HardenedSequenceTest, WhereARunMayMakeABaselineNoGapCloses) {
    verifies("SWR-E2E-028", Technique::kEquivalenceClasses);
    HardenedSequence sut{{1U, 2U, Resynchronisation::kByRun}, 65535U};
    ASSERT_EQ(judge(sut, {1U, 2U, 3U}), (Statuses{kWrong, kWrong, kOk}));

    EXPECT_EQ(judge(sut, {100U, 101U, 102U}), (Statuses{kWrong, kWrong, kOk}));
    EXPECT_FALSE(sut.is_closed());
}

TEST(HardenedSequenceTest, RunMakesABaselineWhereThatIsAllowed) {
    verifies("SWR-E2E-008", Technique::kBoundaryValues);
    HardenedSequence sut{{1U, 3U, Resynchronisation::kByRun}, 255U};
    ASSERT_FALSE(sut.is_synchronised());
    ASSERT_EQ(judge(sut, {0U, 1U, 2U, 3U}), (Statuses{kWrong, kWrong, kWrong, kOk}));

    EXPECT_EQ(judge(sut, {80U, 81U, 82U, 83U}), (Statuses{kWrong, kWrong, kWrong, kOk}));
    EXPECT_EQ(sut.get_resync_count(), 2U);
    EXPECT_TRUE(sut.is_synchronised());
}

TEST(HardenedSequenceTest, RunBeginsWithTheFirstWholeFrameAfterAFault) {
    verifies("SWR-E2E-008", Technique::kBoundaryValues, Polarity::kViolation);
    HardenedSequence sut{{1U, 2U}, 255U};
    ASSERT_EQ(judge(sut, {5U}), Statuses{kWrong});

    sut.note_fault();
    ASSERT_EQ(judge(sut, {6U}), Statuses{kWrong});
    EXPECT_FALSE(sut.is_synchronised()) << "5 and 6 had a frame that was not whole between them";
    ASSERT_EQ(judge(sut, {7U, 8U}), (Statuses{kWrong, kOk}));
}

TEST(E2eCheckerTest, AFrameThatIsNotWholeBreaksTheRunOfAHardenedChannel) {
    verifies("SWR-E2E-008", Technique::kFaultInjection, Polarity::kViolation);
    HardenedE2eChecker<E2eProfile04<>> sut{rig::P04::make(16U), {1U, 2U, Resynchronisation::kByReset}};
    const auto check = [&sut](std::uint32_t counter, std::byte damage) {
        rig::Frame frame = rig::protect<E2eProfile04<>>(rig::P04::make(16U), counter, 16U);
        frame[14] ^= damage;
        return sut.check(rig::view(frame));
    };

    ASSERT_EQ(check(5U, std::byte{0U}), kWrong);
    ASSERT_EQ(check(6U, std::byte{1U}), CheckStatus::kError);
    ASSERT_EQ(check(6U, std::byte{0U}), kWrong);
    EXPECT_FALSE(sut.get_order().is_synchronised());
    ASSERT_EQ(check(7U, std::byte{0U}), kWrong);
    EXPECT_TRUE(sut.get_order().is_synchronised());
}

TEST(PlainSequenceTest, LostFramesAreThoseBeforeTheLastAcceptedOneAndForgottenByARestart) {
    verifies("SWR-E2E-006", Technique::kStateTransition);
    PlainSequence sut{{3U}, 255U};
    EXPECT_EQ(sut.get_lost_count(), 0U);
    ASSERT_EQ(judge(sut, {0U, 2U}), (Statuses{kOk, kLost}));
    EXPECT_EQ(sut.get_lost_count(), 1U);

    sut.restart();
    EXPECT_EQ(sut.get_lost_count(), 0U);
}

TEST(HardenedSequenceTest, LostFramesAreForgottenByWhateverIsNotAccepted) {
    verifies("SWR-E2E-007", Technique::kStateTransition);
    HardenedSequence sut{{3U, 2U}, 255U};
    EXPECT_EQ(sut.get_lost_count(), 0U);
    ASSERT_EQ(judge(sut, {0U, 1U, 3U}), (Statuses{kWrong, kWrong, kLost}));
    ASSERT_EQ(sut.get_lost_count(), 1U);
    ASSERT_EQ(judge(sut, {3U}), Statuses{kRepeated});
    EXPECT_EQ(sut.get_lost_count(), 0U);

    ASSERT_EQ(judge(sut, {5U}), Statuses{kLost});
    sut.restart();
    EXPECT_EQ(sut.get_lost_count(), 0U);
}

TEST(HardenedSequenceTest, GapsAndARestartBreakARun) {
    verifies("SWR-E2E-008", Technique::kFaultInjection, Polarity::kViolation);
    HardenedSequence sut{{1U, 3U}, 255U};
    ASSERT_EQ(judge(sut, {0U, 2U, 4U, 6U, 8U}), Statuses(5U, kWrong));
    EXPECT_FALSE(sut.is_synchronised());
    EXPECT_EQ(sut.get_resync_count(), 0U);

    ASSERT_EQ(judge(sut, {9U}), Statuses{kWrong});
    sut.restart();
    ASSERT_EQ(judge(sut, {10U, 11U}), Statuses(2U, kWrong));
    EXPECT_FALSE(sut.is_synchronised()) << "the third frame of a run, but not since the restart";
    ASSERT_EQ(judge(sut, {12U, 13U}), (Statuses{kWrong, kOk}));
}

TEST(SynchronisingSequenceTest, ARefusedFrameBeginsTheToleranceAnew) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues, Polarity::kViolation);
    SynchronisingSequence proven{{1U, 14U, 1U}, 14U};
    EXPECT_EQ(proven.get_lost_count(), 0U);
    EXPECT_EQ(judge(proven, {0U, 5U, 8U}), (Statuses{kInitial, kWrong, kWrong}))
        << "a step of 3, where 2 are allowed after a refused one";

    SynchronisingSequence quiet{{1U, 1U, 0U}, 14U};
    ASSERT_EQ(judge(quiet, {0U}), Statuses{kInitial});
    quiet.note_silence();
    quiet.note_silence();
    EXPECT_EQ(judge(quiet, {10U, 1U}), (Statuses{kWrong, kOk})) << "10 was news, if not good ones";
}

TEST(SynchronisingSequenceTest, LimitsThatNothingIsSaidOfAreTheStrictestThatWork) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues);
    constexpr SynchronisingLimits kLimits{};
    EXPECT_EQ(kLimits.max_delta_init, 1U);
    EXPECT_EQ(kLimits.max_no_new_or_repeated, 1U);
    EXPECT_EQ(kLimits.sync_init, 1U);
}

TEST(CheckStatusTest, NumbersAreThoseOfTheStandard) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues);
    const auto number = [](CheckStatus status) { return static_cast<unsigned>(status); };
    EXPECT_EQ(number(kOk), 0x00U);
    EXPECT_EQ(number(CheckStatus::kNoNewData), 0x01U);
    EXPECT_EQ(number(CheckStatus::kError), 0x02U);
    EXPECT_EQ(number(kSync), 0x03U);
    EXPECT_EQ(number(kInitial), 0x04U);
    EXPECT_EQ(number(kRepeated), 0x08U);
    EXPECT_EQ(number(kLost), 0x20U);
    EXPECT_EQ(number(kWrong), 0x40U);
}

TEST(E2eCheckerTest, ACheckWithoutAFrameLetsTheNextOneStepFurther) {
    verifies("SWR-E2E-006", Technique::kBoundaryValues);
    constexpr NibbleCounterChannel kChannel{0x0123U, DataIdMode::kBoth, 8U};
    const auto check = [&kChannel](bool is_silent) {
        E2eChecker<E2eProfile01<>> sut{kChannel, {1U, 14U, 0U}};
        static_cast<void>(sut.check(rig::view(rig::protect<E2eProfile01<>>(kChannel, 3U, 8U))));
        if (is_silent) {
            EXPECT_EQ(sut.check_silence(), CheckStatus::kNoNewData);
        }
        return sut.check(rig::view(rig::protect<E2eProfile01<>>(kChannel, 6U, 8U)));
    };

    EXPECT_EQ(check(false), kWrong) << "a step of 3, where each check allows one more than 1";
    EXPECT_EQ(check(true), kLost);
}

TEST(HardenedSequenceTest, RunIsBrokenByEveryOtherFrame) {
    verifies("SWR-E2E-008", Technique::kErrorGuessing, Polarity::kViolation);
    HardenedSequence sut{{1U, 3U, Resynchronisation::kByRun}, 255U};
    ASSERT_EQ(judge(sut, {0U, 1U, 2U}), (Statuses{kWrong, kWrong, kWrong}));

    EXPECT_EQ(judge(sut, {80U, 81U, 3U, 82U, 83U}), (Statuses{kWrong, kWrong, kOk, kWrong, kWrong}))
        << "live sender";
    EXPECT_EQ(judge(sut, {3U, 84U, 85U}), (Statuses{kRepeated, kWrong, kWrong})) << "its frame again";
    sut.note_fault();
    EXPECT_EQ(judge(sut, {86U, 87U, 89U, 91U}), Statuses(4U, kWrong)) << "a damaged frame, then gaps";
    sut.note_silence();
    EXPECT_EQ(judge(sut, {92U, 93U, 94U}), (Statuses{kWrong, kWrong, kOk})) << "91, 92, 93 are a run";
}

TEST(HardenedSequenceTest, ResetNeedsARunToo) {
    verifies("SWR-E2E-008", Technique::kStateTransition);
    E2eChecker<E2eProfile04<>, HardenedSequence> sut{rig::P04::make(16U),
                                                     {1U, 2U, Resynchronisation::kByReset}};
    const auto check = [&sut](std::uint32_t counter) {
        return sut.check(rig::view(rig::protect<E2eProfile04<>>(rig::P04::make(16U), counter, 16U)));
    };
    ASSERT_EQ((Statuses{check(0U), check(1U), check(2U)}), (Statuses{kWrong, kWrong, kOk}));
    ASSERT_EQ((Statuses{check(90U), check(91U), check(92U)}), (Statuses{kWrong, kWrong, kWrong}));

    sut.restart();
    EXPECT_EQ((Statuses{check(93U), check(94U), check(95U)}), (Statuses{kWrong, kWrong, kOk}));
    EXPECT_EQ(sut.get_restart_count(), 1U);
    EXPECT_EQ(sut.get_order().get_resync_count(), 2U);
}

TEST(HardenedSequenceTest, LimitsOutsideTheirRangeAreRefused) {
    verifies("SWR-E2E-009", Technique::kBoundaryValues, Polarity::kViolation);

    EXPECT_EQ(HardenedSequence::find_fault({1U, 2U}, 14U), ChannelFault::kNone);
    EXPECT_EQ(HardenedSequence::find_fault({7U, 255U}, 14U), ChannelFault::kNone);
    EXPECT_EQ(HardenedSequence::find_fault({8U, 2U}, 14U), ChannelFault::kLimits);
    EXPECT_EQ(HardenedSequence::find_fault({0U, 2U}, 14U), ChannelFault::kLimits);
    EXPECT_EQ(HardenedSequence::find_fault({1U, 1U}, 14U), ChannelFault::kLimits);
    EXPECT_EQ(HardenedSequence::find_fault({}, 14U), ChannelFault::kLimits) << "max_delta has no default";
}

/// Lets a live sender go on with losses, and plays runs of its past between, of every age up to half the
/// counter period.
/// @return replayed frames that were accepted. @post `replays` were tried.
std::uint32_t count_accepted(std::uint32_t counter_max, std::uint32_t max_delta, std::uint32_t replays,
                             std::uint32_t seed) {
    HardenedSequence sut{{max_delta, 2U}, counter_max};
    std::mt19937 random{seed};
    const auto draw = [&random](std::uint64_t least, std::uint64_t most) {
        return least + random() % (most - least + 1U);
    };
    const std::uint64_t period = std::uint64_t{counter_max} + 1U;
    const auto to_counter = [period](std::uint64_t number) {
        return static_cast<std::uint32_t>(number % period);
    };
    std::uint64_t newest = 5U * period;  // frames are numbered without end; the sender has long been running
    static_cast<void>(sut.judge(to_counter(newest - 1U)));
    static_cast<void>(sut.judge(to_counter(newest)));
    std::uint32_t accepted = 0U;
    for (std::uint32_t done = 0U; done < replays;) {
        // A frame that is older looks like one from ahead, and closes the channel.
        const std::uint64_t age = draw(0U, period - counter_max / 2U - 1U);
        const std::uint64_t length_max = counter_max / 2U < 40U ? counter_max / 2U : 40U;
        const std::uint64_t length = draw(1U, age + 1U < length_max ? age + 1U : length_max);
        for (std::uint64_t i = 0U; i < length && done < replays; ++i, ++done) {
            accepted += is_usable(sut.judge(to_counter(newest - age + i))) ? 1U : 0U;
        }
        newest += draw(1U, max_delta);
        EXPECT_TRUE(is_usable(sut.judge(to_counter(newest)))) << "the live sender is still followed";
    }
    return accepted;
}

TEST(HardenedSequenceTest, NoneOfAMillionReplaysBehindTheSenderIsAccepted) {
    verifies("SWR-E2E-007", Technique::kFaultInjection, Polarity::kViolation);
    std::uint32_t seed = 20261122U;
    for (const std::uint32_t most : {14U, 15U, 255U, 65535U, 0xFFFFFFFFU}) {
        for (const std::uint32_t max_delta : {1U, 3U, 7U}) {
            EXPECT_EQ(count_accepted(most, max_delta, 1000000U / 15U + 1U, ++seed), 0U)
                << most << " " << max_delta;
        }
    }
}

TEST(HardenedSequenceTest, WhatRemainsPossibleIsAFrameOfOnePeriodAgo) {
    verifies("SWR-E2E-007", Technique::kBoundaryValues);
    // Stated in the design note with its remedies: a longer counter, or an epoch in the identifier.
    HardenedSequence sut{{1U, 2U}, 14U};
    ASSERT_EQ(judge(sut, {3U, 4U, 5U}), (Statuses{kWrong, kWrong, kOk}));

    EXPECT_EQ(judge(sut, {6U}), Statuses{kOk}) << "whether new or fifteen frames old, nobody can tell";
}

}  // namespace
}  // namespace mamori::safety
