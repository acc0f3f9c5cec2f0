// SPDX-License-Identifier: Apache-2.0
/// @file
/// Latest-value data ports. A component writes to its OutPort and reads its InPort. The executive moves
/// values at window boundaries, so the values read do not depend on execution times (logical execution time).
/// Within one window, the executive forwards a value to the components that are later in its order.
///
/// @satisfies SWR-KRN-015, SWR-KRN-016, SWR-KRN-038, SWR-KRN-040, SWR-KRN-054
/// Design:   docs/design/kernel.md#ports, docs/design/kernel.md#counters
#ifndef MAMORI_KERNEL_DATA_PORT_HPP
#define MAMORI_KERNEL_DATA_PORT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/detail/core_line.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/payload/trace_hash.hpp"

namespace mamori {

/// Status of the data of a port, with the numbers of the standard. PORT_ERROR (1) and UNKNOWN_ERROR (5) are
/// omitted: the compiler makes the connections, so no other failure is possible.
/// Source: OpenRTM PortStatus (PORT_OK .. UNKNOWN_ERROR).
enum class PortStatus : std::uint32_t {
    kOk = 0U,             ///< PORT_OK
    kBufferFull = 2U,     ///< BUFFER_FULL, of an output: a queue that it feeds was full
    kBufferEmpty = 3U,    ///< BUFFER_EMPTY, of an input: no value
    kBufferTimeout = 4U,  ///< BUFFER_TIMEOUT, of an input: the value is too old or from the future
};

/// Age limit of an input whose connection states any_age().
inline constexpr Duration kNoAgeLimit{std::numeric_limits<std::int64_t>::max()};

/// Ages of a fresh value of an input.
struct AgeLimits {
    Duration age_max{};   ///< maximum age, > 0; 0: not stated
    Duration lead_max{};  ///< maximum time of a value after now, >= 0
};

/// An instant before every other one.
inline constexpr Instant kBeforeAll{std::numeric_limits<std::int64_t>::min()};

/// Whether a connection must feed an input. The system table rejects an unconnected mandatory input.
enum class Need : std::uint8_t { kMandatory, kOptional };

/// Counters of a port. Counters wrap at 2^32; what does not apply to a port is 0.
struct PortCounts {
    std::uint32_t written{0U};     ///< outputs: OutPortBase::get_written_count()
    std::uint32_t received{0U};    ///< inputs: values that arrived; of a queue: values that were read
    std::uint32_t superseded{0U};  ///< inputs: values that a newer one replaced before they arrived
    std::uint32_t lost{0U};        ///< outputs: OutPortBase::get_lost_count(); inputs: see their function
    std::uint32_t waiting{0U};     ///< values in a queue
    std::uint32_t capacity{0U};    ///< maximum number of values that can wait; 0: no queue
    std::uint32_t high_water_mark{0U};  ///< maximum number of values that have waited, 0 .. capacity
    std::uint32_t rejected{0U};         ///< of `lost`: values rejected because the queue was full
    std::uint32_t overwritten{0U};      ///< of `lost`: values overwritten before they were read
    std::uint32_t empty_reads{0U};      ///< reads that found no waiting value
};

/// Type-free part of an output, for the executive and the table.
///
/// Thread safety: none; all from the core of its component. Time: O(1). Nothing blocks. Memory: no heap.
class OutPortBase : public Member {
  public:
    /// Number of publications so far (wraps at 2^32).
    std::uint32_t get_sequence() const noexcept { return sequence_; }
    /// Instant of the last publication; meaningless before the first publication.
    Instant get_published_at() const noexcept { return published_at_; }
    /// Revision (number of the write) of the published value; 0: no publication in this run.
    std::uint64_t get_published_revision() const noexcept { return published_revision_; }
    /// Whether the last publication of this run was the one of `instant`.
    bool was_published_at(Instant instant) const noexcept {
        return published_revision_ != 0U && published_at_ == instant;
    }
    /// Status of the published value.
    /// @return kBufferFull (a full queue that it feeds has rejected the value, see FullPolicy::kDoNothing);
    ///         otherwise kOk, also before the first publication.
    PortStatus get_status() const noexcept {
        const bool is_refused = refused_revision_ != 0U && refused_revision_ == published_revision_;
        return is_refused ? PortStatus::kBufferFull : PortStatus::kOk;
    }
    /// True when a written value waits for publication.
    bool is_staged() const noexcept { return staged_count_ != 0U; }
    /// Number of values that wait for publication: at most 1, and at most the capacity of a QueueOutPort.
    std::uint32_t get_staged_count() const noexcept { return staged_count_; }
    /// Revision of the last write that was accepted, since construction; 0: no write.
    std::uint64_t get_revision() const noexcept { return revision_; }
    /// Number of writes since construction, also of rejected ones (wraps at 2^32).
    std::uint32_t get_written_count() const noexcept {
        return static_cast<std::uint32_t>(revision_) + rejected_count_;
    }
    /// Number of values that no connection receives: a full QueueOutPort rejected them, or their window was
    /// discarded (wraps at 2^32). An input of the same window may have received such a value before.
    std::uint32_t get_lost_count() const noexcept { return rejected_count_ + discarded_count_; }
    /// The counters above.
    PortCounts get_counts() const noexcept {
        PortCounts counts;
        counts.written = get_written_count();
        counts.lost = get_lost_count();
        counts.rejected = rejected_count_;
        return counts;
    }
    /// For connections between cores: get_revision() at the start of the run (wraps at 2^32).
    std::uint32_t get_run_revision() const noexcept { return run_revision_; }
    /// For connections between cores: number of values discarded in this run.
    std::uint32_t get_discarded_in_run() const noexcept { return discarded_count_ - run_discarded_count_; }

