// SPDX-License-Identifier: Apache-2.0
// Goal: each undamaged frame gives its message, and nothing else gives one. Method: frames of every length by
// hand; 10^7 random and mutated octets with a fixed seed, in which the test knows each undamaged frame.
#include "mamori/ports/lcm/byte_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <vector>

#include "mamori/trace/verifies.hpp"

namespace mamori::ports::lcm {
namespace {

using namespace verification;
using Octets = std::vector<std::byte>;

constexpr std::size_t kMessageMax = 600U;
constexpr std::uint64_t kSeed = 0x434F4253U;

Octets make_octets(std::initializer_list<int> values) {
    Octets octets;
    for (const int value : values) {
        octets.push_back(static_cast<std::byte>(value));
    }
    return octets;
}

Octets make_frame(const Octets& message) {
    Octets frame(calc_frame_size_max(message.size()), std::byte{0xA5});
    const Result<std::size_t> size =
        encode_frame({message.data(), message.size()}, {frame.data(), frame.size()});
    EXPECT_TRUE(size.has_value());
    frame.resize(size.get_value());
    return frame;
}

class ByteFrameTest : public ::testing::Test {
  protected:
    /// The last event that is not kNone.
    FrameEvent push(const Octets& octets) {
        FrameEvent last = FrameEvent::kNone;
        for (const std::byte octet : octets) {
            const FrameEvent event = decoder_.push(octet);
            if (event != FrameEvent::kNone) {
                last = event;
                ++events_;
            }
        }
        return last;
    }
    Octets get_message() const {
        const Span<const std::byte> message = decoder_.get_message();
        return {message.begin(), message.end()};
    }

    std::array<std::byte, kMessageMax + kFrameChecksumSize> buffer_{};
    FrameDecoder decoder_{buffer_};
    int events_{0};
};

TEST_F(ByteFrameTest, AFrameIsTheStuffedMessageAndItsChecksumBetweenZeros) {
    verifies("SWR-LCM-009", Technique::kRequirementsBased, Polarity::kNominal);
    // CRC-32 of "123456789" is CBF43926 (catalogue of parametrised CRC algorithms, CRC-32/ISO-HDLC).
    EXPECT_EQ(make_frame(make_octets({'1', '2', '3', '4', '5', '6', '7', '8', '9'})),
              make_octets({0, 14, '1', '2', '3', '4', '5', '6', '7', '8', '9', 0xCB, 0xF4, 0x39, 0x26, 0}));
    // CRC-32 of one zero octet is D202EF8D.
    EXPECT_EQ(make_frame(make_octets({0})), make_octets({0, 1, 5, 0xD2, 0x02, 0xEF, 0x8D, 0}));
}

TEST_F(ByteFrameTest, EveryLengthAndContentComesBackAndHasNoZeroInside) {
    verifies("SWR-LCM-009", Technique::kBoundaryValues, Polarity::kNominal);
    for (std::size_t length = 0U; length <= kMessageMax; ++length) {
        for (const int zero_every : {0, 1, 2, 254, 255}) {
            Octets message(length, std::byte{0x5A});
            for (std::size_t i = 0U; zero_every > 0 && i < length; ++i) {
                if (i % static_cast<std::size_t>(zero_every) == 0U) {
                    message[i] = std::byte{0};
                }
            }
            const Octets frame = make_frame(message);
            ASSERT_LE(frame.size(), calc_frame_size_max(length));
            ASSERT_EQ(std::count(frame.begin(), frame.end(), std::byte{0}), 2);
            ASSERT_EQ(push(frame), FrameEvent::kMessage) << length;
            ASSERT_EQ(get_message(), message) << length;
        }
    }
}

TEST_F(ByteFrameTest, TheLongestFrameHasOneMoreOctetPer254OctetsBegun) {
    verifies("SWR-LCM-009", Technique::kBoundaryValues, Polarity::kNominal);
    EXPECT_EQ(calc_frame_size_max(0U), 7U);
    EXPECT_EQ(calc_frame_size_max(249U), 256U);
    EXPECT_EQ(calc_frame_size_max(250U), 258U);  // with the checksum one full block
    EXPECT_EQ(calc_frame_size_max(503U), 511U);
    EXPECT_EQ(calc_frame_size_max(504U), 513U);
    EXPECT_EQ(make_frame(Octets(250U, std::byte{0x5A})).size(), 258U);
}

TEST_F(ByteFrameTest, ANewDecoderHasNoMessageAndTakesAFrameWhoseBeginItMissed) {
    verifies("SWR-LCM-009", Technique::kStateTransition, Polarity::kNominal);
    EXPECT_TRUE(get_message().empty());

    Octets frame = make_frame(make_octets({1, 2, 3}));
    frame.erase(frame.begin());
    EXPECT_EQ(push(frame), FrameEvent::kMessage);
    EXPECT_EQ(get_message(), make_octets({1, 2, 3}));
    EXPECT_EQ(events_, 1);
}

TEST_F(ByteFrameTest, ABufferThatIsTooSmallStaysUnchanged) {
    verifies("SWR-LCM-009", Technique::kBoundaryValues, Polarity::kViolation);
    const Octets message(300U, std::byte{1});
    Octets frame(calc_frame_size_max(message.size()), std::byte{0xA5});
    const Span<const std::byte> source(message.data(), message.size());

    EXPECT_EQ(encode_frame(source, {frame.data(), frame.size() - 1U}).get_status(), Status::kOutOfResources);
    EXPECT_EQ(frame, Octets(frame.size(), std::byte{0xA5}));
    EXPECT_TRUE(encode_frame(source, {frame.data(), frame.size()}).has_value());
}

TEST_F(ByteFrameTest, EachKindOfDamageIsReportedAndTheNextFrameIsFound) {
    verifies("SWR-LCM-009", Technique::kEquivalenceClasses, Polarity::kViolation);
    const Octets good = make_frame(make_octets({1, 2, 3}));
    Octets truncated = good;
    truncated.erase(truncated.end() - 2);
    Octets flipped = good;
    flipped[2] ^= std::byte{0x40};

    EXPECT_EQ(push(truncated), FrameEvent::kMalformed);
    EXPECT_EQ(push(make_octets({0, 4, 1, 2, 3, 0})), FrameEvent::kMalformed);  // shorter than a checksum
    EXPECT_EQ(push(flipped), FrameEvent::kChecksum);
    EXPECT_EQ(push(make_frame(Octets(kMessageMax + 1U, std::byte{7}))), FrameEvent::kOversized);
    EXPECT_TRUE(get_message().empty());
    EXPECT_EQ(push(good), FrameEvent::kMessage);
    EXPECT_EQ(events_, 5);
    EXPECT_EQ(get_message(), make_octets({1, 2, 3}));
}

TEST_F(ByteFrameTest, EveryFlippedBitOfAFrameIsDetected) {
    verifies("SWR-LCM-009", Technique::kFaultInjection, Polarity::kViolation);
    const Octets good = make_frame(make_octets({'1', '2', '3', '4', '5', '6', '7', '8', '9'}));
    for (std::size_t bit = 8U; bit < (good.size() - 1U) * 8U; ++bit) {
        Octets flipped = good;
        flipped[bit / 8U] ^= std::byte{1U} << (bit % 8U);
        EXPECT_NE(push(flipped), FrameEvent::kMessage) << bit;
        EXPECT_EQ(push(good), FrameEvent::kMessage) << bit;
    }
}

TEST_F(ByteFrameTest, AResetDropsTheLastMessageAndTheBegunFrame) {
    verifies("SWR-LCM-009", Technique::kStateTransition, Polarity::kNominal);
    const Octets good = make_frame(make_octets({1, 2, 3}));
    ASSERT_EQ(push(good), FrameEvent::kMessage);
    ASSERT_EQ(push(make_octets({5, 1})), FrameEvent::kNone);
    decoder_.reset();

    EXPECT_TRUE(get_message().empty());
    EXPECT_EQ(push(good), FrameEvent::kMessage);
    EXPECT_EQ(events_, 2);
}

/// One stretch of the stream: an undamaged frame, a mutated one, or random octets.
class Stream final {
  public:
    struct Part {
        Octets octets;
        bool has_message{false};  ///< it was a frame before a mutation
        bool is_good{false};
        Octets message{};
    };

