// SPDX-License-Identifier: Apache-2.0
/// @file
/// The `.lcm` text of a payload type, from the field list: what lcm-gen and the tools of LCM read.
///
/// @satisfies SWR-LCM-001      Design: docs/design/lcm.md#types
#ifndef MAMORI_PORTS_LCM_TYPE_TEXT_HPP
#define MAMORI_PORTS_LCM_TYPE_TEXT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/lcm/fingerprint.hpp"

namespace mamori::ports::lcm {

namespace detail {

/// Appends to a buffer of fixed size, and remembers when something did not fit.
class TextWriter final {
  public:
    constexpr explicit TextWriter(Span<char> buffer) noexcept : buffer_(buffer) {}

    constexpr void add(char character) noexcept {
        if (size_ < buffer_.size()) {
            buffer_.data()[size_] = character;
        }
        ++size_;
    }
    constexpr void add(std::string_view text) noexcept {
        for (const char character : text) {
            add(character);
        }
    }
    constexpr void add_number(std::size_t number) noexcept {
        std::size_t unit = 1U;
        while (number / unit >= 10U) {
            unit *= 10U;
        }
        for (; unit > 0U; unit /= 10U) {
            add(static_cast<char>('0' + number / unit % 10U));
        }
    }
    /// A name of C++ in the spelling of LCM: `a.b` for `a::b`.
    constexpr void add_dotted(std::string_view name) noexcept {
        for (std::size_t i = 0U; i < name.size(); ++i) {
            if (name.substr(i, 2U) == "::") {
                add('.');
                ++i;
            } else {
                add(name[i]);
            }
        }
    }
    /// @return characters written; kOutOfResources (the buffer is too small).
    constexpr Result<std::size_t> get_size() const noexcept {
        if (size_ > buffer_.size()) {
            return Status::kOutOfResources;
        }
        return size_;
    }

  private:
    Span<char> buffer_;
    std::size_t size_{0U};
};

/// One line per field, and one for the length of a sequence.
struct TextVisitor {
    TextWriter& text;

    template <typename Form>
    constexpr void operator()(std::string_view name, Form /*form*/) noexcept {
        using Inner = typename Form::Inner;
        using Element = typename Inner::Element;
        if constexpr (Form::kIsSequence) {
            text.add("    int32_t n_");
            text.add(name);
            text.add(";  // 0 .. ");
            text.add_number(Form::kCapacity);
            text.add('\n');
        }
        text.add("    ");
        if constexpr (kIsStruct<Element>) {
            text.add_dotted(get_spelled(LcmNames<Element>::kType));
        } else {
            text.add(get_primitive<Element>());
        }
        text.add(' ');
        text.add(name);
        if constexpr (Form::kIsSequence) {
            text.add("[n_");
            text.add(name);
            text.add(']');
        }
        for (std::size_t i = 0U; i < Inner::kDimensions; ++i) {
            text.add('[');
            text.add_number(Inner::get_size(i));
            text.add(']');
        }
        text.add(';');
        add_limits<Element>();
        text.add('\n');
    }

    template <typename Element>
    constexpr void add_limits() noexcept {
        if constexpr (mamori::detail::Shape<Element>::kIsString) {
            text.add("  // up to ");
            text.add_number(mamori::detail::Shape<Element>::kCapacity);
            text.add(" characters");
        } else if constexpr (std::is_enum_v<Element>) {
            text.add("  // 0 .. ");
            text.add_number(Enumerators<Element>::kCount - 1U);
        }
    }
};

/// @param[in] header_size of the byte array in front of the fields [byte]; 0: none.
/// @param[in] suffix of the name of the struct.
template <typename T>
constexpr Result<std::size_t> write_struct(std::size_t header_size, std::string_view suffix,
                                           Span<char> buffer) noexcept {
    TextWriter text(buffer);
    text.add("// Made by Mamori from the field list of ");
    text.add(get_spelled(LcmNames<T>::kType));
    text.add(". Change that list, not this file.\npackage ");
    text.add_dotted(get_namespace<T>());
    text.add(";\n\nstruct ");
    text.add(get_type_name<T>());
    text.add(suffix);
    text.add(" {\n");
    if (header_size > 0U) {
        text.add("    byte ");
        text.add(kHeaderName);
        text.add('[');
        text.add_number(header_size);
        text.add("];\n");
    }
    TextVisitor visitor{text};
    for_each_field<T>(visitor);
    text.add("}\n");
    return text.get_size();
}

/// Calls `call(TypeList<E>{})` for each struct among the fields, after the structs in it.
template <typename Call>
struct StructVisitor {
    Call& call;

    template <typename Form>
    constexpr void operator()(std::string_view /*name*/, Form /*form*/) {
        using Element = typename Form::Inner::Element;
        if constexpr (kIsStruct<Element>) {
            for_each_field<Element>(*this);
            call(mamori::detail::TypeList<Element>{});
        }
    }
};

}  // namespace detail

/// Writes the `.lcm` text of T: its package and its struct, without the structs in it, which are texts of
/// their own (for_each_lcm_struct()). No memory. @param[out] buffer not terminated by NUL.
/// @return characters written; kOutOfResources (the buffer is too small; its content is incomplete).
template <typename T>
constexpr Result<std::size_t> write_lcm_text(Span<char> buffer) noexcept {
    static_assert(kLcmFingerprint<T> != 0U, "");
    return detail::write_struct<T>(0U, {}, buffer);
}

/// Calls `call(TypeList<E>{})` for T and before that for each struct in it; a struct that occurs twice is
/// passed twice.
template <typename T, typename Call>
constexpr void for_each_lcm_struct(Call& call) {
    detail::StructVisitor<Call> visitor{call};
    detail::for_each_field<T>(visitor);
    call(mamori::detail::TypeList<T>{});
}

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_TYPE_TEXT_HPP
