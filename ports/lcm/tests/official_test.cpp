// SPDX-License-Identifier: Apache-2.0
// Goal: messages and fingerprints equal the official library, in both directions. Method: the build
// makes the
// `.lcm` text of three types from their field lists and lcm-gen makes code of it; random messages with a
// fixed seed are encoded by both sides and decoded by the other.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "mamori/ports/lcm/codec.hpp"
#include "mamori/safety/e2e/checker.hpp"
#include "mamori/safety/e2e/protector.hpp"
#include "mamori/trace/verifies.hpp"
#include "official/lcm_sample/Cloud.hpp"
#include "official/lcm_sample/Cloud_e2e.hpp"
#include "official/lcm_sample/Reading.hpp"
#include "official/lcm_sample/Robot.hpp"
#include "support/random_value.hpp"
#include "support/sample_types.hpp"

namespace mamori::ports::lcm {
namespace {

using lcm_sample::make_random;
using namespace verification;

constexpr std::uint64_t kSeed = 0x4C434DU;
constexpr int kMessages = 100'000;  // of the three types together

/// The bits of a number in the type of the official field.
template <typename To, typename From>
To to_official(From value) {
    static_assert(sizeof(To) == sizeof(From));
    To result{};
    std::memcpy(&result, &value, sizeof result);
    return result;
}

official::lcm_sample::inner::Point convert(const lcm_sample::inner::Point& from) {
    official::lcm_sample::inner::Point to{};
    to.x = from.x;
    to.id = from.id;
    return to;
}

official::lcm_sample::Reading convert(const lcm_sample::Reading& from) {
    official::lcm_sample::Reading to{};
    to.a = from.a;
    to.b = from.b;
    to.c = static_cast<std::int8_t>(from.c);
    to.d = from.d;
    to.e = to_official<std::int16_t>(from.e);
    to.f = from.f;
    to.g = to_official<std::int32_t>(from.g);
    to.h = from.h;
    to.i = to_official<std::int64_t>(from.i);
    to.j = from.j;
    to.k = from.k;
    to.l = from.l ? 1 : 0;
    to.m = static_cast<std::int32_t>(from.m);
    return to;
}

official::lcm_sample::Robot convert(const lcm_sample::Robot& from) {
    official::lcm_sample::Robot to{};
    to.base = convert(from.base);
    for (std::size_t i = 0U; i < 7U; ++i) {
        to.position_rad[i] = from.position_rad[i];
    }
    for (std::size_t i = 0U; i < 2U; ++i) {
        for (std::size_t j = 0U; j < 3U; ++j) {
            to.matrix[i][j] = from.matrix[i][j];
        }
        to.tips[i] = convert(from.tips[i]);
        to.flags[i] = from.flags[i] ? 1 : 0;
    }
    to.name.assign(from.name.begin(), from.name.end());
    for (std::size_t i = 0U; i < 3U; ++i) {
        to.modes[i] = static_cast<std::int32_t>(from.modes[i]);
    }
    return to;
}

template <typename Official>
Official convert_cloud(const lcm_sample::Cloud& from) {
    Official to{};
    to.values.assign(from.values.begin(), from.values.end());
    for (const lcm_sample::inner::Point& point : from.points) {
        to.points.push_back(convert(point));
    }
    for (const std::array<std::int16_t, 3U>& row : from.rows) {
        to.rows.push_back({row[0], row[1], row[2]});
    }
    for (const BoundedString<6U>& name : from.names) {
        to.names.emplace_back(name.begin(), name.end());
    }
    to.octets.assign(from.octets.begin(), from.octets.end());
    for (const lcm_sample::Mode mode : from.modes) {
        to.modes.push_back(static_cast<std::int32_t>(mode));
    }
    to.n_values = static_cast<std::int32_t>(to.values.size());
    to.n_points = static_cast<std::int32_t>(to.points.size());
    to.n_rows = static_cast<std::int32_t>(to.rows.size());
    to.n_names = static_cast<std::int32_t>(to.names.size());
    to.n_octets = static_cast<std::int32_t>(to.octets.size());
    to.n_modes = static_cast<std::int32_t>(to.modes.size());
    to.last = convert(from.last);
    return to;
}
official::lcm_sample::Cloud convert(const lcm_sample::Cloud& from) {
    return convert_cloud<official::lcm_sample::Cloud>(from);
}

template <typename Official>
std::vector<std::byte> encode_official(const Official& value) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(value.getEncodedSize()));
    EXPECT_EQ(value.encode(bytes.data(), 0, static_cast<int>(bytes.size())), value.getEncodedSize());
    return bytes;
}

