// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/frame_clock.hpp"

#include <cerrno>

#include "mamori/kernel/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

std::int64_t read_monotonic() noexcept {
    timespec now{};
    // It cannot fail with a clock that every Linux has and a valid address.
    MAMORI_ENSURE(1, clock_gettime(CLOCK_MONOTONIC, &now) == 0);
    return static_cast<std::int64_t>(now.tv_sec) * kSecond + now.tv_nsec;
}

}  // namespace

FrameClock FrameClock::starting_in(Duration lead) noexcept {
    MAMORI_REQUIRE(2, lead >= Duration{0});
    return FrameClock{read_monotonic() + lead.ns};
}

Instant FrameClock::get_now() const noexcept {
    return Instant{read_monotonic() - epoch_ns_};
}

timespec FrameClock::to_timespec(Instant instant) const noexcept {
    const std::int64_t at = instant.ns + epoch_ns_;
    const std::int64_t since_zero = at > 0 ? at : 0;
    timespec result{};
    result.tv_sec = static_cast<time_t>(since_zero / kSecond);
    result.tv_nsec = static_cast<long>(since_zero % kSecond);
    return result;
}

void FrameClock::wait_until(Instant instant) const noexcept {
    // A sleep until an instant that has passed takes some 20 us all the same: a runner that catches up has
    // many.
    if (get_now() >= instant) {
        return;
    }
    const timespec at = to_timespec(instant);
    int result = EINTR;
    while (result == EINTR) {
        result = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
    }
    MAMORI_ENSURE(3, result == 0);
}

}  // namespace mamori::ports::posix_rt
