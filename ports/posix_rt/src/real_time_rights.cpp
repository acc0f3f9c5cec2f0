// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/real_time_rights.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::posix_rt {
namespace {

constexpr std::size_t kPage = 4096U;
constexpr std::size_t kStackMax = 1U << 20U;
constexpr std::size_t kRoom = 64U << 20U;
constexpr std::size_t kReserve = 4096U;  ///< for stack frames below the touched bytes

Right to_right(int system_error) noexcept {
    return {system_error == 0, system_error};
}

/// Free bytes of the stack of the calling thread below `frame`, minus kReserve; 0 if Linux does not report
/// them.
std::size_t calc_free_stack(std::uintptr_t frame) noexcept {
    pthread_attr_t attributes;
    if (pthread_getattr_np(pthread_self(), &attributes) != 0) {
        return 0U;
    }
    void* lowest = nullptr;
    std::size_t size = 0U;
    const bool is_known = pthread_attr_getstack(&attributes, &lowest, &size) == 0;
    static_cast<void>(pthread_attr_destroy(&attributes));
    const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(lowest) + kReserve;
    return is_known && frame > end ? static_cast<std::size_t>(frame - end) : 0U;
}

/// Writes to each page of the next `size` bytes of the stack, at most those that the thread has. Allocates
/// exactly these bytes, because an array of the maximum size would overflow a small stack.
[[gnu::noinline]] void touch_stack(std::size_t size) noexcept {
    const std::size_t free = calc_free_stack(reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0)));
    const std::size_t touched = size < free ? size : free;
    if (touched == 0U) {
        return;
    }
    auto* const stack = static_cast<volatile std::uint8_t*>(__builtin_alloca(touched));
    for (std::size_t i = 0U; i < touched; i += kPage) {
        stack[touched - 1U - i] = 0U;
    }
}

/// Locks all memory. Unlocks it again if the limit (RLIMIT_MEMLOCK) leaves too little for later allocations,
/// because then no further thread could get a stack.
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

/// Attributes of a thread with a stack of `size` bytes above a guard. @return 0 or an error number;
/// `attributes` exist for 0 only.
int make_attributes(pthread_attr_t& attributes, std::size_t size) noexcept {
    int result = pthread_attr_init(&attributes);
    if (result != 0) {
        return result;
    }
    result = pthread_attr_setstacksize(&attributes, size < kThreadStackMin ? kThreadStackMin : size);
    if (result == 0) {
        result = pthread_attr_setguardsize(&attributes, kThreadStackGuard);
    }
    if (result != 0) {
        static_cast<void>(pthread_attr_destroy(&attributes));
    }
    return result;
}

/// Uses SCHED_OTHER, with any policy of the caller. @return 0 or the error of pthread_create().
int create_ordinary(pthread_t& thread, void* (*run)(void*), void* argument, std::size_t stack_size) noexcept {
    const sched_param none{};
    pthread_attr_t attributes;
    int result = make_attributes(attributes, stack_size);
    if (result != 0) {
        return result;
    }
    // These calls cannot fail with constants that each Linux supports.
    MAMORI_ENSURE(1, pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED) == 0);
    MAMORI_ENSURE(2, pthread_attr_setschedpolicy(&attributes, SCHED_OTHER) == 0);
    MAMORI_ENSURE(3, pthread_attr_setschedparam(&attributes, &none) == 0);
    result = pthread_create(&thread, &attributes, run, argument);
    static_cast<void>(pthread_attr_destroy(&attributes));
    return result;
}

/// Uses the scheduling of the caller. @return 0 or the error of pthread_create().
int create_alike(pthread_t& thread, void* (*run)(void*), void* argument, std::size_t stack_size) noexcept {
    pthread_attr_t attributes;
    int result = make_attributes(attributes, stack_size);
    if (result == 0) {
        result = pthread_create(&thread, &attributes, run, argument);
        static_cast<void>(pthread_attr_destroy(&attributes));
    }
    return result;
}

}  // namespace

Right set_priority(pthread_t thread, int priority) noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return to_right(pthread_setschedparam(thread, priority == 0 ? SCHED_OTHER : SCHED_FIFO, &parameters));
}

Right set_idle(pthread_t thread) noexcept {
    const sched_param none{};
    return to_right(pthread_setschedparam(thread, SCHED_IDLE, &none));
}

bool may_leave_idle() noexcept {
    const auto try_both = [](void* result) -> void* {
        *static_cast<bool*>(result) =
            set_idle(pthread_self()).is_granted && set_priority(pthread_self(), 0).is_granted;
        return nullptr;
    };
    bool is_allowed = false;
    pthread_t thread{};
    if (create_alike(thread, try_both, &is_allowed, kThreadStack) != 0) {
        return false;
    }
    return pthread_join(thread, nullptr) == 0 && is_allowed;
}

int get_own_priority() noexcept {
    sched_param parameters{};
    return ::sched_getparam(0, &parameters) == 0 ? parameters.sched_priority : 0;
}

Status start_thread(pthread_t& thread, void* (*run)(void*), void* argument, ThreadPlace place,
                    ThreadRights& rights) noexcept {
    pthread_t started{};
    int result = create_ordinary(started, run, argument, place.stack_size);
    // If SCHED_OTHER requires a privilege, the caller runs in SCHED_IDLE, and so does the new thread.
    if (result == EPERM && get_own_priority() == 0) {
        result = create_alike(started, run, argument, place.stack_size);
    }
    if (result != 0) {
        return Status::kOutOfResources;
    }
    thread = started;
    rights.priority = place.priority == 0 ? to_right(0) : set_priority(started, place.priority);
    rights.processor = set_processor(started, place.processor);
    return Status::kOk;
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