    Part make_part() {
        Part part{};
        const std::uint64_t kind = random_() % 3U;
        if (kind == 0U) {
            part.octets.resize(random_() % 200U);
            std::generate(part.octets.begin(), part.octets.end(), [this] { return make_octet(); });
            return part;
        }
        part.message.resize(random_() % kMessageMax);
        std::generate(part.message.begin(), part.message.end(), [this] { return make_octet(); });
        part.octets = make_frame(part.message);
        part.has_message = true;
        part.is_good = kind == 1U;
        if (!part.is_good) {
            mutate(part.octets);
        }
        return part;
    }

  private:
    /// Zero and the code of a full block are frequent.
    std::byte make_octet() {
        const std::uint64_t value = random_();
        return value % 8U == 0U ? std::byte{0} : value % 8U == 1U ? std::byte{0xFF} : std::byte(value >> 56U);
    }
    /// Flips, removes and inserts; the frame always differs from the original afterwards, or has lost its
    /// begin or end.
    void mutate(Octets& octets) {
        const std::size_t place = 1U + random_() % (octets.size() - 2U);
        const std::uint64_t kind = random_() % 4U;
        Octets mutated;
        for (std::size_t i = 0U; i < octets.size(); ++i) {
            if (i != place) {
                mutated.push_back(octets[i]);
            } else if (kind == 0U) {
                mutated.push_back(octets[i] ^ std::byte(1U + random_() % 255U));
            } else if (kind == 1U) {
                break;
            } else if (kind == 2U) {
                mutated.push_back(make_octet());
                mutated.push_back(octets[i]);
            }
        }
        octets = mutated;
    }

    std::mt19937_64 random_{kSeed};
};

TEST_F(ByteFrameTest, TenMillionRandomAndMutatedOctetsLoseNoGoodMessageAndGiveNoOther) {
    verifies("SWR-LCM-009", Technique::kErrorGuessing, Polarity::kViolation);
    constexpr std::size_t kOctets = 10'000'000U;
    Stream stream;
    std::size_t octets = 0U;
    std::size_t good = 0U;
    std::size_t received = 0U;
    std::size_t unexpected = 0U;
    std::size_t damaged = 0U;

    while (octets < kOctets) {
        const Stream::Part part = stream.make_part();
        octets += part.octets.size();
        good += part.is_good ? 1U : 0U;
        for (const std::byte octet : part.octets) {
            const FrameEvent event = decoder_.push(octet);
            if (event == FrameEvent::kMessage) {
                // A mutation can leave the frame equal, or only add a delimiter: then its message is right.
                const bool is_expected = part.has_message && get_message() == part.message;
                received += is_expected && part.is_good ? 1U : 0U;
                unexpected += is_expected ? 0U : 1U;
            } else if (event != FrameEvent::kNone) {
                ++damaged;
            }
        }
    }

    EXPECT_EQ(received, good) << "seed " << kSeed;
    EXPECT_EQ(unexpected, 0U) << "seed " << kSeed;
    EXPECT_GT(good, 10'000U);
    EXPECT_GT(damaged, 10'000U);
}

}  // namespace
}  // namespace mamori::ports::lcm
