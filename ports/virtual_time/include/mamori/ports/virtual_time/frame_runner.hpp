// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs whole frames of an executive in virtual time, in lockstep with simulated devices: devices are sampled
/// before the first window and advanced by one frame after the last.
///
/// @satisfies SWR-VTM-003      Design: docs/design/virtual_time.md#lockstep
#ifndef MAMORI_PORTS_VIRTUAL_TIME_FRAME_RUNNER_HPP
#define MAMORI_PORTS_VIRTUAL_TIME_FRAME_RUNNER_HPP

#include <cstdint>

#include "mamori/kernel/executive.hpp"
#include "mamori/ports/virtual_time/virtual_host.hpp"

namespace mamori::ports::virtual_time {

/// Devices and faults around the executive. Calling context: that of FrameRunner::run_frame.
class FrameDevices {
  public:
    /// Before the first window of frame `frame` (0, 1, ...): sample inputs, apply faults that are due.
    virtual void begin_frame(std::uint64_t frame, Instant now) noexcept = 0;
    /// After the last window: take outputs, move the plant on by `length`.
    virtual void end_frame(std::uint64_t frame, Instant now, Duration length) noexcept = 0;

  protected:
    ~FrameDevices() = default;
};

/// Drives one executive; frame n begins at n times the frame length. All references must outlive it, and the
/// clock of `host` must not be past the frame that is run next (own bug).
///
/// Thread safety: none. Time: one frame per call, as fast as the host computes it.
class FrameRunner final {
  public:
    FrameRunner(Executive& executive, VirtualHost& host, FrameDevices& devices) noexcept
        : executive_(executive), host_(host), devices_(devices) {}

    /// Runs the next frame: each window opens at its offset, whatever happened in the one before.
    void run_frame() noexcept;

    /// Frames run so far.
    std::uint64_t get_frame_count() const noexcept { return frame_count_; }
    /// Windows that ended with WindowOutcome::kOverrun so far.
    std::uint64_t get_overrun_count() const noexcept { return overrun_count_; }

  private:
    Executive& executive_;
    VirtualHost& host_;
    FrameDevices& devices_;
    std::uint64_t frame_count_{0U};
    std::uint64_t overrun_count_{0U};
};

}  // namespace mamori::ports::virtual_time

#endif  // MAMORI_PORTS_VIRTUAL_TIME_FRAME_RUNNER_HPP
