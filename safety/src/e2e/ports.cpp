// SPDX-License-Identifier: Apache-2.0
// Both ports of a message over each kind of input, so that the proofs about the library (symbols, stack,
// controller's compiler) see what a user's program will hold. Nothing refers to this object.
#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/safety/e2e/e2e.hpp"

namespace mamori::safety::detail {

/// A payload with numbers, a text and a sequence.
struct ExamplePayload {
    std::array<double, 2U> numbers{};
    BoundedString<7U> text{};
    BoundedSequence<std::uint32_t, 4U> sequence{};
};

}  // namespace mamori::safety::detail

MAMORI_FIELDS(mamori::safety::detail::ExamplePayload, numbers, text, sequence)

namespace mamori::safety {
namespace detail {

inline constexpr SentIdChannel kExampleChannel{1U, 12U + 8U + 28U, 12U + 8U + 48U};
inline constexpr E2eInLimits<HardenedSequence> kExampleLimits{Duration{1}, {1U}, 8U, {}};
/// A struct, for a short name of what is made of it.
struct ExampleMessage : E2eMessage<Stamped<ExamplePayload>, E2eProfile04<>, kExampleChannel> {};

}  // namespace detail

template class E2eOutPort<detail::ExampleMessage>;
template class E2eInPort<detail::ExampleMessage, detail::kExampleLimits>;
template class E2eInPort<detail::ExampleMessage, detail::kExampleLimits,
                         QueueInPort<detail::ExampleMessage::Frame, 2U>>;

}  // namespace mamori::safety
