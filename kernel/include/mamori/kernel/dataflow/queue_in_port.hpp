// SPDX-License-Identifier: Apache-2.0
/// @file
/// An input that queues every publication of its source instead of keeping the latest, with the buffer
/// policies of OpenRTM. The source may run on another core. Planned instants decide which entries a cycle can
/// read, not the relative speed of the cores.
///
/// @satisfies SWR-KRN-028, SWR-KRN-029, SWR-KRN-037, SWR-KRN-039, SWR-KRN-054
/// Design:   docs/design/kernel.md#connections, docs/design/kernel.md#counters
/// Source:   OpenRTM-aist, buffer.write.full_policy and buffer.read.empty_policy of a data port
#ifndef MAMORI_KERNEL_QUEUE_IN_PORT_HPP
#define MAMORI_KERNEL_QUEUE_IN_PORT_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

namespace mamori {

/// Input of type T with a queue for `kCapacity` waiting values (1 .. 254).
///
/// At cycle start, the functions of InPortBase (value present, instant, age, status) refer to the value that
/// the first read() returns: the oldest waiting value, or the value read last when none waits. After a
/// read(), they refer to the value that this read() returned. The next waiting value is never older, so using
/// this age for it is safe.
///
/// Thread safety: read by its component; filled by the executive of the source's core, which may be another.
///                The counters can be read from anywhere, that of empty reads only where the component runs.
/// Time:          wait-free; read() and push() copy one T, open() is O(kCapacity). Counters wrap at 2^32.
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

    /// Takes the oldest value that was published at or before the window start.
    /// @param[out] value written on kOk only.
    /// @return kOk (with kReadback also for the value that was read last); kPreconditionNotMet (none waits,
    ///         and kEmpty is kDoNothing or nothing was read since the last restart()); kOutOfResources (kFull
    ///         is kOverwrite and the writer on the other core was faster: call again).
    Status read(T& value) noexcept {
        const Status status = fetch();
        const bool is_readable_again = kEmpty == EmptyPolicy::kReadback && was_read_;
        if (status == Status::kOk || (status == Status::kPreconditionNotMet && is_readable_again)) {
            value = value_;
            return Status::kOk;
        }
        return status;
    }

    /// True when read() would return a value that was not read before. For the owner. The call holds the
    /// oldest value, so that an overwriting writer cannot replace it.
    bool has_waiting() noexcept { return buffer_.peek() == Status::kOk && is_front_due(); }

    /// Maximum number of values that have waited, 0 .. kCapacity.
    std::uint32_t get_high_water_mark() const noexcept { return buffer_.get_high_water_mark(); }
    /// Number of values rejected because kCapacity values waited (kFull is kDoNothing).
    std::uint32_t get_rejected_count() const noexcept { return buffer_.get_rejected_count(); }
    /// Number of values overwritten before they were read (kFull is kOverwrite).
    std::uint32_t get_overwritten_count() const noexcept { return buffer_.get_overwritten_count(); }
    /// Number of read() calls that found no waiting value.
    std::uint32_t get_empty_read_count() const noexcept { return empty_read_count_; }

    /// All counters. Of the values that the source wrote, up to the one that it appended last:
    /// written = received + superseded + lost + waiting. Values that another one replaced before publication,
    /// and values of modes in which the connection is inactive, count as superseded. Values of another run or
    /// mode that were dropped unread count as lost. While the source runs on another core, `waiting` may
    /// contain a value that has just been read.
    PortCounts get_counts() const noexcept {
        PortCounts counts;
        counts.received = received_count_;
        counts.capacity = static_cast<std::uint32_t>(kCapacity);
        counts.high_water_mark = get_high_water_mark();
        counts.rejected = get_rejected_count();
        counts.overwritten = get_overwritten_count();
        counts.empty_reads = get_empty_read_count();
        const std::uint32_t lost = counts.rejected + counts.overwritten + dropped_count_;
        counts.lost = lost + source_.discarded_count.load(std::memory_order_relaxed);
        counts.superseded = source_.superseded_count.load(std::memory_order_relaxed);
        counts.waiting = source_.pushed_count.load(std::memory_order_relaxed) - received_count_ - lost;
        return counts;
    }
    /// As get_counts(). @param[in] base an input of this type. For the system table.
    static PortCounts count(const InPortBase& base) noexcept {
        return static_cast<const QueueInPort&>(base).get_counts();
    }

