// SPDX-License-Identifier: Apache-2.0
// Goal: a background window has an executive of its own after those of the cores, and the table check rejects
//       one that cannot complete, a reader whose value may be overwritten, and rows that contradict its
//       class.
// Method: tables on both sides of each limit; invalid rows; the delay against counting every nanosecond.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "mamori/kernel/run/executives.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::FakeHost;
using testing_support::Relay;
using testing_support::SpyObserver;
using namespace verification;
using Rules = std::vector<Rule>;

Counter g_counter;
Counter g_other{"other"};
Relay g_relay;
Relay g_planner{"planner"};
Crossing<std::int64_t> g_to_planner;
Crossing<std::int64_t> g_to_relay;

constexpr auto kSystem =
    system(frame(50_ms), publication_margin(100_us),
           window("plan", 2200_us, 44500_us, core(1), background(), budget(20_ms), run(g_planner)),
           window("loop", 0_ms, 300_us, every(1_ms), core(1), budget(200_us), run(g_relay)),
           window("slow", 500_us, 10_ms, background(), budget(5_ms), run(g_other)),
           window("fast", 0_ms, 100_us, every(1_ms), budget(50_us), run(g_counter)),
           connect(g_counter.out, g_planner.in, through(g_to_planner), any_age()),
           connect(g_planner.out, g_relay.in, through(g_to_relay), any_age()));
MAMORI_CHECK(kSystem);

template <typename Table>
Rules list_rules(const Table& table) {
    std::array<Finding, 16U> findings{};
    const std::size_t count = check_all(make_view(table), findings);
    Rules rules;
    for (std::size_t i = 0U; i < count && i < findings.size(); ++i) {
        rules.push_back(findings[i].rule);
    }
    return rules;
}

TEST(BackgroundWindowTest, HasAnExecutiveOfItsOwnAfterThoseOfTheCores) {
    verifies("SWR-KRN-080", Technique::kRequirementsBased);
    const SystemView view = make_view(kSystem);

    EXPECT_EQ(view.windows[0].core, 2U);
    EXPECT_EQ(view.windows[0].background_of, 1U);
    EXPECT_EQ(view.windows[0].execution_budget, 20_ms);
    EXPECT_EQ(view.windows[0].budget, 44500_us);
    EXPECT_EQ(view.windows[1].core, 1U);
    EXPECT_EQ(view.windows[1].background_of, kNoIndex);
    EXPECT_EQ(view.windows[1].execution_budget, Duration{0});
    EXPECT_EQ(view.windows[2].core, 3U);
    EXPECT_EQ(view.windows[2].background_of, 0U);
    EXPECT_EQ(detail::count_cores(view), 4U);
    EXPECT_EQ(detail::count_processors(view), 2U);
    EXPECT_EQ(detail::find_background_of(view, 2U), 1U);
    EXPECT_EQ(detail::find_background_of(view, 1U), kNoIndex);
    EXPECT_EQ(detail::find_background_of(view, 4U), kNoIndex);
}

TEST(BackgroundWindowTest, WindowsOfOneCoreShareTheExecutiveAndMustNotOverlap) {
    verifies("SWR-KRN-080", Technique::kBoundaryValues, Polarity::kViolation);
    const auto make = [](Duration offset) {
        return system(frame(10_ms), window("a", 0_ms, 4_ms, background(), budget(1_ms), run(g_counter)),
                      window("b", offset, 4_ms, background(), budget(1_ms), run(g_other)),
                      window("c", 0_ms, 1_ms, budget(1_ms), run(g_planner)),
                      connect(g_counter.out, g_planner.in, through(g_to_planner), any_age()));
    };

    EXPECT_EQ(make(4_ms).windows[0].core, 1U);
    EXPECT_EQ(make(4_ms).windows[1].core, 1U);
    EXPECT_EQ(list_rules(make(4_ms)), Rules{});
    EXPECT_EQ(list_rules(make(4_ms - 1_ns)), Rules{Rule::kWindowsOverlap});
}

