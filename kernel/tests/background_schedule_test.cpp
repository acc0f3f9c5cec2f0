// SPDX-License-Identifier: Apache-2.0
// Goal: the data that ordinary and background windows of one core exchange do not depend on execution times.
// Method: random tables that keep the rules; a preemptive processor with random execution times decides in
//         which order windows latch and publish; the data are compared with those of planned instants.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;

constexpr Duration kFrame{8000};
constexpr std::int64_t kEnd = 3 * kFrame.ns;
#ifdef __OPTIMIZE__
constexpr int kTables = 50'000;
#else
constexpr int kTables = 1'000;  // a sanitizer or the measurement of coverage takes fifty times as long
#endif

class Dice final {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    std::int64_t roll(std::int64_t first, std::int64_t last) {
        return std::uniform_int_distribution<std::int64_t>{first, last}(engine_);
    }

  private:
    std::mt19937_64 engine_;
};

struct Times {
    std::int64_t offset;
    std::int64_t length;
    std::int64_t period;
    std::int64_t budget;
};

/// Indices of the windows, and of their times in a plan.
constexpr std::size_t kFast = 0U;   ///< ordinary, writes
constexpr std::size_t kServe = 1U;  ///< ordinary, reads what the background writes
constexpr std::size_t kRead = 2U;   ///< background, reads
constexpr std::size_t kWrite = 3U;  ///< background, writes

struct Plan {
    explicit Plan(Dice& dice) : margin(dice.roll(2, 40)) {
        const std::int64_t period = 1000 << dice.roll(0, 1);
        const std::int64_t length = dice.roll(50, 500);
        times[kFast] = {dice.roll(0, 100), length, period, dice.roll(1, length)};
        const std::int64_t place = times[kFast].offset + length + dice.roll(0, 100);
        const std::int64_t rest = dice.roll(20, 280);
        times[kServe] = {place, rest, 1000 << dice.roll(0, 3), dice.roll(1, rest)};
        const std::int64_t slow = 4000 << dice.roll(0, 1);
        const std::int64_t half = dice.roll(1000, slow - 1000);
        const std::int64_t first = dice.roll(0, half - 600);
        times[kRead] = {first, half - first, slow, dice.roll(1, (half - first) / 2)};
        times[kWrite] = {half, slow - half, slow, dice.roll(1, (slow - half) / 2)};
    }

    std::int64_t margin;
    Times times[4]{};
};

/// What the table of a plan refers to.
struct Parts {
    Counter fast{"fast"};
    Counter slow{"slow"};
    Sink read{"read"};
    Sink served{"served"};
    Crossing<std::int64_t> to_read;
    Crossing<std::int64_t> to_serve;
};

template <typename... Options>
auto make_window(const char* name, const Times& times, const Options&... options) {
    return window(name, Duration{times.offset}, Duration{times.length}, every(Duration{times.period}),
                  budget(Duration{times.budget}), options...);
}

auto make_table(const Plan& plan, Parts& parts) {
    return system(frame(kFrame), publication_margin(Duration{plan.margin}),
                  make_window("fast", plan.times[kFast], run(parts.fast)),
                  make_window("serve", plan.times[kServe], run(parts.served)),
                  make_window("read", plan.times[kRead], background(), run(parts.read)),
                  make_window("write", plan.times[kWrite], background(), run(parts.slow)),
                  connect(parts.fast.out, parts.read.in, through(parts.to_read), any_age()),
                  connect(parts.slow.out, parts.served.in, through(parts.to_serve), any_age()));
}

bool is_valid(const Plan& plan) {
    Parts parts;
    const auto table = make_table(plan, parts);
    return check(make_view(table)).rule == Rule::kNone;
}

/// A window instance, which has its effect on data at `at`: a reader latches, a writer publishes.
struct Step {
    std::int64_t at;
    std::size_t window;
    std::int64_t release;
};

bool is_earlier(const Step& a, const Step& b) {
    return std::tie(a.at, a.window) < std::tie(b.at, b.window);
}

std::vector<Step> list_starts(const Plan& plan, std::size_t first, std::size_t end) {
    std::vector<Step> starts;
    for (std::size_t w = first; w < end; ++w) {
        for (std::int64_t t = plan.times[w].offset; t < kEnd; t += plan.times[w].period) {
            starts.push_back({t, w, t});
        }
    }
    std::sort(starts.begin(), starts.end(), &is_earlier);
    return starts;
}

/// Effects at planned instants: a reader latches at its start, a writer publishes at its end.
std::vector<Step> make_planned(const Plan& plan) {
    std::vector<Step> steps = list_starts(plan, kFast, kWrite + 1U);
    for (Step& step : steps) {
        step.at += step.window == kFast || step.window == kWrite ? plan.times[step.window].length : 0;
    }
    std::sort(steps.begin(), steps.end(), &is_earlier);
    return steps;
}

/// Processor time of lower priority, around the ordinary windows.
class Processor final {
  public:
    Processor(const Plan& plan, Dice& dice)
        : plan_(plan), dice_(dice), starts_(list_starts(plan, 0U, kRead)) {}

    /// @return the instant at which work that is released at `from` has executed for `own`.
    std::int64_t run(std::int64_t from, std::int64_t own) {
        now_ = std::max(now_, from);
        std::int64_t left = own;
        while (next_ < starts_.size() &&
               (starts_[next_].release <= now_ || left > starts_[next_].release - now_)) {
            const Step start = starts_[next_++];
            const std::int64_t free = std::max<std::int64_t>(0, start.release - now_);
            left -= free;
            now_ = std::max(now_, start.release + serve(start));
        }
        now_ += left;
        return now_;
    }
    /// Runs what is left of the ordinary windows. @return their effects.
    std::vector<Step> finish() {
        while (next_ < starts_.size()) {
            serve(starts_[next_++]);
        }
        return effects_;
    }

