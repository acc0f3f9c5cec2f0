// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: connections of ports.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/dataflow/queue_out_port.hpp"
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

// A connection joins ports of two payload types.
namespace payload_mismatch {
#ifdef MAMORI_BREAK_PAYLOAD_MISMATCH
[[maybe_unused]] constexpr auto kConnection =
    mamori::connect(g_producer.whole, g_consumer.in, mamori::any_age());
#else
[[maybe_unused]] constexpr auto kConnection =
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age());
#endif
}  // namespace payload_mismatch

// A queued output has another payload type than its input.
namespace queue_payload_mismatch {
#ifdef MAMORI_BREAK_QUEUE_PAYLOAD_MISMATCH
inline mamori::QueueOutPort<std::int32_t, 2U> g_queue{mamori::kNoOwner, "queue"};
#else
inline mamori::QueueOutPort<double, 2U> g_queue{mamori::kNoOwner, "queue"};
#endif
[[maybe_unused]] constexpr auto kConnection = mamori::connect(g_queue, g_consumer.in, mamori::any_age());
}  // namespace queue_payload_mismatch

// A queued output has room for no value.
namespace queue_without_room {
#ifdef MAMORI_BREAK_QUEUE_WITHOUT_ROOM
inline mamori::QueueOutPort<double, 0U> g_queue{mamori::kNoOwner, "queue"};
#else
inline mamori::QueueOutPort<double, 254U> g_queue{mamori::kNoOwner, "queue"};
#endif
}  // namespace queue_without_room

// A mandatory input has no source.
namespace input_not_connected {
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer))
#ifndef MAMORI_BREAK_INPUT_NOT_CONNECTED
        ,
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age())
#endif
);
MAMORI_CHECK(kSystem);
}  // namespace input_not_connected

// An input has two sources.
namespace two_writers {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
                   mamori::window("w", 0_us, 100_us, mamori::budget(50_us),
                                  mamori::run(g_producer, g_second_producer, g_consumer)),
                   mamori::connect(g_producer.real, g_consumer.in, mamori::any_age())
#ifdef MAMORI_BREAK_TWO_WRITERS
                       ,
                   mamori::connect(g_second_producer.real, g_consumer.in, mamori::any_age())
#endif
    );
MAMORI_CHECK(kSystem);
}  // namespace two_writers

// A connection feeds a component that no window runs.
namespace unknown_component {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
#ifdef MAMORI_BREAK_UNKNOWN_COMPONENT
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
#else
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us),
                                  mamori::run(g_producer, g_consumer)),
#endif
                   mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace unknown_component

// A connection leaves its core with nothing in between.
namespace crossing_without_buffer {
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("plan", 100_us, 100_us, mamori::core(1), mamori::budget(50_us), mamori::run(g_consumer)),
#ifdef MAMORI_BREAK_CROSSING_WITHOUT_BUFFER
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
#else
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing), mamori::any_age()));
#endif
MAMORI_CHECK(kSystem);
}  // namespace crossing_without_buffer

