// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/run/executive.hpp"

#include "mamori/kernel/base/remainder.hpp"

namespace mamori {

Status Executive::initialize() noexcept {
    if (is_busy_ || !life_.may_initialize()) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    const Status result = life_.initialize();
    end_operation();
    return result;
}

Status Executive::start() noexcept {
    if (is_busy_ || !life_.may_start()) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    const Status result = life_.start();
    end_operation();
    return result;
}

Status Executive::stop() noexcept {
    if (is_busy_ || !life_.may_stop()) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    const Status result = life_.stop();
    end_operation();
    return result;
}

Status Executive::finalize() noexcept {
    if (is_busy_ || !life_.may_finalize()) {
        return Status::kPreconditionNotMet;
    }
    is_busy_ = true;
    const Status result = life_.finalize();
    end_operation();
    return result;
}

void Executive::end_operation() noexcept {
    is_busy_ = false;
    show_windows();
}

void Executive::show_windows() noexcept {
    // If the table violates a rule, indices in its rows may be out of range.
    const detail::CoreState& core = life_.get_core();
    if (core.introspection != nullptr && life_.is_table_valid()) {
        core.introspection->show_windows(core, life_.get_data_flow().get_trace_hash());
    }
}

void Executive::set_observer(ExecutionObserver* observer) noexcept {
    MAMORI_REQUIRE(5, !is_busy_);
    detail::CoreState& core = life_.get_core();
    core.observer = observer;
    const Span<ExecutionRecord> records =
        observer == nullptr ? Span<ExecutionRecord>{} : observer->get_records();
    MAMORI_REQUIRE(4, records.empty() || records.size() >= core.view.components.size());
    core.records = records.data();
    core.parts.observe = &detail::observe_pass;
    life_.get_runner().prepare_work();
}

/// Before the first window of a major frame: executes changes that affect all windows of the core.
void Executive::begin_frame(Instant release) noexcept {
    detail::CoreState& core = life_.get_core();
    core.frame_start = Instant{release.ns - detail::calc_remainder(release.ns, core.view.frame.ns)};
    for (detail::WindowState& state : core.windows) {
        static_cast<void>(state.context.apply_pending_rate());
    }
    detail::ModeFollower& modes = life_.get_runner().get_modes();
    if (modes.has_joined()) {
        modes.begin_frame();
    }
}

WindowOutcome Executive::run_window(std::size_t index, Instant release, WindowHost& host) noexcept {
    MAMORI_REQUIRE(2, !is_busy_);
    detail::CoreState& core = life_.get_core();
    detail::WindowRunner& runner = life_.get_runner();
    const Instant start = host.get_now();
    MAMORI_REQUIRE(3, release <= start);
    const WindowRow& row = core.view.windows[index];
    MAMORI_REQUIRE(6, row.core == core.core);
    detail::WindowState& state = core.windows[index];
    WindowOutcome outcome = WindowOutcome::kStopped;
    const bool is_running = state.context.is_running();
    if (is_running || runner.get_modes().has_joined()) {
        is_busy_ = true;
        core.release = release;
        if (release < core.frame_start || release - core.frame_start >= core.view.frame) {
            begin_frame(release);
        }
        if (is_running) {
            outcome = runner.open(row, state, start, host);
        }
        is_busy_ = false;
    }
    if (core.introspection != nullptr && life_.is_table_valid()) {
        core.introspection->show_window(index, state.context, release, start, outcome, host,
                                        life_.get_data_flow().get_trace_hash());
    }
    return outcome;
}

}  // namespace mamori
