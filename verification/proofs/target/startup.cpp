// SPDX-License-Identifier: Apache-2.0
// From reset to run_program() on a bare Cortex-M4: paints the stack, initialises the variables, calls.
// Source: Armv7-M Architecture Reference Manual, B1.5 (exception model).
#include <array>
#include <cstdint>

#include "board.hpp"

extern "C" {
// Symbols of the linker script; only their addresses have a meaning.
extern std::uint32_t stack_bottom;
extern std::uint32_t stack_top;
extern std::uint32_t data_begin;
extern std::uint32_t data_end;
extern const std::uint32_t data_image;
extern std::uint32_t bss_begin;
extern std::uint32_t bss_end;

// The target of a call of a pure virtual function.
[[noreturn]] void __cxa_pure_virtual() {  // NOLINT: name of the C++ ABI
    proof::end_program(proof::kFaulted);
}

[[noreturn]] void fault_handler() {
    proof::write_text("fault\n");
    proof::end_program(proof::kFaulted);
}

[[noreturn]] void begin_program() {
    const std::uint32_t* from = &data_image;
    for (std::uint32_t* to = &data_begin; to < &data_end; ++to) {
        *to = *from;
        ++from;
    }
    for (std::uint32_t* to = &bss_begin; to < &bss_end; ++to) {
        *to = 0U;
    }
    proof::end_program(proof::run_program());
}

// Without a stack frame: the complete stack is painted before anything uses it.
[[gnu::naked, noreturn]] void reset_handler() {
    asm volatile(
        "ldr r0, =stack_bottom\n"
        "ldr r1, =stack_top\n"
        "ldr r2, =0xa5a5a5a5\n"
        "1: cmp r0, r1\n"
        "bcs 2f\n"
        "str r2, [r0], #4\n"
        "b 1b\n"
        "2: bl begin_program\n");
}
}  // extern "C"

namespace proof {
namespace {

constexpr std::uint32_t kPaint = 0xa5a5a5a5U;

struct Vectors {
    std::uint32_t* stack;
    void (*reset)();
    std::array<void (*)(), 14U> faults;
};

[[gnu::section(".vectors"), gnu::used]] const Vectors vectors{
    &stack_top,
    &reset_handler,
    {&fault_handler, &fault_handler, &fault_handler, &fault_handler, &fault_handler, &fault_handler,
     &fault_handler, &fault_handler, &fault_handler, &fault_handler, &fault_handler, &fault_handler,
     &fault_handler, &fault_handler}};

}  // namespace

std::uint32_t calc_stack_used() noexcept {
    const std::uint32_t* lowest = &stack_bottom;
    while (lowest < &stack_top && *lowest == kPaint) {
        ++lowest;
    }
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&stack_top) -
                                      reinterpret_cast<std::uintptr_t>(lowest));
}

}  // namespace proof
