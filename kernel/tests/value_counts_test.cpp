// SPDX-License-Identifier: Apache-2.0
// Goal: each written value is received, superseded, lost or waiting, and the counters of the ports say so.
// Method: random writes, reads, overruns and delays of a second core; after each window, the counters are
//         compared with those of a model that knows each value.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <random>
#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/dataflow/queue_out_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"

namespace mamori {
namespace {

using namespace testing_support;
using namespace verification;
using Pass = WindowHost::Pass;

constexpr std::uint32_t kFrames = 1000U;  ///< of one run
#ifdef __OPTIMIZE__
constexpr std::uint64_t kRuns = 1000U;
#else
constexpr std::uint64_t kRuns = 10U;  // a sanitizer or the measurement of coverage takes fifty times as long
#endif
constexpr std::uint32_t kOutCapacity = 3U;
constexpr std::uint32_t kInCapacity = 4U;

/// Writes the numbers 1, 2, ... to each output.
class Writer final : public Component {
  public:
    Writer() : Component("writer") {}
    OutPort<std::uint32_t> latest{*this, "latest"};
    QueueOutPort<std::uint32_t, kOutCapacity> each{*this, "each"};
    using Ports = mamori::Ports<&Writer::latest, &Writer::each>;

    std::array<std::uint32_t, 2U> pass_writes{};  ///< writes to each output in either pass
    std::uint32_t latest_count{0U};
    std::uint32_t each_count{0U};
    std::uint32_t rejected_count{0U};

    Status on_execute(ContextHandle) noexcept override { return write(pass_writes[0]); }
    Status on_state_update(ContextHandle) noexcept override { return write(pass_writes[1]); }

  private:
    Status write(std::uint32_t count) {
        for (std::uint32_t i = 0U; i < count; ++i) {
            latest.write(++latest_count);
            const Status status = each.write(each_count + 1U);
            each_count += status == Status::kOk ? 1U : 0U;
            rejected_count += status == Status::kOutOfResources ? 1U : 0U;
        }
        return Status::kOk;
    }
};

/// Reads at most `reads` values of each queue in a cycle.
class Reader final : public Component {
  public:
    explicit Reader(const char* name) : Component(name) {}
    InPort<std::uint32_t> latest{*this, "latest"};
    InPort<std::uint32_t> newest{*this, "newest"};
    QueueInPort<std::uint32_t, kInCapacity> latest_queue{*this, "latest_queue"};
    QueueInPort<std::uint32_t, kInCapacity> overwriting{*this, "overwriting"};
    QueueInPort<std::uint32_t, kInCapacity, FullPolicy::kDoNothing> rejecting{*this, "rejecting"};
    using Ports = mamori::Ports<&Reader::latest, &Reader::newest, &Reader::latest_queue, &Reader::overwriting,
                                &Reader::rejecting>;

    std::uint32_t reads{0U};
    std::array<std::vector<std::uint32_t>, 3U> values;  ///< what each queue gave

    Status on_execute(ContextHandle) noexcept override {
        read_from(latest_queue, values[0]);
        read_from(overwriting, values[1]);
        read_from(rejecting, values[2]);
        return Status::kOk;
    }

  private:
    template <typename Port>
    void read_from(Port& port, std::vector<std::uint32_t>& into) {
        std::uint32_t value = 0U;
        for (std::uint32_t i = 0U; i < reads && port.has_waiting(); ++i) {
            EXPECT_EQ(port.read(value), Status::kOk);
            into.push_back(value);
        }
    }
};

/// What a sink of one output should count.
struct ModelSink {
    std::uint32_t last{0U};  ///< number of the value that arrived last, or that was appended or rejected last
    std::uint32_t received{0U};
    std::uint32_t superseded{0U};
    std::uint32_t lost{0U};
    std::uint32_t lost_since{0U};  ///< of `lost`, those after `last`

    void pass_to(std::uint32_t number) {
        superseded += number - last - 1U - lost_since;
        lost_since = 0U;
        last = number;
    }
    void discard(const std::vector<std::uint32_t>& staged) {
        for (const std::uint32_t number : staged) {
            lost_since += number > last ? 1U : 0U;
            lost += number > last ? 1U : 0U;
        }
    }
    void check(const PortCounts& counts) const {
        EXPECT_EQ(counts.received, received);
        EXPECT_EQ(counts.superseded, superseded);
        EXPECT_EQ(counts.lost, lost);
    }
};

struct ModelInput : ModelSink {
    /// A value has arrived.
    void show(std::uint32_t number) {
        if (number > last) {
            pass_to(number);
            ++received;
        }
    }
};

/// Between cores, a discarded value is known when the next one arrives.
struct ModelCrossing : ModelInput {
    std::vector<std::uint32_t> discarded;  ///< not known by the sink yet

