// SPDX-License-Identifier: Apache-2.0
// Goal: the codec writes into the buffer only, and rejects all that is not a message of its type. Method:
// messages made by hand and by truncation, extension and mutation of good ones; the comparison with the
// official library is in official_test.cpp.
#include "mamori/ports/lcm/codec.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "mamori/ports/lcm/rtc_names.hpp"
#include "mamori/ports/lcm/type_printer.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/random_value.hpp"
#include "support/sample_types.hpp"

namespace lcm_codec_test {

enum class Colour : std::uint8_t { kRed, kGreen };
struct Small {
    bool is_on{false};
    Colour colour{Colour::kRed};
    mamori::BoundedSequence<std::int16_t, 2U> values{};
    mamori::BoundedString<3U> name{};
};
/// The same fields as Small under other names: another type for LCM.
struct Renamed {
    bool is_off{false};
    Colour colour{Colour::kRed};
    mamori::BoundedSequence<std::int16_t, 2U> values{};
    mamori::BoundedString<3U> name{};
};
using Joints = mamori::rtc::TimedDoubleSeq<7U>;
struct One {
    std::uint8_t octet{0U};
};
/// Limits with each number of digits.
struct Limits {
    mamori::BoundedString<9U> a{};
    mamori::BoundedString<10U> b{};
    mamori::BoundedString<99U> c{};
    mamori::BoundedString<100U> d{};
    mamori::BoundedString<1234U> e{};
};
/// A struct in a struct in a struct.
struct Middle {
    One one{};
};
struct Outer {
    Middle middle{};
};
struct Clash {
    std::int32_t n_values{0};
    mamori::BoundedSequence<std::int16_t, 2U> values{};
};

}  // namespace lcm_codec_test

MAMORI_LAST_ENUMERATOR(lcm_codec_test::Colour, kGreen)
MAMORI_FIELDS(lcm_codec_test::Small, is_on, colour, values, name)
MAMORI_LCM_NAMES(lcm_codec_test::Small, is_on, colour, values, name)
MAMORI_LCM_FIELDS(lcm_codec_test::Renamed, is_off, colour, values, name)
MAMORI_LCM_FIELDS(lcm_codec_test::One, octet)
MAMORI_LCM_FIELDS(lcm_codec_test::Limits, a, b, c, d, e)
MAMORI_LCM_FIELDS(lcm_codec_test::Middle, one)
MAMORI_LCM_FIELDS(lcm_codec_test::Outer, middle)
MAMORI_LCM_FIELDS(lcm_codec_test::Clash, n_values, values)
MAMORI_LCM_NAMES(lcm_codec_test::Joints, tm, data)