    /// Publishes the staged value. For the executive, at window end.
    /// @param[in] now instant of publication. @return true when a value was staged.
    bool publish(Instant now) noexcept {
        if (staged_count_ == 0U) {
            return false;
        }
        ++sequence_;  // the staged slot becomes the published slot
        published_at_ = now;
        published_revision_ = revision_;
        staged_count_ = 0U;
        return true;
    }
    /// Discards the staged values, because their window overran, and counts them as lost. The published value
    /// does not change.
    void discard() noexcept {
        discarded_count_ += staged_count_;
        has_loss_ = has_loss_ || staged_count_ != 0U;
        staged_count_ = 0U;
    }
    /// For the executive, before a run: no value of the run is staged or published. The value remains
    /// readable.
    void begin_run() noexcept {
        discard();
        published_revision_ = 0U;
        run_revision_ = static_cast<std::uint32_t>(revision_);
        run_discarded_count_ = discarded_count_;
        reported_frame_ = kBeforeAll;
        has_loss_ = false;
    }
    /// For connections: a full queue rejected the value of a write. @param[in] revision number of the write.
    void note_refused(std::uint64_t revision) noexcept {
        refused_revision_ = revision;
        has_loss_ = true;
    }
    /// For connections: a full queue overwrote an older value.
    void note_overwritten() noexcept { has_loss_ = true; }
    /// For the executive: whether to report a loss of this run now, at most once per major frame. A second
    /// loss in a frame is reported in the next frame. @param[in] frame start of the major frame.
    bool take_loss(Instant frame) noexcept {
        if (!has_loss_ || reported_frame_ == frame) {
            return false;
        }
        has_loss_ = false;
        reported_frame_ = frame;
        return true;
    }

  protected:
    template <typename Owner>
    constexpr OutPortBase(Owner& owner, const char* name) noexcept : Member(owner, MemberKind::kPort, name) {}
    ~OutPortBase() = default;

    /// Slot of the published value. Each publication swaps the slots, so the parity of the sequence number
    /// selects the slot, also after a wrap.
    std::size_t get_published_slot() const noexcept { return sequence_ & 1U; }
    std::size_t get_staged_slot() const noexcept { return (sequence_ + 1U) & 1U; }

    std::uint64_t revision_{0U};  ///< number of writes so far
    /// Placed between the two revisions: if they were adjacent, a compiler would store both as one vector,
    /// and each write would wait for the vector store of the previous write.
    Instant published_at_{};
    std::uint64_t published_revision_{0U};  ///< revision of the published value
    std::uint64_t refused_revision_{0U};    ///< revision of the last write that a full queue rejected
    std::uint32_t sequence_{0U};
    std::uint32_t rejected_count_{0U};
    std::uint8_t staged_count_{0U};
    bool has_loss_{false};  ///< not reported yet

