// SPDX-License-Identifier: Apache-2.0
/// @file
/// Fingerprint of a payload type: the 64-bit hash over names, types and dimensions of its fields with which
/// every LCM message begins. It is calculated by the compiler and equals that of the code of lcm-gen.
///
/// @satisfies SWR-LCM-002      Design: docs/design/lcm.md#types
/// Source:   LCM Type Specification Language, "Fingerprint Computation"
#ifndef MAMORI_PORTS_LCM_FINGERPRINT_HPP
#define MAMORI_PORTS_LCM_FINGERPRINT_HPP

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "mamori/ports/lcm/type_shape.hpp"

namespace mamori::ports::lcm {

namespace detail {

/// Hash over the members of one struct.
class MemberHash final {
  public:
    constexpr void add_byte(std::uint8_t byte) noexcept {
        // The shift to the right is arithmetic: it repeats the sign.
        const std::uint64_t high = (value_ >> 55U) | ((value_ >> 63U) != 0U ? ~std::uint64_t{0x1FFU} : 0U);
        value_ = ((value_ << 8U) ^ high) + byte;
    }
    constexpr void add_text(std::string_view text) noexcept {
        add_byte(static_cast<std::uint8_t>(text.size()));
        for (const char character : text) {
            add_byte(static_cast<std::uint8_t>(character));
        }
    }
    /// A number in decimal digits, as in the `.lcm` text.
    constexpr void add_number(std::size_t number) noexcept {
        char digits[20]{};
        std::size_t first = sizeof digits;
        do {
            --first;
            digits[first] = static_cast<char>('0' + number % 10U);
            number /= 10U;
        } while (number > 0U);
        add_text(std::string_view(digits + first, sizeof digits - first));
    }
    /// `n_` and the name of a sequence.
    constexpr void add_length_name(std::string_view sequence) noexcept {
        add_byte(static_cast<std::uint8_t>(sequence.size() + 2U));
        add_byte('n');
        add_byte('_');
        for (const char character : sequence) {
            add_byte(static_cast<std::uint8_t>(character));
        }
    }
    constexpr std::uint64_t get_value() const noexcept { return value_; }

  private:
    std::uint64_t value_{0x12345678U};
};

inline constexpr std::uint8_t kConstantDimension = 0U;
inline constexpr std::uint8_t kVariableDimension = 1U;

template <typename T>
constexpr std::uint64_t calc_type_hash(std::size_t header_size) noexcept;

/// Adds each field to the hash of its struct; collects the hashes of the structs in it.
struct FingerprintVisitor {
    MemberHash hash{};
    std::uint64_t nested{0U};

    template <typename Form>
    constexpr void operator()(std::string_view name, Form /*form*/) noexcept {
        using Inner = typename Form::Inner;
        using Element = typename Inner::Element;
        if constexpr (Form::kIsSequence) {
            hash.add_length_name(name);
            hash.add_text("int32_t");
            hash.add_byte(0U);
        }
        hash.add_text(name);
        if constexpr (kIsStruct<Element>) {
            nested += calc_type_hash<Element>(0U);
        } else {
            hash.add_text(get_primitive<Element>());
        }
        hash.add_byte(static_cast<std::uint8_t>(Inner::kDimensions + (Form::kIsSequence ? 1U : 0U)));
        if constexpr (Form::kIsSequence) {
            hash.add_byte(kVariableDimension);
            hash.add_length_name(name);
        }
        for (std::size_t i = 0U; i < Inner::kDimensions; ++i) {
            hash.add_byte(kConstantDimension);
            hash.add_number(Inner::get_size(i));
        }
    }
};

/// Name of the byte array in front of the fields of a protected message.
inline constexpr std::string_view kHeaderName = "e2e";

/// @param[in] header_size of the byte array in front of the fields [byte]; 0: none.
template <typename T>
constexpr std::uint64_t calc_type_hash(std::size_t header_size) noexcept {
    static_assert(!has_name_clash<T>({}), "a field has the name of the length n_<name> of a sequence");
    FingerprintVisitor visitor;
    if (header_size > 0U) {
        visitor.hash.add_text(kHeaderName);
        visitor.hash.add_text("byte");
        visitor.hash.add_byte(1U);
        visitor.hash.add_byte(kConstantDimension);
        visitor.hash.add_number(header_size);
    }
    for_each_field<T>(visitor);
    const std::uint64_t sum = visitor.hash.get_value() + visitor.nested;
    return (sum << 1U) + (sum >> 63U);
}

}  // namespace detail

/// Fingerprint of T without protection. @tparam T struct with MAMORI_LCM_FIELDS, as are the structs in it.
template <typename T>
inline constexpr std::uint64_t kLcmFingerprint = detail::calc_type_hash<T>(0U);

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_FINGERPRINT_HPP