// A connection leaves its partition with nothing in between.
namespace partition_without_buffer {
#ifdef MAMORI_BREAK_PARTITION_WITHOUT_BUFFER
constexpr const char* kPartition = "other";
#else
constexpr const char* kPartition = "safety";
#endif
constexpr auto kSystem = mamori::system(mamori::frame(1_ms),
                                        mamori::window("sense", 0_us, 100_us, mamori::partition("safety"),
                                                       mamori::budget(50_us), mamori::run(g_producer)),
                                        mamori::window("plan", 100_us, 100_us, mamori::partition(kPartition),
                                                       mamori::budget(50_us), mamori::run(g_consumer)),
                                        mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace partition_without_buffer

// Two connections go through one Crossing.
namespace crossing_used_twice {
inline Consumer g_second_consumer;
inline mamori::Crossing<double> g_second_crossing;
#ifdef MAMORI_BREAK_CROSSING_USED_TWICE
constexpr mamori::Crossing<double>& kSecondCrossing = g_crossing;
#else
constexpr mamori::Crossing<double>& kSecondCrossing = g_second_crossing;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("plan", 100_us, 100_us, mamori::core(1), mamori::budget(50_us),
                   mamori::run(g_consumer, g_second_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing), mamori::any_age()),
    mamori::connect(g_producer.real, g_second_consumer.in, mamori::through(kSecondCrossing),
                    mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace crossing_used_twice

// The reader may start 600 us late, when its writer overwrites the value of its planned start.
namespace history_too_short {
#ifdef MAMORI_BREAK_HISTORY_TOO_SHORT
constexpr mamori::Duration kOffset = 500_us - 1_ns;
#else
constexpr mamori::Duration kOffset = 500_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms),
    mamori::window("sense", 0_us, 500_us, mamori::every(1_ms), mamori::budget(100_us),
                   mamori::run(g_producer)),
    mamori::window("act", 500_us, 500_us, mamori::every(1_ms), mamori::budget(500_us),
                   mamori::run(g_second_producer)),
    mamori::window("plan", kOffset, 9_ms, mamori::background(), mamori::budget(1_ms),
                   mamori::run(g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing), mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace history_too_short

// The reader starts 1 ns before the publication margin after its writer on the other core ends.
namespace margin_not_kept {
#ifdef MAMORI_BREAK_MARGIN_NOT_KEPT
constexpr mamori::Duration kOffset = 120_us - 1_ns;
#else
constexpr mamori::Duration kOffset = 120_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::publication_margin(20_us),
    mamori::window("sense", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("plan", kOffset, 100_us, mamori::core(1), mamori::budget(50_us), mamori::run(g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing), mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace margin_not_kept

// No value is younger than zero.
namespace age_limit_not_positive {
#ifdef MAMORI_BREAK_AGE_LIMIT_NOT_POSITIVE
constexpr mamori::Duration kAgeMax{0};
#else
constexpr mamori::Duration kAgeMax{1};
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(kAgeMax)));
MAMORI_CHECK(kSystem);
}  // namespace age_limit_not_positive

// The second age limit would silently replace the first.
namespace connection_option_twice {
#ifdef MAMORI_BREAK_CONNECTION_OPTION_TWICE
constexpr auto kConnection =
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(1_ms), mamori::fresh_within(2_ms));
#else
constexpr auto kConnection = mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(1_ms));
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
    kConnection);
MAMORI_CHECK(kSystem);
}  // namespace connection_option_twice

// A component lists a member that is no port.
namespace port_is_no_port {
class Odd final : public mamori::Component {
  public:
    constexpr Odd() noexcept : Component("odd") {}
    mamori::OutPort<double> out{*this, "out"};
    double number{0.0};
#ifdef MAMORI_BREAK_PORT_IS_NO_PORT
    using Ports = mamori::Ports<&Odd::out, &Odd::number>;
#else
    using Ports = mamori::Ports<&Odd::out>;
#endif
};
Odd g_odd;
[[maybe_unused]] constexpr auto kRunList = mamori::run(g_odd);
}  // namespace port_is_no_port

// A connection states no age limit.
namespace age_limit_not_stated {
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
#ifdef MAMORI_BREAK_AGE_LIMIT_NOT_STATED
    mamori::connect(g_producer.real, g_consumer.in));
#else
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
#endif
MAMORI_CHECK(kSystem);
}  // namespace age_limit_not_stated

// A connection states two age limits.
namespace two_age_limits {
#ifdef MAMORI_BREAK_TWO_AGE_LIMITS
[[maybe_unused]] constexpr auto kConnection =
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(1_ms), mamori::any_age());
#endif
}  // namespace two_age_limits

// The reader runs before its writer in one window.
namespace delay_not_stated {
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_consumer, g_producer)),
#ifdef MAMORI_BREAK_DELAY_NOT_STATED
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
#else
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age(), mamori::delayed_by_a_frame()));
#endif
MAMORI_CHECK(kSystem);
}  // namespace delay_not_stated

// A connection in the order of its window states a delay that it does not have.
namespace delay_stated_without_delay {
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
#ifdef MAMORI_BREAK_DELAY_STATED_WITHOUT_DELAY
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age(), mamori::delayed_by_a_frame()));
#else
    mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
#endif
MAMORI_CHECK(kSystem);
}  // namespace delay_stated_without_delay

// A component reads its own output.
namespace own_output_without_delay {
class Filter final : public mamori::Component {
  public:
    constexpr Filter() noexcept : Component("filter") {}
    mamori::InPort<double> last{*this, "last"};
    mamori::OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Filter::last, &Filter::out>;
};
inline Filter g_filter;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_filter)),
#ifdef MAMORI_BREAK_OWN_OUTPUT_WITHOUT_DELAY
    mamori::connect(g_filter.out, g_filter.last, mamori::any_age()));
#else
    mamori::connect(g_filter.out, g_filter.last, mamori::any_age(), mamori::delayed_by_a_frame()));
#endif
MAMORI_CHECK(kSystem);
}  // namespace own_output_without_delay

