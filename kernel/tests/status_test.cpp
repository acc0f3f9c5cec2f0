// SPDX-License-Identifier: Apache-2.0
// Goal: the return codes are those of the standard, and a missing value cannot be taken for a present one.
#include "mamori/kernel/base/status.hpp"

#include <string>

#include "mamori/trace/verifies.hpp"

namespace mamori {
namespace {

using namespace verification;

TEST(StatusTest, NumbersAndNamesAreThoseOfTheRtcStandard) {
    verifies("SWR-KRN-001", Technique::kInterface);

    EXPECT_EQ(static_cast<std::uint32_t>(Status::kOk), 0U);
    EXPECT_EQ(static_cast<std::uint32_t>(Status::kError), 1U);
    EXPECT_EQ(static_cast<std::uint32_t>(Status::kBadParameter), 2U);
    EXPECT_EQ(static_cast<std::uint32_t>(Status::kUnsupported), 3U);
    EXPECT_EQ(static_cast<std::uint32_t>(Status::kOutOfResources), 4U);
    EXPECT_EQ(static_cast<std::uint32_t>(Status::kPreconditionNotMet), 5U);
    EXPECT_EQ(std::string(get_name(Status::kOk)), "RTC_OK");
    EXPECT_EQ(std::string(get_name(Status::kError)), "RTC_ERROR");
    EXPECT_EQ(std::string(get_name(Status::kBadParameter)), "BAD_PARAMETER");
    EXPECT_EQ(std::string(get_name(Status::kUnsupported)), "UNSUPPORTED");
    EXPECT_EQ(std::string(get_name(Status::kOutOfResources)), "OUT_OF_RESOURCES");
    EXPECT_EQ(std::string(get_name(Status::kPreconditionNotMet)), "PRECONDITION_NOT_MET");
}

TEST(StatusTest, ACorruptedCodeHasANameThatSaysSo) {
    verifies("SWR-KRN-001", Technique::kErrorGuessing, Polarity::kViolation);

    EXPECT_EQ(std::string(get_name(static_cast<Status>(6U))), "INVALID_STATUS");
}

TEST(StatusTest, ResultNeverReportsSuccessWithoutAValue) {
    verifies("SWR-KRN-001", Technique::kErrorGuessing, Polarity::kViolation);

    const Result<int> built_from_ok{Status::kOk};
    EXPECT_FALSE(built_from_ok.has_value());
    EXPECT_EQ(built_from_ok.get_status(), Status::kError);
    EXPECT_EQ(Result<int>{Status::kBadParameter}.get_status(), Status::kBadParameter);
    EXPECT_TRUE(Result<int>{7}.has_value());
}

}  // namespace
}  // namespace mamori
