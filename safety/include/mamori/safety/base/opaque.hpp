// SPDX-License-Identifier: Apache-2.0
/// @file
/// What an optimiser may not look through. A check of memory or of the processor compares what must be equal
/// in a sound machine, which a compiler, whose machine is always sound, would otherwise leave out.
///
/// @satisfies SWR-RED-001, SWR-SLF-008      Design: docs/design/redundancy.md#optimisation-barriers
#ifndef MAMORI_SAFETY_OPAQUE_HPP
#define MAMORI_SAFETY_OPAQUE_HPP

namespace mamori::safety {

/// @return `value`, of which the compiler knows nothing any more: what is calculated with it, is calculated
///         when the program runs.
template <typename T>
inline T hide(T value) noexcept {
    asm volatile("" : "+m"(value));  // DEV-001
    return value;
}

/// Whatever the compiler knows about memory that others can reach, it forgets: the next access is one.
/// @param[in] memory an object, which others can reach from here on, should nobody have known of it before.
inline void forget(const volatile void* memory) noexcept {
    asm volatile("" : : "r"(memory) : "memory");  // DEV-002
}

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_OPAQUE_HPP
