// SPDX-License-Identifier: Apache-2.0
// The controller version of board.hpp: Arm semihosting, which QEMU converts to text and an exit status.
// Source: Arm Semihosting for AArch32 and AArch64, SYS_WRITE0, SYS_EXIT_EXTENDED.
#include "board.hpp"

namespace proof {
namespace {

constexpr std::uint32_t kWriteText = 0x04U;
constexpr std::uint32_t kExitExtended = 0x20U;
constexpr std::uint32_t kApplicationExit = 0x20026U;

void call_host(std::uint32_t operation, const void* argument) noexcept {
    asm volatile(
        "mov r0, %0\n"
        "mov r1, %1\n"
        "bkpt 0xab\n"
        :
        : "r"(operation), "r"(argument)
        : "r0", "r1", "memory");
}

}  // namespace

void write_text(const char* text) noexcept {
    call_host(kWriteText, text);
}

void end_program(int status) noexcept {
    const std::uint32_t block[2] = {kApplicationExit, static_cast<std::uint32_t>(status)};
    call_host(kExitExtended, block);
    __builtin_trap();
}

}  // namespace proof
