// SPDX-License-Identifier: Apache-2.0
// Goal: the lower bound of a protected exchange does the same job as the protected ports. Method: both pairs
// of ends exchange the same values, and one random disturbance per cycle, over many short runs from a fixed
// seed. Every message and every reading must be equal.
#include "hand_written_e2e.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <set>

#include "e2e_rig.hpp"
#include "mamori/trace/verifies.hpp"

namespace mamori::verification::bench {
namespace {

constexpr std::size_t kSize = 16U;
using Value = Message<kSize>;
using Protected = safety::E2eMessage<Value, E2eProfile, kE2eChannel<kSize>>;
using Bytes = std::array<std::byte, Protected::kLengthMax>;
using Generator = std::mt19937;

enum class Disturbance : unsigned {
    kNone,
    kNothingSent,
    kBitError,
    kRepetition,
    kReplay,
    kOtherIdentifier,
    kOtherLength,
    kOtherCounter,
    kStuckAtZero,
    kStuckAtOne,
    kLate,
    kEarly,
};
constexpr unsigned kDisturbances = 12U;

/// Both pairs of ends.
class BothPairs {
  public:
    /// One cycle. @return the outcome, which is the same for both unless a check of the test fails.
    safety::E2eOutcome run_cycle(Disturbance disturbance, Generator& random) {
        now_ = now_ + Duration{10};
        const Value value{random(), random()};
        const bool is_sent = disturbance != Disturbance::kNothingSent;
        if (is_sent) {
            send(value);
            Bytes bytes = hand_sender_.get_published().bytes;
            disturb(bytes, disturbance, random);
            deliver(bytes, calc_published_at(disturbance));
        }
        return read();
    }

  private:
    void send(const Value& value) {
        for (int i = 0; i < 2; ++i) {  // the second write replaces the first
            EXPECT_EQ(sender_.write(value), Status::kOk);
            hand_sender_.write(value);
        }
        out_.publish(now_);
        hand_sender_.publish(now_);
        const Bytes& bytes = hand_sender_.get_published().bytes;
        ASSERT_EQ(out_.get_published().size(), bytes.size());
        EXPECT_EQ(std::memcmp(out_.get_published().data(), bytes.data(), bytes.size()), 0);
    }
    void disturb(Bytes& bytes, Disturbance disturbance, Generator& random) {
        const Bytes sent = bytes;
        const std::size_t byte = random() % bytes.size();
        switch (disturbance) {
            case Disturbance::kBitError:
                bytes[byte] ^= static_cast<std::byte>(1U << (random() % 8U));
                break;
            case Disturbance::kRepetition:
                bytes = last_;
                break;
            case Disturbance::kReplay:
                bytes = first_;
                break;
            case Disturbance::kOtherIdentifier:
                change(bytes, 4U + random() % 4U);
                break;
            case Disturbance::kOtherLength:
                change(bytes, random() % 2U);
                break;
            case Disturbance::kOtherCounter:
                change(bytes, 2U + random() % 2U);
                break;
            case Disturbance::kStuckAtZero:
                bytes.fill(std::byte{0U});
                break;
            case Disturbance::kStuckAtOne:
                bytes.fill(std::byte{0xFFU});
                break;
            case Disturbance::kNone:
            case Disturbance::kNothingSent:
            case Disturbance::kLate:
            case Disturbance::kEarly:
                break;
        }
        first_ = cycles_ == 0U ? sent : first_;
        last_ = sent;
        ++cycles_;
    }
    /// Changes a field, with a checksum that agrees.
    static void change(Bytes& bytes, std::size_t byte) {
        using Frame = HandWrittenFrame<kSize>;
        bytes[byte] ^= std::byte{1U};
        const Frame frame{bytes};
        const std::uint32_t checksum = __builtin_bswap32(frame.calc_checksum());
        std::memcpy(bytes.data() + Frame::kCrcAt, &checksum, sizeof(checksum));
    }
    Instant calc_published_at(Disturbance disturbance) const {
        switch (disturbance) {
            case Disturbance::kLate:
                return now_ - Duration{1001};
            case Disturbance::kEarly:
                return now_ + Duration{1};
            default:
                return now_;
        }
    }
    void deliver(const Bytes& bytes, Instant published_at) {
        typename Protected::Frame frame;
        ASSERT_EQ(frame.resize(bytes.size()), Status::kOk);
        std::memcpy(frame.data(), bytes.data(), bytes.size());
        in_.take({frame, cycles_, published_at});
        hand_receiver_.take(HandWrittenFrame<kSize>{bytes}, cycles_, published_at);
    }
    safety::E2eOutcome read() {
        Value value{};
        static_cast<void>(receiver_.read(now_, value));
        in_.mark_read();
        EXPECT_EQ(hand_receiver_.read(now_), value);
        EXPECT_STREQ(get_name(hand_receiver_.get_outcome()), get_name(receiver_.get_outcome()));
        EXPECT_STREQ(get_name(hand_receiver_.get_cause()), get_name(receiver_.get_checker().get_cause()));
        EXPECT_EQ(hand_receiver_.get_state(), receiver_.get_state());
        for (std::size_t i = 0U; i < safety::kE2eOutcomeCount; ++i) {
            const auto outcome = static_cast<safety::E2eOutcome>(i);
            EXPECT_EQ(hand_receiver_.get_count(outcome), receiver_.get_count(outcome));
        }
        for (std::size_t i = 0U; i < safety::kFrameCauseCount; ++i) {
            const auto cause = static_cast<safety::FrameCause>(i);
            EXPECT_EQ(hand_receiver_.get_count(cause), receiver_.get_checker().get_count(cause));
        }
        return receiver_.get_outcome();
    }

