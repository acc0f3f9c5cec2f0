// SPDX-License-Identifier: Apache-2.0
/// @file
/// A tool that looks at a running system from outside, as often as it is told to.
///
/// @satisfies SWR-PRT-039      Design: docs/design/posix_rt.md#requests-from-outside
#ifndef MAMORI_TIME_FAULTS_INTROSPECTION_LOAD_HPP
#define MAMORI_TIME_FAULTS_INTROSPECTION_LOAD_HPP

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "grid_figures.hpp"
#include "mamori/kernel/run/introspection.hpp"

namespace mamori::time_faults {

enum class Pace : std::uint8_t {
    kNone,
    kSteady,  ///< one request each millisecond
    kBurst,   ///< a hundred requests at once each 100 ms
    kWithoutPause
};

/// A request reads every row. The thread has no fixed priority and any processor.
///
/// Thread safety: set_pace() and get_request_count() from any thread.
class IntrospectionLoad final {
  public:
    /// @param[in] shown must outlive it. To be made before its maker binds itself to a processor.
    explicit IntrospectionLoad(const Introspection& shown);
    IntrospectionLoad(const IntrospectionLoad&) = delete;
    IntrospectionLoad& operator=(const IntrospectionLoad&) = delete;
    ~IntrospectionLoad();

    /// From now on its thread runs on this processor.
    void bind(int processor) noexcept;

    /// True in the middle of a request. For whoever keeps its thread from running.
    const std::atomic<bool>& is_requesting() const noexcept { return is_requesting_; }

    void set_pace(Pace pace) noexcept { pace_.store(pace, std::memory_order_relaxed); }
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

/// Runs the grid `round_count` times at each pace, `frame_count` frames each, in turns that begin with
/// another pace each time. @param[in] grid open. @return one element per round.
std::vector<LoadRound> run_load_rounds(Grid& grid, IntrospectionLoad& load, std::uint64_t round_count,
                                       std::uint64_t frame_count);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_INTROSPECTION_LOAD_HPP
