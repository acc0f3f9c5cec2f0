// SPDX-License-Identifier: Apache-2.0
// Goal: a protected output sends what the profile and the CDR writer define, one counter per frame that
// leaves. Method: frames beside the same bytes made by hand; sizes of every kind of payload; cycles with two
// writes, and with a window that overran.
#include <vector>

#include "mamori/trace/verifies.hpp"
#include "port_rig.hpp"

namespace e2e_port_test {
namespace {

using namespace mamori::verification;

template <typename Frame>
std::vector<std::byte> to_bytes(const Frame& frame) {
    std::vector<std::byte> bytes;
    for (const std::uint8_t byte : frame) {
        bytes.push_back(std::byte{byte});
    }
    return bytes;
}

template <typename Message>
class E2eOutPortTest : public ::testing::Test {
  protected:
    mamori::OutPort<typename Message::Frame> out_{mamori::kNoOwner, "out"};
    E2eOutPort<Message> sut_{out_};

    std::vector<std::byte> send(const Speed& value) {
        EXPECT_EQ(sut_.write(value), Status::kOk);
        EXPECT_TRUE(out_.publish(Instant{}));
        return to_bytes(out_.get_published());
    }
};

using Messages = ::testing::Types<M01, M02, M04, M05, M06, M07, M08, M11, M22, M44>;
struct MessageName {
    template <typename Message>
    static std::string GetName(int) {  // NOLINT(readability-identifier-naming)
        return "P" + std::to_string(Message::Profile::kNumber);
    }
};
TYPED_TEST_SUITE(E2eOutPortTest, Messages, MessageName);

TYPED_TEST(E2eOutPortTest, FrameIsTheEncodingBehindTheHeaderOfTheProfile) {
    verifies("SWR-E2E-030", Technique::kBackToBack);
    using Profile = typename TypeParam::Profile;
    const Speed value{2.5, Gear::kDrive};
    std::vector<std::byte> payload(12U);
    ASSERT_EQ(mamori::encode(value, {payload.data(), payload.size()}, mamori::ByteOrder::kLittle).get_value(),
              12U);

    for (std::uint32_t i = 0U; i < 20U; ++i) {
        std::vector<std::byte> frame(TypeParam::kPayloadAt);
        frame.insert(frame.end(), payload.begin(), payload.end());
        Profile::write(TypeParam::kChannel,
                       (Profile::kFirstCounter + i) % (Profile::kCounterMax + 1ULL) & 0xFFFFFFFFU,
                       {frame.data(), frame.size()});
        EXPECT_EQ(this->send(value), frame) << i;
    }
}

TYPED_TEST(E2eOutPortTest, SecondWriteInACycleReplacesTheFirstUnderItsCounter) {
    verifies("SWR-E2E-038", Technique::kStateTransition);
    E2eChecker<typename TypeParam::Profile, HardenedSequence> checker{TypeParam::kChannel, {1U, 2U}};
    for (std::uint32_t i = 0U; i < 20U; ++i) {
        ASSERT_EQ(this->sut_.write({1.0, Gear::kDrive}), Status::kOk);
        const std::uint32_t next = this->sut_.get_counter();
        const std::vector<std::byte> frame = this->send({0.0, Gear::kPark});

        EXPECT_EQ(this->sut_.get_counter(), next);
        EXPECT_EQ(checker.check({frame.data(), frame.size()}),
                  i < 2U ? CheckStatus::kWrongSequence : CheckStatus::kOk);
        Speed value{};
        ASSERT_EQ(mamori::decode({frame.data() + TypeParam::kPayloadAt, 12U}, TypeParam::kByteOrder, value),
                  Status::kOk);
        EXPECT_EQ(value.rad_s, 0.0);
    }
}

TEST(E2eOutPortTest, DiscardedFrameIsALostOne) {
    verifies("SWR-E2E-038", Technique::kFaultInjection, Polarity::kViolation);
    mamori::OutPort<M04::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<M04> sut{out};
    ASSERT_EQ(sut.write({}), Status::kOk);

    out.discard();
    ASSERT_EQ(sut.write({}), Status::kOk);
    EXPECT_EQ(sut.get_counter(), 2U);
}

TEST(E2eOutPortTest, ValueWithoutAnEncodingIsNotSent) {
    verifies("SWR-E2E-030", Technique::kErrorGuessing, Polarity::kViolation);
    mamori::OutPort<M04::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<M04> sut{out};

    EXPECT_EQ(sut.write({1.0, static_cast<Gear>(2U)}), Status::kBadParameter);
    EXPECT_FALSE(out.is_staged());
    EXPECT_EQ(sut.get_counter(), 0U);

    ASSERT_EQ(sut.write({1.0, Gear::kDrive}), Status::kOk);
    EXPECT_EQ(sut.write({2.0, static_cast<Gear>(2U)}), Status::kBadParameter);
    EXPECT_EQ(sut.get_counter(), 1U);
    ASSERT_TRUE(out.publish(Instant{}));
    Speed value{};
    ASSERT_EQ(mamori::decode(detail::view_bytes(out.get_published()).subspan(12U, 12U),
                             mamori::ByteOrder::kLittle, value),
              Status::kOk);
    EXPECT_EQ(value.rad_s, 1.0);
}

TEST(E2eOutPortTest, FirstCounterOutsideTheProfileSendsNothing) {
    verifies("SWR-E2E-030", Technique::kBoundaryValues, Polarity::kViolation);
    mamori::OutPort<M01::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<M01> last{out, 14U};
    E2eOutPort<M01> none{out, 15U};

    EXPECT_EQ(none.write({}), Status::kPreconditionNotMet);
    EXPECT_FALSE(out.is_staged());
    EXPECT_EQ(last.write({}), Status::kOk);
    EXPECT_EQ(last.get_counter(), 0U);
}

// Lengths.
constexpr SentIdChannel kNoteChannel{7U, 12U + 9U, 12U + 16U};
using NoteMessage = E2eMessage<Note, E2eProfile04<>, kNoteChannel>;
constexpr SentIdChannel kMixedChannel{7U, 12U + 56U, 12U + 72U};
using MixedMessage = E2eMessage<Mixed, E2eProfile04<>, kMixedChannel, mamori::ByteOrder::kBig>;

TEST(E2eMessageTest, FramesAreAsLongAsTheirValues) {
    verifies("SWR-E2E-030", Technique::kBoundaryValues);
    mamori::OutPort<NoteMessage::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<NoteMessage> sut{out};
    const auto calc_length = [&](const Note& note) {
        EXPECT_EQ(sut.write(note), Status::kOk);
        EXPECT_TRUE(out.publish(Instant{}));
        return out.get_published().size();
    };

    EXPECT_EQ(calc_length({1U, {"7 chars"}}), NoteMessage::kLengthMax);
    EXPECT_EQ(calc_length({}), NoteMessage::kLengthMin);
    EXPECT_EQ(calc_length({1U, {"abc"}}), 12U + 4U + 4U + 4U);
    EXPECT_EQ(calc_length({1U, {"7 chars"}}), NoteMessage::kLengthMax);
}

TEST(E2eMessageTest, LengthsOfEveryKindOfPayloadAreThoseOfItsEncodings) {
    verifies("SWR-E2E-030", Technique::kBackToBack);
    mamori::OutPort<MixedMessage::Frame> out{mamori::kNoOwner, "out"};
    E2eOutPort<MixedMessage> sut{out};
    Mixed longest{};
    for (auto& row : longest.rows) {
        ASSERT_EQ(row.resize(3U), Status::kOk);
    }
    longest.name = mamori::BoundedString<5U>{"12345"};

    ASSERT_EQ(sut.write(longest), Status::kOk);
    ASSERT_TRUE(out.publish(Instant{}));
    EXPECT_EQ(out.get_published().size(), MixedMessage::kLengthMax);
    ASSERT_EQ(sut.write({}), Status::kOk);
    ASSERT_TRUE(out.publish(Instant{}));
    EXPECT_EQ(out.get_published().size(), MixedMessage::kLengthMin);
}

constexpr NibbleCounterChannel kFarCounter{0x0023U, DataIdMode::kLow, 15U, 0U, 16U, 28U};
constexpr NibbleCounterChannel kFarNibble{0x0123U, DataIdMode::kNibble, 16U, 8U, 4U, 28U};
constexpr NibbleCounterChannel kNearNibble{0x0123U, DataIdMode::kNibble, 14U, 8U, 4U, 0U};
constexpr IdListChannel kFarList{kListed.data_ids, 17U, 3U};

TEST(E2eMessageTest, PayloadLiesBehindTheLastByteOfTheHeader) {
    verifies("SWR-E2E-030", Technique::kEquivalenceClasses);

    EXPECT_EQ(M01::kPayloadAt, 2U);
    EXPECT_EQ(M07::kPayloadAt, 20U);
    EXPECT_EQ((E2eMessage<Speed, E2eProfile01<>, kFarCounter>::kPayloadAt), 3U);
    EXPECT_EQ((E2eMessage<Speed, E2eProfile01<>, kFarNibble>::kPayloadAt), 4U);
    EXPECT_EQ((E2eMessage<Speed, E2eProfile01<>, kNearNibble>::kPayloadAt), 2U);
    EXPECT_EQ((E2eMessage<Speed, E2eProfile22<>, kFarList>::kPayloadAt), 5U);
}

TEST(E2eMessageTest, PlaceOfThePayloadIsThatOfTheFieldWhichLiesLast) {
    verifies("SWR-E2E-030", Technique::kBoundaryValues);
    NibbleCounterChannel channel{0x0123U, DataIdMode::kNibble, 16U, 8U, 16U, 28U};
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile01<>>(channel), 4U);
    channel.nibble_offset = 20U;
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile01<>>(channel), 3U);
    channel.nibble_offset = 4U;
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile01<>>(channel), 3U);
    channel.counter_offset = 0U;
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile01<>>(channel), 2U);
    channel.nibble_offset = 28U;
    channel.mode = DataIdMode::kBoth;  // sends no nibble, wherever it would lie
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile01<>>(channel), 2U);

    SentIdChannel sent{7U, 30U, 30U};
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile04<>>(sent), 12U);
    sent.offset = 8U;
    EXPECT_EQ(detail::calc_payload_begin<E2eProfile04<>>(sent), 20U);
}

