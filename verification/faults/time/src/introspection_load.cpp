// SPDX-License-Identifier: Apache-2.0
#include "introspection_load.hpp"

#include <array>

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::time_faults {
namespace {

constexpr std::uint64_t kBurst = 100U;

}  // namespace

IntrospectionLoad::IntrospectionLoad(const Introspection& shown) : shown_(shown) {
    thread_ = std::thread{[this] { serve(); }};
}

IntrospectionLoad::~IntrospectionLoad() {
    is_ending_.store(true, std::memory_order_relaxed);
    thread_.join();
}

void IntrospectionLoad::bind(int processor) noexcept {
    static_cast<void>(ports::posix_rt::set_processor(thread_.native_handle(), processor));
}

void IntrospectionLoad::serve() noexcept {
    const auto clock = ports::posix_rt::FrameClock::starting_in(Duration{0});
    Instant next{};
    for (std::uint64_t millisecond = 0U; !is_ending_.load(std::memory_order_relaxed); ++millisecond) {
        const Pace pace = pace_.load(std::memory_order_relaxed);
        while (pace_.load(std::memory_order_relaxed) == Pace::kWithoutPause) {
            request(1U);
        }
        if (pace == Pace::kSteady) {
            request(1U);
        } else if (pace == Pace::kBurst && millisecond % kBurst == 0U) {
            request(kBurst);
        }
        next = next + Duration{1'000'000};
        clock.wait_until(next);
    }
}

void IntrospectionLoad::request(std::uint64_t count) noexcept {
    std::uint64_t row_count = 0U;
    const auto look = [&row_count](std::size_t, const auto&) noexcept { ++row_count; };
    is_requesting_.store(true, std::memory_order_relaxed);
    for (std::uint64_t i = 0U; i < count; ++i) {
        CoreSnapshot core{};
        row_count += shown_.read_core(0U, core) == Status::kOk ? 1U : 0U;
        shown_.for_each_window(look);
        shown_.for_each_component(look);
        shown_.for_each_port(look);
    }
    is_requesting_.store(false, std::memory_order_relaxed);
    // A request that saw nothing is none.
    request_count_.fetch_add(row_count > 0U ? count : 0U, std::memory_order_relaxed);
}

std::vector<LoadRound> run_load_rounds(Grid& grid, IntrospectionLoad& load, std::uint64_t round_count,
                                       std::uint64_t frame_count) {
    constexpr std::array<Pace, 3U> kPaces{Pace::kNone, Pace::kSteady, Pace::kBurst};
    constexpr std::array<std::int64_t LoadRound::*, 3U> kTimes{&LoadRound::calm_ns, &LoadRound::steady_ns,
                                                               &LoadRound::burst_ns};
    std::vector<LoadRound> rounds;
    static_cast<void>(grid.run(frame_count));  // pages, caches and clocks of the processor settle
    for (std::uint64_t number = 0U; number < round_count; ++number) {
        LoadRound round;
        for (std::size_t turn = 0U; turn < kPaces.size(); ++turn) {
            const std::size_t next = (turn + number) % kPaces.size();
            load.set_pace(kPaces[next]);
            round.*kTimes[next] = calc_median_start(grid.run(frame_count));
        }
        rounds.push_back(round);
    }
    load.set_pace(Pace::kNone);
    return rounds;
}

}  // namespace mamori::time_faults
