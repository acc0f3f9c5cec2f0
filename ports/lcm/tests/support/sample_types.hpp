// SPDX-License-Identifier: Apache-2.0
// Three message types with every form that a field can have, for the tests of ports/lcm and for lcm-gen.
#ifndef MAMORI_PORTS_LCM_SAMPLE_TYPES_HPP
#define MAMORI_PORTS_LCM_SAMPLE_TYPES_HPP

#include <array>
#include <cstdint>

#include "mamori/ports/lcm/protected_message.hpp"
#include "mamori/ports/lcm/type_names.hpp"
#include "mamori/safety/e2e/profile_04.hpp"

namespace lcm_sample {

enum class Mode : std::uint8_t { kIdle, kRun, kStop };

/// Every kind of number.
struct Reading {
    std::int8_t a{0};
    std::uint8_t b{0U};
    char c{'\0'};
    std::int16_t d{0};
    std::uint16_t e{0U};
    std::int32_t f{0};
    std::uint32_t g{0U};
    std::int64_t h{0};
    std::uint64_t i{0U};
    float j{0.0F};
    double k{0.0};
    bool l{false};
    Mode m{Mode::kIdle};
};

namespace inner {
struct Point {
    double x{0.0};
    std::int32_t id{0};
};
}  // namespace inner

/// Arrays of several dimensions, structs in structs, a string.
struct Robot {
    inner::Point base{};
    std::array<double, 7U> position_rad{};
    std::array<std::array<float, 3U>, 2U> matrix{};
    std::array<inner::Point, 2U> tips{};
    mamori::BoundedString<12U> name{};
    std::array<Mode, 3U> modes{};
    std::array<bool, 2U> flags{};
};

/// Sequences of everything.
struct Cloud {
    mamori::BoundedSequence<double, 5U> values{};
    mamori::BoundedSequence<inner::Point, 4U> points{};
    mamori::BoundedSequence<std::array<std::int16_t, 3U>, 3U> rows{};
    mamori::BoundedSequence<mamori::BoundedString<6U>, 3U> names{};
    mamori::BoundedSequence<std::uint8_t, 9U> octets{};
    mamori::BoundedSequence<Mode, 2U> modes{};
    Reading last{};
};

}  // namespace lcm_sample

MAMORI_LAST_ENUMERATOR(lcm_sample::Mode, kStop)
MAMORI_LCM_FIELDS(lcm_sample::Reading, a, b, c, d, e, f, g, h, i, j, k, l, m)
MAMORI_LCM_FIELDS(lcm_sample::inner::Point, x, id)
MAMORI_LCM_FIELDS(lcm_sample::Robot, base, position_rad, matrix, tips, name, modes, flags)
MAMORI_LCM_FIELDS(lcm_sample::Cloud, values, points, rows, names, octets, modes, last)

namespace lcm_sample {

using Profile = mamori::safety::E2eProfile04<>;
inline constexpr mamori::safety::SentIdChannel kCloudChannel{
    0x0A0B0C0DU, mamori::ports::lcm::kChannelLengthMin<Cloud, Profile>,
    mamori::ports::lcm::kChannelLengthMax<Cloud, Profile>, 0U};
using CloudMessage = mamori::ports::lcm::LcmMessage<Cloud, Profile, kCloudChannel>;

}  // namespace lcm_sample

#endif  // MAMORI_PORTS_LCM_SAMPLE_TYPES_HPP