    void show(std::uint32_t number) {
        while (!discarded.empty() && discarded.front() < number) {
            ++lost;
            ++lost_since;
            discarded.erase(discarded.begin());
        }
        ModelInput::show(number);
    }
    void discard(const std::vector<std::uint32_t>& staged) {
        discarded.insert(discarded.end(), staged.begin(), staged.end());
    }
};

struct ModelQueue : ModelSink {
    struct Waiting {
        std::uint32_t number;
        std::uint32_t frame;
    };
    bool is_overwriting{true};
    std::deque<Waiting> waiting;
    bool is_held{false};  ///< the reader holds the oldest one, so nothing overwrites it

    void append(const std::vector<std::uint32_t>& staged, std::uint32_t frame) {
        for (const std::uint32_t number : staged) {
            if (number > last) {
                pass_to(number);
                append({number, frame});
            }
        }
    }
    void look() { is_held = !waiting.empty(); }
    /// @return the numbers of up to `count` values that were published until `frame`.
    std::vector<std::uint32_t> read(std::uint32_t count, std::uint32_t frame) {
        std::vector<std::uint32_t> numbers;
        for (std::uint32_t i = 0U; i < count; ++i) {
            look();
            if (!is_held || waiting.front().frame > frame) {
                break;
            }
            numbers.push_back(waiting.front().number);
            waiting.pop_front();
            is_held = false;
            ++received;
        }
        return numbers;
    }
    void check(const PortCounts& counts) const {
        ModelSink::check(counts);
        EXPECT_EQ(counts.waiting, waiting.size());
    }

  private:
    void append(Waiting value) {
        const std::size_t held_count = is_held ? 1U : 0U;
        const bool is_full = waiting.size() - held_count == kInCapacity;
        if (!is_full || is_overwriting) {
            waiting.push_back(value);
        }
        if (is_full && is_overwriting) {
            waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(held_count));
        }
        lost += is_full ? 1U : 0U;
    }
};

/// What one reader should count.
template <typename Input>
struct ModelReader {
    explicit ModelReader(Reader& observed) : reader(observed) { rejecting.is_overwriting = false; }
    Reader& reader;
    Input latest;
    Input newest;
    ModelQueue latest_queue;
    ModelQueue overwriting;
    ModelQueue rejecting;
    std::array<std::vector<std::uint32_t>, 3U> values;

