// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/frame_clock.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

constexpr std::int64_t not_before_zero(std::int64_t ns) noexcept {
    return ns > 0 ? ns : 0;
}

}  // namespace

FrameClock FrameClock::starting_in(Duration lead, const TimeSource& source) noexcept {
    MAMORI_REQUIRE(2, lead >= Duration{0});
    return FrameClock{source, add_saturating(Instant{source.read_ns()}, lead).ns};
}

Instant FrameClock::get_now() const noexcept {
    return Instant{source_->read_ns() - epoch_ns_};
}

timespec FrameClock::to_timespec(Instant instant) const noexcept {
    const std::int64_t at =
        not_before_zero(source_->to_monotonic(add_saturating(instant, Duration{epoch_ns_}).ns));
    timespec result{};
    result.tv_sec = static_cast<time_t>(at / kSecond);
    result.tv_nsec = static_cast<long>(at % kSecond);
    return result;
}

void FrameClock::wait_until(Instant instant) const noexcept {
    // A sleep until an instant that has passed takes about 20 us. A late runner would lose this time for each
    // window.
    if (get_now() < instant) {
        source_->wait_until(add_saturating(instant, Duration{epoch_ns_}).ns);
    }
}

}  // namespace mamori::ports::posix_rt
