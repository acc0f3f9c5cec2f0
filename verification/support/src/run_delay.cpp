// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/run_delay.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>

namespace mamori::verification {
namespace {

/// The second number in the file; -1 if there is none.
std::int64_t read_delay_ns(int descriptor) noexcept {
    std::array<char, 96U> text{};
    const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
    const char* const end = text.data() + (size > 0 ? size : 0);
    std::int64_t number = 0;
    const std::from_chars_result first = std::from_chars(text.data(), end, number);
    if (first.ec != std::errc{} || first.ptr == end) {
        return -1;
    }
    const std::from_chars_result second = std::from_chars(first.ptr + 1, end, number);
    return second.ec == std::errc{} ? number : -1;
}

}  // namespace

Duration RunDelayMeter::take() noexcept {
    const bool is_first = !is_open_;
    if (is_first) {
        is_open_ = true;
        descriptor_ = ::open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC);
    }
    const std::int64_t now_ns = descriptor_ < 0 ? -1 : read_delay_ns(descriptor_);
    if (now_ns < 0) {
        return Duration{0};
    }
    const Duration delay{is_first ? 0 : now_ns - last_ns_};
    last_ns_ = now_ns;
    return delay;
}

}  // namespace mamori::verification
