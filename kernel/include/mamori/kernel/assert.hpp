// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checks against the project's own bugs. They are always on; a failed check calls the handler that the
/// application owns, which takes the machine to its safe state and does not return.
///
/// @satisfies SWR-KRN-003      Design: docs/design/kernel.md#errors
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
};

/// Takes the failure record; must not return. Called from any context, interrupts included, and at most
/// once: a check that fails while it runs, or after it returned, halts at once.
using AssertionHandler = void (*)(const AssertionRecord& record) noexcept;

/// Installs the application's handler. @param[in] handler nullptr restores the default, which halts.
/// Not thread safe: call it once, before any context is started.
void set_assertion_handler(AssertionHandler handler) noexcept;

namespace detail {
/// Calls the handler and halts should it return.
[[noreturn]] void fail_assertion(const char* file, std::uint32_t id, std::uint32_t line) noexcept;
}  // namespace detail

}  // namespace mamori

/// Pre-condition, post-condition and invariant: same mechanism, three words for the reader. The condition is
/// evaluated once, in any context, interrupts included; a failure in a constant expression stops the
/// compiler. `id` as in AssertionRecord.
#define MAMORI_REQUIRE(id, condition)   \
    ((condition) ? static_cast<void>(0) \
                 : ::mamori::detail::fail_assertion(__FILE__, (id), static_cast<std::uint32_t>(__LINE__)))
#define MAMORI_ENSURE(id, condition) MAMORI_REQUIRE(id, condition)
#define MAMORI_INVARIANT(id, condition) MAMORI_REQUIRE(id, condition)

#endif  // MAMORI_KERNEL_ASSERT_HPP
