// SPDX-License-Identifier: Apache-2.0
#include "safety_system.hpp"

#include "mamori/kernel/system/system.hpp"
#include "mamori/safety/reaction/fault_register.hpp"
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
};

}  // namespace mamori::partition_faults

MAMORI_FIELDS(mamori::partition_faults::StopOrder, reaction, fault)

namespace mamori::partition_faults {
namespace {

using ports::posix_rt::FrameOutcome;
using ports::posix_rt::PartitionNews;
using safety::Reaction;

/// Number of major frames without a valid reply that a busy host may cause. Earlier valid replies then no
/// longer count.
constexpr std::uint32_t kPauseFrames{10U};

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

/// Supervises the partition by its messages.
class Guard final : public Component {
  public:
    constexpr Guard() noexcept : Component("guard") {}
    InPort<Answer> answer{*this, "answer"};
    InPort<PartitionNews> news{*this, "news"};
    OutPort<StopOrder> stop{*this, "stop"};
    using Ports = mamori::Ports<&Guard::answer, &Guard::news, &Guard::stop>;

    Status on_initialize() noexcept override {
        return alive_.is_watched(0U) ? Status::kOk : alive_.watch(0U, {kPauseFrames, kSilentFrames});
    }
    Status on_execute(ContextHandle context) noexcept override {
        const PartitionNews& now = news.read();
        const bool is_answer = answer.is_new();
        const bool is_right = is_answer && answer.read().check == calc_check(answer.read());
        const bool is_malformed = now.outcome == FrameOutcome::kMalformed;
        const bool is_flood = is_answer && now.skipped > kSkippedMax;
        add(system_log->receptions, {context.now, is_answer, is_right, is_malformed, now.skipped});
        follow_reset();
        const bool is_good = is_right && !is_flood;
        if (is_good) {
            // Supervision of the slot begins at the start.
            static_cast<void>(alive_.report_alive(0U));
        }
        const safety::AliveVerdict verdict = alive_.step();
        const bool is_silent = verdict == safety::AliveVerdict::kExpired;
        const std::uint32_t count = good_count.load(std::memory_order_relaxed) + (is_good ? 1U : 0U);
        good_count.store(verdict == safety::AliveVerdict::kLate ? 0U : count, std::memory_order_relaxed);
        report(PartitionFault::kSilent, is_silent, context.now);
        report(PartitionFault::kFlooding, is_flood, context.now);
        report(PartitionFault::kCorrupt, is_malformed || (is_answer && !is_right), context.now);
        const safety::ReactionDemand demand = calc_reaction(kReactions, faults_);
        stop.write({static_cast<std::uint32_t>(demand.reaction), demand.fault});
        return Status::kOk;
    }

  private:
    void report(PartitionFault fault, bool is_present, Instant now) noexcept {
        faults_.report(static_cast<safety::FaultIndex>(fault), is_present, now);
    }
    /// Faults that are still present remain latched, as the drive shows.
    void follow_reset() noexcept {
        if (is_reset_wanted.exchange(false, std::memory_order_relaxed)) {
            static_cast<void>(alive_.acknowledge(0U));
            faults_.report(static_cast<safety::FaultIndex>(PartitionFault::kSilent), false, Instant{});
            static_cast<void>(faults_.acknowledge_all());
        }
    }

    std::array<safety::AliveSlot, 1U> slots_{};
    safety::AliveSupervisor alive_{slots_};
    std::array<safety::FaultRecord, kReactions.size()> records_{};
    safety::FaultRegister faults_{records_};
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
        const bool is_stop = order.reaction != static_cast<std::uint32_t>(Reaction::kNone);
        if (is_stop && !was_stop_ && system_log->clock != nullptr) {
            const bool is_known = order.fault < kReactions.size();
            const bool is_declared = is_known && order.reaction == kReactions[order.fault].reaction;
            add(system_log->reactions,
                {system_log->clock->get_now(), static_cast<PartitionFault>(order.fault), is_declared});
        }
        was_stop_ = is_stop;
        is_stopped.store(is_stop, std::memory_order_release);
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
    bool was_stop_{false};
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
constexpr auto kSystem = system(
    frame(kFrame), kFaults, window("ask", 0_us, 240_us, budget(230_us), mamori::run(ask_witness, asker)),
    window("protect", 240_us, 240_us, budget(230_us), mamori::run(protect_witness, receiver, guard)),
    window("act", 480_us, 240_us, budget(230_us), mamori::run(act_witness, drive)),
    window("tell", 720_us, 240_us, budget(230_us), mamori::run(tell_witness, sender)),
    connect(receiver.out, guard.answer, any_age()), connect(receiver.news, guard.news, any_age()),
    connect(guard.stop, drive.stop, any_age()), connect(asker.request, sender.in, any_age()));
MAMORI_CHECK(kSystem);
static_assert(kSystem.kWindowCount == kWindowCount);
ExecutiveFor executive_of_table{kSystem};

}  // namespace

Executive& executive = executive_of_table;
std::array<ports::posix_rt::WindowThread, kWindowCount> window_threads;

}  // namespace mamori::partition_faults
