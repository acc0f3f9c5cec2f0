// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/provisions.hpp"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cfenv>
#include <cstring>
#include <limits>

#include "mamori/safety/base/opaque.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr Status to_status(bool is_in_effect) noexcept {
    return is_in_effect ? Status::kOk : Status::kPreconditionNotMet;
}

/// Content of a file of /proc with a terminating zero.
using Page = std::array<char, 4096U>;

/// @return the number after `name` at the start of a line [KiB]; kUnsupported (not found).
Result<std::uint64_t> find_figure(const Page& page, const char* name) noexcept {
    const char* next = std::strstr(page.data(), name);
    if (next == nullptr) {
        return Status::kUnsupported;
    }
    next += std::strlen(name);
    next += std::strspn(next, " \t");
    std::uint64_t figure = 0U;
    std::size_t digits = 0U;
    // Larger numbers would overflow and are invalid.
    while (*next >= '0' && *next <= '9' && digits < 18U) {
        figure = figure * 10U + static_cast<std::uint64_t>(*next - '0');
        ++next;
        ++digits;
    }
    return digits == 0U ? Result<std::uint64_t>{Status::kUnsupported} : Result<std::uint64_t>{figure};
}

Status check_memory(const Page& page, std::uint64_t unlockable) noexcept {
    const Result<std::uint64_t> mapped = find_figure(page, "\nVmSize:");
    const Result<std::uint64_t> locked = find_figure(page, "\nVmLck:");
    const Result<std::uint64_t> swapped = find_figure(page, "\nVmSwap:");
    if (!mapped.has_value() || !locked.has_value() || !swapped.has_value()) {
        return Status::kUnsupported;
    }
    return to_status(swapped.get_value() == 0U &&
                     mapped.get_value() <= locked.get_value() + unlockable / 1024U);
}

/// @return fixed priority of a thread, 0 without one; kPreconditionNotMet (the thread has ended);
///         kUnsupported (the system denies the query).
Result<int> read_priority(pid_t thread) noexcept {
    sched_param parameters{};
    if (::sched_getparam(thread, &parameters) != 0) {
        return errno == ESRCH ? Status::kPreconditionNotMet : Status::kUnsupported;
    }
    return parameters.sched_priority;  // 0 for each policy without a fixed priority
}

}  // namespace

MemoryLocked::~MemoryLocked() {
    if (file_ >= 0) {
        static_cast<void>(::close(file_));
    }
}

Status MemoryLocked::open() noexcept {
    if (file_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    file_ = ::open("/proc/self/status", O_RDONLY | O_CLOEXEC);
    return file_ >= 0 ? Status::kOk : Status::kUnsupported;
}

Status MemoryLocked::look() noexcept {
    // Other threads can map and unmap memory while Linux generates the figures, so a difference is checked
    // again.
    constexpr int kLooks = 3;
    Status status = Status::kUnsupported;
    for (int look = 0; look < kLooks && status != Status::kOk; ++look) {
        Page page{};
        const bool is_read = ::pread(file_, page.data(), page.size() - 1U, 0) > 0;
        status = is_read ? check_memory(page, unlockable_) : Status::kUnsupported;
    }
    return status;
}

Status PreciseTimers::look() noexcept {
    timespec resolution{};
    if (::clock_getres(clock_, &resolution) != 0) {
        return Status::kUnsupported;
    }
    return to_status(resolution.tv_sec == 0 && resolution.tv_nsec <= 1000);
}

Status FloatingPointMode::look() noexcept {
    using Limits = std::numeric_limits<double>;
    // Denormal results are not flushed to zero, and denormal operands are not treated as zero.
    const bool keeps_results = safety::hide(Limits::min()) * safety::hide(0.5) != 0.0;
    const bool keeps_operands = safety::hide(Limits::denorm_min()) * safety::hide(0x1p60) != 0.0;
    return to_status(keeps_results && keeps_operands && std::fegetround() == FE_TONEAREST);
}

void GuardAbove::set_guard() noexcept {
    guard_.store(::gettid(), std::memory_order_release);
}

Status GuardAbove::look() noexcept {
    const pid_t thread = guard_.load(std::memory_order_acquire);
    if (thread == 0) {
        return Status::kPreconditionNotMet;
    }
    const Result<int> guard = read_priority(thread);
    const Result<int> own = read_priority(0);
    if (!guard.has_value() || !own.has_value()) {
        return guard.has_value() ? own.get_status() : guard.get_status();
    }
    return to_status(guard.get_value() > own.get_value());
}

Status SoftwareWatchdogArmed::look() noexcept {
    return to_status(watchdog_.is_watching());
}

Status DeviceWatchdogArmed::look() noexcept {
    const Result<Duration> left = device_.read_time_left();
    if (left.get_status() == Status::kUnsupported) {
        return Status::kUnsupported;
    }
    return to_status(left.has_value() && left.get_value() > Duration{0});
}

}  // namespace mamori::ports::posix_rt
