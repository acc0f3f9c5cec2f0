// SPDX-License-Identifier: Apache-2.0
// What an executive shows to an introspection. How it executes windows: executive.cpp.
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"

namespace mamori {

void Executive::set_introspection(Introspection* introspection) noexcept {
    MAMORI_REQUIRE(1, !is_busy_);
    detail::CoreState& core = life_.get_core();
    MAMORI_REQUIRE(2, introspection == nullptr || introspection->is_of(core.view));
    if (!life_.is_table_valid()) {
        life_.check_table();
    }
    core.introspection = introspection;
    life_.get_runner().prepare_work();
    show_windows();
}

void Executive::show_windows() noexcept {
    // If the table violates a rule, indices in its rows may be out of range.
    const detail::CoreState& core = life_.get_core();
    if (core.introspection == nullptr || !life_.is_table_valid()) {
        return;
    }
    for (std::size_t w = 0U; w < core.view.windows.size(); ++w) {
        if (core.is_own(w)) {
            core.introspection->publish_window(w, core.windows[w].context, core.release,
                                               life_.get_data_flow().get_trace_hash());
        }
    }
}

void Executive::show_window(std::size_t window, Instant release, Instant start, WindowOutcome outcome,
                            const WindowHost& host) noexcept {
    const detail::CoreState& core = life_.get_core();
    core.introspection->note_opening(window, start - release, host.get_now() - start, outcome);
    core.introspection->publish_window(window, core.windows[window].context, release,
                                       life_.get_data_flow().get_trace_hash());
}

}  // namespace mamori
