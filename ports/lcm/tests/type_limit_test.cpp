// SPDX-License-Identifier: Apache-2.0
// Goal: a printer keeps its limits, and a text is printed whole or reported as incomplete. Method: structs
// numbered by a template, a field whose name fills the text to the limit; a pipe that takes a part of a text,
// and a file that may have one octet.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <utility>

#include "mamori/ports/lcm/type_printer.hpp"
#include "mamori/trace/verifies.hpp"
#include "support/interrupted_call.hpp"
#include "support/sample_types.hpp"
#include "support/text_file.hpp"

namespace lcm_limit {

/// One of many structs.
template <int kNumber>
struct Numbered {
    std::int32_t value{0};
};
/// The name of the field has `kSize` characters.
template <std::size_t kSize>
struct Named {
    std::int32_t value{0};
};

/// `n::T` and three digits.
template <int kNumber>
inline constexpr std::array<char, 8U> kTypeName{
    'n', ':', ':', 'T', '0' + kNumber / 100, '0' + kNumber / 10 % 10, '0' + kNumber % 10, '\0'};

template <std::size_t kSize>
constexpr std::array<char, kSize + 1U> make_field_name() {
    std::array<char, kSize + 1U> name{};
    for (std::size_t i = 0U; i < kSize; ++i) {
        name[i] = 'a';
    }
    return name;
}
template <std::size_t kSize>
inline constexpr std::array<char, kSize + 1U> kFieldName = make_field_name<kSize>();

struct OneValue {
    static constexpr bool kDeclared = true;
    template <typename Self, typename Call>
    static constexpr decltype(auto) apply(Self& self, Call&& call) noexcept {
        return call(self.value);
    }
};

}  // namespace lcm_limit

template <int kNumber>
struct mamori::Fields<lcm_limit::Numbered<kNumber>> : lcm_limit::OneValue {};
template <std::size_t kSize>
struct mamori::Fields<lcm_limit::Named<kSize>> : lcm_limit::OneValue {};
template <int kNumber>
struct mamori::ports::lcm::LcmNames<lcm_limit::Numbered<kNumber>> {
    static constexpr bool kDeclared = true;
    static constexpr const char* kType = lcm_limit::kTypeName<kNumber>.data();
    static constexpr const char* kFields = "value";
};
template <std::size_t kSize>
struct mamori::ports::lcm::LcmNames<lcm_limit::Named<kSize>> {
    static constexpr bool kDeclared = true;
    static constexpr const char* kType = "n::Named";
    static constexpr const char* kFields = lcm_limit::kFieldName<kSize>.data();
};

namespace mamori::ports::lcm {
namespace {

using lcm_limit::Named;
using lcm_limit::Numbered;
using lcm_sample::count_parts;
using lcm_sample::OneOctetScope;
using lcm_sample::SignalScope;
using lcm_sample::wait_until;
using lcm_sample::inner::Point;
using namespace verification;

constexpr int kStructs = 256;
constexpr std::size_t kText = 16384U;

/// Characters of the text of a Named struct without the name of its field.
constexpr std::size_t calc_other_characters() {
    std::array<char, 512U> text{};
    return write_lcm_text<Named<1U>>({text.data(), text.size()}).get_value() - 1U;
}
using Longest = Named<kText - calc_other_characters()>;
using TooLong = Named<kText + 1U - calc_other_characters()>;

class TypeLimitTest : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(file_.is_open()); }
    template <int... kNumber>
    void add_all(std::integer_sequence<int, kNumber...> /*numbers*/) {
        (printer_.add<Numbered<kNumber>>(), ...);
    }

    lcm_sample::TextFile file_;
    TypePrinter printer_{file_.get_file()};
};

TEST_F(TypeLimitTest, OneStructMoreThanTheLimitIsReportedAndNotPrinted) {
    verifies("SWR-LCM-001", Technique::kBoundaryValues, Polarity::kViolation);
    add_all(std::make_integer_sequence<int, kStructs>{});
    EXPECT_EQ(printer_.get_status(), Status::kOk);
    EXPECT_EQ(count_parts(file_.read(), "struct "), kStructs);

    printer_.add<Numbered<kStructs>>();
    EXPECT_EQ(printer_.get_status(), Status::kOutOfResources);
    EXPECT_EQ(count_parts(file_.read(), "struct "), kStructs);
}

