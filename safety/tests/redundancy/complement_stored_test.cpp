// SPDX-License-Identifier: Apache-2.0
// Goal: a value whose memory changed by itself is never given out; a type whose bytes are not all value is
// refused. Method: every single bit of both forms is turned, for values of 1 to 16 bytes; every pair of bits
// for one byte; the compiler is run on types with padding.
#include "mamori/safety/redundancy/complement_stored.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "compile_fail/compiler.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

template <std::size_t kBytes>
struct Block {
    std::array<std::uint8_t, kBytes> bytes{};
    friend bool operator==(const Block& a, const Block& b) { return a.bytes == b.bytes; }
};

/// Turns one bit of an object, as memory does it.
template <typename T>
void flip(T& object, std::size_t bit) {
    std::array<unsigned char, sizeof(T)> image{};
    std::memcpy(image.data(), &object, image.size());
    image[bit / 8U] = static_cast<unsigned char>(image[bit / 8U] ^ (1U << (bit % 8U)));
    std::memcpy(static_cast<void*>(&object), image.data(), image.size());
}

/// @return single-bit flips of a stored value that were found; every flip is turned back.
template <typename T>
std::size_t count_found(const T& value) {
    ComplementStored<T> sut(value);
    std::size_t found = 0U;
    for (std::size_t bit = 0U; bit < sizeof sut * 8U; ++bit) {
        flip(sut, bit);
        found += sut.read().get_status() == Status::kError ? 1U : 0U;
        flip(sut, bit);
        EXPECT_EQ(sut.read().get_status(), Status::kOk);
    }
    return found;
}

template <std::size_t kBytes>
void expect_every_flip_found() {
    for (const unsigned int fill : {0x00U, 0xFFU, 0x55U, 0xAAU, 0x3CU}) {
        Block<kBytes> value;
        value.bytes.fill(static_cast<std::uint8_t>(fill));
        EXPECT_EQ(count_found(value), kBytes * 16U) << kBytes << " bytes of " << fill;
    }
}

template <std::size_t... kIndex>
void expect_every_flip_found_up_to(std::index_sequence<kIndex...> /*sizes*/) {
    (expect_every_flip_found<kIndex + 1U>(), ...);
}

enum class Colour : std::uint16_t { kRed = 7U };

TEST(ComplementStoredTest, GivesBackWhatWasStored) {
    verifies("SWR-RED-001");
    ComplementStored<std::int32_t> number(-5);
    const ComplementStored<double> negative_zero(-0.0);
    const ComplementStored<Colour> colour(Colour::kRed);
    const ComplementStored<std::array<float, 3U>> vector(std::array{1.0F, 2.0F, 3.0F});

    EXPECT_EQ(number.read().get_status(), Status::kOk);
    EXPECT_EQ(number.read().get_value(), -5);
    EXPECT_TRUE(std::signbit(negative_zero.read().get_value())) << "a float is kept by its bits";
    EXPECT_EQ(colour.read().get_value(), Colour::kRed);
    EXPECT_EQ(vector.read().get_value()[2], 3.0F);
    number.set(6);
    EXPECT_EQ(number.read().get_value(), 6);
}

TEST(ComplementStoredTest, EveryValueOfAByteAndOfAWordIsGivenBack) {
    verifies("SWR-RED-001", Technique::kEquivalenceClasses);
    ComplementStored<std::uint16_t> sut(0U);

    for (std::uint32_t value = 0U; value <= 0xFFFFU; ++value) {
        sut.set(static_cast<std::uint16_t>(value));
        ASSERT_EQ(sut.read().get_status(), Status::kOk);
        ASSERT_EQ(sut.read().get_value(), value);
    }
}

TEST(ComplementStoredTest, EveryFlippedBitIsFoundInValuesOfOneToSixteenBytes) {
    verifies("SWR-RED-001", Technique::kFaultInjection, Polarity::kViolation);

    expect_every_flip_found_up_to(std::make_index_sequence<16U>{});
}

