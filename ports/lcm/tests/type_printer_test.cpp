// SPDX-License-Identifier: Apache-2.0
// Goal: a program prints the text of each of its types once, and reports an incomplete output. Method: the
// sample types, printed into a file; the helpers of the names at run time.
#include "mamori/ports/lcm/type_printer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <string>
#include <string_view>

#include "mamori/trace/verifies.hpp"
#include "support/sample_types.hpp"
#include "support/text_file.hpp"

namespace mamori::ports::lcm {
namespace {

using namespace verification;

class TypePrinterTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(file_.is_open()); }
    int get_file() const { return file_.get_file(); }
    std::string read() const { return file_.read(); }
    static int count(const std::string& text, const std::string& part) {
        return lcm_sample::count_parts(text, part);
    }

    lcm_sample::TextFile file_;
};

TEST_F(TypePrinterTest, EachStructIsPrintedOnceAfterTheStructsInIt) {
    verifies("SWR-LCM-001", Technique::kRequirementsBased, Polarity::kNominal);
    TypePrinter printer(get_file());
    printer.add<lcm_sample::Robot>();
    printer.add<lcm_sample::Cloud>();
    printer.add<lcm_sample::Robot>();
    EXPECT_EQ(printer.get_status(), Status::kOk);

    const std::string text = read();
    EXPECT_EQ(text.rfind("// Made by Mamori from the field list of lcm_sample::inner::Point.", 0U), 0U);
    for (const char* name : {"struct Point {", "struct Robot {", "struct Reading {", "struct Cloud {"}) {
        EXPECT_EQ(count(text, name), 1) << name;
    }
    EXPECT_LT(text.find("struct Point {"), text.find("struct Robot {"));
    EXPECT_LT(text.find("struct Reading {"), text.find("struct Cloud {"));
    EXPECT_EQ(count(text, "package lcm_sample.inner;"), 1);
    EXPECT_EQ(count(text, "    float matrix[2][3];\n"), 1);
    EXPECT_EQ(count(text, "    string name;  // up to 12 characters\n"), 1);
    EXPECT_EQ(count(text, "    int32_t m;  // 0 .. 2\n"), 1);
}

TEST_F(TypePrinterTest, AProtectedMessageHasItsHeaderBeforeTheFields) {
    verifies("SWR-LCM-001", Technique::kRequirementsBased, Polarity::kNominal);
    TypePrinter printer(get_file());
    printer.add<lcm_sample::CloudMessage>();
    EXPECT_EQ(printer.get_status(), Status::kOk);

    const std::string text = read();
    EXPECT_EQ(count(text, "struct Cloud_e2e {\n    byte e2e[12];\n"), 1);
    EXPECT_EQ(count(text, "struct Cloud {"), 0);
    EXPECT_EQ(count(text, "struct Reading {"), 1);
}

TEST_F(TypePrinterTest, AnOutputThatCannotBeWrittenIsReported) {
    verifies("SWR-LCM-001", Technique::kFaultInjection, Polarity::kViolation);
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    TypePrinter printer(full);
    printer.add<lcm_sample::inner::Point>();

    EXPECT_EQ(printer.get_status(), Status::kError);
    EXPECT_EQ(::close(full), 0);
}

TEST_F(TypePrinterTest, ABufferThatIsTooSmallForTheTextIsReported) {
    verifies("SWR-LCM-001", Technique::kBoundaryValues, Polarity::kViolation);
    std::array<char, 4096U> text{};
    const Result<std::size_t> size = write_lcm_text<lcm_sample::inner::Point>({text.data(), text.size()});
    ASSERT_TRUE(size.has_value());

    EXPECT_TRUE(write_lcm_text<lcm_sample::inner::Point>({text.data(), size.get_value()}).has_value());
    EXPECT_EQ(write_lcm_text<lcm_sample::inner::Point>({text.data(), size.get_value() - 1U}).get_status(),
              Status::kOutOfResources);
}

TEST(TypeNamesTest, NamesOfAListAreFoundWithoutTheSpacesAroundThem) {
    verifies("SWR-LCM-001", Technique::kEquivalenceClasses, Polarity::kNominal);
    EXPECT_EQ(detail::trim("  a b  "), "a b");
    EXPECT_EQ(detail::trim("   "), "");
    EXPECT_EQ(detail::trim(""), "");
    const std::string_view list = " first, second ,third";
    EXPECT_EQ(detail::get_listed(list, 0U), "first");
    EXPECT_EQ(detail::get_listed(list, 1U), "second");
    EXPECT_EQ(detail::get_listed(list, 2U), "third");
    EXPECT_EQ(detail::get_listed(list, 3U), "");
    EXPECT_EQ(detail::get_listed(list, 9U), "");
    EXPECT_EQ(detail::count_listed(list), 3U);
    EXPECT_EQ(detail::count_listed("one"), 1U);
}

TEST(TypeNamesTest, ATypeIsNamedWithoutTheGlobalNamespace) {
    verifies("SWR-LCM-001", Technique::kEquivalenceClasses, Polarity::kNominal);
    EXPECT_EQ(detail::get_spelled("::ns::Type"), "ns::Type");
    EXPECT_EQ(detail::get_spelled("ns::Type"), "ns::Type");
    EXPECT_TRUE(detail::is_length_name_of("n_values", "values"));
    EXPECT_FALSE(detail::is_length_name_of("n_values", "value"));
    EXPECT_FALSE(detail::is_length_name_of("m_values", "values"));
}

}  // namespace
}  // namespace mamori::ports::lcm
