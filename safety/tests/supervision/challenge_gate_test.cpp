// SPDX-License-Identifier: Apache-2.0
// Goal: a watchdog that asks is answered on proven health only, in its window, and with an answer that only a
// whole and fresh supervision cycle can give. Method: every link left out, doubled and moved; both sides of
// both ends of the window and of the tolerance; a device that refuses.
#include "mamori/safety/supervision/challenge_gate.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "supervision_rig.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

enum class Entity : EntityIndex { kControl, kPlanner };
enum class Point : CheckpointIndex { kRead, kWrite, kPlan };

constexpr std::array kEntities{supervise(Entity::kControl, kEveryMode, 1U),
                               supervise(Entity::kPlanner, in_modes(Entity::kPlanner))};
constexpr std::array kCheckpoints{
    checkpoint(Point::kRead, Entity::kControl, CheckpointRole::kInitial),
    checkpoint(Point::kWrite, Entity::kControl, CheckpointRole::kFinal),
    checkpoint(Point::kPlan, Entity::kPlanner),
};
constexpr std::array kAlives{alive(Point::kRead, {1U, 0U, 0U, 1U}), alive(Point::kPlan, {1U, 0U, 0U, 4U})};
constexpr std::array kDeadlines{deadline(Point::kRead, Point::kWrite, {Duration{0}, Duration{50}})};
constexpr std::array kEdges{edge(Point::kRead, Point::kWrite)};
constexpr SupervisionTable kTable{kEntities, kCheckpoints, kAlives, kDeadlines, kEdges, 2U, 1000U};

/// Judges answers by the table; asks another question after each right or wrong one.
class FakeChallenge final : public ChallengeWatchdog {
  public:
    Result<std::uint32_t> get_question() noexcept override {
        return has_question ? Result<std::uint32_t>{question} : Result<std::uint32_t>{Status::kError};
    }
    Status answer(Instant, std::uint32_t answer) noexcept override {
        ++answers;
        if (!takes_answers) {
            return Status::kError;
        }
        const bool is_right = answer == calc_sound_answer(kTable, question);
        question = question * 1664525U + 1013904223U;
        return is_right ? Status::kOk : Status::kBadParameter;
    }
    std::uint32_t question{12345U};
    int answers{0};
    bool has_question{true};
    bool takes_answers{true};
};

class ChallengeGateTest : public ::testing::Test {
  protected:
    /// A whole cycle with a healthy control, at `at_ns`.
    ChallengeOutcome run(std::int64_t at_ns) {
        rig_.report_as(Entity::kControl, Point::kRead, at_ns);
        rig_.report_as(Entity::kControl, Point::kWrite, at_ns);
        return supervise_at(at_ns);
    }
    ChallengeOutcome supervise_at(std::int64_t at_ns, bool is_consistent = true) {
        ProofChain chain{sut_.ask(Instant{at_ns})};
        const SupervisionStatus status = rig_.sut.step(Instant{at_ns}, chain);
        return sut_.step(Instant{at_ns}, to_global_status(status), is_consistent, chain.get_value());
    }
    /// Answers without any supervision.
    ChallengeOutcome answer(std::int64_t at_ns, std::uint32_t answer) {
        static_cast<void>(sut_.ask(Instant{at_ns}));
        return sut_.step(Instant{at_ns}, GlobalStatus::kOk, true, answer);
    }

    SupervisionRig<kTable> rig_{};
    FakeChallenge watchdog_{};
    ChallengeGate sut_{watchdog_, {Duration{100}, Duration{200}}};
};

using Link = std::pair<ProofLink, std::size_t>;

std::uint32_t calc_answer(const std::vector<Link>& links) {
    ProofChain chain{12345U};
    for (const Link& link : links) {
        chain.add(link.first, link.second);
    }
    return chain.get_value();
}

std::vector<Link> make_sound_links() {
    return {{ProofLink::kReports, 0U}, {ProofLink::kReports, 1U},  {ProofLink::kAlive, 0U},
            {ProofLink::kAlive, 1U},   {ProofLink::kDeadline, 0U}, {ProofLink::kEntity, 0U},
            {ProofLink::kEntity, 1U},  {ProofLink::kWhole, 0U}};
}

