// SPDX-License-Identifier: Apache-2.0
#include "two_nodes.hpp"

#include <algorithm>
#include <deque>
#include <new>
#include <random>
#include <stdexcept>

#include "mamori/kernel/run/executives.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/virtual_time/frame_runner.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"
#include "mamori/safety/notice/node_monitor.hpp"
#include "mamori/safety/notice/survival_notifier.hpp"

namespace mamori::verification::notice {
namespace {

using namespace mamori::literals;  // NOLINT: units of the tables
using namespace mamori::safety;    // NOLINT: the subject
using ports::virtual_time::FrameRunner;
using ports::virtual_time::kNever;
using ports::virtual_time::SimulatedCore;
using ports::virtual_time::VirtualHostFor;

// ---- The sending node: a notice in every fifth major frame

constexpr NoticeNode kArm{0xA4A10001U, 1_ms, 5U,
                          std::array{"reader", "guard", "planner", "supervisor", "notifier"}};
using Notice = NoticeFor<kArm>;

class Worker final : public Component {
  public:
    constexpr explicit Worker(const char* name) noexcept : Component(name) {}
    Status on_execute(ContextHandle) noexcept override { return has_failed ? Status::kError : Status::kOk; }
    bool has_failed{false};
};

extern ExecutionSupervisor g_supervision;

Status supervise_all(ExecutionSupervisor& supervision, ContextHandle context) noexcept {
    static_cast<void>(supervision.step(context.now));
    return Status::kOk;
}

Worker g_reader{"reader"};
Worker g_guard{"guard"};
Worker g_planner{"planner"};
SystemFunction<&supervise_all> g_supervisor{"supervisor", g_supervision};
SurvivalNotifier<kArm> g_notifier{"notifier", g_supervision};
constexpr auto kArmSystem = system(frame(1_ms), window("read", 0_us, 100_us, budget(50_us), run(g_reader)),
                                   window("guard", 100_us, 100_us, budget(50_us), run(g_guard)),
                                   window("plan", 200_us, 100_us, budget(50_us), run(g_planner)),
                                   system_window("supervise", 300_us, 50_us, budget(50_us), g_supervisor),
                                   window("notify", 350_us, 50_us, budget(50_us), run(g_notifier)));
MAMORI_CHECK(kArmSystem);
ExecutionStorageFor<kArmSystem> g_storage;
ExecutionSupervisor g_supervision{g_storage, 10_us};
constexpr ComponentLimits kOften{{5U, 10U}, {0_us, 50_us}, SupervisionScope::kLocal};
constexpr std::array kWatched = {watch(g_guard, kOften)};

// ---- The supervising node, in every second millisecond

constexpr NoticeLimits kLimits{6_ms, 2U, 3U, 40U};

/// End of a transport.
class Link final : public Component {
  public:
    constexpr Link() noexcept : Component("link") {}
    OutPort<Notice::Frame> out{*this, "out"};
    using Ports = mamori::Ports<&Link::out>;
    Status on_execute(ContextHandle) noexcept override {
        if (has_message) {
            out.write(message);
            has_message = false;
        }
        return Status::kOk;
    }
    Notice::Frame message{};
    bool has_message{false};
};

Link g_link;
NodeMonitor<kArm, kLimits> g_monitor{"arm"};
constexpr auto kBaseSystem =
    system(frame(2_ms), window("receive", 0_us, 1000_us, budget(500_us), run(g_link, g_monitor)),
           connect(g_link.out, g_monitor.notice, any_age()));
MAMORI_CHECK(kBaseSystem);

template <const auto& kTable>
class Node final {
  public:
    Node() { start(); }
    void start() {
        if (executive.initialize() != Status::kOk || executive.start() != Status::kOk) {
            throw std::runtime_error("a node does not start");
        }
    }
    void end() {
        if (executive.stop() != Status::kOk || executive.finalize() != Status::kOk) {
            throw std::runtime_error("a node does not stop");
        }
    }
    void run_frame() { runner_.run_frame(); }

    ExecutiveFor<std::remove_const_t<std::remove_reference_t<decltype(kTable)>>> executive{kChecked<kTable>};
    VirtualHostFor<std::remove_const_t<std::remove_reference_t<decltype(kTable)>>> host{kTable};

  private:
    SimulatedCore core_{executive, host};
    NoDevices devices_{};
    FrameRunner runner_{{&core_, 1U}, devices_};
};

// ---- The channel: delays up to 3 ms, loses no two messages in a row

class Channel final {
  public:
    explicit Channel(std::mt19937& random) : random_(random) {}

