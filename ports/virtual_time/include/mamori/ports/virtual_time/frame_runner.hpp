// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs whole frames of a system in virtual time, with as many cores as it has, in lockstep with simulated
/// devices: devices are sampled before the first window and advanced by one frame after the last.
///
/// @satisfies SWR-VTM-003, SWR-VTM-010      Design: docs/design/conformance.md#lockstep
#ifndef MAMORI_PORTS_VIRTUAL_TIME_FRAME_RUNNER_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_FRAME_RUNNER_HPP

#include <cstdint>

#include "mamori/kernel/run/devices.hpp"
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/frame_schedule.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"

namespace mamori::ports::virtual_time {

/// One core of the simulated machine: its executive and its clock, both of which must outlive it.
class SimulatedCore final {
  public:
    SimulatedCore(Executive& executive, VirtualHost& host) noexcept : SimulatedCore(executive, host, host) {}

    /// @param[in] host what the windows are run with: an observer that hands everything on to `clock`; must
    ///            outlive this object.
    SimulatedCore(Executive& executive, VirtualHost& clock, WindowHost& host) noexcept
        : executive_(executive),
          clock_(clock),
          host_(host),
          schedule_(executive.get_view(), executive.get_core(), clock.get_now()) {}

  private:
    friend class FrameRunner;

    Executive& executive_;
    VirtualHost& clock_;
    WindowHost& host_;
    FrameSchedule schedule_;
    const SimulatedCore* ordinary_{nullptr};  ///< whose windows preempt its windows; nullptr: none
};

/// Drives the executives of one system; frame n begins at n times the frame length. The windows of all cores
/// run in the order of their planned instants, on which alone the data flow depends. Ordinary windows preempt
/// the background windows of their core. All references must outlive it. A clock of a core that is past the
/// next frame is a contract violation.
///
/// Thread safety: none. Time: one frame per call, as fast as the host computes it.
class FrameRunner final {
  public:
    /// @param[in] cores at least one, all of the same system table.
    /// @param[in] first_frame number of the frame that is run first.
    FrameRunner(Span<SimulatedCore> cores, Devices& devices, std::uint64_t first_frame = 0U) noexcept
        : cores_(cores), devices_(devices), frame_count_(first_frame) {
        pair_cores();
    }

    /// Runs the next frame: each window opens at its instants, whatever happened in the one before.
    void run_frame() noexcept;

    /// Number of the frame that is run next.
    std::uint64_t get_frame_count() const noexcept { return frame_count_; }
    /// Windows that ended with WindowOutcome::kOverrun so far.
    std::uint64_t get_overrun_count() const noexcept { return overrun_count_; }

  private:
    /// Shows each core of background windows the core whose windows preempt it.
    void pair_cores() noexcept;
    /// Core whose next opening is the earliest.
    SimulatedCore& find_next() noexcept;
    static WindowOutcome open(SimulatedCore& core, const FrameSchedule::Opening& opening) noexcept;

    Span<SimulatedCore> cores_;
    Devices& devices_;
    std::uint64_t frame_count_;
    std::uint64_t overrun_count_{0U};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_FRAME_RUNNER_HPP