TEST_F(ChallengeGateTest, AnswerOfTheFirstCycleNeedsAQuestionToo) {
    verifies("SWR-SUP-039", Technique::kBoundaryValues, Polarity::kViolation);

    static_cast<void>(sut_.step(Instant{}, GlobalStatus::kOk, true, 0U));
    EXPECT_EQ(watchdog_.answers, 0) << "nothing was asked";
}

TEST(ProofChainTest, LinkIsItsNumberDeviationAndIndexInAKnownOrder) {
    verifies("SWR-SUP-039", Technique::kBackToBack);
    const std::array<std::pair<ProofLink, std::uint8_t>, 6U> links{{{ProofLink::kReports, 1U},
                                                                    {ProofLink::kAlive, 2U},
                                                                    {ProofLink::kDeadline, 3U},
                                                                    {ProofLink::kEntity, 4U},
                                                                    {ProofLink::kWhole, 5U},
                                                                    {ProofLink::kApplication, 6U}}};

    for (const auto& [link, number] : links) {
        ProofChain sut{0x01020304U};
        sut.add(link, 0xABCDU, 0x81U);
        Crc32 expected;
        for (const unsigned int byte : {0x04U, 0x03U, 0x02U, 0x01U, 0xCDU, 0xABU, 0x81U, unsigned{number}}) {
            expected.add(static_cast<std::uint8_t>(byte));
        }
        EXPECT_EQ(sut.get_value(), expected.get_value()) << unsigned{number};
    }
}

TEST_F(ChallengeGateTest, AnswerIsTheChecksumOfQuestionAndLinks) {
    verifies("SWR-SUP-039");

    EXPECT_EQ(calc_answer(make_sound_links()), calc_sound_answer(kTable, 12345U));
    EXPECT_EQ(ProofChain{0x34333231U}.get_value(), 0x9BE3E0A3U) << "CRC-32 of the characters 1234";
}

TEST_F(ChallengeGateTest, LinkThatIsLeftOutDoubledMovedOrChangedGivesAnotherAnswer) {
    verifies("SWR-SUP-039", Technique::kFaultInjection, Polarity::kViolation);
    const std::vector<Link> sound = make_sound_links();
    const std::uint32_t right = calc_sound_answer(kTable, 12345U);

    for (std::size_t i = 0U; i < sound.size(); ++i) {
        const auto place = static_cast<std::ptrdiff_t>(i);
        std::vector<Link> links = sound;
        links.erase(links.begin() + place);
        EXPECT_NE(calc_answer(links), right) << "without " << i;
        links.insert(links.end(), sound[i]);
        EXPECT_EQ(calc_answer(links) == right, i + 1U == sound.size()) << "last instead of place " << i;
        links = sound;
        links.insert(links.begin() + place, sound[i]);
        EXPECT_NE(calc_answer(links), right) << "twice " << i;
        links = sound;
        links[i].second ^= 1U;
        EXPECT_NE(calc_answer(links), right) << "another index " << i;
        links[i] = {ProofLink::kApplication, sound[i].second};
        EXPECT_NE(calc_answer(links), right) << "another link " << i;
    }
}

TEST_F(ChallengeGateTest, EveryDeviationGivesAnotherAnswer) {
    verifies("SWR-SUP-039", Technique::kFaultInjection, Polarity::kViolation);
    ProofChain right{1U};
    right.add(ProofLink::kAlive, 0xFFFFU);

    for (unsigned deviation = 1U; deviation <= 0xFFU; ++deviation) {
        ProofChain wrong{1U};
        wrong.add(ProofLink::kAlive, 0xFFFFU, static_cast<std::uint8_t>(deviation));
        EXPECT_NE(wrong.get_value(), right.get_value()) << deviation;
    }
}

TEST_F(ChallengeGateTest, SoundCycleGivesTheRightAnswerInEachMode) {
    verifies("SWR-SUP-039", Technique::kEquivalenceClasses);
    ASSERT_EQ(run(0), ChallengeOutcome::kAnswered);
    ASSERT_EQ(rig_.sut.set_mode(1U, Instant{0}), Status::kOk);
    rig_.report_as(Entity::kPlanner, Point::kPlan, 100);

    EXPECT_EQ(run(100), ChallengeOutcome::kAnswered);
}

/// Deviations in the order of the links: reports, alives, deadline, entities, whole.
using Deviations = std::array<std::uint8_t, 8U>;