TEST_F(TypeLimitTest, ATextOfOneCharacterMoreThanTheLimitIsReportedAndNotPrinted) {
    verifies("SWR-LCM-001", Technique::kBoundaryValues, Polarity::kViolation);
    printer_.add<Longest>();
    EXPECT_EQ(printer_.get_status(), Status::kOk);
    EXPECT_EQ(file_.read().size(), kText);

    TypePrinter other(file_.get_file());
    other.add<TooLong>();
    EXPECT_EQ(other.get_status(), Status::kOutOfResources);
    EXPECT_EQ(file_.read().size(), kText);
}

/// Standard output is `file` while it exists.
class OutputScope final {
  public:
    explicit OutputScope(int file) {
        static_cast<void>(std::fflush(stdout));
        EXPECT_EQ(::dup2(file, STDOUT_FILENO), STDOUT_FILENO);
    }
    OutputScope(const OutputScope&) = delete;
    OutputScope& operator=(const OutputScope&) = delete;
    ~OutputScope() {
        EXPECT_EQ(::dup2(before_, STDOUT_FILENO), STDOUT_FILENO);
        EXPECT_EQ(::close(before_), 0);
    }

  private:
    int before_{::dup(STDOUT_FILENO)};
};

TEST_F(TypeLimitTest, AProgramPrintsItsTypesToTheStandardOutputAndFailsIfItIsIncomplete) {
    verifies("SWR-LCM-001", Technique::kFaultInjection, Polarity::kViolation);
    const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    int printed = -1;
    int incomplete = -1;
    {
        const OutputScope output(file_.get_file());
        printed = print_lcm_types<Point, Numbered<0>>();
    }
    {
        const OutputScope output(full);
        incomplete = print_lcm_types<Point, Numbered<1>>();
    }
    EXPECT_EQ(::close(full), 0);

    EXPECT_EQ(printed, 0);
    EXPECT_EQ(count_parts(file_.read(), "struct Point {"), 1);
    EXPECT_EQ(count_parts(file_.read(), "struct T000 {"), 1);
    EXPECT_EQ(incomplete, 1);
}

TEST_F(TypeLimitTest, AnOutputThatTakesATextInPartsGetsAllOfIt) {
    verifies("SWR-LCM-001", Technique::kFaultInjection, Polarity::kNominal);
    std::array<int, 2U> ends{};
    ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
    const int room = ::fcntl(ends[1], F_SETPIPE_SZ, 4096);
    ASSERT_GT(room, 0);
    ASSERT_LT(room, static_cast<int>(kText));
    const SignalScope scope(SIGUSR1);
    std::string text;
    std::atomic<bool> is_done{false};
    // A signal ends the call that waits at the full pipe. The pipe is read after the call has returned.
    std::thread reader([&text, &ends, &is_done, room, writer = ::pthread_self()] {
        int waiting = 0;
        EXPECT_TRUE(wait_until(
            [&] { return is_done || (::ioctl(ends[0], FIONREAD, &waiting) == 0 && waiting == room); }));
        EXPECT_EQ(::pthread_kill(writer, SIGUSR1), 0);
        EXPECT_TRUE(wait_until([] { return SignalScope::count != 0; }));
        std::array<char, 4096U> part{};
        for (ssize_t size = 1; size > 0;) {
            size = ::read(ends[0], part.data(), part.size());
            text.append(part.data(), size > 0 ? static_cast<std::size_t>(size) : 0U);
        }
    });
    TypePrinter printer(ends[1]);
    printer.add<Longest>();
    is_done = true;
    EXPECT_EQ(::close(ends[1]), 0);
    reader.join();
    EXPECT_EQ(::close(ends[0]), 0);

    EXPECT_EQ(printer.get_status(), Status::kOk);
    EXPECT_EQ(SignalScope::count, 1);
    printer_.add<Longest>();
    EXPECT_EQ(text, file_.read());
}

TEST_F(TypeLimitTest, AfterARefusedPartNothingMoreIsWrittenAndTheOutputIsReported) {
    verifies("SWR-LCM-001", Technique::kFaultInjection, Polarity::kViolation);
    {
        const OneOctetScope scope;
        printer_.add<Point>();
    }

    EXPECT_EQ(SignalScope::count, 1);  // the second part
    EXPECT_EQ(printer_.get_status(), Status::kError);
    EXPECT_EQ(file_.read(), "/");
}

}  // namespace
}  // namespace mamori::ports::lcm
