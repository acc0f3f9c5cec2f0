// SPDX-License-Identifier: Apache-2.0
// Goal: window threads have the requested stack and lock only this, and an overflow hits the guard. Method:
// the work of a window asks the C library for its own stack; Linux reports the locked memory; a process
// overflows its stack deliberately, also by a stack frame that is larger than a page.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/patient_options.hpp"

namespace mamori::ports::posix_rt {
namespace {

using namespace verification;
using namespace literals;

constexpr std::size_t kKib = 1024U;
constexpr std::size_t kPage = 4096U;

struct Stack {
    std::uintptr_t lowest{0U};
    std::size_t size{0U};
    std::size_t guard{0U};
};

/// Reads the stack of the calling thread. The C library counts the guard separately.
Stack read_stack() {
    Stack stack;
    pthread_attr_t attributes;
    void* lowest = nullptr;
    if (pthread_getattr_np(pthread_self(), &attributes) != 0 ||
        pthread_attr_getstack(&attributes, &lowest, &stack.size) != 0 ||
        pthread_attr_getguardsize(&attributes, &stack.guard) != 0) {
        std::abort();
    }
    static_cast<void>(pthread_attr_destroy(&attributes));
    stack.lowest = reinterpret_cast<std::uintptr_t>(lowest);
    return stack;
}

/// Runs `step` as the only component of a window.
void run_in(GuardedHost& host, const FrameClock& clock, std::size_t window, void (*step)(void*),
            void* argument) {
    struct Step {
        void (*run)(void*);
        void* argument;
    } one{step, argument};
    const auto run = [](void* what, std::size_t, std::size_t) noexcept {
        static_cast<Step*>(what)->run(static_cast<Step*>(what)->argument);
    };
    const WindowHost::Work work{run, &one, window, 0U, 0U, 1U, WindowHost::Pass::kExecute};
    ASSERT_EQ(host.run_within(work, clock.get_now() + 60_s), 1U);
}

Stack read_stack_of(GuardedHost& host, const FrameClock& clock, std::size_t window) {
    Stack stack;
    run_in(host, clock, window, [](void* result) { *static_cast<Stack*>(result) = read_stack(); }, &stack);
    return stack;
}

std::uint64_t read_locked_bytes() {
    std::ifstream file{"/proc/self/status"};
    std::string word;
    std::uint64_t locked_kib = 0U;
    while (file >> word) {
        if (word == "VmLck:") {
            file >> locked_kib;
        }
    }
    return locked_kib * kKib;
}

class WindowStackTest : public ::testing::Test {
  protected:
    /// The C library reuses the stack of an ended thread that is at most four times as large; a sanitizer
    /// adds what it needs itself.
    void expect_stack(GuardedHost& host, std::size_t window, std::size_t size) {
        const Stack stack = read_stack_of(host, clock_, window);
        EXPECT_GE(stack.size, size) << window;
        EXPECT_LE(stack.size, 4U * size + 1024U * kKib) << window;
        EXPECT_EQ(stack.guard, kThreadStackGuard) << window;
    }