TEST(E2eMessageTest, ChannelTakesTheFramesOfAMessageAndNoOthers) {
    verifies("SWR-E2E-037", Technique::kBoundaryValues, Polarity::kViolation);
    const auto takes = [](std::size_t least, std::size_t greatest) {
        return detail::takes_exactly<E2eProfile04<>>({7U, least, greatest}, 24U, 28U);
    };

    EXPECT_TRUE(takes(24U, 28U));
    EXPECT_FALSE(takes(23U, 28U));
    EXPECT_FALSE(takes(25U, 28U));
    EXPECT_FALSE(takes(24U, 27U));
    EXPECT_FALSE(takes(24U, 29U));
}

TEST(E2eMessageTest, ShortestEncodingHasNothingInItsSequencesAndTexts) {
    verifies("SWR-E2E-030", Technique::kBackToBack);

    EXPECT_EQ(detail::calc_least_end<Mixed>(0U), mamori::calc_encoded_size(Mixed{}).get_value());
    EXPECT_EQ(detail::calc_least_end<Note>(0U), mamori::calc_encoded_size(Note{}).get_value());
    EXPECT_EQ(detail::calc_least_end<Speed>(0U), mamori::max_encoded_size<Speed>());
    EXPECT_EQ(detail::calc_least_end<Speed>(4U), 20U);  // aligned to 8 first
}

}  // namespace
}  // namespace e2e_port_test
