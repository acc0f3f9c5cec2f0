// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/virtual_time/frame_runner.hpp"

namespace mamori::ports::virtual_time {

void FrameRunner::run_frame() noexcept {
    const SystemView& view = executive_.get_view();
    const Instant start{static_cast<std::int64_t>(frame_count_) * view.frame.ns};
    host_.advance_to(start);
    devices_.begin_frame(frame_count_, start);
    for (std::size_t window = 0U; window < view.windows.size(); ++window) {
        const Instant release = start + view.windows[window].offset;
        host_.advance_to(release);
        if (executive_.run_window(window, release, host_) == WindowOutcome::kOverrun) {
            ++overrun_count_;
        }
    }
    host_.advance_to(start + view.frame);
    devices_.end_frame(frame_count_, start, view.frame);
    ++frame_count_;
}

}  // namespace mamori::ports::virtual_time
