// SPDX-License-Identifier: Apache-2.0
// Goal: each field of a long list can end a decoding by itself, and neither direction touches memory outside
// or makes up a value when somebody else changes its input between its two passes.
// Method: every cut of forty fields; payloads whose field list disturbs on purpose when it is walked again.
#include <gtest/gtest.h>

#include <cstdint>

#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/trace/verifies.hpp"
#include "mamori/verification/failed_check.hpp"
#include "support/cdr_checks.hpp"

namespace mamori {
namespace {

struct Forty {
    std::uint8_t a0, a1, a2, a3, a4, a5, a6, a7, a8, a9;
    std::uint8_t b0, b1, b2, b3, b4, b5, b6, b7, b8, b9;
    std::uint8_t c0, c1, c2, c3, c4, c5, c6, c7, c8, c9;
    std::uint8_t d0, d1, d2, d3, d4, d5, d6, d7, d8, d9;
};
struct Flag {
    bool is_set;
};
struct Lists {
    BoundedSequence<std::uint8_t, 4> head;
    BoundedSequence<double, 1> tail;
};

/// What happens when a payload is walked for the second time: encoder and decoder look first and act then.
class Disturbance {
  public:
    void arm(void (*act)() noexcept) {
        act_ = act;
        walks_ = 0U;
    }
    void on_walk() noexcept {
        ++walks_;
        if (walks_ == 2U && act_ != nullptr) {
            act_();
        }
    }

  private:
    void (*act_)() noexcept {nullptr};
    std::size_t walks_{0U};
};
Disturbance g_disturbance;
std::byte g_flag_byte{1};
Lists g_lists{};

}  // namespace

template <>
struct Fields<Flag> {
    static constexpr bool kDeclared = true;
    template <typename Self, typename Call>
    static decltype(auto) apply(Self& self, Call&& call) noexcept {
        g_disturbance.on_walk();
        return call(self.is_set);
    }
};
template <>
struct Fields<Lists> {
    static constexpr bool kDeclared = true;
    template <typename Self, typename Call>
    static decltype(auto) apply(Self& self, Call&& call) noexcept {
        g_disturbance.on_walk();
        return call(self.head, self.tail);
    }
};
}  // namespace mamori
MAMORI_FIELDS(mamori::Forty, a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9,
              c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, d0, d1, d2, d3, d4, d5, d6, d7, d8, d9)

namespace mamori {
namespace {

using namespace verification;

TEST(CdrLimitsTest, AnEncodingThatIsCutBeforeAnyOfFortyFieldsIsRefused) {
    verifies("SWR-CDR-013", Technique::kBoundaryValues, Polarity::kViolation);
    Forty forty{};
    forty.a0 = 1U;
    forty.d9 = 40U;

    for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
        const cdr_checks::Bytes whole = cdr_checks::encode_exactly(forty, order);
        ASSERT_EQ(whole.size(), 40U);
        cdr_checks::expect_only_whole_is_taken(whole, order, forty);
        cdr_checks::expect_decodes<Forty>(whole, order, whole);
    }
}

TEST(CdrLimitsTest, ABufferThatChangesWhileItIsReadGivesNoValueThatTheTypeDoesNotHave) {
    verifies("SWR-CDR-013", Technique::kFaultInjection, Polarity::kViolation);
    const Span<const std::byte> buffer{&g_flag_byte, 1U};
    Flag flag{false};

    g_disturbance.arm(nullptr);
    ASSERT_EQ(decode(buffer, ByteOrder::kLittle, flag), Status::kOk);
    EXPECT_TRUE(flag.is_set);
    g_disturbance.arm([]() noexcept { g_flag_byte = std::byte{2}; });
    EXPECT_EQ(decode(buffer, ByteOrder::kLittle, flag), Status::kBadParameter);
    EXPECT_FALSE(flag.is_set) << "a boolean of two would be none";
}

TEST(CdrLimitsDeathTest, APayloadThatGrowsWhileItIsWrittenEndsInTheAssertionAndNotBehindTheBuffer) {
    verifies("SWR-CDR-011", Technique::kFaultInjection, Polarity::kViolation);
    std::array<std::byte, 12U> buffer{};
    const auto encode_growing = [&buffer](std::size_t head_size, std::size_t room) {
        ASSERT_EQ(g_lists.head.resize(head_size), Status::kOk);
        g_lists.tail.clear();
        g_disturbance.arm([]() noexcept { static_cast<void>(g_lists.tail.resize(1U)); });
        static_cast<void>(encode(g_lists, Span<std::byte>(buffer.data(), room), ByteOrder::kLittle));
    };
    g_disturbance.arm(nullptr);
    std::array<std::byte, 16U> large{};
    ASSERT_EQ(g_lists.tail.resize(1U), Status::kOk);
    ASSERT_EQ(encode(g_lists, large, ByteOrder::kLittle).get_value(), 16U);

    EXPECT_CHECK_FAILS(encode_growing(0U, 8U), "cdr_writer.hpp", 1) << "begins at the end of the buffer";
    EXPECT_CHECK_FAILS(encode_growing(1U, 12U), "cdr_writer.hpp", 1) << "begins behind it";
}

}  // namespace
}  // namespace mamori
