// SPDX-License-Identifier: Apache-2.0
/// @file
/// Platform functions that the program needs: on a bare controller in QEMU, or on the host.
///
/// @satisfies SWR-PRF-024      Design: docs/design/proofs.md#watermark
#ifndef VERIFICATION_PROOFS_TARGET_BOARD_HPP
#define VERIFICATION_PROOFS_TARGET_BOARD_HPP

#include <cstdint>

namespace proof {

/// Exit statuses of the image.
inline constexpr int kEnded = 0;
inline constexpr int kFaulted = 70;     ///< a processor fault or a failed check
inline constexpr int kNotStarted = 71;  ///< the executive rejected the start

/// Writes a zero-terminated text to standard error.
void write_text(const char* text) noexcept;
/// Ends the program with an exit status.
[[noreturn]] void end_program(int status) noexcept;
/// Number of stack bytes that were ever written, from its top; 0 if the stack is not painted.
std::uint32_t calc_stack_used() noexcept;

/// The program itself. @return its exit status.
int run_program() noexcept;

}  // namespace proof

#endif  // VERIFICATION_PROOFS_TARGET_BOARD_HPP