    const FrameClock clock_ = FrameClock::starting_in(Duration{0});
    std::array<WindowThread, 3U> threads_{};
};

TEST_F(WindowStackTest, EachWindowHasTheStackOfItsHostOrItsOwn) {
    verifies("SWR-PRT-060");
    EXPECT_EQ(threads_[0].get_stack_size(), 0U);
    ASSERT_EQ(threads_[1].set_stack_size(64U * kKib), Status::kOk);
    ASSERT_EQ(threads_[2].set_stack_size(8192U * kKib), Status::kOk);
    EXPECT_EQ(threads_[1].get_stack_size(), 64U * kKib);
    GuardedHost by_default{threads_, clock_, {}};
    ASSERT_EQ(by_default.open(), Status::kOk);

    expect_stack(by_default, 0U, kThreadStack);
    expect_stack(by_default, 1U, 64U * kKib);
    expect_stack(by_default, 2U, 8192U * kKib);
    ASSERT_EQ(by_default.close(), Status::kOk);
    GuardedHost stated{threads_, clock_, {0, ThreadPlace::kAnyProcessor, 2048U * kKib}};
    ASSERT_EQ(stated.open(), Status::kOk);
    expect_stack(stated, 0U, 2048U * kKib);
    expect_stack(stated, 1U, 64U * kKib);
    ASSERT_EQ(stated.close(), Status::kOk);
}

TEST_F(WindowStackTest, ASizeIsAtLeastTheMinimum) {
    verifies("SWR-PRT-060", Technique::kBoundaryValues);
    for (const std::size_t asked :
         {std::size_t{1U}, kThreadStackMin - 1U, kThreadStackMin, kThreadStackMin + 1U}) {
        ASSERT_EQ(threads_[0].set_stack_size(asked), Status::kOk);
        GuardedHost host{threads_, clock_, {}};
        ASSERT_EQ(host.open(), Status::kOk);
        expect_stack(host, 0U, asked < kThreadStackMin ? kThreadStackMin : asked);
        ASSERT_EQ(host.close(), Status::kOk);
    }
}

TEST_F(WindowStackTest, TheStackOfARunningThreadIsNotChanged) {
    verifies("SWR-PRT-060", Technique::kErrorGuessing, Polarity::kViolation);
    GuardedHost host{threads_, clock_, {}};
    ASSERT_EQ(host.open(), Status::kOk);

    EXPECT_EQ(threads_[0].set_stack_size(64U * kKib), Status::kPreconditionNotMet);
    EXPECT_EQ(threads_[0].get_stack_size(), 0U);
    ASSERT_EQ(host.close(), Status::kOk);
    EXPECT_EQ(threads_[0].set_stack_size(64U * kKib), Status::kOk);
    EXPECT_EQ(threads_[0].set_stack_size(0U), Status::kOk);
    EXPECT_EQ(threads_[0].get_stack_size(), 0U);
}

TEST_F(WindowStackTest, AStackForWhichThereIsNoMemoryStartsNoThread) {
    verifies("SWR-PRT-060", Technique::kBoundaryValues, Polarity::kViolation);
    for (const std::size_t size : {~std::size_t{0U}, ~std::size_t{0U} - kPage + 1U, std::size_t{1U} << 60U}) {
        ASSERT_EQ(threads_[1].set_stack_size(size), Status::kOk);
        GuardedHost host{threads_, clock_, {}};
        EXPECT_EQ(host.open(), Status::kOutOfResources) << size;
        EXPECT_EQ(threads_[0].set_stack_size(0U), Status::kOk) << "the first thread has ended";
    }
    ASSERT_EQ(threads_[1].set_stack_size(0U), Status::kOk);
    GuardedHost host{threads_, clock_, {}};
    EXPECT_EQ(host.open(), Status::kOk);
    EXPECT_EQ(host.close(), Status::kOk);
}

TEST(LockedStackTest, FiftyWindowsLockLessThanTwentyMegabytes) {
    verifies("SWR-PRT-060", Technique::kRequirementsBased, Polarity::kViolation);
    constexpr std::uint64_t kMost = 20'000'000U;
    // The memory of the threads is not locked yet, so it counts too.
    const std::uint64_t before = read_locked_bytes();
    if (!lock_memory(4096U).is_granted || read_locked_bytes() == before) {
        GTEST_SKIP() << "verdict=no-privilege: memory cannot be locked here";
    }
    const FrameClock clock = FrameClock::starting_in(Duration{0});
    static std::array<WindowThread, 50U> threads;
    GuardedHost host{threads, clock, {}};
    const std::uint64_t program = read_locked_bytes();
    const Status opened = host.open();
    const std::uint64_t growth = read_locked_bytes() - program + sizeof(threads);

    EXPECT_EQ(opened, Status::kOk);
    EXPECT_EQ(host.close(), Status::kOk);
    EXPECT_EQ(munlockall(), 0);
    EXPECT_LT(growth, kMost);
    EXPECT_GT(growth, 50U * kThreadStack) << "the stacks are locked";
    RecordProperty("locked_bytes_of_50_windows", std::to_string(growth));
}

// ---- Machine ----

/// Of this process.
std::size_t count_threads() {
    const std::filesystem::directory_iterator threads{"/proc/self/task"};
    return static_cast<std::size_t>(std::distance(begin(threads), end(threads)));
}

/// Notes the stack of its thread and the number of threads.
class StackReader final : public Component {
  public:
    explicit constexpr StackReader(const char* name) noexcept : Component(name) {}
    using Ports = mamori::Ports<>;
    std::size_t size{0U};
    std::size_t thread_count{0U};  ///< the most

