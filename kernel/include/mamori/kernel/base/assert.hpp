// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks of contracts. They are always on; a failed check calls the handler that the application owns, which
/// takes the machine to its safe state and does not return.
///
/// @satisfies SWR-KRN-003, SWR-KRN-042      Design: docs/design/kernel.md#errors
/// Never used on input from a port or a device: that is what Status is for.
#ifndef MAMORI_KERNEL_ASSERT_HPP
#define MAMORI_KERNEL_ASSERT_HPP

#include <cstdint>

namespace mamori {

/// Where a check failed. `id` is unique within the file and never changes its meaning.
struct AssertionRecord {
    const char* file;    ///< as the compiler was given it; static storage
    std::uint32_t id;    ///< 1, 2, ...
    std::uint32_t line;  ///< of the check, 1, 2, ...
#if defined(__unix__)
    const char* condition{nullptr};  ///< source text, static storage; nullptr: not given
#else
    static constexpr const char* condition{nullptr};  ///< a controller has no memory for texts
#endif
};

/// Takes the failure record; must not return. Called from any context, interrupts included, and at most
/// once: a check that fails while it runs waits for it (kFailureLooks, or the gate), and halts then. On a
/// host (Unix), the program prints one line to standard error before it halts, about the check that the
/// handler got; a handler that ends the program itself prints its own text.
using AssertionHandler = void (*)(const AssertionRecord& record) noexcept;

/// Installs the application's handler. @param[in] handler nullptr restores the default, which halts.
/// Not thread safe: call it once, before any context is started.
void set_assertion_handler(AssertionHandler handler) noexcept;

/// Without a gate a later failure looks so often whether the handler has returned, before it halts the
/// program: about a second on a processor of 3 GHz. Closing the outputs takes milliseconds, and a handler
/// that hangs must not keep a failed program alive. The kernel has no clock to count time with.
inline constexpr std::uint32_t kFailureLooks{100'000'000U};

/// Takes each failure record before the handler does, in the context that failed. A port with threads lets
/// the first failure pass and holds later ones of other threads back, for a bounded time, so that they do not
/// end the program while the handler runs. A target with one thread returns at once.
using AssertionGate = void (*)(const AssertionRecord& record) noexcept;

/// Installs the gate of the port. @param[in] gate nullptr restores the default. Thread safe.
void set_assertion_gate(AssertionGate gate) noexcept;

namespace detail {
/// Calls gate and handler, prints the line on a host, and halts. @param[in] condition its source text.
#if defined(__unix__)
[[noreturn]] void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line,
                                 const char* condition) noexcept;
#else
[[noreturn]] void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line) noexcept;
#endif
}  // namespace detail

}  // namespace mamori

/// Not for users. The text is dropped before it costs memory where nothing can print it.
#if defined(__unix__)
#define MAMORI_FAIL_ASSERTION(id, text) \
    ::mamori::detail::fail_assertion(__FILE__, (id), static_cast<std::uint32_t>(__LINE__), text)
#else
#define MAMORI_FAIL_ASSERTION(id, text) \
    ::mamori::detail::fail_assertion(__FILE__, (id), static_cast<std::uint32_t>(__LINE__))
#endif

/// Pre-condition, post-condition and invariant: same mechanism, three words for the reader. The condition is
/// evaluated once, in any context, interrupts included; a failure in a constant expression stops the
/// compiler. `id` as in AssertionRecord.
#define MAMORI_REQUIRE(id, condition) \
    ((condition) ? static_cast<void>(0) : MAMORI_FAIL_ASSERTION(id, #condition))
#define MAMORI_ENSURE(id, condition) \
    ((condition) ? static_cast<void>(0) : MAMORI_FAIL_ASSERTION(id, #condition))
#define MAMORI_INVARIANT(id, condition) \
    ((condition) ? static_cast<void>(0) : MAMORI_FAIL_ASSERTION(id, #condition))

#endif  // MAMORI_KERNEL_ASSERT_HPP