namespace mamori::ports::lcm {
namespace {

using lcm_codec_test::Colour;
using lcm_codec_test::Small;
using namespace verification;

using Octets = std::vector<std::byte>;

Small make_small() {
    Small value{};
    value.is_on = true;
    value.colour = Colour::kGreen;
    value.values = std::array<std::int16_t, 2U>{0x0102, -2};
    value.name = "ab";
    return value;
}

template <typename T>
Octets encode_all(const T& value) {
    Octets octets(kLcmSizeMax<T>);
    const Result<std::size_t> size = encode_lcm(value, {octets.data(), octets.size()});
    EXPECT_TRUE(size.has_value());
    octets.resize(size.has_value() ? size.get_value() : 0U);
    return octets;
}

Status decode_small(const Octets& octets, Small& value) {
    return decode_lcm({octets.data(), octets.size()}, value);
}

/// Octet `index` after the fingerprint.
constexpr std::size_t at(std::size_t index) {
    return kFingerprintSize + index;
}

TEST(LcmCodecTest, FieldsFollowTheFingerprintMostSignificantOctetFirstWithoutPadding) {
    verifies("SWR-LCM-003", Technique::kRequirementsBased, Polarity::kNominal);
    const Octets octets = encode_all(make_small());

    const std::array<int, 20U> body{1, 0, 0, 0, 1, 0, 0, 0, 2, 1, 2, 0xFF, 0xFE, 0, 0, 0, 3, 'a', 'b', 0};
    ASSERT_EQ(octets.size(), kFingerprintSize + body.size());
    for (std::size_t i = 0U; i < body.size(); ++i) {
        EXPECT_EQ(std::to_integer<int>(octets[at(i)]), body[i]) << i;
    }
    static_assert(kLcmSizeMax<Small> == 8U + 1U + 4U + 4U + 4U + 4U + 4U);
    static_assert(kLcmSizeMin<Small> == 8U + 1U + 4U + 4U + 4U + 1U);
}

TEST(LcmCodecTest, AShortBufferOrAnInvalidEnumerationLeavesTheBufferUnchanged) {
    verifies("SWR-LCM-003", Technique::kBoundaryValues, Polarity::kViolation);
    const std::size_t size = encode_all(make_small()).size();
    Octets buffer(size + 2U, std::byte{0xA5});
    const Octets before = buffer;

    for (std::size_t length = 0U; length < size; ++length) {
        EXPECT_EQ(encode_lcm(make_small(), {buffer.data(), length}).get_status(), Status::kOutOfResources);
    }
    Small invalid = make_small();
    invalid.colour = static_cast<Colour>(2);
    EXPECT_EQ(encode_lcm(invalid, {buffer.data(), buffer.size()}).get_status(), Status::kBadParameter);
    EXPECT_EQ(buffer, before);

    ASSERT_TRUE(encode_lcm(make_small(), {buffer.data(), size}).has_value());
    EXPECT_EQ(buffer[size], std::byte{0xA5});
}

TEST(LcmCodecTest, ADecodedMessageHasTheValuesOfTheSender) {
    verifies("SWR-LCM-004", Technique::kRequirementsBased, Polarity::kNominal);
    Small value{};
    ASSERT_EQ(decode_small(encode_all(make_small()), value), Status::kOk);

    EXPECT_TRUE(value.is_on);
    EXPECT_EQ(value.colour, Colour::kGreen);
    EXPECT_EQ(value.values, make_small().values);
    EXPECT_EQ(value.name, make_small().name);
}

TEST(LcmCodecTest, TruncatedAndExtendedMessagesAreRejectedWithoutAChange) {
    verifies("SWR-LCM-004", Technique::kBoundaryValues, Polarity::kViolation);
    const Octets good = encode_all(make_small());
    Small value{};

    for (std::size_t length = 0U; length < good.size(); ++length) {
        // A copy of exactly this length, so that the address sanitizer sees each octet that is read behind
        // it.
        const Octets truncated(good.data(), good.data() + length);
        EXPECT_EQ(decode_small(truncated, value), Status::kBadParameter) << length;
    }
    Octets longer = good;
    longer.push_back(std::byte{0});
    EXPECT_EQ(decode_small(longer, value), Status::kBadParameter);
    EXPECT_EQ(encode_all(value), encode_all(Small{}));
}

/// Memory whose last octet is followed by a page that ends the program when it is read.
class GuardedMemory final {
  public:
    GuardedMemory() {
        EXPECT_NE(pages_, MAP_FAILED);
        EXPECT_EQ(::mprotect(static_cast<std::byte*>(pages_) + size_, size_, PROT_NONE), 0);
    }
    GuardedMemory(const GuardedMemory&) = delete;
    GuardedMemory& operator=(const GuardedMemory&) = delete;
    ~GuardedMemory() { EXPECT_EQ(::munmap(pages_, 2U * size_), 0); }
    /// @return the first `length` octets at the end of the memory.
    Span<const std::byte> put(const Octets& octets, std::size_t length) {
        std::byte* const begin = static_cast<std::byte*>(pages_) + (size_ - length);
        std::copy_n(octets.begin(), length, begin);
        return {begin, length};
    }

