// SPDX-License-Identifier: Apache-2.0
/// @file
/// Common Data Representation of payloads: the bare CDR body that data ports of OpenRTM exchange, without
/// encapsulation octet, byte-order flag or type id. Alignment counts from the first byte of the payload.
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

/// Order of the bytes of a number. It is a property of the connection (`serializer.cdr.endian`), not of the
/// payload.
enum class ByteOrder : std::uint8_t { kLittle, kBig };

/// Size of the encoding of `value` [bytes], at most max_encoded_size<T>(). O(number of strings, enumerations
/// and structs in sequences and arrays).
/// @return the size; kBadParameter when an enumeration holds none of its enumerators.
template <typename T>
constexpr Result<std::size_t> calc_encoded_size(const T& value) noexcept {
    detail::CdrMeter meter;
    if (!detail::walk(value, meter)) {
        return Status::kBadParameter;
    }
    return meter.get_position();
}

/// Encodes `value` into the first bytes of `buffer`. Padding is written as zero; there is none at the end.
/// Bytes behind the encoding are not touched. Thread safe on separate objects, O(encoded size), no memory.
/// @param[out] buffer max_encoded_size<T>() bytes are always enough; no part of `value`.
/// @return bytes written; kOutOfResources (buffer too small) and kBadParameter (an enumeration holds none of
///     its enumerators), both with the buffer unchanged.
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

/// Decodes the whole of `buffer`, which may come from anywhere: no byte outside it is read, whatever it
/// holds. Thread safe on separate objects, O(size of the buffer), no memory.
/// @param[in] buffer must not change during the call; no part of `value`.
/// @param[in,out] value takes the decoded value; unchanged on anything but kOk.
/// @return kOk; kBadParameter: the buffer ends too early or too late, a sequence or string is longer than its
///     bound, a string lacks its closing NUL or has one inside, a boolean is neither 0 nor 1, or an
///     enumeration is none of its enumerators. The contents of padding are ignored.
template <typename T>
constexpr Status decode(Span<const std::byte> buffer, ByteOrder order, T& value) noexcept {
    const bool is_read = order == ByteOrder::kBig ? detail::read_cdr<true>(buffer, value)
                                                  : detail::read_cdr<false>(buffer, value);
    return is_read ? Status::kOk : Status::kBadParameter;
}

}  // namespace mamori

#endif  // MAMORI_KERNEL_CDR_HPP
