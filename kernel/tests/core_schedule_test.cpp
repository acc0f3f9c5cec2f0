// SPDX-License-Identifier: Apache-2.0
// Goal: with two cores, the data that a reader receives do not depend on execution times and release
//       lateness.
// Method: random tables and schedules, within the margin and one period of the writer; each run is compared
//         with the same table in virtual time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
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
constexpr std::int64_t kFrames = 3;
#ifdef __OPTIMIZE__
constexpr int kSchedules = 100'000;
#else
constexpr int kSchedules = 2'000;  // a sanitizer or the measurement of coverage takes fifty times as long
#endif

/// Random numbers of one schedule, from its seed.
class Dice final {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}
    /// A number of first .. last.
    std::int64_t roll(std::int64_t first, std::int64_t last) {
        return std::uniform_int_distribution<std::int64_t>{first, last}(engine_);
    }

  private:
    std::mt19937_64 engine_;
};

/// Times of the writer's and the reader's window, and the margin between them [ns].
struct Plan {
    explicit Plan(Dice& dice)
        : writer_period(dice.roll(0, 3) == 0 ? 4000 : 1000 * dice.roll(1, 2)),
          writer_offset(dice.roll(0, 200)),
          writer_length(dice.roll(50, 400)),
          margin(dice.roll(1, 100)),
          reader_period(1000 << dice.roll(0, 3)),
          reader_offset(writer_offset + writer_length + margin + dice.roll(0, 100)),
          reader_length(reader_period - reader_offset) {}

    std::int64_t writer_period;
    std::int64_t writer_offset;
    std::int64_t writer_length;
    std::int64_t margin;
    std::int64_t reader_period;
    std::int64_t reader_offset;
    std::int64_t reader_length;
};

/// Notes the latest value and the queued values of each cycle.
class Reader final : public Component {
  public:
    Reader() : Component("reader") {}
    InPort<std::int64_t> latest{*this, "latest"};
    QueueInPort<std::int64_t, 24U, FullPolicy::kDoNothing, EmptyPolicy::kDoNothing> each{*this, "each"};
    using Ports = mamori::Ports<&Reader::latest, &Reader::each>;

    std::vector<std::vector<std::int64_t>> cycles;

    Status on_execute(ContextHandle) noexcept override {
        std::vector<std::int64_t> values{latest.read()};
        std::int64_t value = 0;
        while (each.read(value) == Status::kOk) {
            values.push_back(value);
        }
        cycles.push_back(values);
        return Status::kOk;
    }
};

/// A window instance: it has its effect on data at `at`. The writer's effect is the publication.
struct Step {
    std::int64_t at;
    std::int64_t order;  ///< random order of equal times
    std::size_t window;  ///< 0: writer, on core 0; 1: reader, on core 1
    std::int64_t release;
};

std::vector<Step> make_steps(const Plan& plan, Dice* dice) {
    std::vector<Step> steps;
    for (std::int64_t t = plan.writer_offset; t < kFrames * kFrame.ns; t += plan.writer_period) {
        const std::int64_t late =
            dice == nullptr ? plan.writer_length : dice->roll(0, plan.writer_length + plan.margin - 1);
        steps.push_back({t + late, dice == nullptr ? 0 : dice->roll(0, 1), 0U, t});
    }
    const std::int64_t late_max = std::min(plan.reader_length, plan.writer_period - 1);
    for (std::int64_t t = plan.reader_offset; t < kFrames * kFrame.ns; t += plan.reader_period) {
        steps.push_back({t + (dice == nullptr ? 0 : dice->roll(0, late_max)), 0, 1U, t});
    }
    std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) {
        return std::tie(a.at, a.order, a.window) < std::tie(b.at, b.order, b.window);
    });
    return steps;
}

/// Runs the steps in their order. @return what the reader read in each cycle, and its missed values.
std::tuple<std::vector<std::vector<std::int64_t>>, std::uint32_t> run_steps(const Plan& plan,
                                                                            const std::vector<Step>& steps) {
    Counter counter;
    Reader reader;
    Crossing<std::int64_t> crossing;
    const auto table = system(
        frame(kFrame), publication_margin(Duration{plan.margin}),
        window("write", Duration{plan.writer_offset}, Duration{plan.writer_length},
               every(Duration{plan.writer_period}), budget(Duration{plan.writer_length}), run(counter)),
        window("read", Duration{plan.reader_offset}, Duration{plan.reader_length},
               every(Duration{plan.reader_period}), core(1), budget(Duration{plan.reader_length}),
               run(reader)),
        connect(counter.out, reader.latest, through(crossing), any_age()),
        connect(counter.out, reader.each, any_age()));
    ExecutiveFor writer_core{table};
    ExecutiveFor reader_core{table, 1U};
    FakeHost host;
    EXPECT_EQ(writer_core.initialize(), Status::kOk);
    EXPECT_EQ(reader_core.initialize(), Status::kOk);
    EXPECT_EQ(writer_core.start(), Status::kOk);
    EXPECT_EQ(reader_core.start(), Status::kOk);
    for (const Step& step : steps) {
        Executive& core = step.window == 0U ? static_cast<Executive&>(writer_core) : reader_core;
        host.now = Instant{step.window == 0U ? step.release : step.at};
        EXPECT_EQ(core.run_window(step.window, Instant{step.release}, host), WindowOutcome::kCompleted);
    }
    return {reader.cycles, reader.latest.get_missed_count()};
}

TEST(CoreScheduleTest, DataOfRandomSchedulesOnTwoCoresAreThoseOfVirtualTime) {
    verifies("SWR-KRN-051", Technique::kBackToBack);
    std::uint64_t reordered = 0U;
    for (int seed = 0; seed < kSchedules; ++seed) {
        Dice dice{static_cast<std::uint64_t>(seed)};
        const Plan plan{dice};
        const std::vector<Step> planned = make_steps(plan, nullptr);
        const std::vector<Step> steps = make_steps(plan, &dice);
        reordered += std::equal(planned.begin(), planned.end(), steps.begin(),
                                [](const Step& a, const Step& b) { return a.release == b.release; })
                         ? 0U
                         : 1U;

        const auto [values, missed] = run_steps(plan, steps);

        ASSERT_EQ(values, std::get<0>(run_steps(plan, planned))) << "seed " << seed;
        ASSERT_EQ(missed, 0U) << "seed " << seed;
    }
    EXPECT_GT(reordered, static_cast<std::uint64_t>(kSchedules) / 4U)
        << "the schedules must differ from the plan";
}

}  // namespace
}  // namespace mamori
