// SPDX-License-Identifier: Apache-2.0
/// @file
/// An input that queues every publication of its source instead of keeping the latest, with the buffer
/// policies of OpenRTM. The source may run on another core: entries count by their planned instants, so what
/// a cycle can read does not depend on which core was faster.
///
/// @satisfies SWR-KRN-028, SWR-KRN-029, SWR-KRN-037, SWR-KRN-039      Design:
/// docs/design/kernel.md#connections Source:   OpenRTM-aist, buffer.write.full_policy and
/// buffer.read.empty_policy of a data port
#ifndef MAMORI_KERNEL_QUEUE_IN_PORT_HPP
#define MAMORI_KERNEL_QUEUE_IN_PORT_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

namespace mamori {

/// Input of type T with room for `kCapacity` values (1 .. 254) that wait.
///
/// What InPortBase tells of "the value" (whether there is one, its instant, age and status) is told, when a
/// cycle begins, of the value that the first read() gives: the oldest that waits, or the one read last when
/// none does. After a read() it is told of the value that this read gave. The next one that waits is never
/// older, so a cycle that takes it for as old errs on the safe side.
///
/// Thread safety: read by its component; filled by the executive of the source's core, which may be another.
///                Counts may be asked for anywhere, those of empty reads where the component runs.
/// Time:          wait-free; read() and push() copy one T, open() is O(kCapacity). Counts wrap at 2^32.
/// Memory:        kCapacity + 3 T and kCapacity + 2 instants, no heap.
template <typename T, std::size_t kCapacity, FullPolicy kFull = FullPolicy::kOverwrite,
          EmptyPolicy kEmpty = EmptyPolicy::kReadback, Need kNeed = Need::kMandatory>
class QueueInPort final : public InPortBase {
    static_assert(is_payload<T>(),
                  "a payload needs MAMORI_FIELDS(Type, field, ...) and must be trivially copyable");

  public:
    using Payload = T;
    static constexpr bool kIsMandatory = kNeed == Need::kMandatory;
    static constexpr bool kIsQueue = true;
    static constexpr bool kMayLeaveCore = true;

    /// @param[in] owner the component that has this port as a member. @param[in] name static storage, not
    /// nullptr.
    constexpr QueueInPort(Component& owner, const char* name) noexcept : InPortBase(owner, name) {}
    /// A port that belongs to no component and to no table.
    constexpr QueueInPort(NoOwner owner, const char* name) noexcept : InPortBase(owner, name) {}

    /// Takes the oldest value whose publication is not after the opening of the window.
    /// @param[out] value written on kOk only.
    /// @return kOk (with kReadback also for the value that was read last); kPreconditionNotMet (none waits,
    ///         and kEmpty is kDoNothing or nothing was ever read); kOutOfResources (kFull is kOverwrite and
    ///         the writer on the other core was faster: ask again).
    Status read(T& value) noexcept {
        const Status status = fetch();
        const bool is_readable_again = kEmpty == EmptyPolicy::kReadback && was_read_;
        if (status == Status::kOk || (status == Status::kPreconditionNotMet && is_readable_again)) {
            value = value_;
            return Status::kOk;
        }
        return status;
    }

    /// True when read() would give a value that was not read before. For the owner: looking holds the oldest
    /// value, which a writer that overwrites then leaves alone.
    bool has_waiting() noexcept { return buffer_.peek() == Status::kOk && is_front_due(); }

    /// Most values that ever waited, 0 .. kCapacity.
    std::uint32_t get_high_water_mark() const noexcept { return buffer_.get_high_water_mark(); }
    /// Values that were refused because kCapacity waited (kFull is kDoNothing).
    std::uint32_t get_rejected_count() const noexcept { return buffer_.get_rejected_count(); }
    /// Values that gave way before they were read (kFull is kOverwrite).
    std::uint32_t get_overwritten_count() const noexcept { return buffer_.get_overwritten_count(); }
    /// Calls of read() that found none waiting.
    std::uint32_t get_empty_read_count() const noexcept { return empty_read_count_; }

