// SPDX-License-Identifier: Apache-2.0
#include "safety_system.hpp"

#include <new>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/virtual_watchdog.hpp"
#include "mamori/safety/cycle/safety_cycle.hpp"
#include "mamori/safety/supervision/alive_supervisor.hpp"

namespace mamori::partition_faults {

SystemLog* system_log = nullptr;
std::atomic<bool> is_stopped{false};
std::atomic<std::uint32_t> good_count{0U};
std::atomic<bool> is_reset_wanted{false};
ports::posix_rt::FrameReader answer_reader;
ports::posix_rt::FrameWriter request_writer;

/// Message to the drive.
struct StopOrder {
    std::uint32_t reaction{0U};  ///< safety::Reaction
    std::uint16_t fault{safety::kNoFault};
    bool is_stop{true};
};

}  // namespace mamori::partition_faults

MAMORI_FIELDS(mamori::partition_faults::StopOrder, reaction, fault, is_stop)

namespace mamori::partition_faults {
namespace {

using ports::posix_rt::FrameOutcome;
using ports::posix_rt::PartitionNews;
using safety::Reaction;

/// Number of major frames without a valid reply that a busy host may cause. Earlier valid replies then no
/// longer count.
constexpr std::uint32_t kPauseFrames{10U};
constexpr std::uint32_t kNever{1'000'000'000U};
constexpr Duration kLong = 1'000_s;

template <typename Row>
void add(std::vector<Row>& rows, const Row& row) noexcept {
    if (rows.size() < rows.capacity()) {
        rows.push_back(row);
    }
}

/// The first component of each window: records that the window has started.
class Witness final : public Component {
  public:
    constexpr Witness(const char* name, std::size_t window) noexcept : Component(name), window_(window) {}
    using Ports = mamori::Ports<>;

    Status on_execute(ContextHandle context) noexcept override {
        const std::size_t place = system_log->ran_count.fetch_add(1U, std::memory_order_relaxed);
        if (place < system_log->ran.size()) {
            system_log->ran[place] = {window_, context.now};
        }
        return Status::kOk;
    }

  private:
    std::size_t window_;
};

class Asker final : public Component {
  public:
    constexpr Asker() noexcept : Component("asker") {}
    OutPort<Request> request{*this, "request"};
    using Ports = mamori::Ports<&Asker::request>;

    Status on_execute(ContextHandle) noexcept override {
        request.write({++sequence_});
        return Status::kOk;
    }

  private:
    std::uint64_t sequence_{0U};
};

extern safety::SafetyState state;

/// Supervises the partition by its messages; SafetyCycle does the rest.
class Guard final : public safety::SafetyCycle {
  public:
    Guard() noexcept : SafetyCycle("guard", state) {
        static_cast<void>(alive_.watch(0U, {kPauseFrames, kSilentFrames}));
    }
    InPort<Answer> answer{*this, "answer"};
    InPort<PartitionNews> news{*this, "news"};
    OutPort<StopOrder> stop{*this, "stop"};
    using Ports = mamori::Ports<&Guard::answer, &Guard::news, &Guard::stop>;

  private:
    safety::CycleInputs read_inputs(Instant now) noexcept override {
        const PartitionNews& found = news.read();
        const bool is_answer = answer.is_new();
        const bool is_right = is_answer && answer.read().check == calc_check(answer.read());
        const bool is_malformed = found.outcome == FrameOutcome::kMalformed;
        const bool is_flood = is_answer && found.skipped > kSkippedMax;
        add(system_log->receptions, {now, is_answer, is_right, is_malformed, found.skipped});
        was_pushed_ = is_reset_wanted.exchange(false, std::memory_order_relaxed) && !was_pushed_;
        if (was_pushed_) {
            static_cast<void>(alive_.acknowledge(0U));
        }
        const bool is_good = is_right && !is_flood;
        if (is_good) {
            // Supervision of the slot begins at the start.
            static_cast<void>(alive_.report_alive(0U));
        }
        const safety::AliveVerdict verdict = alive_.step();
        const std::uint32_t count = good_count.load(std::memory_order_relaxed) + (is_good ? 1U : 0U);
        good_count.store(verdict == safety::AliveVerdict::kLate ? 0U : count, std::memory_order_relaxed);
        present_ = {verdict == safety::AliveVerdict::kExpired, is_flood,
                    is_malformed || (is_answer && !is_right), false};
        // The drive obeys and stands, and one push resets or starts.
        const bool is_start = was_pushed_ && get_state() == safety::SafeState::kStandby;
        return {true, !outputs_.brake_release, outputs_.torque_enable, is_start, was_pushed_, true, outputs_};
    }
    safety::SelfTestStatus step_self_test(bool is_first, Instant) noexcept override {
        return is_first ? safety::SelfTestStatus::kRunning : safety::SelfTestStatus::kPassed;
    }
    bool is_present(safety::FaultIndex fault) noexcept override { return present_[fault]; }
    void command(safety::SafeState, const safety::StopOutputs& outputs) noexcept override {
        safety::ReactionDemand worst{};
        for (std::size_t fault = 0U; fault < present_.size(); ++fault) {
            const safety::ReactionDemand& demand =
                state.get_faults().get_record(static_cast<safety::FaultIndex>(fault)).demand;
            worst = safety::is_worse(demand, worst) ? demand : worst;
        }
        outputs_ = outputs;
        stop.write({static_cast<std::uint32_t>(worst.reaction), worst.fault,
                    outputs.stop_requested || !outputs.torque_enable});
    }

    std::array<safety::AliveSlot, 1U> slots_{};
    safety::AliveSupervisor alive_{slots_};
    std::array<bool, kReactions.size()> present_{};
    safety::StopOutputs outputs_{};
    bool was_pushed_{false};
};

/// The drive, on which the reaction acts.
class Drive final : public Component {
  public:
    constexpr Drive() noexcept : Component("drive") {}
    InPort<StopOrder> stop{*this, "stop"};
    using Ports = mamori::Ports<&Drive::stop>;

    Status on_execute(ContextHandle) noexcept override {
        StopOrder order = stop.read();
        seed_defect(order);
        const bool is_reaction = order.reaction != static_cast<std::uint32_t>(Reaction::kNone);
        if (is_reaction && !was_reaction_ && system_log->clock != nullptr) {
            const bool is_known = order.fault < kReactions.size();
            const bool is_declared = is_known && order.reaction == kReactions[order.fault].reaction;
            add(system_log->reactions,
                {system_log->clock->get_now(), static_cast<PartitionFault>(order.fault), is_declared});
        }
        was_reaction_ = is_reaction;
        is_stopped.store(order.is_stop, std::memory_order_release);
        return Status::kOk;
    }

  private:
    void seed_defect(StopOrder& order) noexcept {
        if (system_log->clock == nullptr) {
            return;
        }
        if (system_log->defect == verification::Defect::kWrongName && order.fault < kReactions.size()) {
            order.fault = static_cast<std::uint16_t>((order.fault + 1U) % kReactions.size());
        }
        ++cycle_;
        if (system_log->defect == verification::Defect::kOverrun &&
            cycle_ % verification::kDefectEvery == 0U) {
            const Instant end = system_log->clock->get_now() + kFrame;
            while (system_log->clock->get_now() < end) {
            }
        }
    }

    std::uint64_t cycle_{0U};
    bool was_reaction_{false};
};

Witness ask_witness{"ask_witness", 0U};
Asker asker;
Witness protect_witness{"protect_witness", 1U};
/// Its window may start late by its length and still find a reply of this major frame.
ports::posix_rt::PartitionReceiver<Answer> receiver{"receiver", answer_reader, 240_us};
Guard guard;
Witness act_witness{"act_witness", 2U};
Drive drive;
Witness tell_witness{"tell_witness", 3U};
ports::posix_rt::PartitionSender<Request> sender{"sender", request_writer};
/// Budgets have slack for the longest host stall that is not recorded.
constexpr auto kSystem = safety::system(
    frame(kFrame), kFaults, window("ask", 0_us, 240_us, budget(230_us), mamori::run(ask_witness, asker)),
    window("protect", 240_us, 240_us, budget(230_us), mamori::run(protect_witness, receiver, guard)),
    window("act", 480_us, 240_us, budget(230_us), mamori::run(act_witness, drive)),
    window("tell", 720_us, 240_us, budget(230_us), mamori::run(tell_witness, sender)),
    connect(receiver.out, guard.answer, any_age()), connect(receiver.news, guard.news, any_age()),
    connect(guard.stop, drive.stop, any_age()), connect(asker.request, sender.in, any_age()),
    // The evaluation of the campaign judges windows and times: a busy host may move them.
    safety::supervise(guard, safety::alive(kNever, kNever + 1U), safety::deadline(kLong)),
    safety::supervise(receiver, safety::alive(kNever, kNever + 1U), safety::deadline(kLong)),
    safety::confirmed_by(receiver.news, safety::StopConfirmation::kStandstill,
                         safety::StopConfirmation::kClosedBrakes, safety::StopConfirmation::kTorqueOff),
    safety::cycle(safety::StopBounds{2_s, 2_s}, safety::BrakeLimits{1_s, true},
                  safety::WatchdogWindow{0_us, kLong}, safety::torque_feedback(kLong),
                  safety::tolerated_lateness(kLong),
                  safety::on_late_reaction(safety::raises(PartitionFault::kInternal)),
                  safety::on_failed_self_test(safety::raises(PartitionFault::kInternal)),
                  safety::on_unconfirmed_brakes(safety::raises(PartitionFault::kInternal))));
MAMORI_SAFETY_CHECK(kSystem);
ports::virtual_time::VirtualWatchdog watchdog{kLong};
safety::SafetyStorage<kSystem> storage;
safety::SafetyState state{storage, watchdog};
static_assert(kSystem.kWindowCount == kWindowCount);
ExecutiveFor executive_of_table{kSystem};

}  // namespace

Executive& executive = executive_of_table;
bool restart() noexcept {
    if (executive.stop() != Status::kOk || executive.finalize() != Status::kOk) {
        return false;
    }
    new (&storage) safety::SafetyStorage<kSystem>{};
    new (&state) safety::SafetyState{storage, watchdog};
    return executive.initialize() == Status::kOk && executive.start() == Status::kOk;
}
std::array<ports::posix_rt::WindowThread, kWindowCount> window_threads;

}  // namespace mamori::partition_faults