  private:
    std::size_t size_{static_cast<std::size_t>(::sysconf(_SC_PAGESIZE))};
    void* pages_{::mmap(nullptr, 2U * size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)};
};

template <typename T>
void expect_no_truncated_message() {
    GuardedMemory memory;
    std::mt19937_64 random(13U);
    for (int i = 0; i < 20; ++i) {
        const Octets good = encode_all(lcm_sample::make_random<T>(random));
        T value{};
        for (std::size_t length = 0U; length < good.size(); ++length) {
            ASSERT_EQ(decode_lcm(memory.put(good, length), value), Status::kBadParameter) << length;
        }
        ASSERT_EQ(encode_all(value), encode_all(T{}));
        ASSERT_EQ(decode_lcm(memory.put(good, good.size()), value), Status::kOk);
    }
}

TEST(LcmCodecTest, ATruncatedMessageOfAnyTypeIsRejectedWithoutReadingAfterIt) {
    verifies("SWR-LCM-004", Technique::kBoundaryValues, Polarity::kViolation);
    expect_no_truncated_message<lcm_sample::Reading>();
    expect_no_truncated_message<lcm_sample::Robot>();
    expect_no_truncated_message<lcm_sample::Cloud>();
}

TEST(LcmCodecTest, ARejectedMessageDoesNotChangeAValueThatIsNotEmpty) {
    verifies("SWR-LCM-004", Technique::kBoundaryValues, Polarity::kViolation);
    const Small other{};
    const Octets empty = encode_all(other);
    // A sequence of 3 numbers, limit 2; a string of 4 characters, limit 3: consistent in all octets.
    Octets long_sequence = empty;
    long_sequence[at(8U)] = std::byte{3};
    long_sequence.insert(long_sequence.begin() + static_cast<std::ptrdiff_t>(at(9U)), 6U, std::byte{1});
    Octets long_string = empty;
    long_string[at(12U)] = std::byte{5};
    long_string.insert(long_string.begin() + static_cast<std::ptrdiff_t>(at(13U)), 4U, std::byte{'a'});
    Octets longer = empty;
    longer.push_back(std::byte{0});

    for (const Octets& invalid : {long_sequence, long_string, longer}) {
        Small value = make_small();
        EXPECT_EQ(decode_small(invalid, value), Status::kBadParameter);
        EXPECT_EQ(encode_all(value), encode_all(make_small()));
    }
    Small value = make_small();
    EXPECT_EQ(decode_small(empty, value), Status::kOk);
    EXPECT_EQ(encode_all(value), empty);
}

TEST(LcmCodecTest, AnInvalidBooleanAfterOtherFieldsDoesNotChangeThem) {
    verifies("SWR-LCM-004", Technique::kEquivalenceClasses, Polarity::kViolation);
    lcm_sample::Reading sent{};
    sent.a = 1;
    Octets octets = encode_all(sent);
    octets[octets.size() - 5U] = std::byte{2};  // the field before the last
    lcm_sample::Reading value{};

    EXPECT_EQ(decode_lcm({octets.data(), octets.size()}, value), Status::kBadParameter);
    EXPECT_EQ(value.a, 0);
}

TEST(LcmCodecTest, AnInvalidEnumerationBehindAValidOneIsNotEncoded) {
    verifies("SWR-LCM-003", Technique::kEquivalenceClasses, Polarity::kViolation);
    lcm_sample::Robot invalid{};
    invalid.modes[2] = static_cast<lcm_sample::Mode>(3);
    Octets buffer(kLcmSizeMax<lcm_sample::Robot>);

    EXPECT_EQ(encode_lcm(invalid, {buffer.data(), buffer.size()}).get_status(), Status::kBadParameter);
}

TEST(LcmCodecTest, TheShortestMessageLeavesTheOctetsAfterItUnchanged) {
    verifies("SWR-LCM-003", Technique::kBoundaryValues, Polarity::kNominal);
    Octets buffer(32U, std::byte{0xA5});

    ASSERT_EQ(encode_lcm(lcm_codec_test::One{}, {buffer.data(), buffer.size()}).get_value(), at(1U));
    EXPECT_EQ(Octets(buffer.begin() + static_cast<std::ptrdiff_t>(at(1U)), buffer.end()),
              Octets(32U - at(1U), std::byte{0xA5}));
}

/// The writer itself, because the functions for users measure a message before they write it.
TEST(LcmCodecTest, AWriterChecksItsBuffer) {
    verifies("SWR-LCM-003", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<std::byte, 12U> buffer{};
    const std::array<std::uint32_t, 13U> numbers{};

    detail::LcmWriter whole({buffer.data(), buffer.size()});
    EXPECT_TRUE(whole.run(numbers.data(), 2U));
    EXPECT_TRUE(whole.run(numbers.data(), 1U));
    EXPECT_EQ(whole.get_position(), buffer.size());
    EXPECT_CHECK_FAILS(static_cast<void>(whole.run(numbers.data(), 1U)), "codec.hpp", 1);
    detail::LcmWriter other({buffer.data(), buffer.size()});
    EXPECT_CHECK_FAILS(static_cast<void>(other.run(numbers.data(), 4U)), "codec.hpp", 1);
}

TEST(LcmCodecTest, AMessageOfAnotherTypeIsRejectedByItsFingerprint) {
    verifies("SWR-LCM-004", Technique::kEquivalenceClasses, Polarity::kViolation);
    Small value{};
    const Octets other = encode_all(lcm_codec_test::Renamed{});
    ASSERT_EQ(other.size(), encode_all(Small{}).size());

    EXPECT_EQ(decode_small(other, value), Status::kUnsupported);
    EXPECT_EQ(decode_small(Octets(kFingerprintSize), value), Status::kUnsupported);
    EXPECT_EQ(decode_small(Octets(kFingerprintSize - 1U), value), Status::kBadParameter);
}

TEST(LcmCodecTest, InvalidContentIsRejectedWithoutAChange) {
    verifies("SWR-LCM-004", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Octets good = encode_all(make_small());
    struct Case {
        std::size_t place;
        int octet;
    };
    // Boolean 2; enumeration 2 and 0x01000001; length 3 and a negative length; string length 0 and 5; NUL
    // inside, no NUL at the end.
    const std::array<Case, 9U> cases{{{at(0U), 2},
                                      {at(4U), 2},
                                      {at(1U), 1},
                                      {at(8U), 3},
                                      {at(5U), 0x80},
                                      {at(16U), 0},
                                      {at(16U), 5},
                                      {at(17U), 0},
                                      {at(19U), 'c'}}};
    for (const Case& invalid : cases) {
        Octets octets = good;
        octets[invalid.place] = std::byte(invalid.octet);
        Small value{};
        EXPECT_EQ(decode_small(octets, value), Status::kBadParameter) << invalid.place;
        EXPECT_EQ(encode_all(value), encode_all(Small{})) << invalid.place;
    }
}

TEST(LcmCodecTest, AStringWithoutRoomForItsNulIsRejectedAtTheEndOfAMessage) {
    verifies("SWR-LCM-004", Technique::kBoundaryValues, Polarity::kViolation);
    Octets octets = encode_all(Small{});
    octets.pop_back();
    octets.back() = std::byte{0};  // length 0
    Small value{};

    EXPECT_EQ(decode_small(octets, value), Status::kBadParameter);
}

TEST(LcmCodecTest, RandomOctetsNeverGiveAValueThatEncodesDifferently) {
    verifies("SWR-LCM-004", Technique::kErrorGuessing, Polarity::kViolation);
    std::mt19937_64 random(7U);
    int accepted = 0;
    for (int i = 0; i < 20'000; ++i) {
        Octets octets = encode_all(lcm_sample::make_random<lcm_sample::Cloud>(random));
        for (std::uint64_t flips = random() % 3U; flips > 0U; --flips) {
            octets[kFingerprintSize + random() % (octets.size() - kFingerprintSize)] =
                std::byte(random() % 4U);
        }
        octets.resize(octets.size() - random() % 2U);
        lcm_sample::Cloud value{};
        if (decode_lcm({octets.data(), octets.size()}, value) == Status::kOk) {
            ++accepted;
            ASSERT_EQ(encode_all(value), octets) << i;
        }
    }
    EXPECT_GT(accepted, 1000);
}

TEST(LcmTypeTest, TheTextNamesPackageStructFieldsLengthsAndLimits) {
    verifies("SWR-LCM-001", Technique::kRequirementsBased, Polarity::kNominal);
    std::array<char, 512U> text{};
    const Result<std::size_t> size = write_lcm_text<Small>({text.data(), text.size()});
    ASSERT_TRUE(size.has_value());

    EXPECT_EQ(
        std::string(text.data(), size.get_value()),
        "// Made by Mamori from the field list of lcm_codec_test::Small. Change that list, not this file.\n"
        "package lcm_codec_test;\n\n"
        "struct Small {\n"
        "    boolean is_on;\n"
        "    int32_t colour;  // 0 .. 1\n"
        "    int32_t n_values;  // 0 .. 2\n"
        "    int16_t values[n_values];\n"
        "    string name;  // up to 3 characters\n"
        "}\n");
}

TEST(LcmTypeTest, LimitsOfAnyNumberOfDigitsAreInTheText) {
    verifies("SWR-LCM-001", Technique::kBoundaryValues, Polarity::kNominal);
    std::array<char, 512U> buffer{};
    const std::size_t size =
        write_lcm_text<lcm_codec_test::Limits>({buffer.data(), buffer.size()}).get_value();
    const std::string text(buffer.data(), size);

    EXPECT_NE(text.find("    string a;  // up to 9 characters\n"
                        "    string b;  // up to 10 characters\n"
                        "    string c;  // up to 99 characters\n"
                        "    string d;  // up to 100 characters\n"
                        "    string e;  // up to 1234 characters\n"),
              std::string::npos)
        << text;
}

TEST(LcmTypeTest, StructsInStructsComeBeforeThemAtEachDepth) {
    verifies("SWR-LCM-001", Technique::kRequirementsBased, Polarity::kNominal);
    struct NameList {
        std::string names{};
        void operator()(mamori::detail::TypeList<lcm_codec_test::One> /*type*/) { names += "One "; }
        void operator()(mamori::detail::TypeList<lcm_codec_test::Middle> /*type*/) { names += "Middle "; }
        void operator()(mamori::detail::TypeList<lcm_codec_test::Outer> /*type*/) { names += "Outer "; }
    };
    NameList list{};
    for_each_lcm_struct<lcm_codec_test::Outer>(list);

    EXPECT_EQ(list.names, "One Middle Outer ");
}

TEST(LcmTypeTest, TimedTypesOfRtMiddlewareHaveNames) {
    verifies("SWR-LCM-001", Technique::kRequirementsBased, Polarity::kNominal);
    std::array<char, 512U> buffer{};
    const std::size_t size =
        write_lcm_text<lcm_codec_test::Joints>({buffer.data(), buffer.size()}).get_value();
    const std::string text(buffer.data(), size);
    EXPECT_NE(text.find("package lcm_codec_test;\n\nstruct Joints {\n    mamori.rtc.Time tm;\n"
                        "    int32_t n_data;  // 0 .. 7\n    double data[n_data];\n}\n"),
              std::string::npos)
        << text;

    rtc::TimedDouble sent{};
    sent.tm = {1U, 2U};
    sent.data = 0.5;
    rtc::TimedDouble received{};
    const Octets octets = encode_all(sent);
    ASSERT_EQ(decode_lcm({octets.data(), octets.size()}, received), Status::kOk);
    EXPECT_EQ(received.tm.nsec, 2U);
    EXPECT_EQ(received.data, 0.5);
}

TEST(LcmTypeTest, ATextThatDoesNotFitAndAClashOfNamesAreDetected) {
    verifies("SWR-LCM-001", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<char, 512U> text{};
    const std::size_t size = write_lcm_text<Small>({text.data(), text.size()}).get_value();

    text[size - 1U] = '#';
    EXPECT_EQ(write_lcm_text<Small>({text.data(), size - 1U}).get_status(), Status::kOutOfResources);
    EXPECT_EQ(text[size - 1U], '#');
    EXPECT_EQ(write_lcm_text<Small>({text.data(), size}).get_value(), size);
    static_assert(detail::has_name_clash<lcm_codec_test::Clash>({}));
    static_assert(!detail::has_name_clash<Small>({}));
    static_assert(detail::has_name_clash<Small>("name"));
}

TEST(LcmTypeTest, APrinterThatCannotWriteReportsAnError) {
    verifies("SWR-LCM-001", Technique::kFaultInjection, Polarity::kViolation);
    static TypePrinter printer(-1);
    printer.add<Small>();

    EXPECT_EQ(printer.get_status(), Status::kError);
}

}  // namespace
}  // namespace mamori::ports::lcm
