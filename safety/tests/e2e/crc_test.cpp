// SPDX-License-Identifier: Apache-2.0
// Goal: each checksum of the catalogue has its published values, and depends on the bytes only.
// Method: published values and a second implementation bit by bit; every pair of cuts, every number of
// tables.
#include "mamori/safety/e2e/crc.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "mamori/safety/e2e/crc_catalogue.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::safety {
namespace {

using namespace verification;

using Bytes = std::vector<std::byte>;

Bytes make_bytes(std::string_view text) {
    Bytes bytes;
    for (const char character : text) {
        bytes.push_back(static_cast<std::byte>(character));
    }
    return bytes;
}

Bytes make_bytes(std::initializer_list<unsigned> values) {
    Bytes bytes;
    for (const unsigned value : values) {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

/// Bytes without a pattern that a checksum could have in common with them.
Bytes make_noise(std::size_t size) {
    std::uint32_t state = 12345U;
    Bytes bytes;
    for (std::size_t i = 0U; i < size; ++i) {
        state = state * 1664525U + 1013904223U;
        bytes.push_back(static_cast<std::byte>(state >> 24U));
    }
    return bytes;
}

template <const auto& kCrc, std::size_t kSlices = 8U>
std::uint64_t calc(const Bytes& bytes) {
    Crc<kCrc, kSlices> crc;
    crc.add({bytes.data(), bytes.size()});
    return crc.get_value();
}

/// The definition, bit by bit and without tables.
template <const auto& kCrc>
std::uint64_t calc_bit_by_bit(const Bytes& bytes) {
    using Word = typename Crc<kCrc>::Word;
    constexpr int kTop = std::numeric_limits<Word>::digits - 1;
    Word value = kCrc.initial;
    for (const std::byte byte : bytes) {
        for (int bit = 0; bit < 8; ++bit) {
            const int place = kCrc.is_reflected ? bit : 7 - bit;
            const auto in = (std::to_integer<unsigned>(byte) >> place) & 1U;
            const bool feeds_back = ((value >> kTop) & 1U) != in;
            value = static_cast<Word>(value << 1U);
            value = static_cast<Word>(feeds_back ? value ^ kCrc.polynomial : value);
        }
    }
    const Word result = kCrc.is_reflected ? detail::reflect(value) : value;
    return static_cast<Word>(result ^ kCrc.final_xor);
}

template <const auto& kCrc>
void expect_values(const std::array<std::uint64_t, 5U>& expected) {
    EXPECT_EQ(calc<kCrc>(make_bytes("123456789")), expected[0]);
    EXPECT_EQ(calc<kCrc>(make_bytes({0U, 0U, 0U, 0U})), expected[1]);
    EXPECT_EQ(calc<kCrc>(make_bytes({0xFFU, 0xFFU, 0xFFU, 0xFFU})), expected[2]);
    EXPECT_EQ(calc<kCrc>(make_bytes({0xF2U, 0x01U, 0x83U})), expected[3]);
    EXPECT_EQ(calc<kCrc>(make_bytes({0x33U, 0x22U, 0x55U, 0xAAU, 0xBBU, 0xCCU, 0xDDU, 0xEEU, 0xFFU})),
              expected[4]);
}

TEST(CrcTest, PublishedValuesComeOut) {
    verifies("SWR-E2E-001");

    expect_values<kCrc8>({0x4BU, 0x59U, 0x74U, 0x37U, 0xCBU});
    expect_values<kCrc8H2f>({0xDFU, 0x12U, 0x6CU, 0xC2U, 0x11U});
    expect_values<kCrc16>({0x29B1U, 0x84C0U, 0x1D0FU, 0xD374U, 0xF53FU});
    expect_values<kCrc16Arc>({0xBB3DU, 0x0000U, 0x9401U, 0xC2E1U, 0xAE98U});
    expect_values<kCrc32>({0xCBF43926U, 0x2144DF1CU, 0xFFFFFFFFU, 0x24AB9D77U, 0xB0AE863DU});
    expect_values<kCrc32P4>({0x1697D06AU, 0x6FB32240U, 0xFFFFFFFFU, 0x4F721A25U, 0xA65A343DU});
    expect_values<kCrc64>({0x995DC9BBDF1939FAU, 0xF4A586351E1B9F4BU, 0xFFFFFFFF00000000U, 0x319C27668164F1C6U,
                           0x701ECEB219A8E5D5U});
    EXPECT_EQ(calc<kCrc8E2e>(make_bytes("123456789")), 0x37U);
    EXPECT_EQ(calc<kCrc8E2e>(make_bytes({0U, 0U, 0U, 0U})), 0x00U);
    EXPECT_EQ(calc<kCrc8E2e>(make_bytes({0xFFU, 0xFFU, 0xFFU, 0xFFU})), 0x2DU);
}

TEST(CrcTest, LibraryStartedNotForTheFirstTimeIsTheFormOfProfileOne) {
    verifies("SWR-E2E-001", Technique::kEquivalenceClasses);
    const Bytes bytes = make_noise(40U);

    Crc<kCrc8> library{0xFFU};
    library.add({bytes.data(), bytes.size()});
    EXPECT_EQ(static_cast<std::uint8_t>(library.get_value() ^ 0xFFU), calc<kCrc8E2e>(bytes));
}

template <const auto& kCrc, std::size_t... kSlices>
void expect_definition(std::index_sequence<kSlices...> /*numbers of tables*/) {
    for (std::size_t size = 0U; size <= 70U; ++size) {
        const Bytes bytes = make_noise(size);
        const std::uint64_t expected = calc_bit_by_bit<kCrc>(bytes);
        const std::vector<std::uint64_t> values{calc<kCrc, kSlices>(bytes)...};
        EXPECT_EQ(values, std::vector<std::uint64_t>(sizeof...(kSlices), expected)) << size << " bytes";
    }
}

TEST(CrcTest, EveryNumberOfTablesGivesTheDefinition) {
    verifies("SWR-E2E-001", Technique::kBackToBack);
    constexpr auto kAll = std::make_index_sequence<17U>{};

    expect_definition<kCrc8>(kAll);
    expect_definition<kCrc8E2e>(kAll);
    expect_definition<kCrc8H2f>(kAll);
    expect_definition<kCrc16>(kAll);
    expect_definition<kCrc16Arc>(kAll);
    expect_definition<kCrc32>(kAll);
    expect_definition<kCrc32P4>(kAll);
    expect_definition<kCrc64>(kAll);
}

template <const auto& kCrc>
void expect_pieces_do_not_matter() {
    using Sut = Crc<kCrc>;
    const Bytes bytes = make_noise(70U);
    const std::uint64_t whole = calc<kCrc>(bytes);
    const Span<const std::byte> all{bytes.data(), bytes.size()};
    for (std::size_t first = 0U; first <= bytes.size(); ++first) {
        for (std::size_t second = first; second <= bytes.size(); ++second) {
            Sut crc;
            crc.add(all.subspan(0U, first));
            Sut next{crc.get_value()};
            next.add(all.subspan(first, second - first));
            next.add(all.subspan(second, bytes.size() - second));
            ASSERT_EQ(next.get_value(), whole) << first << " " << second;
        }
    }
    Sut single;
    for (const std::byte byte : bytes) {
        single.add(byte);
    }
    EXPECT_EQ(single.get_value(), whole);
}

TEST(CrcTest, PiecesDoNotMatter) {
    verifies("SWR-E2E-002", Technique::kBoundaryValues);

    expect_pieces_do_not_matter<kCrc8>();
    expect_pieces_do_not_matter<kCrc8E2e>();
    expect_pieces_do_not_matter<kCrc8H2f>();
    expect_pieces_do_not_matter<kCrc16>();
    expect_pieces_do_not_matter<kCrc16Arc>();
    expect_pieces_do_not_matter<kCrc32>();
    expect_pieces_do_not_matter<kCrc32P4>();
    expect_pieces_do_not_matter<kCrc64>();
}

template <const auto& kCrc>
void expect_tables_of_the_compiler() {
    constexpr std::size_t kSlices = 8U;
    using Word = std::remove_const_t<decltype(kCrc.polynomial)>;
    detail::CrcTables<Word, kSlices> tables{};  // not const, which the compiler would evaluate again
    tables = detail::make_crc_tables<Word, kSlices>(kCrc);
    EXPECT_EQ(tables, (detail::kCrcTables<kCrc, kSlices>));
    std::array<Word, 16U> half_bytes{};
    half_bytes = detail::make_constants<kCrc, 0U>();
    EXPECT_EQ(half_bytes, (detail::kCrcTables<kCrc, 0U>));
}

TEST(CrcTest, TablesOfTheCompilerAreThoseOfTheProgram) {
    verifies("SWR-E2E-001", Technique::kBackToBack);

    expect_tables_of_the_compiler<kCrc8H2f>();
    expect_tables_of_the_compiler<kCrc16>();
    expect_tables_of_the_compiler<kCrc16Arc>();
    expect_tables_of_the_compiler<kCrc32P4>();
    expect_tables_of_the_compiler<kCrc64>();
}

TEST(CrcTest, RepeatedByteIsThatByteSoManyTimes) {
    verifies("SWR-E2E-002", Technique::kEquivalenceClasses);

    Crc<kCrc32P4> crc;
    crc.add_repeated(std::byte{0xA5U}, 19U);
    EXPECT_EQ(crc.get_value(), calc<kCrc32P4>(Bytes(19U, std::byte{0xA5U})));
}

TEST(CrcTest, ChecksumIsKnownToTheCompiler) {
    verifies("SWR-E2E-001", Technique::kInterface);

    constexpr std::uint32_t kValue = [] {
        constexpr std::array<std::byte, 4U> kZeros{};
        Crc<kCrc32P4> crc;
        crc.add(kZeros);
        return crc.get_value();
    }();
    static_assert(kValue == 0x6FB32240U);
    EXPECT_EQ(kValue, 0x6FB32240U);
}

}  // namespace
}  // namespace mamori::safety
