// SPDX-License-Identifier: Apache-2.0
// Goal: our CDR is that of the ORB under OpenRTM.
// Method: encodings that omniORB 4.2.5 made of known values are compared with ours, decoded, truncated and
// damaged, in both byte orders. Source: tests/data/cdr_golden_omniorb425.tsv, made for this project. The
// rules themselves are tested in cdr_test.cpp.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "mamori/kernel/payload/extended_types_2d.hpp"
#include "mamori/kernel/payload/extended_types_3d.hpp"
#include "mamori/kernel/payload/timed_types.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/cdr_checks.hpp"

namespace mamori {
namespace {

using cdr_checks::Bytes;
using cdr_checks::to_hex;
using namespace mamori::rtc;  // NOLINT: one table of all their names
using namespace verification;

constexpr Time kTime{0x01020304U, 0x05060708U};

struct Vector {
    std::string name;
    ByteOrder order{ByteOrder::kLittle};
    Bytes bytes;
};

std::vector<Vector> read_vectors() {
    std::vector<Vector> vectors;
    std::ifstream file(MAMORI_CDR_VECTORS);
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string name;
        std::string order;
        std::size_t size = 0U;
        std::string digits;
        words >> name >> order >> size >> digits;
        const Bytes bytes = cdr_checks::from_hex(digits);
        EXPECT_EQ(bytes.size(), size) << line;
        EXPECT_TRUE(order == "LE" || order == "BE") << line;
        vectors.push_back({name, order == "BE" ? ByteOrder::kBig : ByteOrder::kLittle, bytes});
    }
    return vectors;
}

/// What is done with one vector; `padding` are the places where omniORB leaves what was in memory.
struct Checks {
    std::function<void(const Vector&)> encodes;
    std::function<void(const Vector&)> decodes;
    std::function<void(const Vector&)> refuses;
};

template <typename T>
Checks check(const T& value, const std::set<std::size_t>& padding = {}) {
    const auto masked = [padding](Bytes bytes) {
        for (const std::size_t place : padding) {
            bytes.at(place) = std::byte{0};
        }
        return bytes;
    };
    Checks checks;
    checks.encodes = [value, masked](const Vector& golden) {
        EXPECT_EQ(to_hex(cdr_checks::encode_exactly(value, golden.order)), to_hex(masked(golden.bytes)));
    };
    checks.decodes = [masked](const Vector& golden) {
        cdr_checks::expect_decodes<T>(golden.bytes, golden.order, masked(golden.bytes));
    };
    checks.refuses = [](const Vector& golden) {
        const T witness{};
        cdr_checks::expect_only_whole_is_taken(golden.bytes, golden.order, witness);
        static_cast<void>(cdr_checks::count_taken_with_one_bit_turned(golden.bytes, golden.order, witness));
    };
    return checks;
}

/// The values that the file was made from. Wide strings are in the file and not in Mamori.
std::map<std::string, Checks> make_table() {
    using Flags = std::array<bool, 3>;
    using Texts = std::array<BoundedString<8>, 2>;
    return {
        {"TimedLong", check(TimedLong{kTime, 0x11223344})},
        {"TimedShort", check(TimedShort{kTime, 0x1122})},
        {"TimedState", check(TimedState{kTime, 3})},
        {"TimedDouble", check(TimedDouble{kTime, 1.5})},
        {"TimedFloat", check(TimedFloat{kTime, 1.5F})},
        {"TimedBoolean", check(TimedBoolean{kTime, true})},
        {"TimedChar", check(TimedChar{kTime, 'A'})},
        {"TimedOctet", check(TimedOctet{kTime, 0xABU})},
        {"TimedString", check(TimedString<8>{kTime, "abc"})},
        {"TimedString_empty", check(TimedString<8>{kTime, ""})},
        {"TimedDoubleSeq[2]", check(TimedDoubleSeq<4>{kTime, std::array{1.0, -2.0}}, {12, 13, 14, 15})},
        {"TimedDoubleSeq[0]", check(TimedDoubleSeq<4>{kTime, {}})},
        {"TimedLongSeq[3]", check(TimedLongSeq<4>{kTime, std::array<std::int32_t, 3>{1, 2, 3}})},
        {"TimedShortSeq[3]", check(TimedShortSeq<4>{kTime, std::array<std::int16_t, 3>{1, 2, 3}})},
        {"TimedOctetSeq[3]", check(TimedOctetSeq<4>{kTime, std::array<std::uint8_t, 3>{1U, 2U, 3U}})},
        {"TimedBooleanSeq[3]", check(TimedBooleanSeq<4>{kTime, Flags{true, false, true}})},
        {"TimedStringSeq[2]", check(TimedStringSeq<4, 8>{kTime, Texts{"a", "bcde"}}, {18, 19})},
        {"TimedVelocity2D", check(TimedVelocity2D{kTime, {1.0, 2.0, 3.0}})},
        {"TimedPose3D", check(TimedPose3D{kTime, {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}})},
    };
}

class CdrGoldenTest : public testing::Test {
  protected:
    void SetUp() override {
        vectors_ = read_vectors();
        ASSERT_FALSE(vectors_.empty()) << MAMORI_CDR_VECTORS << " is missing or empty";
    }
    /// Hands each vector to the check that `member` points at; each value must have been met in both orders.
    void for_each(std::function<void(const Vector&)> Checks::* member) {
        const std::map<std::string, Checks> table = make_table();
        std::size_t met = 0U;
        for (const Vector& vector : vectors_) {
            SCOPED_TRACE(vector.name + (vector.order == ByteOrder::kBig ? " big" : " little"));
            if (vector.name != "TimedWString") {
                (table.at(vector.name).*member)(vector);
                ++met;
            }
        }
        EXPECT_EQ(met, 2U * table.size());
    }

    std::vector<Vector> vectors_;
};

TEST_F(CdrGoldenTest, EncodingsAreThoseOfTheOrb) {
    verifies("SWR-CDR-010", Technique::kBackToBack);
    for_each(&Checks::encodes);
}

TEST_F(CdrGoldenTest, EncodingsOfTheOrbAreDecoded) {
    verifies("SWR-CDR-012", Technique::kBackToBack);
    for_each(&Checks::decodes);
}

TEST_F(CdrGoldenTest, CutLongerAndDamagedEncodingsOfTheOrbAreRefused) {
    verifies("SWR-CDR-013", Technique::kFaultInjection, Polarity::kViolation);
    for_each(&Checks::refuses);
}

}  // namespace
}  // namespace mamori