    void send(const Notice::Frame& message, std::int64_t now_ns, Outcome& outcome) {
        ++outcome.sent;
        if (is_cut) {
            return;
        }
        was_lost_ = !was_lost_ && random_() % 8U == 0U;
        if (was_lost_) {
            ++outcome.lost;
            return;
        }
        waiting_.push_back({now_ns + static_cast<std::int64_t>(random_() % 3'000'001U), message});
    }
    void deliver(std::int64_t now_ns) {
        while (!waiting_.empty() && waiting_.front().at_ns <= now_ns) {
            g_link.message = waiting_.front().message;
            g_link.has_message = true;
            waiting_.pop_front();
        }
    }
    bool is_cut{false};

  private:
    struct Waiting {
        std::int64_t at_ns;
        Notice::Frame message;
    };
    std::mt19937& random_;
    std::deque<Waiting> waiting_;
    bool was_lost_{false};
};

constexpr std::uint32_t make_mask() {
    return 0U;
}
template <typename... Faults>
constexpr std::uint32_t make_mask(NoticeFault fault, Faults... faults) {
    return (1U << static_cast<std::uint32_t>(fault)) | make_mask(faults...);
}

/// Faults that may be reported after an injection, and those of which one must be.
constexpr std::uint32_t get_permitted(Injection injection) {
    switch (injection) {
        case Injection::kKill:
        case Injection::kFreeze:
        case Injection::kCut:
            return make_mask(NoticeFault::kLate, NoticeFault::kSilent, NoticeFault::kOutOfOrder);
        case Injection::kHang:
            return make_mask(NoticeFault::kComponentExpired);
        case Injection::kError:
            return make_mask(NoticeFault::kComponentError);
        case Injection::kExit:
            return make_mask(NoticeFault::kComponentMissing);
        case Injection::kStateChange:
            return 0U;
    }
    throw std::runtime_error("unknown injection");
}
constexpr std::uint16_t get_component(Injection injection) {
    return injection == Injection::kError  ? 0U
           : injection == Injection::kHang ? 1U
           : injection == Injection::kExit ? 2U
                                           : kNoNoticeComponent;
}
constexpr bool is_silence(Injection injection) {
    return injection <= Injection::kCut;
}

/// Both nodes, their channel, and the injection that is in progress.
class Bench final {
  public:
    explicit Bench(std::uint32_t seed) : random_(seed), channel_(random_) {
        static_cast<void>(g_supervision.watch(kWatched));  // done by an earlier run
        arm_.executive.set_observer(&g_supervision);
    }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    Outcome run(std::uint64_t frames, std::uint32_t injections) {
        const std::uint64_t spacing = injections == 0U ? 0U : frames / injections;
        std::uint64_t next = calc_next(0U, spacing);
        std::uint32_t injected = 0U;
        for (; outcome_.frames < frames; ++outcome_.frames) {
            if (injected < injections && outcome_.frames == next) {
                inject(static_cast<Injection>(random_() % kInjectionCount));
                ++injected;
                next = calc_next(injected, spacing);
            }
            run_frame();
        }
        recover();
        arm_.end();
        base_.end();
        return outcome_;
    }

  private:
    /// A frame in the second half of the part of the run that belongs to an injection.
    std::uint64_t calc_next(std::uint32_t number, std::uint64_t spacing) {
        return number * spacing + spacing / 2U + random_() % (spacing / 4U + 1U);
    }

