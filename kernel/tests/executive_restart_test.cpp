// SPDX-License-Identifier: Apache-2.0
// Goal: a run begins with empty inputs, queues and inter-core buffers, whatever the run before left in them,
// and whether the time line goes on or begins again. Method: two runs of one table for each kind of
// connection; in the second one the source is silent at first.
#include <gtest/gtest.h>

#include <vector>

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/fake_host.hpp"
#include "support/flow_components.hpp"
#include "support/mode_system.hpp"

namespace mamori {
namespace {

using testing_support::Counter;
using testing_support::FakeHost;
using namespace verification;

constexpr std::int64_t kHour{3'600'000'000'000};

/// Notes what its input says when the context starts and in each cycle.
template <typename In>
class Watcher final : public Component {
  public:
    struct Note {
        PortStatus status;
        bool is_new;
        std::int64_t value;
    };

    Watcher() noexcept : Component("watcher") {}

    In in{*this, "in"};
    using Ports = mamori::Ports<&Watcher::in>;

    std::vector<Note> notes;
    PortStatus at_start{PortStatus::kOk};

    Status on_startup(ContextHandle context) noexcept override {
        at_start = in.calc_status(context.now);
        return Status::kOk;
    }
    Status on_execute(ContextHandle context) noexcept override {
        Note note{in.calc_status(context.now), in.is_new(), 0};
        if constexpr (In::kIsQueue) {
            static_cast<void>(in.read(note.value));
        } else {
            note.value = in.read();
        }
        notes.push_back(note);
        return Status::kOk;
    }
};

/// How the counter is connected to the watcher.
enum class Way { kHandOn, kNextWindow, kOtherCore };

using Latest = InPort<std::int64_t>;
using Queue = QueueInPort<std::int64_t, 4U>;

/// Two runs of the same executives. Frame 1 us: the counter runs from 0 to 400 ns, the watcher from 400 ns,
/// or with the counter when it is handed the values.
template <typename In, Way kWay>
struct Rig {
    Counter counter;
    Watcher<In> watcher;
    Crossing<std::int64_t> crossing;
    FakeHost host;

    static constexpr std::size_t kWatcherCore = kWay == Way::kOtherCore ? 1U : 0U;

    using Table = SystemTable<2U, 3U, 3U, 1U>;

    Table make_table() {
        if constexpr (kWay == Way::kHandOn) {
            return system(frame(1000_ns), window("both", 0_ns, 400_ns, budget(300_ns), run(counter, watcher)),
                          window("idle", 400_ns, 500_ns, budget(300_ns), run(other_)),
                          connect(counter.out, watcher.in, any_age()));
        } else if constexpr (kWay == Way::kNextWindow || In::kIsQueue) {
            return system(frame(1000_ns), window("write", 0_ns, 400_ns, budget(300_ns), run(counter, other_)),
                          window("read", 400_ns, 500_ns, core(kWatcherCore), budget(300_ns), run(watcher)),
                          connect(counter.out, watcher.in, any_age()));
        } else {
            return system(frame(1000_ns), window("write", 0_ns, 400_ns, budget(300_ns), run(counter, other_)),
                          window("read", 400_ns, 500_ns, core(1), budget(300_ns), run(watcher)),
                          connect(counter.out, watcher.in, through(crossing), any_age()));
        }
    }

    Counter other_{"other"};
    Table table{make_table()};
    ExecutiveFor<Table> first{table, 0U};
    ExecutiveFor<Table> second{table, 1U};

