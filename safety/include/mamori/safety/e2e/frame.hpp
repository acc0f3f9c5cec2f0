// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a protected message is to the kernel: a payload of bytes, of any length up to its capacity, that an
/// ordinary port of any kind carries and a partition passes on.
///
/// @satisfies SWR-E2E-030      Design: docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_FRAME_HPP
#define MAMORI_SAFETY_E2E_FRAME_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/payload/bounded_sequence.hpp"

namespace mamori::safety {

/// A frame of up to `kCapacity` bytes, header included.
template <std::size_t kCapacity>
using E2eFrame = BoundedSequence<std::uint8_t, kCapacity>;

namespace detail {

// Kernel payloads are numbers, protection works on bytes; std::byte may look at the storage of anything.
/// The bytes of `frame` in use, to be read.
template <std::size_t kCapacity>
Span<const std::byte> view_bytes(const E2eFrame<kCapacity>& frame) noexcept {
    return {reinterpret_cast<const std::byte*>(frame.data()), frame.size()};
}
/// The bytes of `frame` in use, to be written.
template <std::size_t kCapacity>
Span<std::byte> edit_bytes(E2eFrame<kCapacity>& frame) noexcept {
    return {reinterpret_cast<std::byte*>(frame.data()), frame.size()};
}

}  // namespace detail

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_FRAME_HPP