  private:
    /// @return its execution time: any up to its budget, most often all of it.
    std::int64_t serve(const Step& start) {
        const std::int64_t budget = plan_.times[start.window].budget;
        const std::int64_t time = dice_.roll(0, 1) == 0 ? budget : dice_.roll(0, budget);
        // The runner of the ordinary windows publishes within the margin after the work.
        const bool is_writer = start.window == kFast;
        effects_.push_back({start.release + (is_writer ? time : 0), start.window, start.release});
        return time;
    }

    const Plan& plan_;
    Dice& dice_;
    std::vector<Step> starts_;
    std::vector<Step> effects_;
    std::size_t next_{0U};
    std::int64_t now_{0};
};

/// @param[in] delay of the reader, in addition.
std::vector<Step> make_random(const Plan& plan, Dice& dice, std::int64_t delay = 0) {
    Processor processor{plan, dice};
    std::vector<Step> steps;
    for (const Step& start : list_starts(plan, kRead, kWrite + 1U)) {
        const std::int64_t before = dice.roll(1, plan.margin / 2);
        const std::int64_t after = dice.roll(1, plan.margin - before);
        const std::int64_t budget = plan.times[start.window].budget;
        const std::int64_t time = dice.roll(0, 1) == 0 ? budget : dice.roll(0, budget);
        const std::int64_t latched = processor.run(start.release, before);
        const std::int64_t published = processor.run(latched, time + after);
        EXPECT_LE(published, start.release + plan.times[start.window].length + plan.margin);
        steps.push_back({start.window == kRead ? latched + delay : published, start.window, start.release});
    }
    const std::vector<Step> ordinary = processor.finish();
    steps.insert(steps.end(), ordinary.begin(), ordinary.end());
    // At one instant, a background window that has latched or published came before the ordinary window.
    std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
        return std::make_tuple(a.at, a.window < kRead, a.window) <
               std::make_tuple(b.at, b.window < kRead, b.window);
    });
    return steps;
}

struct Result {
    std::vector<std::int64_t> read;
    std::vector<std::int64_t> served;
    std::uint32_t missed;
};

Result run_steps(const Plan& plan, const std::vector<Step>& steps) {
    Parts parts;
    const auto table = make_table(plan, parts);
    ExecutiveFor ordinary{table};
    ExecutiveFor background{table, 1U};
    FakeHost host;
    EXPECT_EQ(ordinary.initialize(), Status::kOk);
    EXPECT_EQ(background.initialize(), Status::kOk);
    EXPECT_EQ(ordinary.start(), Status::kOk);
    EXPECT_EQ(background.start(), Status::kOk);
    for (const Step& step : steps) {
        Executive& executive = step.window < kRead ? static_cast<Executive&>(ordinary) : background;
        host.now = Instant{step.release};
        EXPECT_EQ(executive.run_window(step.window, Instant{step.release}, host), WindowOutcome::kCompleted);
    }
    return {parts.read.get_values(), parts.served.get_values(),
            parts.read.in.get_missed_count() + parts.served.in.get_missed_count()};
}

TEST(BackgroundScheduleTest, DataOfRandomExecutionTimesAreThoseOfPlannedInstants) {
    verifies("SWR-KRN-082", Technique::kBackToBack);
    int valid_count = 0;
    int reordered_count = 0;
    for (int seed = 0; valid_count < kTables; ++seed) {
        Dice dice{static_cast<std::uint64_t>(seed)};
        const Plan plan{dice};
        if (!is_valid(plan)) {
            continue;
        }
        ++valid_count;
        const std::vector<Step> planned = make_planned(plan);
        const std::vector<Step> random = make_random(plan, dice);
        const bool is_equal = std::equal(
            planned.begin(), planned.end(), random.begin(), random.end(),
            [](const Step& a, const Step& b) { return a.window == b.window && a.release == b.release; });
        reordered_count += is_equal ? 0 : 1;

        const Result result = run_steps(plan, random);

        const Result expected = run_steps(plan, planned);
        ASSERT_EQ(result.read, expected.read) << "seed " << seed;
        ASSERT_EQ(result.served, expected.served) << "seed " << seed;
        ASSERT_EQ(result.missed, 0U) << "seed " << seed;
    }
    EXPECT_GT(reordered_count, kTables / 2) << "the schedules must differ from the plan";
}

TEST(BackgroundScheduleTest, AReaderThatIsDelayedLongerCountsEachLoss) {
    verifies("SWR-KRN-082", Technique::kBackToBack, Polarity::kViolation);
    int valid_count = 0;
    int deviating_count = 0;
    for (int seed = 0; valid_count < kTables / 50; ++seed) {
        Dice dice{static_cast<std::uint64_t>(seed)};
        const Plan plan{dice};
        if (!is_valid(plan)) {
            continue;
        }
        ++valid_count;
        const Result result = run_steps(plan, make_random(plan, dice, 2 * plan.times[kFast].period));
        const bool is_equal = result.read == run_steps(plan, make_planned(plan)).read;
        deviating_count += is_equal ? 0 : 1;
        EXPECT_TRUE(is_equal || result.missed != 0U) << "seed " << seed;
    }
    EXPECT_GT(deviating_count, kTables / 100);
}

}  // namespace
}  // namespace mamori