    std::vector<Executive*> get_cores() {
        return kWay == Way::kOtherCore ? std::vector<Executive*>{&first, &second}
                                       : std::vector<Executive*>{&first};
    }
    void begin() {
        for (Executive* core : get_cores()) {
            ASSERT_EQ(core->initialize(), Status::kOk);
        }
        start();
    }
    void start() {
        watcher.notes.clear();
        for (Executive* core : get_cores()) {
            ASSERT_EQ(core->start(), Status::kOk);
        }
    }
    void end() {
        for (Executive* core : get_cores()) {
            ASSERT_EQ(core->stop(), Status::kOk);
            ASSERT_EQ(core->finalize(), Status::kOk);
        }
    }
    void run_window(std::size_t w, std::int64_t frame_start) {
        host.now = Instant{frame_start + static_cast<std::int64_t>(w) * 400};
        Executive& core = w == 1U ? *get_cores().back() : first;
        ASSERT_EQ(core.run_window(w, host.now, host), WindowOutcome::kCompleted);
    }
    void run_frame(std::int64_t frame_start) {
        run_window(0U, frame_start);
        run_window(1U, frame_start);
    }
};

template <typename R>
class ExecutiveRestartTest : public ::testing::Test {
  protected:
    /// The run before: three frames, and one more value that nobody has read.
    void run_once() {
        rig_.begin();
        for (std::int64_t start = 0; start < 3000; start += 1000) {
            rig_.run_frame(kHour + start);
        }
        ASSERT_EQ(rig_.watcher.notes.back().value, 30);
        rig_.run_window(0U, kHour + 3000);
        rig_.end();
        rig_.counter.is_writing = false;
    }
    /// The next run begins at `start`; its source is silent for two frames.
    void expect_empty_run(std::int64_t start) {
        rig_.begin();
        EXPECT_EQ(rig_.watcher.at_start, PortStatus::kBufferEmpty);
        rig_.run_frame(start);
        rig_.run_frame(start + 1000);
        ASSERT_EQ(rig_.watcher.notes.size(), 2U);
        for (const auto& note : rig_.watcher.notes) {
            EXPECT_EQ(note.status, PortStatus::kBufferEmpty);
            EXPECT_FALSE(note.is_new);
            EXPECT_EQ(note.value, 0);
        }
    }
    /// The first value of the new run arrives in the frame in which it is written.
    void expect_new_values(std::int64_t start) {
        rig_.counter.is_writing = true;
        rig_.run_frame(start);
        EXPECT_EQ(rig_.watcher.notes.back().status, PortStatus::kOk);
        EXPECT_TRUE(rig_.watcher.notes.back().is_new);
        EXPECT_EQ(rig_.watcher.notes.back().value, 50);
    }