TEST_F(ChallengeGateTest, EachPartThatFoundSomethingDeviates) {
    verifies("SWR-SUP-039", Technique::kFaultInjection, Polarity::kViolation);
    const auto expect_step = [this](std::int64_t at_ns, const Deviations& deviations) {
        ProofChain chain{12345U};
        static_cast<void>(rig_.sut.step(Instant{at_ns}, chain));
        ProofChain expected{12345U};
        const std::vector<Link> links = make_sound_links();
        for (std::size_t i = 0U; i < links.size(); ++i) {
            expected.add(links[i].first, links[i].second, deviations[i]);
        }
        EXPECT_EQ(chain.get_value(), expected.get_value()) << at_ns;
        EXPECT_EQ(chain.get_value() == calc_sound_answer(kTable, 12345U), deviations == Deviations{});
    };
    rig_.report_as(Entity::kControl, Point::kRead, 0);
    expect_step(0, {});
    expect_step(10, {0U, 0U, 1U, 0U, 0U, 1U, 0U, 1U});  // failed: a silent cycle
    rig_.report_as(Entity::kControl, Point::kWrite, 15);
    rig_.report_as(Entity::kControl, Point::kRead, 15);
    expect_step(20, {});
    expect_step(66, {0U, 0U, 1U, 0U, 1U, 1U, 0U, 1U});  // expired: a time that is over
    expect_step(70, {1U, 0U, 1U, 0U, 1U, 1U, 0U, 1U});  // still, and nothing of it is judged any more
}

TEST_F(ChallengeGateTest, ReportThatIsWrongDeviatesInTheSameCycle) {
    verifies("SWR-SUP-039", Technique::kFaultInjection, Polarity::kViolation);
    ProofChain chain{12345U};
    ProofChain expected{12345U};
    rig_.report_as(Entity::kControl, Point::kWrite, 0);
    static_cast<void>(rig_.sut.step(Instant{0}, chain));
    expected.add(ProofLink::kReports, 0U, 1U);
    expected.add(ProofLink::kReports, 1U);
    expected.add(ProofLink::kAlive, 0U, 1U);
    expected.add(ProofLink::kAlive, 1U);
    expected.add(ProofLink::kDeadline, 0U, 1U);
    expected.add(ProofLink::kEntity, 0U, 1U);
    expected.add(ProofLink::kEntity, 1U);
    expected.add(ProofLink::kWhole, 0U, 1U);

    EXPECT_EQ(chain.get_value(), expected.get_value());
}

TEST_F(ChallengeGateTest, HealthyCyclesAreAnsweredAndCounted) {
    verifies("SWR-WDG-010");

    for (std::int64_t at = 0; at < 1000; at += 100) {
        ASSERT_EQ(run(at), ChallengeOutcome::kAnswered) << at;
    }
    EXPECT_EQ(watchdog_.answers, 10);
    EXPECT_EQ(sut_.get_answer_count(), 10U);
    EXPECT_EQ(sut_.get_wrong_count(), 0U);
    EXPECT_FALSE(sut_.is_closed());
}

