// SPDX-License-Identifier: Apache-2.0
#include "real_time_machine.hpp"

#include "machine.hpp"
#include "mamori/kernel/base/assert.hpp"
#include "mamori/ports/posix_rt/real_time_rights.hpp"
#include "mamori/ports/posix_rt/time_source.hpp"
#include "safe_arm_system.hpp"

namespace safe_arm {
namespace {

/// Below the windows, above all threads without fixed priority. Without the privilege, the plant runs
/// nevertheless and is late more often.
constexpr int kPlantPriority = 60;

}  // namespace

using mamori::Instant;
using mamori::Status;

RealTimeMachine::RealTimeMachine(mamori::sim::ArmPlant& plant) : plant_(plant), sample_(plant.sample()) {
    MAMORI_ENSURE(1, sem_init(&wanted_, 0, 0U) == 0 && sem_init(&done_, 0, 0U) == 0);
    thread_ = std::thread{[this] { serve(); }};
    static_cast<void>(mamori::ports::posix_rt::set_priority(thread_.native_handle(), kPlantPriority));
}

RealTimeMachine::~RealTimeMachine() {
    is_ending_.store(true, std::memory_order_release);
    static_cast<void>(sem_post(&wanted_));
    thread_.join();
    static_cast<void>(sem_destroy(&wanted_));
    static_cast<void>(sem_destroy(&done_));
}

void RealTimeMachine::serve() {
    while (true) {
        while (sem_wait(&wanted_) != 0) {
        }
        if (is_ending_.load(std::memory_order_acquire)) {
            return;
        }
        plant_.set_watchdog_expired(command_.is_watchdog_expired);
        plant_.set_buttons(command_.is_start_pushed, false);
        if (plant_.step(command_.outputs, kFrame) != Status::kOk) {
            is_plant_sound_.store(false, std::memory_order_relaxed);
        }
        sample_ = plant_.sample();
        static_cast<void>(sem_post(&done_));
    }
}

void RealTimeMachine::before_opening(const mamori::FrameSchedule::Opening& opening, Instant) noexcept {
    if (opening.window != kFirstWindow) {
        return;
    }
    if (is_stepping_ && sem_trywait(&done_) == 0) {
        is_stepping_ = false;
    }
    if (is_stepping_) {
        ++late_count_;
    } else {
        inputs = sample_;
    }
    // The time of the simulated drives stops when a step of them is late.
    inputs.drive_clock_ns = mamori::ports::posix_rt::get_raw_clock().read_ns();
}

void RealTimeMachine::after_opening(const mamori::FrameSchedule::Opening& opening,
                                    mamori::WindowOutcome) noexcept {
    if (opening.window != kLastWindow) {
        return;
    }
    const auto frame = opening.release.ns / kFrame.ns;
    const Instant end{(frame + 1) * kFrame.ns};
    watchdog.check(end);
    if (is_stepping_) {
        return;
    }
    command_ = {outputs, watchdog.has_expired(), calc_buttons({}, end).start};
    is_stepping_ = true;
    static_cast<void>(sem_post(&wanted_));
}

}  // namespace safe_arm