    OutPort<Protected::Frame> out_{kNoOwner, "out"};
    InPort<Protected::Frame> in_{kNoOwner, "in"};
    safety::E2eOutPort<Protected> sender_{out_};
    safety::E2eInPort<Protected, kE2eLimits> receiver_{in_, {}};
    HandWrittenSender<kSize> hand_sender_;
    HandWrittenReceiver<kSize> hand_receiver_;
    Bytes first_{};
    Bytes last_{};
    std::uint64_t cycles_{0U};
    Instant now_{};
};

TEST(HandWrittenE2eTest, UndisturbedValuesArriveAsWithTheProtectedPorts) {
    verifies("SWR-BEN-010", Technique::kEquivalenceClasses, Polarity::kNominal);
    BothPairs pairs;
    Generator random(1U);
    unsigned accepted = 0U;

    for (int cycle = 0; cycle < 1000; ++cycle) {
        const safety::E2eOutcome outcome = pairs.run_cycle(Disturbance::kNone, random);
        accepted += outcome == safety::E2eOutcome::kAccepted ? 1U : 0U;
    }

    EXPECT_GE(accepted, 995U);
}

TEST(HandWrittenE2eTest, DisturbedMessagesGiveTheSameValuesAndCausesAsTheProtectedPorts) {
    verifies("SWR-BEN-010", Technique::kFaultInjection, Polarity::kViolation);
    constexpr unsigned kSeed = 24U;
    Generator random(kSeed);
    std::set<safety::E2eOutcome> seen;

    for (int run = 0; run < 2000 && !HasFailure(); ++run) {
        SCOPED_TRACE(testing::Message() << "seed " << kSeed << ", run " << run);
        BothPairs pairs;
        for (int cycle = 0; cycle < 60 && !HasFailure(); ++cycle) {
            const bool is_disturbed = random() % 5U == 0U;
            const auto disturbance = static_cast<Disturbance>(is_disturbed ? random() % kDisturbances : 0U);
            SCOPED_TRACE(testing::Message()
                         << "cycle " << cycle << ", disturbance " << static_cast<unsigned>(disturbance));
            seen.insert(pairs.run_cycle(disturbance, random));
        }
    }

    EXPECT_EQ(seen.size(), safety::kE2eOutcomeCount - 1U) << "all but a malformed value, which no bytes give";
}

TEST(HandWrittenE2eTest, LongAbsenceEndsTheSameWayAsWithTheProtectedPorts) {
    verifies("SWR-BEN-010", Technique::kFaultInjection, Polarity::kViolation);
    for (const int absence : {253, 254, 255, 256, 257}) {
        SCOPED_TRACE(absence);
        BothPairs pairs;
        Generator random(2U);
        for (int cycle = 0; cycle < 8; ++cycle) {
            static_cast<void>(pairs.run_cycle(Disturbance::kNone, random));
        }
        for (int cycle = 0; cycle < absence; ++cycle) {
            static_cast<void>(pairs.run_cycle(Disturbance::kNothingSent, random));
        }
        static_cast<void>(pairs.run_cycle(Disturbance::kReplay, random));
        for (int cycle = 0; cycle < 8; ++cycle) {
            static_cast<void>(pairs.run_cycle(Disturbance::kNone, random));
        }
    }
}

}  // namespace
}  // namespace mamori::verification::bench
