// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/machine.hpp"

namespace mamori::ports::virtual_time {

Status MachineBase::run(ExecutiveGroup& executives, Span<SimulatedCore> cores,
                        Span<ActionGuard* const> guards, std::uint64_t frames, Devices& devices) noexcept {
    overrun_ = {};
    const Status started = executives.start(guards);
    if (started != Status::kOk) {
        is_stop_wanted_.store(false, std::memory_order_relaxed);
        return started;
    }
    FrameRunner runner{cores, devices, frame_count_};
    const std::int64_t frame = executives.get(0U).get_view().frame.ns;
    // One frame before the end of the time line, so that no instant of a frame overflows.
    const auto last = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / frame - 1);
    const std::uint64_t end = frames < last - frame_count_ ? frame_count_ + frames : last;
    while (runner.get_frame_count() < end && !is_stop_wanted_.load(std::memory_order_relaxed)) {
        runner.run_frame();
    }
    is_stop_wanted_.store(false, std::memory_order_relaxed);
    frame_count_ = runner.get_frame_count();
    overrun_count_ += runner.get_overrun_count();
    return executives.stop(guards);
}

}  // namespace mamori::ports::virtual_time
