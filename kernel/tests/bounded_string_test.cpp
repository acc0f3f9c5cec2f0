// SPDX-License-Identifier: Apache-2.0
// Goal: a string holds up to its bound, is always closed by NUL, and holds none inside.
// Method: both sides of the bound, NUL in every place, comparison, constant expressions.
#include "mamori/kernel/payload/bounded_string.hpp"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"

namespace mamori {
namespace {

using namespace verification;

using Three = BoundedString<3>;
static_assert(std::is_trivially_copyable_v<Three>);
static_assert(Three::capacity() == 3U && Three("abc").size() == 3U && Three("abc")[2] == 'c');

Span<const char> view(const std::string& text) {
    return {text.data(), text.size()};
}

TEST(BoundedStringTest, TextComesBackAndIsClosed) {
    verifies("SWR-CDR-003");
    Three sut;

    EXPECT_TRUE(sut.empty());
    EXPECT_STREQ(sut.c_str(), "");
    EXPECT_EQ(sut.assign(view("ab")), Status::kOk);
    EXPECT_EQ(sut.push_back('c'), Status::kOk);
    EXPECT_FALSE(sut.empty());
    EXPECT_STREQ(sut.c_str(), "abc");
    EXPECT_EQ(std::string(sut.begin(), sut.end()), "abc");
    EXPECT_EQ(sut.assign(view("x")), Status::kOk);
    EXPECT_STREQ(sut.c_str(), "x");
    sut.clear();
    EXPECT_STREQ(sut.c_str(), "");
}

TEST(BoundedStringTest, AFullStringTakesNoMore) {
    verifies("SWR-CDR-003", Technique::kBoundaryValues, Polarity::kViolation);
    Three sut = "ab";

    EXPECT_EQ(sut.assign(view("abcd")), Status::kOutOfResources);
    EXPECT_STREQ(sut.c_str(), "ab");
    EXPECT_EQ(sut.assign(view("xyz")), Status::kOk);
    EXPECT_EQ(sut.push_back('c'), Status::kOutOfResources);
    EXPECT_STREQ(sut.c_str(), "xyz");
}

TEST(BoundedStringTest, NoNulComesInside) {
    verifies("SWR-CDR-003", Technique::kErrorGuessing, Polarity::kViolation);
    Three sut = "ab";

    EXPECT_EQ(sut.push_back('\0'), Status::kBadParameter);
    for (std::size_t place = 0U; place < 3U; ++place) {
        std::string text = "xyz";
        text[place] = '\0';
        EXPECT_EQ(sut.assign(view(text)), Status::kBadParameter) << place;
    }
    EXPECT_STREQ(sut.c_str(), "ab");
    EXPECT_EQ(Three("a\0b").size(), 1U) << "a literal ends at its first NUL";
}

TEST(BoundedStringTest, APartOfItselfCanBeAssigned) {
    verifies("SWR-CDR-003", Technique::kErrorGuessing);
    Three sut = "abc";

    EXPECT_EQ(sut.assign(Span<const char>(sut.c_str() + 1, 2U)), Status::kOk);
    EXPECT_STREQ(sut.c_str(), "bc");
}

TEST(BoundedStringTest, OnlyCharactersInUseAreCompared) {
    verifies("SWR-CDR-004", Technique::kErrorGuessing);
    Three cut = "abc";
    ASSERT_EQ(cut.assign(view("a")), Status::kOk);

    EXPECT_TRUE(cut == "a");
    EXPECT_TRUE(cut != "b");
    EXPECT_TRUE(cut != "ab");
    EXPECT_TRUE(cut != "");
}

TEST(BoundedStringDeathTest, ACharacterBehindTheEndIsOutOfReach) {
    verifies("SWR-CDR-003", Technique::kBoundaryValues, Polarity::kViolation);
    const Three sut = "ab";
    const char open[2] = {'a', 'b'};

    EXPECT_EQ(sut[1], 'b');
    EXPECT_CHECK_FAILS(static_cast<void>(sut[2]), "bounded_string.hpp", 1);
    EXPECT_CHECK_FAILS(static_cast<void>(Three(open)), "bounded_string.hpp", 2);
}

}  // namespace
}  // namespace mamori
