// SPDX-License-Identifier: Apache-2.0
// Goal: subjects alternate in every round, and a subject without completed work gives no time. Method:
// subjects that record their calls, with batches of the smallest size.
#include "rounds.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "mamori/trace/verifies.hpp"

namespace mamori::verification::bench {
namespace {

std::string g_calls;  ///< one letter per run since the last line of progress

template <char kLetter>
class Noting final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        g_calls += kLetter;
        return count;
    }
};

class Losing final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override { return count - 1U; }
};

std::unique_ptr<Subject> refuse() {
    throw std::runtime_error("no such network");
}

Case make_case(std::vector<Candidate> candidates) {
    const CalcExpected same = [](std::uint64_t count, std::size_t) { return count; };
    return {"test", 8U, "ns", 1U, same, std::move(candidates)};
}

const std::vector<Candidate> kTwo{{"a", &make_subject<Noting<'a'>>}, {"b", &make_subject<Noting<'b'>>}};
constexpr Effort kSmall{5U, 3U, 1U};

void ignore(const std::string&) {}

TEST(RoundsTest, SubjectsOfACaseTakeTurnsBatchByBatchAndBeginInTurn) {
    verifies("SWR-BEN-001");
    std::vector<std::string> rounds;
    const auto note = [&rounds](const std::string&) {
        rounds.push_back(g_calls);
        g_calls.clear();
    };

    static_cast<void>(measure({make_case(kTwo)}, kSmall, note));

    EXPECT_EQ(g_calls, "abbaab") << "the last round";
    ASSERT_EQ(rounds.size(), 6U) << "one line when preparing, one at the beginning of each round";
    EXPECT_EQ(rounds[3], "abbaab");
}

TEST(RoundsTest, EachSubjectHasOneTimePerRound) {
    verifies("SWR-BEN-001", Technique::kBoundaryValues);

    const std::vector<Measured> results = measure({make_case(kTwo)}, kSmall, &ignore);

    ASSERT_EQ(results.size(), 1U);
    ASSERT_EQ(results[0].series.size(), 2U);
    for (const Series& series : results[0].series) {
        EXPECT_EQ(series.rounds.size(), 5U);
        for (const double time : series.rounds) {
            EXPECT_GT(time, 0.0);
        }
    }
}

TEST(RoundsTest, WorkThatWasNotDoneEndsTheMeasurement) {
    verifies("SWR-BEN-001", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_THROW(
        static_cast<void>(measure({make_case({{"losing", &make_subject<Losing>}})}, kSmall, &ignore)),
        std::runtime_error);
}

TEST(RoundsTest, ASubjectThatCannotBeMadeIsNamedWithItsReasonAndTheOthersAreMeasured) {
    verifies("SWR-BEN-002", Technique::kFaultInjection, Polarity::kViolation);

    const std::vector<Measured> results = measure({make_case({{"gone", &refuse}, kTwo[0]})}, kSmall, &ignore);

    ASSERT_EQ(results[0].absent.size(), 1U);
    EXPECT_EQ(results[0].absent[0].name, "gone");
    EXPECT_EQ(results[0].absent[0].reason, "no such network");
    EXPECT_EQ(results[0].series.size(), 1U);
}

}  // namespace
}  // namespace mamori::verification::bench