TEST(BackgroundWindowTest, ValuesPassBetweenTheClassesOfOneCoreThroughACrossingOnly) {
    verifies("SWR-KRN-080", Technique::kRequirementsBased, Polarity::kViolation);
    const auto table = system(frame(10_ms), window("a", 0_ms, 1_ms, budget(1_ms), run(g_counter)),
                              window("b", 1_ms, 9_ms, background(), budget(1_ms), run(g_relay)),
                              connect(g_counter.out, g_relay.in, any_age()));

    EXPECT_EQ(list_rules(table), Rules{Rule::kCrossingWithoutBuffer});
}

TEST(BackgroundWindowTest, TheProcessorTimeIsInsideTheWindowAndHoldsTheWorstCases) {
    verifies("SWR-KRN-080", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_budget = [](Duration limit, Duration worst) {
        return list_rules(system(frame(10_ms), window("a", 0_ms, 4_ms, background(), budget(limit),
                                                      run(worst_case(g_counter, worst)))));
    };

    EXPECT_EQ(check_budget(4_ms, 4_ms), Rules{});
    EXPECT_EQ(check_budget(4_ms + 1_ns, 4_ms), Rules{Rule::kBudgetExceedsWindow});
    EXPECT_EQ(check_budget(1_ns, 1_ns), Rules{});
    EXPECT_EQ(check_budget(0_ns, 0_ns), Rules{Rule::kBudgetExceedsWindow});
    EXPECT_EQ(check_budget(3_ms, 3_ms + 1_ns), Rules{Rule::kWorstCasesExceedBudget});
}

TEST(BackgroundWindowTest, ARowThatContradictsItsClassIsInvalid) {
    verifies("SWR-KRN-080", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_change = [](auto change) {
        auto table = kSystem;
        change(table.windows);
        return list_rules(table);
    };
    const Rules invalid{Rule::kWindowRowInvalid};

    EXPECT_EQ(check_change([](auto&) {}), Rules{});
    EXPECT_EQ(check_change([](auto& rows) { rows[1].execution_budget = 1_ns; }), invalid);
    EXPECT_EQ(check_change([](auto& rows) { rows[0].budget = 44500_us - 1_ns; }), invalid);
    EXPECT_EQ(check_change([](auto& rows) { rows[1].core = 2U; }), invalid) << "ordinary among background";
    EXPECT_EQ(check_change([](auto& rows) { rows[0].core = 3U; }), (Rules{invalid[0], invalid[0]}));
    EXPECT_EQ(check_change([](auto& rows) { rows[0].background_of = 0U; }), (Rules{invalid[0], invalid[0]}));
    EXPECT_EQ(check_change([](auto& rows) { rows[0].background_of = 3U; }), invalid) << "of a background";
    EXPECT_EQ(check_change([](auto& rows) { rows[0].background_of = 2U; }), invalid) << "of itself";
}

TEST(BackgroundWindowTest, EventsPerCycleBeyondTheRowAreRejected) {
    verifies("SWR-KRN-018", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_events = [](std::size_t events) {
        return list_rules(
            system(frame(1_ms), window("a", 0_ms, 1_ms, event_driven(events), budget(1_ms), run(g_counter))));
    };

    EXPECT_EQ(check_events(65'535U), Rules{});
    EXPECT_EQ(check_events(65'536U), Rules{Rule::kWindowRowInvalid});
}

/// Maximum time of the ordinary windows before `own` is done, for each start within their common period.
std::int64_t count_delay(const std::vector<WindowRow>& rows, std::int64_t own, std::int64_t period) {
    std::int64_t worst = 0;
    for (std::int64_t start = 0; start < period; ++start) {
        std::int64_t done = 0;
        std::int64_t now = start;
        for (; done < own; ++now) {
            const bool is_busy = std::any_of(rows.begin(), rows.end(), [now](const WindowRow& row) {
                const std::int64_t place = (now - row.offset.ns + row.period.ns) % row.period.ns;
                return place < row.budget.ns;
            });
            done += is_busy ? 0 : 1;
        }
        worst = std::max(worst, now - start - own);
    }
    return worst;
}

TEST(BackgroundWindowTest, TheCalculatedDelayIsNeverShorterThanTheCountedOne) {
    verifies("SWR-KRN-081", Technique::kBackToBack);
    std::size_t equal_count = 0U;
    for (std::int64_t length = 1; length <= 5; ++length) {
        for (std::int64_t own = 1; own <= 12; ++own) {
            WindowRow first{};
            first.period = Duration{10};
            first.budget = Duration{length};
            WindowRow second{};
            second.offset = Duration{length};
            second.period = Duration{20};
            second.budget = Duration{3};
            const std::vector<WindowRow> rows{first, second};
            SystemView view{};
            view.windows = {rows.data(), rows.size()};

            const std::int64_t calculated = detail::calc_interference(view, 0U, Duration{own}, 1_ms).ns;

            const std::int64_t counted = count_delay(rows, own, 20);
            EXPECT_GE(calculated, counted) << length << " " << own;
            equal_count += calculated == counted ? 1U : 0U;
        }
    }
    EXPECT_GE(equal_count, 20U) << "the windows follow each other, so that the bound is often exact";
}

TEST(BackgroundWindowTest, WithAnOverloadedCoreTheDelayIsUnbounded) {
    verifies("SWR-KRN-081", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_load = [](Duration limit) {
        return list_rules(system(frame(1_s),
                                 window("a", 0_ms, 1_ms, every(1_ms), budget(limit), run(g_counter)),
                                 window("b", 0_ms, 1_s, background(), budget(1_ns), run(g_other))));
    };

    EXPECT_EQ(check_load(1_ms), Rules{Rule::kBackgroundTooSlow});
    EXPECT_EQ(check_load(1_ms - 1_us), Rules{});
}

TEST(BackgroundWindowTest, AnIterationWithTooManyStepsCountsAsUnbounded) {
    verifies("SWR-KRN-081", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_own = [](Duration own) {
        WindowRow row{};
        row.period = Duration{2};
        row.budget = Duration{1};
        WindowRow other{};
        other.period = Duration{1'000'000};
        other.budget = Duration{499'000};
        const std::vector<WindowRow> rows{row, other};
        SystemView view{};
        view.windows = {rows.data(), rows.size()};
        return detail::calc_interference(view, 0U, own, 1_s);
    };

    EXPECT_LT(check_own(Duration{1}), 1_s);
    EXPECT_EQ(detail::calc_interference({}, 0U, Duration{1}, Duration{0}), Duration{0});
}

TEST(BackgroundWindowTest, ThePublicationMarginIsPartOfTheResponse) {
    verifies("SWR-KRN-081", Technique::kBoundaryValues, Polarity::kViolation);
    // The work ends exactly at the window end. A publication after it falls into the next ordinary window.
    const auto check_margin = [](Duration margin, Duration length) {
        return list_rules(system(frame(10_ms), publication_margin(margin),
                                 window("a", 0_ms, 1_ms, every(2_ms), budget(1_ms), run(g_counter)),
                                 window("b", 0_ms, length, background(), budget(2_ms), run(g_other))));
    };

    EXPECT_EQ(check_margin(0_ns, 4_ms), Rules{});
    EXPECT_EQ(check_margin(0_ns, 4_ms - 1_ns), Rules{Rule::kBackgroundTooSlow});
    EXPECT_EQ(check_margin(1_ns, 4_ms), Rules{Rule::kBackgroundTooSlow});
    EXPECT_EQ(check_margin(1_ns, 5_ms), Rules{});
    EXPECT_EQ(check_margin(Duration{std::numeric_limits<std::int64_t>::max()}, 5_ms),
              Rules{Rule::kBackgroundTooSlow});
    EXPECT_EQ(check_margin(Duration{-1}, 4_ms), Rules{}) << "no connection needs the margin";
}

TEST(BackgroundWindowTest, AReaderStartsBeforeItsValueIsOverwritten) {
    verifies("SWR-KRN-082", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_offset = [](Duration margin, Duration offset, Duration busy) {
        return list_rules(system(frame(10_ms), publication_margin(margin),
                                 window("w", 0_us, 400_us, every(1_ms), budget(100_us), run(g_counter)),
                                 window("x", 400_us, 600_us, every(1_ms), budget(busy), run(g_other)),
                                 window("r", offset, 8_ms, background(), budget(100_us), run(g_relay)),
                                 connect(g_counter.out, g_relay.in, through(g_to_planner), any_age())));
    };

    // Latest value of a start 1 ns before 400 us: published at -600 us, overwritten from 1 ms on.
    EXPECT_EQ(check_offset(0_us, 400_us - 1_ns, 500_us), Rules{});
    EXPECT_EQ(check_offset(0_us, 400_us - 1_ns, 501_us), Rules{Rule::kHistoryTooShort});
    EXPECT_EQ(check_offset(0_us, 400_us, 600_us), Rules{}) << "overwritten from 2 ms on";
    EXPECT_EQ(check_offset(100_us, 1400_us - 101_us, 500_us), Rules{});
    EXPECT_EQ(check_offset(101_us, 1400_us - 101_us, 500_us), Rules{Rule::kHistoryTooShort});
}

TEST(BackgroundWindowTest, AMarginOverTheHistoryIsRejectedForAnOrdinaryReaderToo) {
    verifies("SWR-KRN-082", Technique::kBoundaryValues, Polarity::kViolation);
    const auto check_margin = [](Duration margin) {
        return list_rules(system(frame(1_ms), publication_margin(margin),
                                 window("w", 0_us, 1_ms, budget(100_us), run(g_counter)),
                                 window("r", 900_us, 10_us, core(1), budget(1_us), run(g_relay)),
                                 connect(g_counter.out, g_relay.in, through(g_to_planner), any_age())));
    };

    EXPECT_EQ(check_margin(100_us - 1_ns), Rules{});
    EXPECT_EQ(check_margin(100_us), Rules{Rule::kHistoryTooShort});
    EXPECT_EQ(check_margin(Duration{-1}), Rules{Rule::kMarginNotKept});
}

TEST(BackgroundWindowTest, ItsDeadlineIsTheWindowEndAlsoAfterALateStart) {
    verifies("SWR-KRN-083", Technique::kBoundaryValues);
    static constexpr auto kTable =
        system(frame(10_ms), window("a", 1_ms, 8_ms, background(), budget(2_ms), run(g_counter)));
    MAMORI_CHECK(kTable);
    ExecutiveFor executive{kTable, 1U};
    SpyObserver observer;
    executive.set_observer(&observer);
    ASSERT_EQ(executive.initialize(), Status::kOk);
    ASSERT_EQ(executive.start(), Status::kOk);
    FakeHost host;
    host.now = Instant{} + 8_ms;

    EXPECT_EQ(executive.run_window(0U, Instant{} + 1_ms, host), WindowOutcome::kCompleted);
    host.now = Instant{} + 18_ms;
    host.hangs[{0U, WindowHost::Pass::kExecute}] = true;
    EXPECT_EQ(executive.run_window(0U, Instant{} + 11_ms, host), WindowOutcome::kOverrun);

    // Both passes of the first cycle, the first pass of the second one.
    EXPECT_EQ(host.deadlines, (std::vector<Instant>{Instant{} + 9_ms, Instant{} + 9_ms, Instant{} + 19_ms}));
    EXPECT_EQ(observer.heard.back(), "overrun window 0 component 0 @19000000");
}

}  // namespace
}  // namespace mamori
