// SPDX-License-Identifier: Apache-2.0
// What an executive shows to an introspection. What it does: executive.cpp.
#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/run/introspection.hpp"
#include "mamori/kernel/table/system_check.hpp"

namespace mamori {

void Executive::set_introspection(Introspection* introspection) noexcept {
    MAMORI_REQUIRE(1, !is_busy_);
    MAMORI_REQUIRE(2, introspection == nullptr || introspection->is_of(view_));
    is_table_sound_ = is_table_sound_ || check(view_).rule == Rule::kNone;
    introspection_ = introspection;
    prepare_work();
    show_windows();
}

void Executive::show_windows() noexcept {
    // The rows of a table that breaks a rule may lead anywhere.
    if (introspection_ == nullptr || !is_table_sound_) {
        return;
    }
    for (std::size_t w = 0U; w < view_.windows.size(); ++w) {
        if (is_own(w)) {
            introspection_->publish_window(w, windows_[w].context, last_release_, trace_hash_.get_value());
        }
    }
}

void Executive::show_opening(std::size_t window, Instant release, Instant opened, WindowOutcome outcome,
                             const WindowHost& host) noexcept {
    introspection_->note_opening(window, opened - release, host.get_now() - opened, outcome);
    introspection_->publish_window(window, windows_[window].context, release, trace_hash_.get_value());
}

}  // namespace mamori