/// Octets of `value`, encoded by Mamori.
template <typename T>
std::vector<std::byte> encode_own(const T& value) {
    std::vector<std::byte> bytes(kLcmSizeMax<T>);
    const Result<std::size_t> size = encode_lcm(value, {bytes.data(), bytes.size()});
    EXPECT_TRUE(size.has_value());
    bytes.resize(size.has_value() ? size.get_value() : 0U);
    return bytes;
}

/// @return true when `value` has the same octets on both sides, and both sides read them as the same value.
template <typename T>
bool is_equal_both_ways(const T& value) {
    using Official = decltype(convert(value));
    const std::vector<std::byte> theirs = encode_official(convert(value));
    const std::vector<std::byte> ours = encode_own(value);
    T decoded{};
    Official read{};
    return ours == theirs && decode_lcm({theirs.data(), theirs.size()}, decoded) == Status::kOk &&
           encode_own(decoded) == theirs &&
           read.decode(ours.data(), 0, static_cast<int>(ours.size())) == static_cast<int>(ours.size()) &&
           encode_official(read) == ours;
}

TEST(OfficialTest, FingerprintsAreThoseOfTheCodeOfLcmGen) {
    verifies("SWR-LCM-002", Technique::kBackToBack, Polarity::kNominal);
    EXPECT_EQ(kLcmFingerprint<lcm_sample::inner::Point>,
              static_cast<std::uint64_t>(official::lcm_sample::inner::Point::getHash()));
    EXPECT_EQ(kLcmFingerprint<lcm_sample::Reading>,
              static_cast<std::uint64_t>(official::lcm_sample::Reading::getHash()));
    EXPECT_EQ(kLcmFingerprint<lcm_sample::Robot>,
              static_cast<std::uint64_t>(official::lcm_sample::Robot::getHash()));
    EXPECT_EQ(kLcmFingerprint<lcm_sample::Cloud>,
              static_cast<std::uint64_t>(official::lcm_sample::Cloud::getHash()));
    EXPECT_EQ(lcm_sample::CloudMessage::kFingerprint,
              static_cast<std::uint64_t>(official::lcm_sample::Cloud_e2e::getHash()));
}

TEST(OfficialTest, RandomMessagesAreEqualOctetForOctetInBothDirections) {
    verifies("SWR-LCM-003", Technique::kBackToBack, Polarity::kNominal);
    std::mt19937_64 random(kSeed);
    int equal = 0;

    for (int i = 0; i < kMessages; ++i) {
        switch (i % 3) {
            case 0:
                equal += is_equal_both_ways(make_random<lcm_sample::Reading>(random)) ? 1 : 0;
                break;
            case 1:
                equal += is_equal_both_ways(make_random<lcm_sample::Robot>(random)) ? 1 : 0;
                break;
            default:
                equal += is_equal_both_ways(make_random<lcm_sample::Cloud>(random)) ? 1 : 0;
                break;
        }
    }

    EXPECT_EQ(equal, kMessages) << "seed " << kSeed;
}

TEST(OfficialTest, AProtectedMessageIsReadByTheOfficialLibraryAndKeepsItsChecksum) {
    verifies("SWR-LCM-005", Technique::kBackToBack, Polarity::kNominal);
    using Message = lcm_sample::CloudMessage;
    std::mt19937_64 random(kSeed);
    safety::E2eProtector<Message::Profile> protector(Message::kChannel);
    safety::E2eChecker<Message::Profile> checker(Message::kChannel, {});
    std::vector<std::byte> bytes(Message::kSizeMax);

    for (int i = 0; i < 3000; ++i) {
        const auto value = make_random<lcm_sample::Cloud>(random);
        const Result<std::size_t> size =
            encode_protected<Message>(value, protector, {bytes.data(), bytes.size()});
        ASSERT_TRUE(size.has_value());
        official::lcm_sample::Cloud_e2e read{};
        ASSERT_EQ(read.decode(bytes.data(), 0, static_cast<int>(size.get_value())),
                  static_cast<int>(size.get_value()));
        const std::vector<std::byte> again = encode_official(read);
        ASSERT_TRUE(std::equal(again.begin(), again.end(), bytes.begin()));
        const Span<const std::byte> message(again.data(), again.size());
        ASSERT_TRUE(is_usable(checker.check(get_protected_part(message))));
        lcm_sample::Cloud decoded{};
        ASSERT_EQ(decode_protected<Message>(message, decoded), Status::kOk);
        ASSERT_EQ(encode_own(decoded), encode_own(value));
        ASSERT_EQ(encode_official(convert(decoded)), encode_own(value));
    }
}

}  // namespace
}  // namespace mamori::ports::lcm