  private:
    std::uint32_t discarded_count_{0U};
    std::uint32_t run_revision_{0U};         ///< revision at the start of the run
    std::uint32_t run_discarded_count_{0U};  ///< discarded_count_ at the start of the run
    Instant reported_frame_{kBeforeAll};     ///< major frame of the last report
};

/// Type-free part of an input.
///
/// Thread safety: none; all from the core of its component. Time: O(1). Memory: no heap.
class InPortBase : public Member {
  public:
    /// False until the first value arrives, and from a restart() until the next value.
    bool has_value() const noexcept { return arrived_in_ != kNever; }
    /// True when the value arrived after the last cycle in which the owner was Active or in Error and
    /// completed its first pass within the budget. A value that the owner could not use remains new.
    bool is_new() const noexcept { return arrived_in_ == *read_pass_; }
    /// Instant at which the value was published, or forwarded within the window; meaningless while
    /// has_value() is false.
    Instant get_published_at() const noexcept { return published_at_; }
    /// Time since the value was published, or forwarded within the window; meaningless while has_value() is
    /// false. @param[in] now window start, as in ContextHandle::now.
    Duration calc_age(Instant now) const noexcept { return now - published_at_; }
    /// Status of the value in the cycle that starts at `now`.
    /// @return kBufferEmpty (no value); kBufferTimeout (older than the age limit of the connection, or later
    ///         than `now` by more than the tolerance); otherwise kOk.
    PortStatus calc_status(Instant now) const noexcept {
        if (!has_value()) {
            return PortStatus::kBufferEmpty;
        }
        const Duration age = calc_age(now);
        const bool is_fresh = age <= limits_->age_max && age.ns >= -limits_->lead_max.ns;
        return is_fresh ? PortStatus::kOk : PortStatus::kBufferTimeout;
    }
    /// For code that drives a port without an executive: is_new() becomes false.
    void mark_read() noexcept { arrived_in_ = has_value() ? kRead : kNever; }
    /// Instant of the last restart(); kBeforeAll before the first restart() and after a restart() without an
    /// instant.
    Instant get_restarted_at() const noexcept { return restarted_at_; }
    /// Number of restarts (wraps at 2^32). Code that keeps a value of its own compares this number and drops
    /// the value after a change.
    std::uint32_t get_restart_count() const noexcept { return restart_count_; }
    /// Number of window starts for which newer values may have overwritten the planned one, because the core
    /// of this input was late by a period of the writer or more (wraps at 2^32). The input then holds an
    /// older value than planned. Always 0 for a connection within a core.
    std::uint32_t get_missed_count() const noexcept { return missed_count_; }
    /// For connections between cores.
    void record_missed() noexcept { ++missed_count_; }
    /// For connections: the last `count` values of the source were discarded. Those up to the value held here
    /// are not lost for this input: it received them within the window.
    /// @param[in] revision of the last discarded value, >= that of the value held here.
    void note_discarded(std::uint32_t count, std::uint64_t revision) noexcept {
        const std::uint32_t lost = count_newer(count, revision, revision_);
        undecided_lost_count_ = get_undecided_lost_count() + lost;
        undecided_since_ = static_cast<std::uint32_t>(revision_);
        lost_count_ += lost;
    }
    /// For connections between cores: `count` values before the next one that arrives were discarded.
    void add_lost(std::uint32_t count) noexcept { lost_count_ += count; }
    /// For connections: the counters begin after the value with this revision.
    void begin_counts(std::uint32_t revision) noexcept {
        if (revision == static_cast<std::uint32_t>(revision_)) {
            return;
        }
        base_ += revision - static_cast<std::uint32_t>(revision_) - get_undecided_lost_count();
        undecided_lost_count_ = 0U;
    }

    /// Counters of an input with the latest value. Of the values that its connection wrote, up to the one
    /// that arrived last: written = received + superseded + lost. What was under way when a run or a mode
    /// ended is not counted.
    PortCounts get_latest_counts() const noexcept {
        PortCounts counts;
        counts.received = received_count_;
        counts.lost = lost_count_;
        counts.superseded = static_cast<std::uint32_t>(revision_) - base_ - received_count_ -
                            (lost_count_ - get_undecided_lost_count());
        return counts;
    }
    /// For the executive. @param[in] limits of the connection that feeds this input; referred to until
    /// reset_age_limits().
    void set_age_limits(const AgeLimits& limits) noexcept { limits_ = &limits; }
    void set_age_limits(const AgeLimits&&) = delete;
    /// For the executive: no limits, as before the first set_age_limits().
    void reset_age_limits() noexcept { limits_ = &kNoLimits; }