    /// Notes which values are in the inputs now.
    void look_at_inputs() {
        latest.show(reader.latest.read());
        newest.show(reader.newest.read());
    }
    void look_at_queues() {
        for (ModelQueue* queue : {&latest_queue, &overwriting, &rejecting}) {
            queue->look();
        }
    }
    void append(const std::vector<std::uint32_t>& last, const std::vector<std::uint32_t>& each,
                std::uint32_t frame) {
        latest_queue.append(last, frame);
        overwriting.append(each, frame);
        rejecting.append(each, frame);
    }
    void discard(const std::vector<std::uint32_t>& last, const std::vector<std::uint32_t>& each) {
        latest.discard(last);
        newest.discard(each);
        latest_queue.discard(last);
        overwriting.discard(each);
        rejecting.discard(each);
    }
    void read(std::uint32_t count, std::uint32_t frame) {
        std::size_t i = 0U;
        for (ModelQueue* queue : {&latest_queue, &overwriting, &rejecting}) {
            const std::vector<std::uint32_t> numbers = queue->read(count, frame);
            values[i].insert(values[i].end(), numbers.begin(), numbers.end());
            ++i;
        }
    }
    void check() const {
        latest.check(count_latest(reader.latest));
        newest.check(count_latest(reader.newest));
        latest_queue.check(reader.latest_queue.get_counts());
        overwriting.check(reader.overwriting.get_counts());
        rejecting.check(reader.rejecting.get_counts());
        EXPECT_EQ(values, reader.values);
    }
    /// When no value is under way: written = received + superseded + lost + waiting.
    void check_sums(std::uint32_t latest_count, std::uint32_t each_count) const {
        const auto calc_sum = [](const PortCounts& counts) {
            return counts.received + counts.superseded + counts.lost + counts.waiting;
        };
        EXPECT_EQ(calc_sum(count_latest(reader.latest)), latest_count);
        EXPECT_EQ(calc_sum(count_latest(reader.newest)), each_count);
        EXPECT_EQ(calc_sum(reader.latest_queue.get_counts()), latest_count);
        EXPECT_EQ(calc_sum(reader.overwriting.get_counts()), each_count);
        EXPECT_EQ(calc_sum(reader.rejecting.get_counts()), each_count);
    }
};

/// A writer and a reader in one window, a reader behind them, and a reader on a second core, which falls back
/// by several frames.
class RandomRun final {
  public:
    explicit RandomRun(std::uint64_t seed) : engine_(seed) {
        EXPECT_EQ(core_0_.initialize(), Status::kOk);
        EXPECT_EQ(core_1_.initialize(), Status::kOk);
        EXPECT_EQ(core_0_.start(), Status::kOk);
        EXPECT_EQ(core_1_.start(), Status::kOk);
    }
    void run_frame(bool is_last) {
        host_.durations.clear();
        host_.hangs.clear();
        host_.deadlines.clear();
        writer_.pass_writes = {is_last ? 1U : roll(4U), is_last ? 0U : roll(2U) * roll(3U)};
        for (Reader* reader : {&near_, &far_, &other_}) {
            reader->reads = roll(6U);
        }
        run_first_window(is_last);
        far_model_.look_at_queues();
        run_reader_window(core_0_, 1U, frame_, is_last);
        far_model_.look_at_inputs();
        if (!is_hanging_) {
            far_model_.read(far_.reads, frame_);
        }
        ++frame_;
        while (other_frame_ < frame_ && (is_last || roll(3U) != 0U)) {
            other_model_.look_at_queues();
            run_reader_window(core_1_, 2U, other_frame_, is_last);
            other_model_.look_at_inputs();
            if (!is_hanging_) {
                other_model_.read(other_.reads, other_frame_);
            }
            ++other_frame_;
        }
    }
    void check() const {
        near_model_.check();
        far_model_.check();
        other_model_.check();
        EXPECT_EQ(writer_.each.get_lost_count(), writer_.rejected_count + discarded_each_count_);
        EXPECT_EQ(writer_.latest.get_lost_count(), discarded_latest_count_);
        EXPECT_EQ(writer_.each.get_written_count(), writer_.each_count + writer_.rejected_count);
        EXPECT_EQ(writer_.latest.get_written_count(), writer_.latest_count);
    }
    void check_sums() const {
        near_model_.check_sums(writer_.latest_count, writer_.each_count);
        far_model_.check_sums(writer_.latest_count, writer_.each_count);
        other_model_.check_sums(writer_.latest_count, writer_.each_count);
    }
    /// Values that each way to be counted has concerned, so that a run is known to show all of them.
    std::array<std::uint32_t, 5U> count_ways() const {
        const PortCounts rejecting = other_.rejecting.get_counts();
        const PortCounts overwriting = other_.overwriting.get_counts();
        return {writer_.rejected_count, discarded_each_count_, rejecting.rejected, overwriting.overwritten,
                near_model_.overwriting.lost - near_.overwriting.get_overwritten_count()};
    }

  private:
    std::uint32_t roll(std::uint32_t count) { return static_cast<std::uint32_t>(engine_() % count); }

    void run_reader_window(Executive& core, std::size_t window, std::uint32_t frame, bool is_last) {
        is_hanging_ = !is_last && roll(8U) == 0U;
        host_.hangs[{window + 1U, Pass::kExecute}] = is_hanging_;
        EXPECT_EQ(run_window(core, window, frame) == WindowOutcome::kOverrun, is_hanging_);
    }
    WindowOutcome run_window(Executive& core, std::size_t window, std::uint32_t frame) {
        const Instant release{frame * 1000 + static_cast<std::int64_t>(window) * 300};
        host_.now = release;
        const WindowOutcome outcome = core.run_window(window, release, host_);
        EXPECT_TRUE(outcome == WindowOutcome::kOverrun || outcome == WindowOutcome::kCompleted);
        return outcome;
    }
    /// The first pass of the writer, the forwarding, the first pass of the reader, the second pass of the
    /// writer; an overrun ends this anywhere.
    void run_first_window(bool is_last) {
        const std::uint32_t place = is_last ? 4U : roll(12U);  // of the overrun; from 4 on: none
        if (place < 3U) {
            host_.durations[{place == 1U ? 1U : 0U, place == 2U ? Pass::kStateUpdate : Pass::kExecute}] =
                Duration{301};
        }
        host_.hangs[{0U, Pass::kExecute}] = place == 3U;
        const std::uint32_t latest_before = writer_.latest_count;
        const std::uint32_t each_before = writer_.each_count;
        near_model_.look_at_queues();
        near_model_.latest.show(writer_.latest.get_published());
        near_model_.newest.show(writer_.each.get_published());

        const WindowOutcome outcome = run_window(core_0_, 0U, frame_);

        EXPECT_EQ(outcome == WindowOutcome::kOverrun, place < 4U);
        const std::uint32_t first_count = place == 3U ? 0U : writer_.pass_writes[0];
        const std::uint32_t each_first = std::min(first_count, kOutCapacity);
        std::vector<std::uint32_t> each;
        for (std::uint32_t number = each_before + 1U; number <= each_before + each_first; ++number) {
            each.push_back(number);
        }
        if (first_count != 0U) {
            near_model_.append({latest_before + first_count}, each, frame_);
            near_model_.latest.show(latest_before + first_count);
            near_model_.newest.show(each.back());
        }
        if (place != 3U) {
            near_model_.look_at_queues();
        }
        if (place == 1U || place == 2U || place >= 4U) {
            near_model_.read(near_.reads, frame_);
        }
        for (std::uint32_t number = each_before + each_first + 1U; number <= writer_.each_count; ++number) {
            each.push_back(number);
        }
        std::vector<std::uint32_t> latest;
        if (writer_.latest_count != latest_before) {
            latest.push_back(writer_.latest_count);
        }
        if (outcome == WindowOutcome::kCompleted) {
            near_model_.append(latest, each, frame_);
            far_model_.append(latest, each, frame_);
            other_model_.append(latest, each, frame_);
        } else {
            near_model_.discard(latest, each);
            far_model_.discard(latest, each);
            other_model_.discard(latest, each);
            discarded_latest_count_ += static_cast<std::uint32_t>(latest.size());
            discarded_each_count_ += static_cast<std::uint32_t>(each.size());
        }
    }

