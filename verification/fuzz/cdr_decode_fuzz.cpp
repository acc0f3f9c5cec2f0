// SPDX-License-Identifier: Apache-2.0
/// @file
/// Fuzz target for the CDR decoder. The first byte selects type and byte order, the rest is the encoding. A
/// rejection must leave the object unchanged. An accepted object, when encoded again, must give the same
/// bytes except for padding. Seeds: corpus/cdr_decode.txt. Design: docs/design/data_flow.md#cdr
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/payload/extended_types_3d.hpp"
#include "mamori/kernel/payload/timed_types.hpp"

namespace mamori::fuzz {

enum class Mode : std::uint8_t { kIdle, kRun, kStop };
enum class Wide : std::uint32_t { kNone, kOne };

/// Contains every width and every kind of nesting.
struct Deep {
    bool flag{false};
    std::array<BoundedSequence<std::int16_t, 3>, 2> rows{};
    BoundedSequence<BoundedString<5>, 3> names{};
    BoundedSequence<BoundedSequence<double, 2>, 2> tables{};
    std::array<Mode, 2> modes{};
    BoundedSequence<Wide, 2> wide{};
    BoundedSequence<rtc::TimedBoolean, 2> flags{};
    char letter{'\0'};
    std::uint64_t huge{0U};
};

}  // namespace mamori::fuzz

MAMORI_LAST_ENUMERATOR(mamori::fuzz::Mode, kStop)
MAMORI_LAST_ENUMERATOR(mamori::fuzz::Wide, kOne)
MAMORI_FIELDS(mamori::fuzz::Deep, flag, rows, names, tables, modes, wide, flags, letter, huge)

namespace {

using mamori::ByteOrder;
using mamori::Result;
using mamori::Span;
using mamori::Status;

void require(bool condition) {
    if (!condition) {
        __builtin_trap();
    }
}

/// Encodes into a buffer of exactly the declared size, so that the sanitizer detects each excess byte.
template <typename T>
std::vector<std::byte> encode_exactly(const T& value, ByteOrder order) {
    const Result<std::size_t> size = mamori::calc_encoded_size(value);
    require(size.has_value() && size.get_value() <= mamori::max_encoded_size<T>());
    std::vector<std::byte> bytes(size.get_value());
    const Result<std::size_t> written =
        mamori::encode(value, Span<std::byte>(bytes.data(), bytes.size()), order);
    require(written.has_value() && written.get_value() == bytes.size());
    return bytes;
}

template <typename T>
void check(const std::vector<std::byte>& input, ByteOrder order) {
    T value{};
    T untouched;
    std::memcpy(&untouched, &value, sizeof value);
    if (mamori::decode(Span<const std::byte>(input.data(), input.size()), order, value) != Status::kOk) {
        require(std::memcmp(&untouched, &value, sizeof value) == 0);
        return;
    }
    const std::vector<std::byte> first = encode_exactly(value, order);
    require(first.size() == input.size());
    for (std::size_t i = 0U; i < first.size(); ++i) {
        // A second encoding may change only the padding, to zero.
        require(first[i] == input[i] || first[i] == std::byte{0});
    }
    T again{};
    require(mamori::decode(Span<const std::byte>(first.data(), first.size()), order, again) == Status::kOk);
    require(encode_exactly(again, order) == first);
}

void choose(std::uint8_t type, const std::vector<std::byte>& input, ByteOrder order) {
    using namespace mamori::rtc;  // NOLINT: a table of their names
    switch (type) {
        case 0U:
            return check<TimedLong>(input, order);
        case 1U:
            return check<TimedBooleanSeq<8>>(input, order);
        case 2U:
            return check<TimedString<8>>(input, order);
        case 3U:
            return check<TimedDoubleSeq<4>>(input, order);
        case 4U:
            return check<TimedStringSeq<3, 6>>(input, order);
        case 5U:
            return check<TimedPose3D>(input, order);
        default:
            return check<mamori::fuzz::Deep>(input, order);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 0U) {
        std::vector<std::byte> input(size - 1U);
        for (std::size_t i = 0U; i < input.size(); ++i) {
            input[i] = static_cast<std::byte>(data[i + 1U]);
        }
        choose(data[0] / 2U % 7U, input, data[0] % 2U == 0U ? ByteOrder::kLittle : ByteOrder::kBig);
    }
    return 0;
}
