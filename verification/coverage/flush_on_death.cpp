// SPDX-License-Identifier: Apache-2.0
/// @file
/// Linked into the test programs of the coverage build: writes the counters also when a test ends its
/// program.
///
/// A death test ends its child process in a trap or in _Exit. There, the run time of clang writes nothing, so
/// the failing side of every kernel check would count as untested. The file merges profiles
/// (LLVM_PROFILE_FILE with %m) and thus adds the counters of the child to those of its parent.
///
/// @satisfies SWR-VER-001      Design: docs/design/test_strength.md#coverage
#include <array>
#include <csignal>
#include <cstddef>

extern "C" {
int __llvm_profile_write_file(void);
[[noreturn]] void __real__exit(int status);
[[noreturn]] void __real__Exit(int status);

[[noreturn]] void __wrap__exit(int status) {
    static_cast<void>(__llvm_profile_write_file());
    __real__exit(status);
}

[[noreturn]] void __wrap__Exit(int status) {
    static_cast<void>(__llvm_profile_write_file());
    __real__Exit(status);
}
}

namespace {

constexpr std::array<int, 6U> kSignals{SIGILL, SIGTRAP, SIGABRT, SIGSEGV, SIGBUS, SIGFPE};
std::array<struct sigaction, kSignals.size()> g_earlier{};

/// Writes the counters, then raises the same signal with the handler that was installed before. A sanitizer
/// can report, and the death test sees the expected signal.
void write_and_die(int signal) {
    static_cast<void>(__llvm_profile_write_file());
    for (std::size_t i = 0U; i < kSignals.size(); ++i) {
        if (kSignals[i] == signal) {
            static_cast<void>(sigaction(signal, &g_earlier[i], nullptr));
        }
    }
    static_cast<void>(std::raise(signal));
}

[[gnu::constructor]] void install() {
    struct sigaction action{};
    action.sa_handler = &write_and_die;
    action.sa_flags = SA_ONSTACK;
    for (std::size_t i = 0U; i < kSignals.size(); ++i) {
        static_cast<void>(sigaction(kSignals[i], &action, &g_earlier[i]));
    }
}

}  // namespace
