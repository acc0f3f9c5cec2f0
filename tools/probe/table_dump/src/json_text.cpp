// SPDX-License-Identifier: Apache-2.0
#include "json_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace mamori::table_dump::json {

std::string quote(std::string_view text) {
    std::string result{"\""};
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        if (letter == '"' || letter == '\\') {
            result += {'\\', letter};
        } else if (code < 0x20U) {
            std::array<char, 8U> escape{};
            static_cast<void>(std::snprintf(escape.data(), escape.size(), "\\u%04x", unsigned{code}));
            result += escape.data();
        } else {
            result += letter;
        }
    }
    return result + "\"";
}

std::string format_number(double value) {
    if (!std::isfinite(value)) {
        return "null";
    }
    std::array<char, 32U> text{};  // a double needs at most 24
    const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), end.ptr};
}

}  // namespace mamori::table_dump::json
