// SPDX-License-Identifier: Apache-2.0
/// @file
/// A process that faults pages as fast as it can, and a meter of what that does to a thread.
#ifndef MAMORI_TIME_FAULTS_PAGE_STORM_HPP
#define MAMORI_TIME_FAULTS_PAGE_STORM_HPP

#include <sys/types.h>

#include <atomic>
#include <cstdint>

namespace mamori::time_faults {

/// Repeatedly maps, touches and unmaps 64 MiB, in its own process without a priority.
class PageStorm final {
  public:
    /// Starts the process, which ends with its parent or after `seconds` at the latest; 0: none. Create
    /// it while the caller has one thread.
    explicit PageStorm(unsigned seconds) noexcept;
    PageStorm(const PageStorm&) = delete;
    PageStorm& operator=(const PageStorm&) = delete;
    /// Ends it.
    ~PageStorm() { stop(); }

    bool is_under_way() const noexcept { return process_ > 0; }
    /// @return whether it faulted pages until now.
    bool stop() noexcept;

  private:
    pid_t process_{-1};
};

/// @return whether memory of this process is locked: with the sanitizers mlockall() does nothing.
bool has_locked_pages();

/// Page faults of the thread that calls look(), since its first call.
///
/// Thread safety: look() by one thread, the rest from any.
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
