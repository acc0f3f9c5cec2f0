// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/introspection_load.hpp"

#include "mamori/ports/posix_rt/frame_clock.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::timing {
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
    const auto count_row = [&row_count](std::size_t, const auto&) noexcept { ++row_count; };
    is_requesting_.store(true, std::memory_order_relaxed);
    for (std::uint64_t i = 0U; i < count; ++i) {
        CoreSnapshot row{};
        // There is at most one core per window.
        for (std::size_t core = 0U; core < shown_.get_window_count(); ++core) {
            row_count += shown_.read_core(core, row) == Status::kOk ? 1U : 0U;
        }
        shown_.for_each_window(count_row);
        shown_.for_each_component(count_row);
        shown_.for_each_port(count_row);
    }
    is_requesting_.store(false, std::memory_order_relaxed);
    request_count_.fetch_add(row_count > 0U ? count : 0U, std::memory_order_relaxed);
}

}  // namespace mamori::timing
