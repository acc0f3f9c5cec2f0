// SPDX-License-Identifier: Apache-2.0
/// @file
/// Common Data Representation of payloads: the CDR body that data ports of OpenRTM exchange, without
/// encapsulation octet, byte-order flag or type id. Alignment is relative to the first byte of the payload.
///
/// @satisfies SWR-CDR-010, SWR-CDR-011, SWR-CDR-012, SWR-CDR-013      Design: docs/design/data_flow.md#cdr
/// Source:   OMG CORBA 3.0, 15.3 (CDR transfer syntax)
#ifndef MAMORI_KERNEL_CDR_HPP
#define MAMORI_KERNEL_CDR_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/payload/detail/cdr_reader.hpp"
#include "mamori/kernel/payload/detail/cdr_size.hpp"
#include "mamori/kernel/payload/detail/cdr_writer.hpp"
#include "mamori/kernel/payload/fields.hpp"

namespace mamori {

/// Byte order of numbers. A property of the connection (`serializer.cdr.endian`), not of the payload.
enum class ByteOrder : std::uint8_t { kLittle, kBig };

/// Size of the encoding of `value` [byte], at most max_encoded_size<T>(). O(number of strings, enumerations
/// and structs in sequences and arrays).
/// @return the size; kBadParameter when an enumeration has a value that is not an enumerator.
template <typename T>
constexpr Result<std::size_t> calc_encoded_size(const T& value) noexcept {
    detail::CdrMeter meter;
    if (!detail::walk(value, meter)) {
        return Status::kBadParameter;
    }
    return meter.get_position();
}

/// Encodes `value` into the first bytes of `buffer`. Padding is zero. The end has no padding. Bytes
/// after the encoding do not change. Thread safe on separate objects, O(encoded size), no memory.
/// @param[out] buffer max_encoded_size<T>() bytes are always sufficient; must not overlap `value`.
/// @return bytes written; kOutOfResources (buffer too small) and kBadParameter (an enumeration has a value
///     that is not an enumerator), both with the buffer unchanged.
template <typename T>
constexpr Result<std::size_t> encode(const T& value, Span<std::byte> buffer, ByteOrder order) noexcept {
    const Result<std::size_t> size = calc_encoded_size(value);
    if (!size.has_value()) {
        return size;
    }
    if (size.get_value() > buffer.size()) {
        return Status::kOutOfResources;
    }
    return order == ByteOrder::kBig ? detail::write_cdr<true>(value, buffer)
                                    : detail::write_cdr<false>(value, buffer);
}

/// Decodes all bytes of `buffer`. The content may be arbitrary: no byte outside the buffer is read. Thread
/// safe on separate objects, O(size of the buffer), no memory.
/// @param[in] buffer must not change during the call; must not overlap `value`.
/// @param[in,out] value receives the decoded value; unchanged on any code except kOk.
/// @return kOk; kBadParameter: the buffer is too short or too long, a sequence or string exceeds its bound, a
///     string lacks its terminating NUL or contains another, a boolean is neither 0 nor 1, or the value of an
///     enumeration is not an enumerator. The contents of padding are ignored.
template <typename T>
constexpr Status decode(Span<const std::byte> buffer, ByteOrder order, T& value) noexcept {
    const bool is_read = order == ByteOrder::kBig ? detail::read_cdr<true>(buffer, value)
                                                  : detail::read_cdr<false>(buffer, value);
    return is_read ? Status::kOk : Status::kBadParameter;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CDR_HPP
