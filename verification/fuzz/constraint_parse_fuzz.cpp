// SPDX-License-Identifier: Apache-2.0
// Goal: no text, however odd, makes the constraint parser misbehave, and what it accepts means what it says.
// Method: the first byte chooses the type of value and the number of elements, the rest is the text. Checked:
// findings lie inside the text; spaces around a text change nothing; every accepted constraint is
// well-formed, admits its own closed limits and no NaN or infinity; printed in a canonical form it reads back
// as the same ranges; and each number equals what the C library makes of the same characters.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <type_traits>

#include "mamori/kernel/parameter/constraint_parser.hpp"
#include "mamori/kernel/parameter/decimal_rounding.hpp"

namespace {

using mamori::Constraint;
using mamori::ConstraintRule;
using mamori::Range;
using mamori::Text;

enum class Mode : std::uint8_t { kOff, kSlow, kFast };
constexpr const char* get_name(Mode mode) noexcept {
    return mode == Mode::kOff ? "off" : mode == Mode::kSlow ? "slow" : mode == Mode::kFast ? "fast" : "";
}

constexpr std::size_t kRanges = 8U;

void require(bool condition, const char* what) {
    if (!condition) {
        std::fprintf(stderr, "violated: %s\n", what);
        std::abort();
    }
}

Text view(const std::string& text) {
    return {text.data(), text.size()};
}

template <typename S>
std::string print(S value) {
    using N = mamori::detail::Number<S>;
    if constexpr (std::is_floating_point_v<N>) {
        char buffer[64];
        std::snprintf(buffer, sizeof buffer, "%.17g", static_cast<double>(value));
        return buffer;
    } else {
        return std::to_string(static_cast<N>(value));
    }
}

/// The ranges of one element, or of each; several ones can only be choices.
template <typename S>
std::string print_element(mamori::Span<const Range<S>> ranges, std::size_t element) {
    std::string choices;
    std::string limits;
    for (const Range<S>& range : ranges) {
        if (range.element != element) {
            continue;
        }
        choices += (choices.empty() ? "" : ",") + print(range.lower);
        limits = print(range.lower) + (range.is_lower_open ? " < x " : "<=x") +
                 (range.is_upper_open ? "<" : "<=") + print(range.upper);
        if (range.lower < range.upper) {
            return limits;
        }
    }
    return "(" + choices + ")";
}

template <typename S>
void require_same(mamori::Span<const Range<S>> a, mamori::Span<const Range<S>> b) {
    require(a.size() == b.size(), "equal number of ranges");
    for (std::size_t i = 0U; i < a.size(); ++i) {
        require(!(a[i].lower < b[i].lower) && !(b[i].lower < a[i].lower), "equal lower limit");
        require(!(a[i].upper < b[i].upper) && !(b[i].upper < a[i].upper), "equal upper limit");
        require(a[i].is_lower_open == b[i].is_lower_open && a[i].is_upper_open == b[i].is_upper_open,
                "equal sides");
        require(a[i].element == b[i].element, "equal element");
    }
}

template <typename S>
void check_accepted(const Constraint<S, kRanges>& constraint, std::size_t element_count) {
    std::string canonical;
    const auto ranges = constraint.get_ranges();
    const bool is_list = ranges[0].element != Range<S>::kEachElement;
    for (const Range<S>& range : ranges) {
        require(range.lower <= range.upper, "limits in order");
        require((range.element == Range<S>::kEachElement) == !is_list, "a list or no list");
        require(!is_list || range.element < element_count, "element of the value");
        const std::size_t element = is_list ? range.element : 0U;
        require(range.is_lower_open || constraint.admits(range.lower, element), "closed lower limit");
        require(range.is_upper_open || constraint.admits(range.upper, element), "closed upper limit");
        require(!range.is_lower_open || !range.contains(range.lower), "open lower limit");
        require(!range.is_upper_open || !range.contains(range.upper), "open upper limit");
    }
    for (std::size_t i = 0U; i < (is_list ? element_count : 1U); ++i) {
        canonical += (i == 0U ? "" : ",") + print_element(ranges, is_list ? i : Range<S>::kEachElement);
        if constexpr (std::is_floating_point_v<S>) {
            require(!constraint.admits(std::numeric_limits<S>::quiet_NaN(), i), "no NaN");
            require(!constraint.admits(std::numeric_limits<S>::infinity(), i), "no infinity");
            require(!constraint.admits(-std::numeric_limits<S>::infinity(), i), "no infinity");
        }
    }
    const auto again = mamori::parse_constraint<S, kRanges>(view(canonical), element_count);
    require(again.finding.rule == ConstraintRule::kNone, "canonical form is accepted");
    require_same(ranges, again.constraint.get_ranges());
}

template <typename S>
void check_text(const std::string& text, std::size_t element_count) {
    const auto parsed = mamori::parse_constraint<S, kRanges>(view(text), element_count);
    const auto padded = mamori::parse_constraint<S, kRanges>(view(" " + text + "\t"), element_count);
    require(parsed.finding.position <= text.size(), "finding inside the text");
    require(mamori::get_text(parsed.finding.rule) != nullptr, "finding has a text");
    require(parsed.finding.rule == padded.finding.rule, "spaces change nothing");
    if (parsed.finding.rule == ConstraintRule::kNone) {
        require_same(parsed.constraint.get_ranges(), padded.constraint.get_ranges());
        check_accepted(parsed.constraint, element_count);
    }
}

template <typename Real>
void check_real(const mamori::Decimal& decimal, Real expected) {
    const mamori::Result<Real> real = mamori::to_real<Real>(decimal);
    const bool is_representable = std::isfinite(expected) && (expected != Real{0} || decimal.digits == 0U);
    require(real.has_value() == is_representable, "refused exactly when not representable");
    if (is_representable) {
        require(real.get_value() == expected, "nearest value");
        require(std::signbit(real.get_value()) == std::signbit(expected), "sign");
    }
}

void check_number(const std::string& text) {
    mamori::TextCursor cursor{view(text)};
    const mamori::Result<mamori::Decimal> decimal = mamori::take_decimal(cursor);
    require(cursor.get_position() <= text.size(), "cursor inside the text");
    if (!decimal.has_value()) {
        return;
    }
    const std::string number = text.substr(0U, cursor.get_position());
    check_real<double>(decimal.get_value(), std::strtod(number.c_str(), nullptr));
    check_real<float>(decimal.get_value(), std::strtof(number.c_str(), nullptr));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0U) {
        return 0;
    }
    const std::string text{reinterpret_cast<const char*>(data) + 1, size - 1U};
    const std::size_t element_count = 1U + (data[0] >> 3U) % 5U;
    switch (data[0] & 7U) {
        case 0U:
            check_text<double>(text, element_count);
            break;
        case 1U:
            check_text<float>(text, element_count);
            break;
        case 2U:
            check_text<std::int8_t>(text, element_count);
            break;
        case 3U:
            check_text<std::uint64_t>(text, element_count);
            break;
        case 4U:
            check_text<std::int64_t>(text, element_count);
            break;
        case 5U:
            check_text<bool>(text, element_count);
            break;
        case 6U:
            check_text<Mode>(text, element_count);
            break;
        default:
            check_number(text);
            break;
    }
    return 0;
}