TEST_F(ChallengeGateTest, UnprovenHealthIsNotAnswered) {
    verifies("SWR-WDG-010", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(supervise_at(0), ChallengeOutcome::kRefused) << "control is silent";
    rig_.report_as(Entity::kControl, Point::kRead, 10);
    rig_.report_as(Entity::kControl, Point::kWrite, 10);
    EXPECT_EQ(supervise_at(10, false), ChallengeOutcome::kRefused) << "state machine is not consistent";
    EXPECT_EQ(supervise_at(20), ChallengeOutcome::kRefused);
    EXPECT_EQ(watchdog_.answers, 0);
}

TEST_F(ChallengeGateTest, AnswersAtBothEndsOfTheWindow) {
    verifies("SWR-WDG-010", Technique::kBoundaryValues);
    ASSERT_EQ(run(0), ChallengeOutcome::kAnswered);

    EXPECT_EQ(run(100), ChallengeOutcome::kAnswered);
    EXPECT_EQ(run(300), ChallengeOutcome::kAnswered);
}

TEST_F(ChallengeGateTest, AnswerBeforeTheWindowIsHeldBackAndTheQuestionStaysOpen) {
    verifies("SWR-WDG-010", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(run(0), ChallengeOutcome::kAnswered);
    const std::uint32_t question = watchdog_.question;

    EXPECT_EQ(run(99), ChallengeOutcome::kHeldBack);
    EXPECT_EQ(watchdog_.answers, 1);
    EXPECT_EQ(watchdog_.question, question);
    EXPECT_EQ(run(100), ChallengeOutcome::kAnswered);
}

TEST_F(ChallengeGateTest, MissedWindowClosesTheGateForGood) {
    verifies("SWR-WDG-010", Technique::kBoundaryValues, Polarity::kViolation);
    ASSERT_EQ(run(0), ChallengeOutcome::kAnswered);

    EXPECT_EQ(run(201), ChallengeOutcome::kClosed);
    EXPECT_TRUE(sut_.is_closed());
    EXPECT_EQ(run(300), ChallengeOutcome::kClosed);
    EXPECT_EQ(watchdog_.answers, 1);
}

TEST_F(ChallengeGateTest, DeviceThatDoesNotTakeAnAnswerIsAskedAndAnsweredAgain) {
    verifies("SWR-WDG-010", Technique::kFaultInjection, Polarity::kViolation);
    watchdog_.takes_answers = false;
    EXPECT_EQ(run(0), ChallengeOutcome::kFailed);
    EXPECT_EQ(sut_.get_answer_count(), 0U);
    EXPECT_EQ(sut_.get_wrong_count(), 0U) << "nobody judged it";

    watchdog_.takes_answers = true;
    EXPECT_EQ(run(1), ChallengeOutcome::kAnswered);
}

TEST_F(ChallengeGateTest, OutcomesOfTheWindowAreItsOwn) {
    verifies("SWR-WDG-010", Technique::kEquivalenceClasses, Polarity::kViolation);

    EXPECT_EQ(to_challenge_outcome(WatchdogOutcome::kServiced), ChallengeOutcome::kAnswered);
    EXPECT_EQ(to_challenge_outcome(WatchdogOutcome::kHeldBack), ChallengeOutcome::kHeldBack);
    EXPECT_EQ(to_challenge_outcome(WatchdogOutcome::kRefused), ChallengeOutcome::kRefused);
    EXPECT_EQ(to_challenge_outcome(WatchdogOutcome::kFailed), ChallengeOutcome::kFailed);
    EXPECT_EQ(to_challenge_outcome(WatchdogOutcome::kClosed), ChallengeOutcome::kClosed);
    EXPECT_EQ(to_challenge_outcome(static_cast<WatchdogOutcome>(77)), ChallengeOutcome::kClosed);
}

TEST_F(ChallengeGateTest, WrongAnswerClosesTheGateForGood) {
    verifies("SWR-WDG-011", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(answer(0, 1U), ChallengeOutcome::kWrong);
    EXPECT_EQ(sut_.get_wrong_count(), 1U);
    EXPECT_TRUE(sut_.is_closed());
    EXPECT_EQ(run(1), ChallengeOutcome::kClosed);
    EXPECT_EQ(watchdog_.answers, 1);
}

TEST_F(ChallengeGateTest, WrongAnswersUpToTheToleranceAreCountedAndTheNextOneCloses) {
    verifies("SWR-WDG-011", Technique::kBoundaryValues, Polarity::kViolation);
    ChallengeGate gate{watchdog_, {Duration{0}, Duration{1000}}, 2U};
    const auto step = [&gate](std::int64_t at_ns, std::uint32_t answer) {
        static_cast<void>(gate.ask(Instant{at_ns}));
        return gate.step(Instant{at_ns}, GlobalStatus::kOk, true, answer);
    };
    EXPECT_EQ(step(0, 1U), ChallengeOutcome::kWrong);
    EXPECT_EQ(step(1, calc_sound_answer(kTable, watchdog_.question)), ChallengeOutcome::kAnswered);
    EXPECT_EQ(step(2, 1U), ChallengeOutcome::kWrong) << "a right answer takes none back";
    static_cast<void>(gate.ask(Instant{3}));
    EXPECT_EQ(gate.step(Instant{3}, GlobalStatus::kFailed, true, 1U), ChallengeOutcome::kRefused);
    EXPECT_EQ(gate.get_wrong_count(), 2U) << "one that was not given is not wrong";
    EXPECT_FALSE(gate.is_closed());

    EXPECT_EQ(step(3, 1U), ChallengeOutcome::kWrong);
    EXPECT_TRUE(gate.is_closed());
    EXPECT_EQ(step(4, calc_sound_answer(kTable, watchdog_.question)), ChallengeOutcome::kClosed);
    EXPECT_EQ(gate.get_wrong_count(), 3U);
}

TEST_F(ChallengeGateTest, RightAnswersLeaveTheGateOpen) {
    verifies("SWR-WDG-011");

    EXPECT_EQ(answer(0, calc_sound_answer(kTable, watchdog_.question)), ChallengeOutcome::kAnswered);
    EXPECT_EQ(sut_.get_wrong_count(), 0U);
    EXPECT_FALSE(sut_.is_closed());
}

TEST_F(ChallengeGateTest, EachQuestionHasAnAnswerOfItsOwn) {
    verifies("SWR-WDG-012", Technique::kBoundaryValues);

    for (unsigned bit = 0U; bit < 32U; ++bit) {
        EXPECT_NE(calc_sound_answer(kTable, 12345U), calc_sound_answer(kTable, 12345U ^ (1U << bit))) << bit;
    }
    EXPECT_EQ(run(0), ChallengeOutcome::kAnswered);
    EXPECT_EQ(run(100), ChallengeOutcome::kAnswered);
}

TEST_F(ChallengeGateTest, AnswerOfTheCycleBeforeIsWrong) {
    verifies("SWR-WDG-012", Technique::kFaultInjection, Polarity::kViolation);
    const std::uint32_t old_answer = calc_sound_answer(kTable, watchdog_.question);
    ASSERT_EQ(run(0), ChallengeOutcome::kAnswered);

    EXPECT_EQ(answer(100, old_answer), ChallengeOutcome::kWrong) << "supervision did not run in between";
}

TEST_F(ChallengeGateTest, SecondAnswerToOneQuestionIsNotGiven) {
    verifies("SWR-WDG-012", Technique::kFaultInjection, Polarity::kViolation);
    ASSERT_EQ(run(0), ChallengeOutcome::kAnswered);

    EXPECT_EQ(sut_.step(Instant{0}, GlobalStatus::kOk, true, 0U), ChallengeOutcome::kHeldBack);
    EXPECT_EQ(sut_.step(Instant{100}, GlobalStatus::kOk, true, 0U), ChallengeOutcome::kFailed);
    EXPECT_EQ(watchdog_.answers, 1);
}

TEST_F(ChallengeGateTest, SecondAnswerInOneCycleIsNotGiven) {
    verifies("SWR-WDG-012", Technique::kErrorGuessing, Polarity::kViolation);
    ChallengeGate gate{watchdog_, {Duration{0}, Duration{1000}}, 5U};
    const std::uint32_t right = calc_sound_answer(kTable, gate.ask(Instant{0}));
    ASSERT_EQ(gate.step(Instant{0}, GlobalStatus::kOk, true, right), ChallengeOutcome::kAnswered);

    EXPECT_EQ(gate.step(Instant{0}, GlobalStatus::kOk, true, right), ChallengeOutcome::kFailed);
    EXPECT_EQ(watchdog_.answers, 1);
}

TEST_F(ChallengeGateTest, RightAnswerOfAnEarlierCycleIsNotGiven) {
    verifies("SWR-WDG-012", Technique::kBoundaryValues, Polarity::kViolation);
    const std::uint32_t right = calc_sound_answer(kTable, sut_.ask(Instant{0}));

    EXPECT_EQ(sut_.step(Instant{1}, GlobalStatus::kOk, true, right), ChallengeOutcome::kFailed);
    EXPECT_EQ(watchdog_.answers, 0);
}

TEST_F(ChallengeGateTest, WithoutAQuestionNothingIsAnswered) {
    verifies("SWR-WDG-012", Technique::kFaultInjection, Polarity::kViolation);
    watchdog_.has_question = false;

    EXPECT_EQ(sut_.ask(Instant{0}), 0U);
    EXPECT_EQ(run(0), ChallengeOutcome::kFailed);
    EXPECT_EQ(watchdog_.answers, 0);
    watchdog_.has_question = true;
    EXPECT_EQ(run(1), ChallengeOutcome::kAnswered);
}

}  // namespace
}  // namespace mamori::safety
