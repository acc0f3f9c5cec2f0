// SPDX-License-Identifier: Apache-2.0
#include "campaign.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <random>
#include <thread>

#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/ports/posix_rt/shared_memory.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/verification/awake_processor.hpp"
#include "mamori/verification/occupancy_watch.hpp"
#include "safety_system.hpp"

namespace mamori::partition_faults {
namespace {

using namespace ports::posix_rt;  // NOLINT: this program is made of them
using verification::AwakeProcessor;
using verification::find_processor;
using verification::OccupancyWatch;
using verification::StallWatch;

/// Above the priorities of other programs: only the host or the software under test delays these threads.
constexpr int kWatchPriority = 98;
constexpr std::size_t kPollsPerFrame = 20U;
constexpr int kRunnerPriority = 97;
constexpr int kWindowPriority = 96;
constexpr std::uint32_t kWellFrames{20U};
constexpr Duration kStep = 1_ms;
constexpr Duration kPatience = 20_s;
/// A partition that has not injected its fault within this time never will.
constexpr Duration kInjectionPatience = 2_s;
constexpr int kStartTries{20};
/// Capacity of the logs [major frames]: about five times the need of a fault, plus a slow start.
constexpr std::size_t kFramesPerFault{1000U};
constexpr std::size_t kFramesBeside{60'000U};

/// Reasons to end with a host cause.
constexpr const char* kTooSlow = "the machine is too slow: what is written down has no room";
constexpr const char* kNoTime = "the machine gives the partition no time";

/// The memory between the processes; this process creates all of it.
struct Link {
    SharedMemory requests{};
    SharedMemory answers{};
    SharedMemory notes{};
    FrameReader diary{};

    bool open() {
        return requests.create("requests", calc_frame_region_size(kRequestCapacity), SharedAccess::kWrite) ==
                   Status::kOk &&
               answers.create("answers", calc_frame_region_size(kAnswerCapacity), SharedAccess::kRead) ==
                   Status::kOk &&
               notes.create("notes", calc_frame_region_size(kNoteCapacity), SharedAccess::kRead) ==
                   Status::kOk &&
               request_writer.open(requests.get_writable_region(), kRequestCapacity) == Status::kOk &&
               answer_reader.open(answers.get_region(), kAnswerCapacity) == Status::kOk &&
               diary.open(notes.get_region(), kNoteCapacity) == Status::kOk;
    }
    /// Returns the last note of the partition since the previous call. @return false if there is none.
    bool take_note(Note& note, Instant& at) {
        std::array<std::byte, kNoteCapacity> content{};
        FrameFacts facts{};
        if (diary.take(content, facts) != FrameOutcome::kNew || facts.length != kNoteCapacity) {
            return false;
        }
        note = static_cast<Note>(content[0U]);
        at = facts.published_at;
        return true;
    }
};

/// Records each window instance, on the thread that runs the windows.
class OpeningLog final : public OpeningObserver {
  public:
    OpeningLog(const FrameClock& clock, std::size_t room, verification::Defect defect)
        : clock_(clock), defect_(defect) {
        openings.reserve(room);
    }

    void before_opening(const FrameSchedule::Opening& opening, Instant woke) noexcept override {
        woke_ = woke;
        const auto frame = static_cast<std::uint64_t>(opening.release.ns / kFrame.ns);
        if (defect_ == verification::Defect::kLateRelease && opening.window == 1U &&
            frame % verification::kDefectEvery == 0U) {
            while (clock_.get_now() < opening.release + kFrame) {
            }
        }
    }
    void after_opening(const FrameSchedule::Opening& opening, WindowOutcome outcome) noexcept override {
        if (openings.size() < openings.capacity()) {
            openings.push_back({{opening.window, opening.release},
                                woke_,
                                clock_.get_now(),
                                outcome == WindowOutcome::kMissed,
                                outcome == WindowOutcome::kOverrun});
        }
    }

    std::vector<TimedOpening> openings{};

  private:
    const FrameClock& clock_;
    verification::Defect defect_;
    Instant woke_{};
};

/// Executes the plan on an ordinary thread in parallel to the windows, which never wait for it.
class Director final {
  public:
    /// @param[in] last instant up to which the logs have capacity.
    Director(const CampaignRequest& request, const FrameClock& clock, Link& link, Instant last)
        : request_(request), clock_(clock), link_(link), last_(last) {}

    /// @return the error; empty if there is none.
    const char* carry_out(const std::vector<Fault>& plan) {
        const char* trouble = "";
        for (std::size_t i = 0U; i < plan.size() && *trouble == '\0'; ++i) {
            trouble = carry_out(plan[i], i);
        }
        static_cast<void>(partition_.end());
        static_cast<void>(wait([this] { return partition_.check() != PartitionState::kRunning; }, kPatience));
        return trouble;
    }
    const std::vector<Injected>& get_injections() const noexcept { return injections_; }

  private:
    template <typename Condition>
    bool wait(Condition is_met, Duration patience) {
        const Instant end = clock_.get_now() + patience;
        while (!is_met()) {
            if (clock_.get_now() > end) {
                return false;
            }
            clock_.wait_until(clock_.get_now() + kStep);
        }
        return true;
    }

    const char* carry_out(const Fault& fault, std::size_t number) {
        if (clock_.get_now() > last_) {
            return kTooSlow;
        }
        if (!start(number)) {
            return describe(partition_.get_error());
        }
        bool is_well = false;
        for (int i = 0; i < kStartTries && !is_well; ++i) {
            if (!become_well()) {
                return "the partition did not become well";
            }
            clock_.wait_until(clock_.get_now() + fault.wait);
            // A partition without processor time has already had its reaction: no fault is injected.
            is_well = !is_stopped.load(std::memory_order_acquire) &&
                      good_count.load(std::memory_order_relaxed) > 0U;
        }
        if (!is_well) {
            return kNoTime;
        }
        Injected injected = inject(fault.kind);
        static_cast<void>(
            wait([] { return is_stopped.load(std::memory_order_acquire); }, kInjectionPatience));
        clock_.wait_until(clock_.get_now() + fault.hold);
        static_cast<void>(partition_.end());
        if (!wait([this] { return partition_.check() == PartitionState::kEnded; }, kPatience)) {
            return "the partition did not end";
        }
        injected.over = clock_.get_now();
        injections_.push_back(injected);
        return "";
    }

    /// Starts the program and waits until it reports that it runs.
    bool start(std::size_t number) {
        const std::string seed = std::to_string(request_.seed + number);
        const std::array<const char*, 1U> arguments{seed.c_str()};
        const std::array<int, 3U> descriptors{link_.requests.get_descriptor(), link_.answers.get_descriptor(),
                                              link_.notes.get_descriptor()};
        PartitionOrder order{request_.worker, arguments, descriptors, &clock_, {}};
        order.limits.niceness = 0;  // the highest priority without a privilege
        order.errors = STDERR_FILENO;
        if (partition_.start(order) != Status::kOk) {
            return false;
        }
        Note note{};
        Instant at{};
        return wait([&] { return link_.take_note(note, at) && note == Note::kRuns; }, kPatience);
    }

    bool become_well() {
        return wait(
            [] {
                const bool is_good = good_count.load(std::memory_order_relaxed) >= kWellFrames;
                if (is_good && is_stopped.load(std::memory_order_acquire)) {
                    is_reset_wanted.store(true, std::memory_order_relaxed);
                    return false;
                }
                return is_good;
            },
            kPatience);
    }

    Injected inject(Kind kind) {
        Injected injected{kind, clock_.get_now(), {}, {}, true};
        int signal = SIGKILL;
        switch (kind) {
            case Kind::kKill:
                break;
            case Kind::kStop:
                signal = SIGSTOP;
                break;
            case Kind::kFlood:
                signal = kFloodSignal;
                break;
            case Kind::kCorrupt:
                signal = kCorruptionSignal;
                break;
        }
        static_cast<void>(partition_.send_signal(signal));
        injected.done = clock_.get_now();
        if (kind == Kind::kFlood || kind == Kind::kCorrupt) {
            Note note{};
            injected.is_done =
                wait([&] { return link_.take_note(note, injected.done) && note == Note::kDone; },
                     kInjectionPatience);
        }
        return injected;
    }

    const CampaignRequest& request_;
    const FrameClock& clock_;
    Link& link_;
    Instant last_;
    PartitionProcess partition_{};
    std::vector<Injected> injections_{};
};

/// The same table in virtual time, up to the last window in real time.
std::vector<Opening> run_in_virtual_time(const std::vector<TimedOpening>& openings) {
    if (openings.empty() || !restart()) {
        return {};
    }
    const Opening& first = openings.front().opening;
    const Opening& last = openings.back().opening;
    const auto frames = static_cast<std::uint64_t>(last.release.ns / kFrame.ns) + 1U;
    SystemLog log;
    log.ran.resize(frames * kWindowCount);
    log.receptions.reserve(frames);
    SystemLog* const before = system_log;
    system_log = &log;
    std::array<Duration, 1U> durations{1_us};
    ports::virtual_time::IndexedVirtualHost host{durations};
    ports::virtual_time::SimulatedCore core{executive, host};
    NoDevices devices;
    ports::virtual_time::FrameRunner runner{{&core, 1U}, devices};
    for (std::uint64_t frame = 0U; frame < frames; ++frame) {
        runner.run_frame();
    }
    system_log = before;
    std::vector<Opening> expected;
    expected.reserve(log.ran.size());
    for (const Opening& opening : log.take_ran()) {
        if (opening.release >= first.release && opening.release <= last.release) {
            expected.push_back(opening);
        }
    }
    return expected;
}

}  // namespace

std::vector<Fault> make_plan(const CampaignRequest& request) {
    std::mt19937_64 random{request.seed};
    std::vector<Fault> plan;
    std::array<Kind, kKindCount> kinds{Kind::kKill, Kind::kStop, Kind::kFlood, Kind::kCorrupt};
    for (std::uint64_t i = 0U; i < request.fault_count; ++i) {
        if (i % kKindCount == 0U) {
            // std::shuffle gives a different order with each library.
            for (std::size_t k = kKindCount - 1U; k > 0U; --k) {
                std::swap(kinds[k], kinds[random() % (k + 1U)]);
            }
        }
        Fault fault{kinds[i % kKindCount], {}, {}};
        fault.wait = 20_ms + Duration{static_cast<std::int64_t>(random() % 100'000'000U)};
        fault.hold = Duration{static_cast<std::int64_t>(random() % 30'000'000U)};
        plan.push_back(fault);
    }
    return plan;
}

Course run(const CampaignRequest& request) {
    // Work that hangs beyond the end of the run may still use these.
    static const FrameClock clock = FrameClock::starting_in(200_ms);
    static const int processor = find_processor();
    static GuardedHost host{window_threads, clock, {kWindowPriority, processor}};
    static SystemLog log;
    static Link link;
    const std::size_t frames = request.fault_count * kFramesPerFault + kFramesBeside;
    log.ran.resize(frames * kWindowCount);
    log.receptions.reserve(frames);
    log.reactions.reserve(frames);
    log.clock = &clock;
    log.defect = request.defect;
    system_log = &log;
    OpeningLog openings{clock, frames * kWindowCount, request.defect};
    static_cast<void>(lock_memory(256U * 1024U));
    if (!link.open() || host.open(kRunnerPriority) != Status::kOk || executive.initialize() != Status::kOk ||
        executive.start() != Status::kOk) {
        Course course;
        course.trouble = "the safety system does not start";
        return course;
    }
    CoreRunner runner{executive, host, clock};
    runner.set_observer(&openings);
    const AwakeProcessor awake{processor};
    OccupancyWatch occupancy{clock, processor};
    StallWatch stalls{clock,
                      Duration{kFrame.ns / std::int64_t{kPollsPerFrame}},
                      {kWatchPriority, processor},
                      frames * kPollsPerFrame};  // all must be recorded: they are host causes
    Right right{};
    std::thread thread{[&runner, &right] {
        right =
            combine(set_priority(pthread_self(), kRunnerPriority), set_processor(pthread_self(), processor));
        runner.run_until_stopped();
    }};
    // After this instant, the longest fault and its starts must still fit into the logs.
    const Instant last{static_cast<std::int64_t>(frames) * kFrame.ns - 2 * kPatience.ns};
    Director director{request, clock, link, last};
    const char* const trouble = director.carry_out(make_plan(request));
    runner.request_stop();
    thread.join();
    stalls.stop();
    occupancy.stop();
    const bool is_closed = host.close() == Status::kOk;
    Course course;
    course.ran = log.take_ran();
    course.openings = std::move(openings.openings);
    course.receptions = std::move(log.receptions);
    course.reactions = std::move(log.reactions);
    course.injections = director.get_injections();
    course.stalls = stalls.get_stalls();
    course.late_polls = stalls.get_late_polls();
    course.knows_foreign = occupancy.knows();
    course.foreign = occupancy.get_foreign();
    course.expected = run_in_virtual_time(course.openings);
    course.host = stalls.get_figures();
    course.is_too_slow = trouble == kTooSlow || trouble == kNoTime;
    course.trouble = is_closed ? trouble : "work of a safety window hangs";
    course.has_priority =
        combine(right, combine(host.get_priority_right(), host.get_processor_right())).is_granted;
    return course;
}

}  // namespace mamori::partition_faults