  protected:
    /// @return how many of `count` values up to `revision` are newer than `held`.
    static std::uint32_t count_newer(std::uint32_t count, std::uint64_t revision,
                                     std::uint64_t held) noexcept {
        const std::uint64_t newer_count = revision - held;
        return newer_count < count ? static_cast<std::uint32_t>(newer_count) : count;
    }

    constexpr InPortBase(Component& owner, const char* name) noexcept
        : Member(owner, MemberKind::kPort, name), read_pass_(&owner.get_read_pass()) {}
    constexpr InPortBase(NoOwner owner, const char* name) noexcept : Member(owner, MemberKind::kPort, name) {}
    ~InPortBase() = default;

    /// Records that a new value has arrived.
    void record_arrival() noexcept { arrived_in_ = *read_pass_; }
    /// Records that the port has a value; does not change is_new().
    void record_value() noexcept { arrived_in_ = has_value() ? arrived_in_ : kRead; }

    /// For connections: another connection, or none, feeds this input from `boundary` on. The input has no
    /// value until a value published later arrives.
    /// @param[in] revision last revision of the source before the boundary; 0 when instants decide which
    ///                     values are accepted, and when there is no source.
    void restart(Instant boundary, std::uint64_t revision) noexcept {
        begin_counts(static_cast<std::uint32_t>(revision));
        restarted_at_ = boundary;
        revision_ = revision;
        ++restart_count_;
        arrived_in_ = kNever;
    }

    Instant published_at_{};
    Instant restarted_at_{kBeforeAll};
    std::uint64_t revision_{0U};  ///< revision of the value held here
    std::uint32_t restart_count_{0U};
    std::uint32_t missed_count_{0U};
    std::uint32_t received_count_{0U};

  private:
    static constexpr AgeLimits kNoLimits{kNoAgeLimit, {}};
    static constexpr std::uint64_t kNever = 0U;  ///< no value
    static constexpr std::uint64_t kRead = 1U;   ///< before every pass: a value that is not new
    static constexpr std::uint64_t kNoOwnersPass = Component::kFirstReadPass;

    /// Lost values that are newer than the value held here.
    std::uint32_t get_undecided_lost_count() const noexcept {
        return undecided_since_ == static_cast<std::uint32_t>(revision_) ? undecided_lost_count_ : 0U;
    }

    std::uint32_t lost_count_{0U};
    std::uint32_t undecided_lost_count_{0U};
    std::uint32_t undecided_since_{0U};  ///< revision held here when they were lost
    std::uint32_t base_{0U};             ///< revisions that no counter contains
    /// Pass of the owner in which the value arrived, so that the end of a pass makes all inputs of the owner
    /// read without a step per input.
    std::uint64_t arrived_in_{kNever};
    const std::uint64_t* read_pass_{&kNoOwnersPass};  ///< current pass of the owner
    const AgeLimits* limits_{&kNoLimits};
};

namespace detail {

/// Storage of a payload within a port. A payload of many cache lines starts at a line boundary, because
/// copies between different alignments are slower. For a smaller payload, the padding is not worthwhile.
template <typename T>
struct PayloadSlot {
    static constexpr std::size_t kLeastAlignment = sizeof(T) >= 16U * kCoreLineSize ? kCoreLineSize : 1U;
    alignas(T) alignas(kLeastAlignment) T value{};
};

}  // namespace detail

/// Counters of an input that keeps the latest value. For the system table.
inline PortCounts count_latest(const InPortBase& port) noexcept {
    return port.get_latest_counts();
}

/// Part of an output of type T that connections use. The value is a trivially copyable payload with a field
/// list (or a plain number).
template <typename T>
class TypedOutPort : public OutPortBase {
    static_assert(is_payload<T>(),
                  "a payload needs MAMORI_FIELDS(Type, field, ...) and must be trivially copyable");

  public:
    using Payload = T;

    /// Last published value; a value-initialised T before the first publication. The referenced value does
    /// not change until the second write() after the publication.
    const T& get_published() const noexcept { return slots_[get_published_slot()].value; }

