// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/crash_handlers.hpp"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <optional>

#include "failure_order.hpp"
#include "mamori/kernel/base/assert.hpp"
#include "mamori/ports/posix_rt/crash_note.hpp"
#include "mamori/ports/posix_rt/crash_place.hpp"

namespace mamori::ports::posix_rt {
namespace {

/// The active plan, and storage for the next plan.
std::array<std::optional<CrashPlan>, 2U> plan_storage;
std::size_t next_plan{0U};  ///< index into plan_storage
std::atomic<const CrashPlan*> plan_in_force{nullptr};
static_assert(std::atomic<const CrashPlan*>::is_always_lock_free);
std::atomic<bool> is_plan_taken{false};

void put_in_force(const CrashPlan& plan) noexcept {
    plan_in_force.store(&plan_storage[next_plan].emplace(plan), std::memory_order_release);
    next_plan = 1U - next_plan;
}

/// The C library function is not used, since it is a cancellation point.
void write_back(Span<std::byte> file) noexcept {
    static_cast<void>(::syscall(SYS_msync, file.data(), file.size(), MS_SYNC));
}

CrashNote make_note(const CrashPlan& plan, int signal, const siginfo_t& info) noexcept {
    CrashNote note;
    note.time = plan.clock.get_now();
    note.session = plan.session;
    note.place = get_crash_place();
    note.signal = static_cast<std::uint8_t>(signal);
    // Signals of the kernel have a code above 0. Other signals have no address.
    note.is_sent = info.si_code <= 0;
    note.address = note.is_sent ? 0U : reinterpret_cast<std::uintptr_t>(info.si_addr);
    return note;
}

/// The signal is blocked until the handler returns. Then it ends the process, and the core file contains the
/// registers of the crash.
void end_by(int signal) noexcept {
    struct sigaction ordinary{};
    ordinary.sa_handler = SIG_DFL;
    static_cast<void>(::sigaction(signal, &ordinary, nullptr));
    static_cast<void>(::raise(signal));
}

void on_crash(int signal, siginfo_t* info, void*) {
    if (!detail::begin_crash()) {
        end_by(signal);
        return;
    }
    const CrashPlan& plan = *plan_in_force.load(std::memory_order_acquire);
    plan.close_outputs(plan.context);
    if (!plan.file.empty()) {
        write_crash_note(plan.file, make_note(plan, signal, *info));
        write_back(plan.file);
    }
    detail::wait_for_failed_check();
    end_by(signal);
}

bool is_usable(const CrashPlan& wanted) noexcept {
    if (wanted.close_outputs == nullptr) {
        return false;
    }
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const bool is_page = reinterpret_cast<std::uintptr_t>(wanted.file.data()) % page == 0U;
    return wanted.file.empty() || (is_page && wanted.file.size() >= kCrashNoteSize);
}

}  // namespace

Status CrashHandlers::install(const CrashPlan& wanted) noexcept {
    if (!is_usable(wanted)) {
        return Status::kBadParameter;
    }
    if (is_plan_taken.exchange(true)) {
        return Status::kPreconditionNotMet;
    }
    put_in_force(wanted);
    detail::install_failure_gate();
    struct sigaction action{};
    action.sa_sigaction = &on_crash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    // During the handler, the signal is blocked, so Linux ends the process if the handler crashes.
    MAMORI_ENSURE(1, ::sigemptyset(&action.sa_mask) == 0);
    for (const int signal : kCrashSignals) {
        MAMORI_ENSURE(2, ::sigaddset(&action.sa_mask, signal) == 0);
    }
    for (std::size_t i = 0U; i < kCrashSignals.size(); ++i) {
        MAMORI_ENSURE(3, ::sigaction(kCrashSignals[i], &action, &previous_[i]) == 0);
    }
    is_installed_ = true;
    return Status::kOk;
}

Status CrashHandlers::replace(const CrashPlan& wanted) noexcept {
    if (!is_usable(wanted)) {
        return Status::kBadParameter;
    }
    if (!is_installed_) {
        return Status::kPreconditionNotMet;
    }
    put_in_force(wanted);
    return Status::kOk;
}

void CrashHandlers::remove() noexcept {
    if (!is_installed_) {
        return;
    }
    for (std::size_t i = 0U; i < kCrashSignals.size(); ++i) {
        MAMORI_ENSURE(4, ::sigaction(kCrashSignals[i], &previous_[i], nullptr) == 0);
    }
    is_installed_ = false;
    is_plan_taken.store(false);
}

}  // namespace mamori::ports::posix_rt
