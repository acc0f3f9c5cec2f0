// SPDX-License-Identifier: Apache-2.0
/// @file
/// Output that publishes every value that its component writes in a cycle, in the order of writing.
///
/// @satisfies SWR-KRN-053      Design: docs/design/kernel.md#ports
#ifndef MAMORI_KERNEL_QUEUE_OUT_PORT_HPP
#define MAMORI_KERNEL_QUEUE_OUT_PORT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"

namespace mamori {

/// Output of type T with a queue for the `kCapacity` values of one cycle (1 .. 254). A QueueInPort receives
/// all of them; its own policy decides when it is full. An InPort receives the newest one.
///
/// Thread safety: written by its component, published by the executive of the same core.
/// Time:          O(sizeof(T)) for write, O(1) for publish. Memory: kCapacity + 2 T, no heap.
template <typename T, std::size_t kCapacity>
class QueueOutPort final : public TypedOutPort<T> {
    static_assert(kCapacity >= 1U && kCapacity <= 254U, "a QueueOutPort has room for 1 to 254 values");

  public:
    static constexpr bool kIsQueue = true;

    /// @param[in] owner the component that has this port as a member. @param[in] name static storage, not
    /// nullptr.
    constexpr QueueOutPort(Component& owner, const char* name) noexcept : TypedOutPort<T>(owner, name) {}
    /// A port that belongs to no component and to no table.
    constexpr QueueOutPort(NoOwner owner, const char* name) noexcept : TypedOutPort<T>(owner, name) {}

    /// Stages a value for publication at window end, after the values of earlier writes of the cycle. For the
    /// actions of its component.
    /// @return kOk; kOutOfResources (kCapacity values wait for publication: the value is rejected and counted
    ///         as lost).
    Status write(const T& value) noexcept {
        if (this->staged_count_ == kCapacity) {
            ++this->rejected_count_;
            this->has_loss_ = true;
            return Status::kOutOfResources;
        }
        values_[this->staged_count_] = value;
        this->stage(value);
        ++this->staged_count_;
        value_count_ = this->staged_count_;
        return Status::kOk;
    }

    /// For connections: the values of the cycle, oldest first: staged, or published and not yet followed by
    /// a write.
    Span<const T> get_values() const noexcept { return Span<const T>{values_}.subspan(0U, value_count_); }

    /// Adds the sequence number, the instant and each value of the last publication to a hash.
    /// @param[in] port an output of this type; for tables, which have no types.
    static void hash_published(const OutPortBase& port, TraceHash& hash) noexcept {
        const auto& self = static_cast<const QueueOutPort&>(port);
        self.hash_publication(hash);
        for (const T& value : self.get_values()) {
            hash.add(value);
        }
    }

  private:
    std::array<T, kCapacity> values_{};
    std::uint8_t value_count_{0U};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_QUEUE_OUT_PORT_HPP