    /// All of the above at once, of an input that is such a queue. For the system table.
    static QueueCounts count(const InPortBase& base) noexcept {
        const auto& self = static_cast<const QueueInPort&>(base);
        return {static_cast<std::uint32_t>(kCapacity), self.get_high_water_mark(), self.get_rejected_count(),
                self.get_overwritten_count(), self.get_empty_read_count()};
    }

    /// For connections, on the source's core: appends a sample when it comes from a later write than the
    /// last one. A full queue counts what it refuses; nothing waits.
    /// @return kOk (also when there was nothing to append); kOutOfResources (kFull is kDoNothing, and as many
    ///         values wait as there is room for).
    Status push(const typename OutPort<T>::Sample& sample) noexcept {
        if (sample.revision <= pushed_revision_) {
            return Status::kOk;
        }
        pushed_revision_ = sample.revision;
        Entry& entry = buffer_.get_write_slot();
        entry.value = sample.value;
        entry.published_at = sample.published_at;
        return buffer_.publish();
    }

    /// For connections: what waits now is not read any more, see open(); neither is what was read last.
    void restart(Instant boundary, std::uint64_t revision) noexcept {
        InPortBase::restart(boundary, revision);
        was_read_ = false;
    }

    /// For connections, before the owner's context starts: every waiting value is dropped, also one of a
    /// later instant than those of the run that begins. Values that the source appends meanwhile may stay.
    void clear() noexcept {
        restart(kBeforeAll, 0U);
        opening_ = kBeforeAll;
        for (std::size_t i = 0U; i < kEntriesMax; ++i) {
            if (buffer_.peek() == Status::kOk) {
                buffer_.drop();
            }
        }
    }

    /// For connections, at the opening of the owner's window: what is published later waits for a later one.
    /// What was published up to the last restart() is of another mode and goes. A value that is handed on in
    /// the new mode at that very instant stays: it comes after the first opening since.
    void open(Instant opening) noexcept {
        const bool is_first = !is_open();
        opening_ = opening;
        for (std::size_t i = 0U; i < kEntriesMax && is_front_of_another_mode(is_first); ++i) {
            buffer_.drop();
        }
        show_oldest();
    }

    /// For connections, on the owner's core before its cycle: the oldest value that waits is the one to be
    /// told of.
    void show_oldest() noexcept {
        is_new_ = has_waiting();
        if (is_new_) {
            published_at_ = buffer_.get_front().published_at;
            has_value_ = true;
        }
    }

  private:
    static constexpr std::size_t kEntriesMax = kCapacity + 1U;  ///< besides those that wait, one may be held
    struct Entry {
        T value{};
        Instant published_at{};
    };

    /// False from a restart() to the next opening.
    bool is_open() const noexcept { return opening_ >= restarted_at_; }
    bool is_front_due() const noexcept { return is_open() && buffer_.get_front().published_at <= opening_; }
    bool is_front_of_another_mode(bool is_first_opening) noexcept {
        if (buffer_.peek() != Status::kOk) {
            return false;
        }
        const Instant published_at = buffer_.get_front().published_at;
        return published_at < restarted_at_ || (is_first_opening && published_at == restarted_at_);
    }

    Status fetch() noexcept {
        const Status status = buffer_.peek();
        if (status == Status::kOutOfResources) {
            return status;
        }
        if (status != Status::kOk || !is_front_due()) {
            ++empty_read_count_;
            return Status::kPreconditionNotMet;
        }
        value_ = buffer_.get_front().value;
        published_at_ = buffer_.get_front().published_at;
        has_value_ = true;
        was_read_ = true;
        buffer_.drop();
        return Status::kOk;
    }

    FifoBuffer<Entry, kCapacity, kFull, EmptyPolicy::kDoNothing> buffer_{};
    T value_{};  ///< read last
    Instant opening_{};
    std::uint64_t pushed_revision_{0U};  ///< the source's side
    std::uint32_t empty_read_count_{0U};
    bool was_read_{false};  ///< since the last restart()
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_QUEUE_IN_PORT_HPP
