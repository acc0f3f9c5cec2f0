// SPDX-License-Identifier: Apache-2.0
/// @file
/// For the tests of protected ports: payloads, a message per profile, and the two ends with a way between
/// them on which a test can do what it likes.
#ifndef MAMORI_SAFETY_TESTS_E2E_PORT_RIG_HPP
#define MAMORI_SAFETY_TESTS_E2E_PORT_RIG_HPP

#include <cstdint>

#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"
#include "mamori/safety/e2e/e2e.hpp"

namespace e2e_port_test {

enum class Gear : std::uint8_t { kPark, kDrive };

/// 12 bytes in CDR, always.
struct Speed {
    double rad_s{0.0};
    Gear gear{Gear::kPark};
};
/// 5 .. 12 bytes and 4 more in front, with padding between.
struct Note {
    std::uint8_t kind{0U};
    mamori::BoundedString<7U> text{};
};
/// Every kind of part.
struct Mixed {
    std::array<mamori::BoundedSequence<std::uint16_t, 3U>, 2U> rows{};
    std::array<Speed, 2U> speeds{};
    mamori::BoundedString<5U> name{};
    std::uint64_t last{0U};
};

inline constexpr Speed kSafe{-1.0, Gear::kPark};

}  // namespace e2e_port_test

MAMORI_LAST_ENUMERATOR(e2e_port_test::Gear, kDrive)
MAMORI_FIELDS(e2e_port_test::Speed, rad_s, gear)
MAMORI_FIELDS(e2e_port_test::Note, kind, text)
MAMORI_FIELDS(e2e_port_test::Mixed, rows, speeds, name, last)

namespace e2e_port_test {

using namespace mamori::literals;
using mamori::Instant;
using mamori::Status;
using namespace mamori::safety;  // NOLINT: the subject of these tests

// A message of each profile.
inline constexpr NibbleCounterChannel kNibbles{0x0123U, DataIdMode::kBoth, 14U};
inline constexpr IdListChannel kListed{
    {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U, 11U, 12U, 13U, 14U, 15U, 16U}, 14U};
inline constexpr SentIdChannel kSent12{0x0A0B0C0DU, 24U, 24U};
inline constexpr SentIdChannel kSent16{0x0A0B0C0DU, 28U, 28U};
inline constexpr SentIdChannel kSent20{0x0A0B0C0DU, 32U, 32U};
inline constexpr KnownIdChannel kKnown3{0x1234U, 15U, 15U};
inline constexpr KnownIdChannel kKnown5{0x1234U, 17U, 17U};
using M01 = E2eMessage<Speed, E2eProfile01<>, kNibbles>;
using M02 = E2eMessage<Speed, E2eProfile02<>, kListed>;
using M04 = E2eMessage<Speed, E2eProfile04<>, kSent12>;
using M05 = E2eMessage<Speed, E2eProfile05<>, kKnown3>;
using M06 = E2eMessage<Speed, E2eProfile06<>, kKnown5>;
using M07 = E2eMessage<Speed, E2eProfile07<>, kSent20>;
using M08 = E2eMessage<Speed, E2eProfile08<>, kSent16>;
using M11 = E2eMessage<Speed, E2eProfile11<>, kNibbles>;
using M22 = E2eMessage<Speed, E2eProfile22<>, kListed>;
using M44 = E2eMessage<Speed, E2eProfile44<>, kSent12>;

/// Loose limits: one good reading makes the channel valid, and 10 bad ones do not end that.
template <typename Order>
inline constexpr E2eInLimits<Order> kLoose{100_ms, {1U}, 12U, {{1U, 11U}, {1U, 11U}, {1U, 11U}}};

/// Both ends by hand. One cycle is 10 ms: the sender's window closes, then the receiver's opens.
template <typename Message, const auto& kLimits, typename Port = mamori::InPort<typename Message::Frame>>
struct Ends {
    using Frame = typename Port::Payload;
    using Value = typename Message::Value;

    explicit Ends(const Value& substitute = Value{}, std::uint32_t counter = Message::Profile::kFirstCounter)
        : sender(out, counter), sut(in, substitute) {}

    mamori::OutPort<Frame> out{mamori::kNoOwner, "out"};
    Port in{mamori::kNoOwner, "in"};
    E2eOutPort<Message, Frame> sender;
    E2eInPort<Message, kLimits, Port> sut;
    Instant now{1000};
    std::uint64_t revision{0U};

    /// What leaves the sender for a value.
    Frame make(const Value& sent) {
        static_cast<void>(sender.write(sent));
        static_cast<void>(out.publish(now));
        return out.get_published();
    }
    /// What arrives at the receiver's input.
    void deliver(const Frame& frame) { deliver(frame, now); }
    void deliver(const Frame& frame, Instant published_at) {
        ++revision;
        if constexpr (Port::kIsQueue) {
            static_cast<void>(in.push({frame, revision, published_at}));
            in.open(now);
        } else {
            in.take({frame, revision, published_at});
        }
    }
    /// A cycle of the receiver. @return what it got; the value stands in `value`.
    E2eWorth read() {
        now = now + 10_ms;
        const E2eWorth worth = sut.read(now, value);
        in.mark_read();
        return worth;
    }
    /// A cycle in which `frame` comes.
    E2eWorth receive(const Frame& frame) {
        deliver(frame);
        return read();
    }
    /// A cycle in which all goes well.
    E2eWorth send(const Value& sent) { return receive(make(sent)); }
    /// Good cycles until the order is found.
    void synchronise() {
        for (int i = 0; i < 4; ++i) {
            static_cast<void>(send(Value{}));
        }
    }

    Value value{};
};

/// Two good readings of three prove the channel; one bad one of three ends that.
inline constexpr E2eInLimits<PlainSequence> kStrict{100_ms, {1U}, 3U, {{2U, 0U}, {1U, 0U}, {3U, 0U}}};
using Strict = Ends<M04, kStrict>;

/// A value of more than 25 ms is too old.
inline constexpr E2eInLimits<PlainSequence> kYoung{25_ms, {1U}, 12U, {{1U, 11U}, {1U, 11U}, {1U, 11U}}};
using Young = Ends<M04, kYoung>;

/// An input that queues two frames.
using Queue = mamori::QueueInPort<M04::Frame, 2U>;

}  // namespace e2e_port_test

#endif  // MAMORI_SAFETY_TESTS_E2E_PORT_RIG_HPP
