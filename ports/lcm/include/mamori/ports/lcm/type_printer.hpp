// SPDX-License-Identifier: Apache-2.0
/// @file
/// Prints the `.lcm` text of the message types of a program, for lcm-gen and `./mamori lcm types`. The main
/// function of a small program of yours calls it: `return print_lcm_types<ns::State, ns::Command>();`.
///
/// @satisfies SWR-LCM-001      Design: docs/design/lcm.md#types
#ifndef MAMORI_PORTS_LCM_TYPE_PRINTER_HPP
#define MAMORI_PORTS_LCM_TYPE_PRINTER_HPP

#include <array>
#include <cstddef>
#include <string_view>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/ports/lcm/protected_message.hpp"
#include "mamori/ports/lcm/type_text.hpp"

namespace mamori::ports::lcm {

/// Writes texts to a file, each struct once.
///
/// Thread safety: none. Time: O(text); writing may block. Memory: kStructsMax pointers and one text.
class TypePrinter final {
  public:
    static constexpr std::size_t kStructsMax = 256U;
    static constexpr std::size_t kTextMax = 16384U;  ///< longest text of one struct [byte]

    /// @param[in] file descriptor, open for writing; 1 is the standard output.
    explicit TypePrinter(int file) noexcept : file_(file) {}

    /// Writes T, or the protected form of an LcmMessage, and the structs in it.
    template <typename T>
    void add() noexcept {
        if constexpr (LcmNames<T>::kDeclared) {
            for_each_lcm_struct<T>(*this);
        } else {
            using Value = typename T::Value;
            detail::StructVisitor<TypePrinter> visitor{*this};
            detail::for_each_field<Value>(visitor);
            print(write_protected_text<T>({text_.data(), text_.size()}));
        }
    }
    template <typename E>
    void operator()(mamori::detail::TypeList<E> /*type*/) noexcept {
        if (is_first(LcmNames<E>::kType)) {
            print(write_lcm_text<E>({text_.data(), text_.size()}));
        }
    }
    /// @return kOk; kOutOfResources (a text or the number of structs is above its limit); kError (writing
    ///         failed).
    Status get_status() const noexcept { return status_; }

  private:
    bool is_first(std::string_view type) noexcept;
    void print(Result<std::size_t> size) noexcept;

    int file_;
    Status status_{Status::kOk};
    std::size_t count_{0U};
    std::array<std::string_view, kStructsMax> printed_{};
    std::array<char, kTextMax> text_{};
};

/// Prints T... to the standard output. @tparam T structs with MAMORI_LCM_FIELDS, or LcmMessage types.
/// @return exit status of the program: 0; 1 when the output is incomplete.
template <typename... T>
int print_lcm_types() noexcept {
    static TypePrinter printer(1);
    (printer.add<T>(), ...);
    return printer.get_status() == Status::kOk ? 0 : 1;
}

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_TYPE_PRINTER_HPP
