// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: payloads, their fields and buffers, and a status that is ignored.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/component/fsm_check.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"
#include "mamori/kernel/dataflow/snapshot_cell.hpp"
#include "mamori/kernel/payload/bounded_sequence.hpp"
#include "mamori/kernel/payload/bounded_string.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

// A port carries a type without a field list.
namespace payload_without_fields {
struct Sample {
    double value;
};
}  // namespace payload_without_fields
#ifndef MAMORI_BREAK_PAYLOAD_WITHOUT_FIELDS
MAMORI_FIELDS(payload_without_fields::Sample, value)
#endif
namespace payload_without_fields {
mamori::OutPort<Sample> g_port{mamori::kNoOwner, "port"};
}  // namespace payload_without_fields

// A field list leaves the last field out.
namespace fields_left_out {
struct Sample {
    double position;
    int sequence;
    double velocity;
};
}  // namespace fields_left_out
#ifdef MAMORI_BREAK_FIELDS_LEFT_OUT
MAMORI_FIELDS(fields_left_out::Sample, position, sequence)
#else
MAMORI_FIELDS(fields_left_out::Sample, position, sequence, velocity)
#endif

// A field list names two fields of different types in the wrong order.
namespace fields_in_wrong_order {
struct Sample {
    double position;
    int sequence;
    double velocity;
};
}  // namespace fields_in_wrong_order
#ifdef MAMORI_BREAK_FIELDS_IN_WRONG_ORDER
MAMORI_FIELDS(fields_in_wrong_order::Sample, sequence, position, velocity)
#else
MAMORI_FIELDS(fields_in_wrong_order::Sample, position, sequence, velocity)
#endif

// A field list names a field that the type does not have.
namespace fields_unknown {
struct Sample {
    double position;
    int sequence;
    double velocity;
};
}  // namespace fields_unknown
#ifdef MAMORI_BREAK_FIELDS_UNKNOWN
MAMORI_FIELDS(fields_unknown::Sample, position, sequence, velocty)
#else
MAMORI_FIELDS(fields_unknown::Sample, position, sequence, velocity)
#endif

// An enumeration is encoded although nothing tells which of its values exist.
namespace enumeration_without_last {
enum class Mode { kIdle, kRun };
}  // namespace enumeration_without_last
#ifndef MAMORI_BREAK_ENUMERATION_WITHOUT_LAST
MAMORI_LAST_ENUMERATOR(enumeration_without_last::Mode, kRun)
#endif
namespace enumeration_without_last {
inline constexpr std::size_t kSize = mamori::max_encoded_size<Mode>();
}  // namespace enumeration_without_last

// A character is encoded whose form on the wire depends on the peers.
namespace wide_character {
#ifdef MAMORI_BREAK_WIDE_CHARACTER
using Character = wchar_t;
#else
using Character = char;
#endif
inline constexpr std::size_t kSize = mamori::max_encoded_size<mamori::BoundedSequence<Character, 4>>();
}  // namespace wide_character

// A literal of four characters for a string of three.
namespace literal_too_long {
#ifdef MAMORI_BREAK_LITERAL_TOO_LONG
inline constexpr mamori::BoundedString<3> kName = "four";
#else
inline constexpr mamori::BoundedString<4> kName = "four";
#endif
}  // namespace literal_too_long

// An array of three elements for a sequence of two.
namespace array_too_long {
#ifdef MAMORI_BREAK_ARRAY_TOO_LONG
inline constexpr mamori::BoundedSequence<int, 2> kNumbers = std::array{1, 2, 3};
#else
inline constexpr mamori::BoundedSequence<int, 3> kNumbers = std::array{1, 2, 3};
#endif
}  // namespace array_too_long

// The buffer carries a payload that needs a copy constructor.
namespace fifo_payload {
struct Payload {
#ifdef MAMORI_BREAK_FIFO_PAYLOAD
    Payload() = default;
    Payload(const Payload& other) : value(other.value) {}
#endif
    double value{0.0};
};
mamori::FifoBuffer<Payload, 4U> g_buffer;
}  // namespace fifo_payload

// The buffer carries a payload that needs a copy constructor.
namespace snapshot_payload {
struct Payload {
#ifdef MAMORI_BREAK_SNAPSHOT_PAYLOAD
    Payload() = default;
    Payload(const Payload& other) : value(other.value) {}
#endif
    double value{0.0};
};
mamori::SnapshotCell<Payload> g_buffer;
}  // namespace snapshot_payload

// The buffer has room for MAMORI_BREAK entries, where 1 to 254 can be; 254 compiles.
namespace fifo_capacity {
#ifndef MAMORI_BREAK_FIFO_CAPACITY
#define MAMORI_BREAK_FIFO_CAPACITY 254
#endif
mamori::FifoBuffer<double, MAMORI_BREAK_FIFO_CAPACITY> g_buffer;
}  // namespace fifo_capacity

// The status of a refusable operation is dropped.
namespace status_ignored {
void initialize();
void initialize() {
#ifdef MAMORI_BREAK_STATUS_IGNORED
    g_producer.initialize();
#else
    static_cast<void>(g_producer.initialize());
#endif
}
}  // namespace status_ignored

// A state machine has a state that no transition leads to.
namespace fsm_state_unreachable {
namespace {
constexpr std::array<mamori::FsmState, 2> kStates{{{"off"}, {"on"}}};
constexpr std::array<mamori::FsmMessage, 1> kMessages{{{"press"}}};
#ifdef MAMORI_BREAK_FSM_STATE_UNREACHABLE
constexpr std::array<mamori::FsmTransition, 1> kTransitions{{{0U, 0U, 0U}}};
#else
constexpr std::array<mamori::FsmTransition, 1> kTransitions{{{0U, 0U, 1U}}};
#endif
constexpr mamori::FsmTable kLamp{"lamp", kStates, kMessages, kTransitions, 0U};
MAMORI_CHECK_FSM(kLamp);
}  // namespace
}  // namespace fsm_state_unreachable