    std::mt19937_64 engine_;
    std::uint32_t frame_{0U};
    std::uint32_t other_frame_{0U};
    std::uint32_t discarded_latest_count_{0U};
    std::uint32_t discarded_each_count_{0U};
    bool is_hanging_{false};
    Writer writer_;
    Reader near_{"near"};
    Reader far_{"far"};
    Reader other_{"other"};
    Crossing<std::uint32_t> latest_crossing_;
    Crossing<std::uint32_t> newest_crossing_;
    SystemTable<3U, 4U, 17U, 15U> table_ = system(
        frame(1000_ns), window("write", 0_ns, 300_ns, budget(300_ns), run(writer_, near_)),
        window("far", 300_ns, 300_ns, budget(300_ns), run(far_)),
        window("other", 600_ns, 300_ns, core(1), budget(300_ns), run(other_)),
        connect(writer_.latest, near_.latest, any_age()), connect(writer_.each, near_.newest, any_age()),
        connect(writer_.latest, near_.latest_queue, any_age()),
        connect(writer_.each, near_.overwriting, any_age()),
        connect(writer_.each, near_.rejecting, any_age()), connect(writer_.latest, far_.latest, any_age()),
        connect(writer_.each, far_.newest, any_age()), connect(writer_.latest, far_.latest_queue, any_age()),
        connect(writer_.each, far_.overwriting, any_age()), connect(writer_.each, far_.rejecting, any_age()),
        connect(writer_.latest, other_.latest, through(latest_crossing_), any_age()),
        connect(writer_.each, other_.newest, through(newest_crossing_), any_age()),
        connect(writer_.latest, other_.latest_queue, any_age()),
        connect(writer_.each, other_.overwriting, any_age()),
        connect(writer_.each, other_.rejecting, any_age()));
    FakeHost host_;
    ExecutiveFor<decltype(table_)> core_0_{table_};
    ExecutiveFor<decltype(table_)> core_1_{table_, 1U};
    ModelReader<ModelInput> near_model_{near_};
    ModelReader<ModelInput> far_model_{far_};
    ModelReader<ModelCrossing> other_model_{other_};
};

TEST(ValueCountsTest, EachValueOfRandomWritesIsReceivedSupersededLostOrWaiting) {
    verifies("SWR-KRN-054", Technique::kBackToBack);
    std::array<std::uint64_t, 5U> ways{};
    for (std::uint64_t seed = 0U; seed < kRuns; ++seed) {
        RandomRun sut{seed};
        for (std::uint32_t frame = 0U; frame < kFrames; ++frame) {
            sut.run_frame(false);
            sut.check();
            ASSERT_FALSE(HasFailure()) << "seed " << seed << ", frame " << frame;
        }
        sut.run_frame(true);
        sut.check();
        sut.check_sums();
        ASSERT_FALSE(HasFailure()) << "seed " << seed;
        const std::array<std::uint32_t, 5U> of_run = sut.count_ways();
        for (std::size_t i = 0U; i < ways.size(); ++i) {
            ways[i] += of_run[i];
        }
    }
    for (const std::uint64_t count : ways) {
        EXPECT_GT(count, 0U);
    }
}

}  // namespace
}  // namespace mamori
