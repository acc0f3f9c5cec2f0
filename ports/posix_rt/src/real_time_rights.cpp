// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/real_time_rights.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstdint>

namespace mamori::ports::posix_rt {
namespace {

constexpr std::size_t kPage = 4096U;
constexpr std::size_t kStackMax = 1U << 20U;
constexpr std::size_t kRoom = 64U << 20U;

Right to_right(int system_error) noexcept {
    return {system_error == 0, system_error};
}

/// Writes into each page of the next `size` bytes of the stack, which the compiler may not leave out.
void touch_stack(std::size_t size) noexcept {
    std::array<volatile std::uint8_t, kStackMax> stack;
    for (std::size_t i = 0U; i < size; i += kPage) {
        stack[kStackMax - 1U - i] = 0U;
    }
}

/// Locks all, and gives it back where a limit (RLIMIT_MEMLOCK) leaves too little for what comes later: with
/// it in force the stack of the next thread could not be had.
int lock_all() noexcept {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        return errno;
    }
    void* const room = mmap(nullptr, kRoom, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED) {
        static_cast<void>(munlockall());
        return ENOMEM;
    }
    static_cast<void>(munmap(room, kRoom));
    return 0;
}

}  // namespace

Right set_priority(pthread_t thread, int priority) noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return to_right(pthread_setschedparam(thread, priority == 0 ? SCHED_OTHER : SCHED_FIFO, &parameters));
}

Right set_processor(pthread_t thread, int processor) noexcept {
    if (processor == ThreadPlace::kAnyProcessor) {
        return to_right(0);
    }
    if (processor < 0 || processor >= CPU_SETSIZE) {
        return to_right(EINVAL);
    }
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(processor), &set);
    return to_right(pthread_setaffinity_np(thread, sizeof set, &set));
}

Right lock_memory(std::size_t stack_size) noexcept {
    const int result = lock_all();
    touch_stack(stack_size < kStackMax ? stack_size : kStackMax);
    return to_right(result);
}

}  // namespace mamori::ports::posix_rt
