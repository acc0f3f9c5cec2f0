// SPDX-License-Identifier: Apache-2.0
/// @file
/// Contract checks. They are always on. A failed check calls the handler of the application, which enters the
/// safe state and does not return.
///
/// @satisfies SWR-KRN-003, SWR-KRN-042      Design: docs/design/kernel.md#errors
/// Not for input from a port or a device: such an input is a runtime error, which Status reports.
#ifndef MAMORI_KERNEL_ASSERT_HPP
#define MAMORI_KERNEL_ASSERT_HPP

#include <cstdint>

namespace mamori {

/// Location of a failed check. `id` is unique within the file and never changes its meaning.
struct AssertionRecord {
    const char* file;    ///< path as passed to the compiler; static storage
    std::uint32_t id;    ///< 1, 2, ...
    std::uint32_t line;  ///< line of the check, 1, 2, ...
#if defined(__unix__)
    const char* condition{nullptr};  ///< source text, static storage; nullptr: not available
#else
    static constexpr const char* condition{nullptr};  ///< a controller has no memory for strings
#endif
};

/// Receives the failure record and must not return. Called from any context, including interrupts, and at
/// most once. A check that fails while the handler runs waits for the handler (for kFailureLooks polls, or in
/// the gate) and then halts. On a host (Unix), the program prints one line to standard error before it halts.
/// The line reports the check that the handler received. A handler that ends the program itself prints its
/// own message.
using AssertionHandler = void (*)(const AssertionRecord& record) noexcept;

/// Installs the handler of the application. @param[in] handler nullptr restores the default, which halts.
/// Not thread safe: call once, before any context starts.
void set_assertion_handler(AssertionHandler handler) noexcept;

/// Without a gate, a later failure polls the handler this many times before it halts the program: about one
/// second on a 3 GHz processor. The handler needs milliseconds to switch the outputs off. The limit prevents
/// a handler that hangs from keeping a failed program alive. The kernel has no clock to measure time.
inline constexpr std::uint32_t kFailureLooks{100'000'000U};

/// Receives each failure record before the handler, in the context that failed. A port with threads returns
/// at once for the first failure. It delays later failures of other threads for a bounded time, so that they
/// do not end the program while the handler runs. A target with one thread returns at once.
using AssertionGate = void (*)(const AssertionRecord& record) noexcept;

/// Installs the gate of the port. @param[in] gate nullptr restores the default, no gate. Thread safe.
void set_assertion_gate(AssertionGate gate) noexcept;

namespace detail {
/// Calls gate and handler, prints the line on a host, and halts. @param[in] condition source text of the
/// check.
#if defined(__unix__)
[[noreturn]] void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line,
                                 const char* condition) noexcept;
#else
[[noreturn]] void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line) noexcept;
#endif
}  // namespace detail

}  // namespace mamori

/// Not for users. Without an output for the text, the macro drops the text, so that it uses no memory.
#if defined(__unix__)
#define MAMORI_FAIL_ASSERTION(id, text) \
    ::mamori::detail::fail_assertion(__FILE__, (id), static_cast<std::uint32_t>(__LINE__), text)
#else
#define MAMORI_FAIL_ASSERTION(id, text) \
    ::mamori::detail::fail_assertion(__FILE__, (id), static_cast<std::uint32_t>(__LINE__))
#endif

/// Precondition, postcondition and invariant: one mechanism, three names. The condition is evaluated once.
/// Allowed in any context, including interrupts. A failure in a constant expression is a compile error. `id`
/// as in AssertionRecord.
#define MAMORI_REQUIRE(id, condition) \
    ((condition) ? static_cast<void>(0) : MAMORI_FAIL_ASSERTION(id, #condition))
#define MAMORI_ENSURE(id, condition) \
    ((condition) ? static_cast<void>(0) : MAMORI_FAIL_ASSERTION(id, #condition))
#define MAMORI_INVARIANT(id, condition) \
    ((condition) ? static_cast<void>(0) : MAMORI_FAIL_ASSERTION(id, #condition))

#endif  // MAMORI_KERNEL_ASSERT_HPP