  protected:
    Status on_execute(ContextHandle) noexcept override {
        size = read_stack().size;
        // A thread that has no window left ends before those of the other core.
        thread_count = std::max(thread_count, count_threads());
        return Status::kOk;
    }
};

StackReader g_small{"small"};
StackReader g_large{"large"};
StackReader g_silent{"silent"};
constexpr auto kSystem =
    system(frame(10_ms), window("small", 0_ms, 5_ms, budget(5_ms), stack(64_KiB), run(g_small)),
           window("large", 0_ms, 5_ms, core(1), budget(5_ms), stack(8192_KiB), run(g_large)),
           window("silent", 5_ms, 5_ms, core(1), budget(5_ms), run(g_silent)));

TEST(MachineStackTest, EachWindowHasOneThreadWithItsDeclaredStack) {
    verifies("SWR-PRT-060");
    static Machine<kSystem> machine{make_options()};
    const std::size_t threads_before = count_threads();

    ASSERT_EQ(machine.run(20U), Status::kOk) << describe(machine.get_report()).c_str();

    for (const auto& [component, declared] :
         {std::pair{&g_small, 64U * kKib + kThreadStackMin},
          std::pair{&g_large, 8192U * kKib + kThreadStackMin}, std::pair{&g_silent, kThreadStack}}) {
        EXPECT_GE(component->size, declared) << component->get_name();
        EXPECT_LE(component->size, 4U * declared + 1024U * kKib) << component->get_name();
        // Three windows, two cores, schedule watch and watchdog.
        EXPECT_EQ(component->thread_count, threads_before + 7U);
    }
}

// ---- Overflow ----

Stack stack_of_window;

/// Ends with status 0 if the access was in the guard of the window stack.
[[noreturn]] void report_location(int, siginfo_t* info, void*) {
    const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
    const std::uintptr_t lowest = stack_of_window.lowest;
    ::_exit(address < lowest && address >= lowest - kThreadStackGuard ? 0 : 1);
}

template <std::size_t kFrame>
__attribute__((noinline, no_sanitize("address"))) int use_up(volatile int depth) {
    volatile char room[kFrame];
    room[0] = static_cast<char>(depth);
    return depth < 0 ? 0 : use_up<kFrame>(depth + 1) + room[0];
}

/// Exit status of a process with a window that calls `overflow`: see report_location().
int overflow_in_a_window(void (*overflow)(void*), std::size_t stack_size) {
    const pid_t child = ::fork();
    if (child == 0) {
        struct sigaction action{};
        action.sa_sigaction = &report_location;
        action.sa_flags = SA_SIGINFO | SA_ONSTACK;
        static const FrameClock clock = FrameClock::starting_in(Duration{0});
        static std::array<WindowThread, 1U> threads;
        static GuardedHost host{threads, clock, {}};
        if (::sigaction(SIGSEGV, &action, nullptr) != 0 ||
            threads[0].set_stack_size(stack_size) != Status::kOk || host.open() != Status::kOk) {
            ::_exit(2);
        }
        run_in(
            host, clock, 0U,
            [](void* then) {
                stack_of_window = read_stack();
                (*static_cast<void (**)(void*)>(then))(nullptr);
            },
            &overflow);
        ::_exit(3);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StackOverflowTest, AnOverflowHitsTheGuardAndLeavesAStackForTheHandler) {
    verifies("SWR-PRT-060", Technique::kFaultInjection, Polarity::kViolation);
    for (const std::size_t size : {std::size_t{0U}, kThreadStackMin, 1024U * kKib}) {
        EXPECT_EQ(overflow_in_a_window([](void*) { static_cast<void>(use_up<256U>(0)); }, size), 0) << size;
    }
}

TEST(StackOverflowTest, AFrameLargerThanAPageDoesNotPassTheGuard) {
    verifies("SWR-PRT-060", Technique::kBoundaryValues, Polarity::kViolation);
    EXPECT_EQ(overflow_in_a_window([](void*) { static_cast<void>(use_up<48U * kKib>(0)); }, 0U), 0);
}

}  // namespace
}  // namespace mamori::ports::posix_rt