    void run_frame() {
        if (!is_stopped_) {
            const std::uint64_t before = g_notifier.notice.get_sequence();
            arm_.run_frame();
            if (g_notifier.notice.get_sequence() != before) {
                channel_.send(g_notifier.notice.get_published(), now_ns_ + 400'000, outcome_);
            }
        }
        now_ns_ += 1'000'000;
        if (now_ns_ % 2'000'000 == 0) {
            channel_.deliver(now_ns_);
            base_.run_frame();
            judge();
        }
    }

    void inject(Injection injection) {
        injection_ = injection;
        injected_at_ns_ = now_ns_;
        phase_ = Phase::kAwaited;
        ++outcome_.injected[static_cast<std::size_t>(injection)];
        ExecutionContext& plan = arm_.executive.get_context(2U);
        switch (injection) {
            case Injection::kKill:
            case Injection::kFreeze:
                is_stopped_ = true;
                return;
            case Injection::kCut:
                channel_.is_cut = true;
                return;
            case Injection::kHang:
                require(arm_.host.set_duration(g_guard, kNever));
                return;
            case Injection::kError:
                g_reader.has_failed = true;
                return;
            case Injection::kExit:
                require(g_planner.exit(Instant{now_ns_}));
                return;
            case Injection::kStateChange:
                require(plan.deactivate_component(g_planner, Instant{now_ns_}));
                return;
        }
    }

    /// Ends the cause of an injection.
    void recover() {
        ExecutionContext& plan = arm_.executive.get_context(2U);
        ExecutionContext& read = arm_.executive.get_context(0U);
        is_stopped_ = false;
        channel_.is_cut = false;
        g_reader.has_failed = false;
        require(arm_.host.set_duration(g_guard, Duration{0}));
        static_cast<void>(g_supervision.acknowledge(g_guard));
        if (injection_ == Injection::kKill && phase_ != Phase::kIdle) {
            arm_.end();
            new (&g_notifier) SurvivalNotifier<kArm>{"notifier", g_supervision};
            arm_.start();
        } else if (injection_ == Injection::kError && phase_ != Phase::kIdle) {
            static_cast<void>(read.reset_component(g_reader, Instant{now_ns_}));
            static_cast<void>(read.activate_component(g_reader, Instant{now_ns_}));
        } else if (injection_ == Injection::kExit && phase_ != Phase::kIdle) {
            static_cast<void>(g_planner.initialize());
            static_cast<void>(plan.activate_component(g_planner, Instant{now_ns_}));
        }
    }

    void judge() {
        const NodeStatus& status = g_monitor.get_status();
        const std::uint32_t permitted =
            phase_ == Phase::kIdle || phase_ == Phase::kStarting ? 0U : get_permitted(injection_);
        if ((status.faults & ~permitted) != 0U) {
            ++outcome_.invented;
            g_monitor.acknowledge(Instant{now_ns_});
            phase_ = Phase::kStarting;
            return;
        }
        switch (phase_) {
            case Phase::kStarting:
                phase_ = status.is_proven ? Phase::kIdle : Phase::kStarting;
                return;
            case Phase::kIdle:
                outcome_.invented += status.is_proven ? 0U : 1U;
                return;
            case Phase::kAwaited:
                await(status);
                return;
            case Phase::kBack:
                await_back();
                return;
        }
    }

    void await(const NodeStatus& status) {
        const bool is_seen =
            injection_ == Injection::kStateChange
                ? g_monitor.get_report(2U).state == LifecycleState::kInactive && status.is_proven
                : status.faults != 0U && !status.is_proven && status.component == get_component(injection_);
        if (!check_bound(is_seen)) {
            return;
        }
        if (injection_ == Injection::kStateChange) {
            require(arm_.executive.get_context(2U).activate_component(g_planner, Instant{now_ns_}));
            injected_at_ns_ = now_ns_;
            phase_ = Phase::kBack;
            return;
        }
        recover();
        // A person waits until the fault has gone, here for a time that covers a notice that is still under
        // way.
        phase_ = Phase::kBack;
        injected_at_ns_ = now_ns_;
    }

    void await_back() {
        if (injection_ == Injection::kStateChange) {
            if (check_bound(g_monitor.get_report(2U).state == LifecycleState::kActive)) {
                phase_ = Phase::kIdle;
            }
        } else if (now_ns_ - injected_at_ns_ >= 40'000'000) {
            g_monitor.acknowledge(Instant{now_ns_});
            phase_ = Phase::kStarting;
        }
    }

    /// @return true when the wait has ended; a report that has not come within the bound is missed.
    bool check_bound(bool is_seen) {
        const std::int64_t delay_ns = now_ns_ - injected_at_ns_;
        const std::int64_t bound_ns = is_silence(injection_) ? kSilenceBoundNs : kChangeBoundNs;
        if (delay_ns > bound_ns) {
            ++outcome_.missed;
            return true;
        }
        if (is_seen) {
            std::int64_t& longest = outcome_.delay_max_ns[static_cast<std::size_t>(injection_)];
            longest = std::max(longest, delay_ns);
        }
        return is_seen;
    }

    static void require(Status status) {
        if (status != Status::kOk) {
            throw std::runtime_error("an injection was rejected");
        }
    }

    enum class Phase : std::uint8_t { kStarting, kIdle, kAwaited, kBack };

    std::mt19937 random_;
    Channel channel_;
    Node<kArmSystem> arm_;
    Node<kBaseSystem> base_;
    Outcome outcome_{};
    std::int64_t now_ns_{0};
    std::int64_t injected_at_ns_{0};
    Injection injection_{Injection::kKill};
    Phase phase_{Phase::kStarting};
    bool is_stopped_{false};
};

}  // namespace

Outcome run_two_nodes(std::uint64_t frames, std::uint32_t injections, std::uint32_t seed) {
    Bench bench{seed};
    return bench.run(frames, injections);
}

}  // namespace mamori::verification::notice