    /// For connections, on the core of the source: appends a sample whose revision is higher than that of the
    /// last sample. A full queue counts the values that it rejects or overwrites; nothing blocks.
    /// @return kOk (also when there was nothing to append); kOutOfResources (kFull is kDoNothing, and
    ///         kCapacity values wait).
    Status push(const typename TypedOutPort<T>::Sample& sample) noexcept {
        if (sample.revision <= source_.revision) {
            return Status::kOk;
        }
        const auto gap = static_cast<std::uint32_t>(sample.revision - source_.revision - 1U);
        count_up(source_.superseded_count, gap - source_.discarded_since);
        count_up(source_.pushed_count, 1U);
        source_.discarded_since = 0U;
        source_.revision = sample.revision;
        Entry& entry = buffer_.get_write_slot();
        entry.value = sample.value;
        entry.published_at = sample.published_at;
        return buffer_.publish();
    }

    /// For connections, on the core of the source: as InPortBase::note_discarded().
    void note_discarded(std::uint32_t count, std::uint64_t revision) noexcept {
        const std::uint32_t lost = count_newer(count, revision, source_.revision);
        source_.discarded_since += lost;
        count_up(source_.discarded_count, lost);
    }

    /// For connections: makes the waiting values and the value read last unreadable; see open().
    void restart(Instant boundary, std::uint64_t revision) noexcept {
        InPortBase::restart(boundary, revision);
        was_read_ = false;
    }

    /// For connections, before the owner's context starts: drops every waiting value, including values from
    /// instants after the start of the new run. Values that the source appends during the call may remain.
    void clear() noexcept {
        restart(kBeforeAll, 0U);
        opening_ = kBeforeAll;
        for (std::size_t i = 0U; i < kEntriesMax; ++i) {
            if (buffer_.peek() == Status::kOk) {
                drop_unread();
            }
        }
    }

    /// For connections, at window start of the owner: values published later wait for a later window. Values
    /// published up to the last restart() belong to another mode and are dropped. A value that is forwarded
    /// in the new mode at exactly that instant remains: it follows the first window start since then.
    void open(Instant opening) noexcept {
        const bool is_first = !is_open();
        opening_ = opening;
        for (std::size_t i = 0U; i < kEntriesMax && is_front_of_another_mode(is_first); ++i) {
            drop_unread();
        }
        show_oldest();
    }

    /// For connections, on the owner's core before its cycle: the functions of InPortBase now refer to the
    /// oldest waiting value, if any.
    void show_oldest() noexcept {
        if (has_waiting()) {
            published_at_ = buffer_.get_front().published_at;
            record_arrival();
        } else {
            mark_read();
        }
    }

  private:
    static constexpr std::size_t kEntriesMax = kCapacity + 1U;  ///< waiting entries, plus one held entry
    struct Entry {
        T value{};
        Instant published_at{};
    };

    /// False from a restart() to the next window start.
    bool is_open() const noexcept { return opening_ >= restarted_at_; }
    bool is_front_due() const noexcept { return is_open() && buffer_.get_front().published_at <= opening_; }
    bool is_front_of_another_mode(bool is_first_opening) noexcept {
        if (buffer_.peek() != Status::kOk) {
            return false;
        }
        const Instant published_at = buffer_.get_front().published_at;
        return published_at < restarted_at_ || (is_first_opening && published_at == restarted_at_);
    }

    void drop_unread() noexcept {
        ++dropped_count_;
        buffer_.drop();
    }
    /// Each counter has one writer, so a load and a store suffice.
    static void count_up(std::atomic<std::uint32_t>& count, std::uint32_t by) noexcept {
        count.store(count.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
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
        record_value();
        was_read_ = true;
        ++received_count_;
        buffer_.drop();
        return Status::kOk;
    }

    /// Written by the core of the source only.
    struct SourceSide {
        std::uint64_t revision{0U};         ///< of the value that was appended or rejected last
        std::uint32_t discarded_since{0U};  ///< discarded values that are newer
        std::atomic<std::uint32_t> discarded_count{0U};
        std::atomic<std::uint32_t> superseded_count{0U};
        std::atomic<std::uint32_t> pushed_count{0U};  ///< appended and rejected values
    };

    FifoBuffer<Entry, kCapacity, kFull, EmptyPolicy::kDoNothing> buffer_{};
    SourceSide source_{};
    T value_{};  ///< value read last
    Instant opening_{};
    std::uint32_t empty_read_count_{0U};
    std::uint32_t dropped_count_{0U};  ///< values of another run or mode that were not read
    bool was_read_{false};             ///< since the last restart()
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_QUEUE_IN_PORT_HPP
