// SPDX-License-Identifier: Apache-2.0
/// @file
/// A thread that requests introspection of a running system, like a tool outside the system.
///
/// @satisfies SWR-TIM-041      Design: docs/design/timing.md#requests
#ifndef MAMORI_TIMING_INTROSPECTION_LOAD_HPP
#define MAMORI_TIMING_INTROSPECTION_LOAD_HPP

#include <atomic>
#include <cstdint>
#include <thread>

#include "mamori/kernel/run/introspection.hpp"

namespace mamori::timing {

enum class Pace : std::uint8_t {
    kNone,
    kSteady,       ///< one request per millisecond
    kBurst,        ///< a hundred successive requests every 100 ms
    kWithoutPause  ///< requests in immediate sequence
};

/// Each request reads all rows. The thread has no fixed priority and may use any processor.
///
/// Thread safety: set_pace() and get_request_count() from any thread.
class IntrospectionLoad final {
  public:
    /// @param[in] shown must outlive this object. Create this object before the calling thread binds itself
    /// to a processor.
    explicit IntrospectionLoad(const Introspection& shown);
    IntrospectionLoad(const IntrospectionLoad&) = delete;
    IntrospectionLoad& operator=(const IntrospectionLoad&) = delete;
    ~IntrospectionLoad();

    /// Binds the thread to this processor.
    void bind(int processor) noexcept;

    /// True during a request. For callers that preempt the thread.
    const std::atomic<bool>& is_requesting() const noexcept { return is_requesting_; }

    void set_pace(Pace pace) noexcept { pace_.store(pace, std::memory_order_relaxed); }
    /// Number of requests that read at least one row.
    std::uint64_t get_request_count() const noexcept {
        return request_count_.load(std::memory_order_relaxed);
    }

  private:
    void serve() noexcept;
    void request(std::uint64_t count) noexcept;

    const Introspection& shown_;
    std::atomic<Pace> pace_{Pace::kNone};
    std::atomic<std::uint64_t> request_count_{0U};
    std::atomic<bool> is_requesting_{false};
    std::atomic<bool> is_ending_{false};
    std::thread thread_;
};

}  // namespace mamori::timing

#endif  // MAMORI_TIMING_INTROSPECTION_LOAD_HPP
