// SPDX-License-Identifier: Apache-2.0
#include "victims.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <ctime>

namespace mamori::time_faults {
namespace {

using namespace literals;  // NOLINT: units of the table below

Victim alpha{"alpha", 0U};
Victim beta{"beta", 1U};
Victim gamma{"gamma", 2U};
Victim delta{"delta", 3U};
constexpr auto kSystem =
    system(frame(kTick), window("first", 0_us, 300_us, budget(kBudget), mamori::run(alpha)),
           window("second", 300_us, 300_us, budget(kBudget), mamori::run(beta, gamma)),
           window("third", 600_us, 300_us, budget(kBudget), mamori::run(delta)));
MAMORI_CHECK(kSystem);
ExecutiveFor executive{kSystem};
IntrospectionFor introspection{kSystem};
std::array<Victim*, kComponentCount> victims{&alpha, &beta, &gamma, &delta};

/// Of the calling thread.
struct ThreadTimes {
    Duration processor{};
    std::int64_t voluntary_switches{0};
};

ThreadTimes read_thread_times() noexcept {
    constexpr std::int64_t kSecond = 1'000'000'000;
    timespec time{};
    rusage usage{};
    static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time));
    static_cast<void>(getrusage(RUSAGE_THREAD, &usage));
    return {Duration{time.tv_sec * kSecond + time.tv_nsec}, usage.ru_nvcsw};
}

}  // namespace

Surroundings& get_surroundings() noexcept {
    static Surroundings surroundings;
    return surroundings;
}

Victim& get_victim(std::size_t component) noexcept {
    return *victims[component];
}

Executive& get_executive() noexcept {
    return executive;
}

Introspection& get_introspection() noexcept {
    return introspection;
}

Status Victim::on_execute(ContextHandle handle) noexcept {
    meter_.look();
    const Surroundings& around = get_surroundings();
    const ThreadTimes before = read_thread_times();
    const Instant begin = around.clock->get_now();
    work_too_long();
    do_as_told();
    const Instant end = around.clock->get_now();
    const ThreadTimes after = read_thread_times();
    // A component that waits or computes itself causes the delay; a guard that demotes it delays it later.
    const Duration delay = delay_meter_.take();
    const Duration used = after.processor - before.processor;
    const bool is_own = after.voluntary_switches != before.voluntary_switches || used >= kLossMin;
    around.delays->set(place_, handle.now, is_own ? Duration{0} : std::max(end - begin - used, delay));
    return Status::kOk;
}

void Victim::work_too_long() noexcept {
    const Surroundings& around = get_surroundings();
    ++cycle_;
    if (around.defect != Defect::kOverrun || cycle_ % kDefectEvery != place_) {
        return;
    }
    const Instant end = around.clock->get_now() + kBudget + kBudget;
    while (around.clock->get_now() < end) {
    }
}

void Victim::do_as_told() noexcept {
    const std::int64_t size = size_ns_.exchange(0, std::memory_order_acquire);
    if (size == 0) {
        return;
    }
    Surroundings& around = get_surroundings();
    const Instant begin = around.clock->get_now();
    OpenOverrun& overrun = (*around.overruns)[around.overrun_count.fetch_add(1U, std::memory_order_relaxed)];
    overrun.component = place_;
    overrun.begin = begin;
    overrun.cause = cause_;
    if (way_ == Way::kLock) {
        const std::lock_guard<std::mutex> lock{*around.mutex};
    } else {
        const Instant end = begin + Duration{size};
        if (way_ == Way::kSleep) {
            around.clock->wait_until(end);
        }
        while (around.clock->get_now() < end) {
        }
    }
    overrun.end_ns.store(around.clock->get_now().ns, std::memory_order_release);
}

}  // namespace mamori::time_faults