    /// Data that a connection moves: a value, its revision and its instant.
    struct Sample {
        const T& value;          ///< refers to the port; copy immediately
        std::uint64_t revision;  ///< number of the write; 0: no value
        Instant published_at;
    };
    /// For connections: the published value.
    Sample get_published_sample() const noexcept {
        return {get_published(), published_revision_, published_at_};
    }
    /// For connections within a window: the staged value before its publication, or none.
    /// @param[in] now window start, which becomes the instant of the value.
    Sample get_staged_sample(Instant now) const noexcept {
        return {slots_[get_staged_slot()].value, is_staged() ? revision_ : 0U, now};
    }

  protected:
    template <typename Owner>
    constexpr TypedOutPort(Owner& owner, const char* name) noexcept : OutPortBase(owner, name) {}
    ~TypedOutPort() = default;

    /// The staged value becomes `value`.
    void stage(const T& value) noexcept {
        slots_[get_staged_slot()].value = value;
        ++revision_;
    }
    void hash_publication(TraceHash& hash) const noexcept {
        hash(get_sequence());
        hash(get_published_at().ns);
    }

  private:
    std::array<detail::PayloadSlot<T>, 2U> slots_{};
};

/// Output of type T that publishes the latest value of a cycle.
///
/// Thread safety: written by its component, published by the executive of the same core.
/// Time: O(sizeof(T)) for write, O(1) for publish. Memory: two T, each aligned to 64 bytes from 1 KiB on.
template <typename T>
class OutPort final : public TypedOutPort<T> {
  public:
    static constexpr bool kIsQueue = false;

    /// @param[in] owner the component that has this port as a member: `OutPort<double> speed{*this,
    /// "speed"}`.
    /// @param[in] name  port name with static storage, not nullptr.
    constexpr OutPort(Component& owner, const char* name) noexcept : TypedOutPort<T>(owner, name) {}
    /// A port that belongs to no component and to no table.
    constexpr OutPort(NoOwner owner, const char* name) noexcept : TypedOutPort<T>(owner, name) {}

    /// Stages a value for publication at window end; a second write in one cycle replaces the first, which is
    /// superseded. For the actions of its component.
    void write(const T& value) noexcept {
        this->stage(value);
        this->staged_count_ = 1U;
    }

    /// Adds the sequence number, the instant and the value of the last publication to a hash.
    /// @param[in] port an output of this type; for tables, which have no types.
    static void hash_published(const OutPortBase& port, TraceHash& hash) noexcept {
        const auto& self = static_cast<const OutPort&>(port);
        self.hash_publication(hash);
        hash.add(self.get_published());
    }
};

/// Input of type T that holds the latest value.
///
/// Thread safety: read by its component, filled by the executive of the same core.
/// Time: O(sizeof(T)). Memory: one T, aligned to 64 bytes from 1 KiB on.
template <typename T, Need kNeed = Need::kMandatory>
class InPort final : public InPortBase {
    static_assert(is_payload<T>(),
                  "a payload needs MAMORI_FIELDS(Type, field, ...) and must be trivially copyable");

  public:
    using Payload = T;
    static constexpr bool kIsMandatory = kNeed == Need::kMandatory;
    static constexpr bool kIsQueue = false;

    /// @param[in] owner the component that has this port as a member: `InPort<double> speed{*this, "speed"}`.
    /// @param[in] name  port name with static storage, not nullptr.
    constexpr InPort(Component& owner, const char* name) noexcept : InPortBase(owner, name) {}
    /// A port that belongs to no component and to no table.
    constexpr InPort(NoOwner owner, const char* name) noexcept : InPortBase(owner, name) {}

    /// Latched value; a value-initialised T while has_value() is false. Does not change during an action; the
    /// reference is valid as long as the port.
    const T& read() const noexcept { return slot_.value; }

    /// As InPortBase::restart(); also replaces the value by a value-initialised T.
    void restart(Instant boundary, std::uint64_t revision) noexcept {
        InPortBase::restart(boundary, revision);
        slot_.value = T{};
    }
    /// Accepts a sample whose revision is higher than that of the current value. For connections.
    void take(const typename TypedOutPort<T>::Sample& sample) noexcept {
        if (sample.revision > revision_) {
            slot_.value = sample.value;
            revision_ = sample.revision;
            published_at_ = sample.published_at;
            ++received_count_;
            record_arrival();
        }
    }

  private:
    detail::PayloadSlot<T> slot_{};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_DATA_PORT_HPP
