// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/stop_signals.hpp"

#include <atomic>
#include <cerrno>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

std::atomic<StopListener*> current{nullptr};
static_assert(std::atomic<StopListener*>::is_always_lock_free);

extern "C" void on_stop(int signal) {
    const int before = errno;
    if (StopListener* const listener = current.load(std::memory_order_acquire); listener != nullptr) {
        listener->on_stop_signal(signal);
    }
    errno = before;
}

bool is_ignored(const struct sigaction& action) noexcept {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_IGN;
}

bool is_default(const struct sigaction& action) noexcept {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_DFL;
}

}  // namespace

Status StopSignals::install(StopListener& listener) noexcept {
    StopListener* none = nullptr;
    if (!current.compare_exchange_strong(none, &listener)) {
        return Status::kPreconditionNotMet;
    }
    struct sigaction action{};
    action.sa_handler = &on_stop;
    action.sa_flags = SA_RESTART | SA_ONSTACK;
    for (std::size_t i = 0U; i < kStopSignals.size(); ++i) {
        MAMORI_ENSURE(1, ::sigaction(kStopSignals[i], nullptr, &previous_[i]) == 0);
        if (!is_ignored(previous_[i])) {
            MAMORI_ENSURE(2, ::sigaction(kStopSignals[i], &action, nullptr) == 0);
        }
    }
    is_installed_ = true;
    return Status::kOk;
}

void StopSignals::remove() noexcept {
    if (!is_installed_) {
        return;
    }
    for (std::size_t i = 0U; i < kStopSignals.size(); ++i) {
        if (!is_ignored(previous_[i])) {
            MAMORI_ENSURE(3, ::sigaction(kStopSignals[i], &previous_[i], nullptr) == 0);
        }
    }
    is_installed_ = false;
    current.store(nullptr, std::memory_order_release);
}

void StopSignals::forward(int signal) const noexcept {
    for (std::size_t i = 0U; i < kStopSignals.size(); ++i) {
        if (kStopSignals[i] == signal && !is_default(previous_[i])) {
            static_cast<void>(::raise(signal));
        }
    }
}

}  // namespace mamori::ports::posix_rt