// A component that no window runs feeds a connection.
namespace unknown_source {
constexpr auto kSystem =
    mamori::system(mamori::frame(1_ms),
#ifdef MAMORI_BREAK_UNKNOWN_SOURCE
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_consumer)),
#else
                   mamori::window("a", 0_us, 100_us, mamori::budget(50_us),
                                  mamori::run(g_producer, g_consumer)),
#endif
                   mamori::connect(g_producer.real, g_consumer.in, mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace unknown_source

// The value is 6 ms old when its reader starts: 6 ms is the shortest limit that a value can meet.
namespace age_limit_too_short {
#ifdef MAMORI_BREAK_AGE_LIMIT_TOO_SHORT
constexpr mamori::Duration kAgeMax = 6_ms - 1_ns;
#else
constexpr mamori::Duration kAgeMax = 6_ms;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(10_ms), mamori::window("sense", 0_us, 1_ms, mamori::budget(50_us), mamori::run(g_producer)),
    mamori::window("plan", 7_ms, 1_ms, mamori::budget(50_us), mamori::run(g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(kAgeMax)));
MAMORI_CHECK(kSystem);
}  // namespace age_limit_too_short

// A reader before its writer gets the value at the next start of the window, 900 us after its end.
namespace age_limit_of_delayed_value {
#ifdef MAMORI_BREAK_AGE_LIMIT_OF_DELAYED_VALUE
constexpr mamori::Duration kAgeMax = 900_us - 1_ns;
#else
constexpr mamori::Duration kAgeMax = 900_us;
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_consumer, g_producer)),
    mamori::connect(g_producer.real, g_consumer.in, mamori::fresh_within(kAgeMax),
                    mamori::delayed_by_a_frame()));
MAMORI_CHECK(kSystem);
}  // namespace age_limit_of_delayed_value

// Between windows of 2 ms and 3 ms on two cores, the value is 400 us old at least. A tolerance of the time
// bases counts.
namespace age_limit_between_rates {
#ifdef MAMORI_BREAK_AGE_LIMIT_BETWEEN_RATES
constexpr mamori::Duration kLeadMax = 100_us - 1_ns;
#else
constexpr mamori::Duration kLeadMax = 100_us;
#endif
constexpr auto kSystem =
    mamori::system(mamori::frame(6_ms),
                   mamori::window("sense", 0_us, 100_us, mamori::every(2_ms), mamori::budget(50_us),
                                  mamori::run(g_producer)),
                   mamori::window("plan", 500_us, 100_us, mamori::every(3_ms), mamori::core(1),
                                  mamori::budget(50_us), mamori::run(g_consumer)),
                   mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_crossing),
                                   mamori::fresh_within(300_us, kLeadMax)));
MAMORI_CHECK(kSystem);
}  // namespace age_limit_between_rates

// An age limit below zero (1), and a tolerance below zero (2).
namespace age_limit_negative {
#ifndef MAMORI_BREAK_AGE_LIMIT_NEGATIVE
constexpr mamori::FreshWithin kLimit = mamori::fresh_within(1_ms);
#elif MAMORI_BREAK_AGE_LIMIT_NEGATIVE == 1
constexpr mamori::FreshWithin kLimit = mamori::fresh_within(mamori::Duration{-1});
#else
constexpr mamori::FreshWithin kLimit = mamori::fresh_within(1_ms, mamori::Duration{-1});
#endif
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("a", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_consumer)),
    mamori::connect(g_producer.real, g_consumer.in, kLimit));
MAMORI_CHECK(kSystem);
}  // namespace age_limit_negative

// A connection ends at an output (1), or begins at an input (2).
namespace connection_direction {
#ifndef MAMORI_BREAK_CONNECTION_DIRECTION
#elif MAMORI_BREAK_CONNECTION_DIRECTION == 1
constexpr auto kConnection = mamori::connect(g_producer.real, g_second_producer.real, mamori::any_age());
#else
constexpr auto kConnection = mamori::connect(g_consumer.in, g_consumer.in, mamori::any_age());
#endif
}  // namespace connection_direction

// A Crossing of another payload type.
namespace crossing_of_other_type {
inline mamori::Crossing<int> g_int_crossing;
#ifdef MAMORI_BREAK_CROSSING_OF_OTHER_TYPE
constexpr auto kConnection =
    mamori::connect(g_producer.real, g_consumer.in, mamori::through(g_int_crossing), mamori::any_age());
#endif
}  // namespace crossing_of_other_type
