// SPDX-License-Identifier: Apache-2.0
#include "faulty_time.hpp"

#include "mamori/kernel/base/assert.hpp"

namespace mamori::time_faults {
namespace {

constexpr std::int64_t kMillion = 1'000'000;

}  // namespace

FaultyTime::FaultyTime(std::size_t change_max) : pieces_(change_max + 1U) {}

std::int64_t FaultyTime::read_ns() const noexcept {
    const Piece& piece = get_piece();
    const std::int64_t since = ports::posix_rt::get_monotonic_clock().read_ns() - piece.real_ns;
    return piece.shown_ns + since + (piece.ppm == 0 ? 0 : since * piece.ppm / kMillion);
}

std::int64_t FaultyTime::to_real(std::int64_t ns) const noexcept {
    const Piece& piece = get_piece();
    const std::int64_t since = ns - piece.shown_ns;
    return piece.real_ns + (piece.ppm == 0 ? since : since * kMillion / (kMillion + piece.ppm) + 1);
}

void FaultyTime::wait_until(std::int64_t ns) const noexcept {
    const std::int64_t hold = is_victim() ? sleep_hold_ns_.exchange(0, std::memory_order_relaxed) : 0;
    // Repeats the wait if the rate changed meanwhile.
    while (read_ns() < ns + hold) {
        ports::posix_rt::get_monotonic_clock().wait_until(to_real(ns + hold));
    }
}

std::int64_t FaultyTime::to_monotonic(std::int64_t ns) const noexcept {
    const std::int64_t hold = is_victim() ? deadline_hold_ns_.exchange(0, std::memory_order_relaxed) : 0;
    return to_real(ns + hold);
}

void FaultyTime::set_rate(std::int64_t ppm) noexcept {
    const std::size_t last = last_.load(std::memory_order_relaxed);
    MAMORI_REQUIRE(1, last + 1U < pieces_.size() && ppm > -kMillion);
    const Piece& piece = pieces_[last];
    const std::int64_t real = ports::posix_rt::get_monotonic_clock().read_ns();
    const std::int64_t since = real - piece.real_ns;
    const std::int64_t shown = piece.shown_ns + since + (piece.ppm == 0 ? 0 : since * piece.ppm / kMillion);
    pieces_[last + 1U] = {real, shown, ppm};
    last_.store(last + 1U, std::memory_order_release);
}

}  // namespace mamori::time_faults