    R rig_;
};
using Rigs =
    ::testing::Types<Rig<Latest, Way::kHandOn>, Rig<Latest, Way::kNextWindow>, Rig<Latest, Way::kOtherCore>,
                     Rig<Queue, Way::kHandOn>, Rig<Queue, Way::kNextWindow>, Rig<Queue, Way::kOtherCore>>;
TYPED_TEST_SUITE(ExecutiveRestartTest, Rigs, );

TYPED_TEST(ExecutiveRestartTest, ARunOnTheSameTimeLineBeginsWithEmptyInputs) {
    verifies("SWR-KRN-039", Technique::kStateTransition, Polarity::kViolation);
    this->run_once();

    this->expect_empty_run(2 * kHour);
    this->expect_new_values(2 * kHour + 2000);
}

TYPED_TEST(ExecutiveRestartTest, ARunWhoseTimeLineBeginsAgainBeginsWithEmptyInputs) {
    verifies("SWR-KRN-039", Technique::kErrorGuessing, Polarity::kViolation);
    this->run_once();

    this->expect_empty_run(0);
    this->expect_new_values(2000);
}

TYPED_TEST(ExecutiveRestartTest, AStartWithoutANewInitialisationEmptiesTheInputsToo) {
    verifies("SWR-KRN-039", Technique::kStateTransition, Polarity::kViolation);
    this->rig_.begin();
    this->rig_.run_frame(0);
    ASSERT_EQ(this->rig_.watcher.notes.back().value, 10);
    for (Executive* core : this->rig_.get_cores()) {
        ASSERT_EQ(core->stop(), Status::kOk);
    }
    this->rig_.counter.is_writing = false;

    this->rig_.start();
    this->rig_.run_frame(1000);

    EXPECT_EQ(this->rig_.watcher.notes.back().status, PortStatus::kBufferEmpty);
}

TYPED_TEST(ExecutiveRestartTest, AFirstRunReadsItsValues) {
    verifies("SWR-KRN-039", Technique::kRequirementsBased);
    this->rig_.begin();
    this->rig_.run_frame(0);

    EXPECT_EQ(this->rig_.watcher.at_start, PortStatus::kBufferEmpty);
    EXPECT_EQ(this->rig_.watcher.notes.back().value, 10);
}

TEST(ExecutiveRestartCoresTest, ACoreThatKeepsRunningKeepsItsValueWhenTheOtherOneStartsAgain) {
    verifies("SWR-KRN-039", Technique::kStateTransition);
    Rig<Latest, Way::kOtherCore> rig;
    rig.begin();
    rig.run_frame(0);
    ASSERT_EQ(rig.first.stop(), Status::kOk);
    rig.counter.is_writing = false;
    ASSERT_EQ(rig.first.start(), Status::kOk);

    rig.run_frame(1000);

    EXPECT_EQ(rig.watcher.notes.back().value, 10);
    EXPECT_FALSE(rig.watcher.notes.back().is_new);
}

TEST(ExecutiveRestartCoresTest, ACoreThatStartsLateReadsTheNextValue) {
    verifies("SWR-KRN-039", Technique::kBoundaryValues, Polarity::kViolation);
    Rig<Queue, Way::kOtherCore> rig;
    ASSERT_EQ(rig.first.initialize(), Status::kOk);
    ASSERT_EQ(rig.second.initialize(), Status::kOk);
    ASSERT_EQ(rig.first.start(), Status::kOk);
    rig.run_window(0U, 0);

    ASSERT_EQ(rig.second.start(), Status::kOk);
    rig.run_window(1U, 0);
    EXPECT_EQ(rig.watcher.notes.back().status, PortStatus::kBufferEmpty);
    rig.run_frame(1000);
    EXPECT_EQ(rig.watcher.notes.back().value, 20);
}

TEST(ExecutiveRestartModesTest, AConnectionThatBeginsLaterBringsNoValueOfTheRunBefore) {
    verifies("SWR-KRN-039", Technique::kStateTransition, Polarity::kViolation);
    testing_support::TroublePlan plan{};
    testing_support::ModeHost host;
    testing_support::Part planner{"planner", 2, host, plan};
    testing_support::Part drive{"drive", 3, host, plan};
    const auto table =
        system(frame(1000_ns), window("first", 0_ns, 400_ns, budget(300_ns), run(planner)),
               window("second", 400_ns, 500_ns, budget(400_ns), run(drive)),
               connect(planner.out, drive.in, only_in("halt"), any_age()),
               system_mode("work", runs(planner, drive)), safe_mode("halt", runs(drive, planner)));
    SystemModes modes{make_view(table)};
    ExecutiveFor<std::decay_t<decltype(table)>> sut{table, modes};
    const auto run_frame = [&](std::int64_t start) {
        for (const std::size_t w : {std::size_t{0U}, std::size_t{1U}}) {
            host.now = Instant{start + static_cast<std::int64_t>(w) * 400};
            EXPECT_EQ(sut.run_window(w, host.now, host), WindowOutcome::kCompleted);
        }
    };
    ASSERT_EQ(sut.initialize(), Status::kOk);
    ASSERT_EQ(sut.start(), Status::kOk);
    run_frame(kHour);
    ASSERT_EQ(sut.stop(), Status::kOk);

    // The planner publishes nothing in this run, whose time line begins again.
    ASSERT_EQ(sut.start(), Status::kOk);
    ASSERT_EQ(modes.request_safe_mode(), Status::kOk);
    ASSERT_EQ(sut.get_context(0U).stop(Instant{0}), Status::kOk);
    for (std::int64_t start = 0; start < 6000; start += 1000) {
        host.now = Instant{start};
        static_cast<void>(sut.run_window(0U, host.now, host));
        host.now = Instant{start + 400};
        ASSERT_EQ(sut.run_window(1U, host.now, host), WindowOutcome::kCompleted);
    }

    EXPECT_FALSE(drive.in.has_value());
}

}  // namespace
}  // namespace mamori
