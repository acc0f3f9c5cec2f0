// SPDX-License-Identifier: Apache-2.0
/// @file
/// A process that causes page faults as fast as possible, and a meter of their effect on a thread.
#ifndef MAMORI_TIME_FAULTS_PAGE_STORM_HPP
#define MAMORI_TIME_FAULTS_PAGE_STORM_HPP

#include <sys/types.h>

#include <atomic>
#include <cstdint>

namespace mamori::time_faults {

/// Repeatedly maps, touches and unmaps 64 MiB, in its own process without priority.
class PageStorm final {
  public:
    /// Starts the process. It ends with its parent, or after `seconds` (0: no process) at the latest. Create
    /// this object while the caller has one thread.
    explicit PageStorm(unsigned seconds) noexcept;
    PageStorm(const PageStorm&) = delete;
    PageStorm& operator=(const PageStorm&) = delete;
    /// Ends the process.
    ~PageStorm() { stop(); }

    bool is_under_way() const noexcept { return process_ > 0; }
    /// @return whether the process has caused page faults until now.
    bool stop() noexcept;

  private:
    pid_t process_{-1};
};

/// @return whether the memory of this process is locked: with sanitizers, mlockall() has no effect.
bool has_locked_pages();

/// Page faults of the thread that calls look(), since its first call.
///
/// Thread safety: look() from one thread, other functions from any thread.
class PageMeter final {
  public:
    void look() noexcept;
    std::int64_t get_major() const noexcept { return major_.load(std::memory_order_relaxed); }
    std::int64_t get_minor() const noexcept { return minor_.load(std::memory_order_relaxed); }

  private:
    std::int64_t first_major_{-1};
    std::int64_t first_minor_{0};
    std::atomic<std::int64_t> major_{0};
    std::atomic<std::int64_t> minor_{0};
};

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_PAGE_STORM_HPP
