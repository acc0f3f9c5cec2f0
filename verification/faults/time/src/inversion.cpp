// SPDX-License-Identifier: Apache-2.0
#include "inversion.hpp"

#include "mamori/ports/posix_rt/real_time_rights.hpp"

namespace mamori::time_faults {
namespace {

void wait_for(sem_t& semaphore) noexcept {
    while (sem_wait(&semaphore) != 0) {
    }
}

void place(std::thread& thread, int priority, int processor) {
    static_cast<void>(ports::posix_rt::set_priority(thread.native_handle(), priority));
    static_cast<void>(ports::posix_rt::set_processor(thread.native_handle(), processor));
}

}  // namespace

Inversion::Inversion(const ports::posix_rt::FrameClock& clock, int priority, int processor) : clock_(clock) {
    sem_init(&to_take_, 0, 0U);
    sem_init(&to_give_, 0, 0U);
    sem_init(&to_compute_, 0, 0U);
    low_ = std::thread{[this] { hold(); }};
    middle_ = std::thread{[this] { compute(); }};
    place(low_, 0, processor);
    place(middle_, priority, processor);
}

Inversion::~Inversion() {
    is_ending_.store(true, std::memory_order_release);
    sem_post(&to_take_);
    sem_post(&to_give_);
    sem_post(&to_compute_);
    low_.join();
    middle_.join();
    sem_destroy(&to_take_);
    sem_destroy(&to_give_);
    sem_destroy(&to_compute_);
}

void Inversion::prepare() noexcept {
    if (!is_asked_) {
        is_asked_ = true;
        sem_post(&to_take_);
    }
}

void Inversion::attempt(Instant end) noexcept {
    is_asked_ = false;
    is_held_.store(false, std::memory_order_relaxed);
    end_ns_.store(end.ns, std::memory_order_release);
    sem_post(&to_compute_);
    sem_post(&to_give_);
}

void Inversion::hold() noexcept {
    for (wait_for(to_take_); !is_ending_.load(std::memory_order_acquire); wait_for(to_take_)) {
        const std::lock_guard<std::mutex> lock{mutex_};
        is_held_.store(true, std::memory_order_release);
        wait_for(to_give_);
    }
}

void Inversion::compute() noexcept {
    for (wait_for(to_compute_); !is_ending_.load(std::memory_order_acquire); wait_for(to_compute_)) {
        while (clock_.get_now() < Instant{end_ns_.load(std::memory_order_acquire)}) {
        }
    }
}

}  // namespace mamori::time_faults
