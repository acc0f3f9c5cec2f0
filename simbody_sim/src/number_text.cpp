// SPDX-License-Identifier: Apache-2.0
#include "number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace mamori::sim::detail {

bool try_parse_number(std::string_view text, double& number) {
    double parsed = 0.0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, parsed);
    if (error != std::errc{} || rest != end || !std::isfinite(parsed)) {
        return false;
    }
    number = parsed;
    return true;
}

std::string to_text(double number) {
    std::array<char, 32U> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} ? std::string(text.data(), end) : std::string("?");
}

}  // namespace mamori::sim::detail