TEST(ComplementStoredTest, EveryFlippedBitIsFoundForEveryValueOfAByte) {
    verifies("SWR-RED-001", Technique::kFaultInjection, Polarity::kViolation);

    for (std::uint32_t value = 0U; value <= 0xFFU; ++value) {
        ASSERT_EQ(count_found(static_cast<std::uint8_t>(value)), 16U) << value;
    }
}

TEST(ComplementStoredTest, EveryFlippedBitIsFoundInFloatsBoolsAndEnumerators) {
    verifies("SWR-RED-001", Technique::kFaultInjection, Polarity::kViolation);

    EXPECT_EQ(count_found(1.5), 128U);
    EXPECT_EQ(count_found(std::nan("")), 128U) << "not-a-number is equal to itself here";
    EXPECT_EQ(count_found(1.5F), 64U);
    EXPECT_EQ(count_found(true), 16U);
    EXPECT_EQ(count_found(Colour::kRed), 32U);
}

TEST(ComplementStoredTest, OfTwoFlippedBitsOnlyThoseAtTheSameBitOfBothFormsAreMissed) {
    verifies("SWR-RED-001", Technique::kFaultInjection, Polarity::kViolation);
    std::size_t missed = 0U;

    for (std::size_t first = 0U; first < 16U; ++first) {
        for (std::size_t second = first + 1U; second < 16U; ++second) {
            ComplementStored<std::uint8_t> sut(0x5AU);
            flip(sut, first);
            flip(sut, second);
            const bool is_found = !sut.read().has_value();
            ASSERT_EQ(is_found, second != first + 8U) << first << " and " << second;
            missed += is_found ? 0U : 1U;
        }
    }
    EXPECT_EQ(missed, 8U) << "stated in the design note: the same bit of both forms";
}

TEST(ComplementStoredTest, ClearedAndFilledMemoryIsFound) {
    verifies("SWR-RED-001", Technique::kFaultInjection, Polarity::kViolation);
    ComplementStored<std::uint32_t> sut(1U);

    std::memset(static_cast<void*>(&sut), 0, sizeof sut);
    EXPECT_EQ(sut.read().get_status(), Status::kError);
    EXPECT_EQ(sut.read().get_value(), 0U) << "no corrupted value is given out";
    std::memset(static_cast<void*>(&sut), 0xFF, sizeof sut);
    EXPECT_EQ(sut.read().get_status(), Status::kError);
    sut.set(2U);
    EXPECT_EQ(sut.read().get_value(), 2U);
}

TEST(ComplementStoredCompileTest, TypesWithoutPaddingCompile) {
    verifies("SWR-RED-002");
    EXPECT_TRUE(has_no_padding<bool>());
    EXPECT_TRUE(has_no_padding<float>());
    EXPECT_TRUE((has_no_padding<std::array<double, 2U>>()));

    const rig::Compilation result = rig::compile("redundancy_source.cpp", "MAMORI_DEFECT_NONE");
    EXPECT_EQ(result.exit_status, 0) << result.messages;
}

TEST(ComplementStoredCompileTest, TypesWithPaddingOrMoreThanBytesDoNotCompile) {
    verifies("SWR-RED-002", Technique::kErrorGuessing, Polarity::kViolation);

    for (const char* const defect : {"MAMORI_DEFECT_PADDING", "MAMORI_DEFECT_FLOAT_PADDING"}) {
        const rig::Compilation result = rig::compile("redundancy_source.cpp", defect);
        EXPECT_EQ(result.exit_status, 1) << defect;
        EXPECT_TRUE(result.names("bytes between or behind the fields belong to no value")) << result.messages;
    }
    const rig::Compilation owner = rig::compile("redundancy_source.cpp", "MAMORI_DEFECT_NOT_BYTES");
    EXPECT_EQ(owner.exit_status, 1);
    EXPECT_TRUE(owner.names("a value that is more than its bytes")) << owner.messages;
}

}  // namespace
}  // namespace mamori::safety
