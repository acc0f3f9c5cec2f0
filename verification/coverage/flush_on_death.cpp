// SPDX-License-Identifier: Apache-2.0
/// @file
/// Linked into the test programs of the coverage build: keeps the counters also when a test ends its
/// process.
///
/// A death test ends its child process in a trap, in _Exit or by a signal that it raises. There, the run time
/// of clang writes nothing, so the failing side of every kernel check would count as untested. A forked child
/// therefore adds its counters to memory that it shares with the test program, which writes all of them. The
/// child does not write the file, because a test that kills it at that moment would leave an invalid file.
///
/// @satisfies SWR-VER-001      Design: docs/design/test_strength.md#coverage
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" {
int __llvm_profile_write_file(void);
char* __llvm_profile_begin_counters(void);
char* __llvm_profile_end_counters(void);
char* __llvm_profile_begin_bitmap(void);
char* __llvm_profile_end_bitmap(void);
[[noreturn]] void __real__exit(int status);
[[noreturn]] void __real__Exit(int status);
int __real_raise(int signal);
}

namespace {

pid_t g_program = 0;       ///< the process that writes the file
char* g_shared = nullptr;  ///< sum of the counters of its children, then of their MC/DC bitmaps

void add(char* target, const char* source, std::size_t size) {
    for (std::size_t i = 0U; i < size; i += sizeof(std::uint64_t)) {
        const auto* value = reinterpret_cast<const std::uint64_t*>(source + i);
        if (*value != 0U) {
            __atomic_fetch_add(reinterpret_cast<std::uint64_t*>(target + i), *value, __ATOMIC_RELAXED);
        }
    }
}

void unite(char* target, const char* source, std::size_t size) {
    for (std::size_t i = 0U; i < size; ++i) {
        __atomic_fetch_or(target + i, source[i], __ATOMIC_RELAXED);
    }
}

void keep_counters() {
    char* const counters = __llvm_profile_begin_counters();
    char* const bitmap = __llvm_profile_begin_bitmap();
    const auto size = static_cast<std::size_t>(__llvm_profile_end_counters() - counters);
    const auto bitmap_size = static_cast<std::size_t>(__llvm_profile_end_bitmap() - bitmap);
    if (::getpid() != g_program) {
        add(g_shared, counters, size);
        unite(g_shared + size, bitmap, bitmap_size);
        return;
    }
    add(counters, g_shared, size);
    unite(bitmap, g_shared + size, bitmap_size);
    static_cast<void>(__llvm_profile_write_file());
}

constexpr std::array<int, 6U> kSignals{SIGILL, SIGTRAP, SIGABRT, SIGSEGV, SIGBUS, SIGFPE};
std::array<struct sigaction, kSignals.size()> g_earlier{};

/// Keeps the counters, then raises the same signal with the handler that was installed before. A sanitizer
/// can report, and the death test sees the expected signal.
void keep_and_die(int signal) {
    keep_counters();
    for (std::size_t i = 0U; i < kSignals.size(); ++i) {
        if (kSignals[i] == signal) {
            static_cast<void>(sigaction(signal, &g_earlier[i], nullptr));
        }
    }
    static_cast<void>(__real_raise(signal));
}

[[gnu::constructor]] void install() {
    const std::ptrdiff_t size = (__llvm_profile_end_counters() - __llvm_profile_begin_counters()) +
                                (__llvm_profile_end_bitmap() - __llvm_profile_begin_bitmap());
    void* const memory = ::mmap(nullptr, static_cast<std::size_t>(size), PROT_READ | PROT_WRITE,
                                MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        std::abort();
    }
    g_shared = static_cast<char*>(memory);
    g_program = ::getpid();
    static_cast<void>(std::atexit(&keep_counters));
    struct sigaction action{};
    action.sa_handler = &keep_and_die;
    action.sa_flags = SA_ONSTACK;
    for (std::size_t i = 0U; i < kSignals.size(); ++i) {
        static_cast<void>(sigaction(kSignals[i], &action, &g_earlier[i]));
    }
}

}  // namespace

extern "C" {
[[noreturn]] void __wrap__exit(int status) {
    keep_counters();
    __real__exit(status);
}

[[noreturn]] void __wrap__Exit(int status) {
    keep_counters();
    __real__Exit(status);
}

int __wrap_raise(int signal) {
    const int error = errno;
    keep_counters();
    errno = error;
    return __real_raise(signal);
}
}
