// SPDX-License-Identifier: Apache-2.0
/// @file
/// Latest-value data ports. A component writes into its OutPort and reads its InPort; the executive moves
/// values at window boundaries, so what is read does not depend on how long the code took (logical execution
/// time). Within one window the executive hands a value on to the components that come later in its order.
///
/// @satisfies SWR-KRN-015, SWR-KRN-016, SWR-KRN-038, SWR-KRN-040      Design: docs/design/kernel.md#ports
#ifndef MAMORI_KERNEL_DATA_PORT_HPP
#define MAMORI_KERNEL_DATA_PORT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/port_base.hpp"
#include "mamori/kernel/payload/fields.hpp"
#include "mamori/kernel/payload/trace_hash.hpp"

namespace mamori {

/// What a port has to say about its data, with the numbers of the standard. Its PORT_ERROR (1) and
/// UNKNOWN_ERROR (5) are missing on purpose: a connection is made by the compiler and cannot fail otherwise.
/// Source: OpenRTM PortStatus (PORT_OK .. UNKNOWN_ERROR).
enum class PortStatus : std::uint32_t {
    kOk = 0U,             ///< PORT_OK
    kBufferFull = 2U,     ///< BUFFER_FULL, of an output: a queue that it feeds had no room
    kBufferEmpty = 3U,    ///< BUFFER_EMPTY, of an input
    kBufferTimeout = 4U,  ///< BUFFER_TIMEOUT, of an input: the data is too old, or of an instant to come
};

/// Age limit of an input whose connection states any_age().
inline constexpr Duration kNoAgeLimit{std::numeric_limits<std::int64_t>::max()};

/// An instant before every other one.
inline constexpr Instant kBeforeAll{std::numeric_limits<std::int64_t>::min()};

/// Must an input be fed by a connection? The system table refuses a mandatory one that is not.
enum class Need : std::uint8_t { kMandatory, kOptional };

/// What an input that queues has counted; 0 for one that keeps the latest value. Counts wrap at 2^32.
struct QueueCounts {
    std::uint32_t capacity{0U};         ///< values for which there is room; 0: no queue
    std::uint32_t high_water_mark{0U};  ///< most values that ever waited, 0 .. capacity
    std::uint32_t rejected{0U};         ///< values that were refused because the queue was full
    std::uint32_t overwritten{0U};      ///< values that gave way before they were read
    std::uint32_t empty_reads{0U};      ///< reads that found none waiting
};

/// Type-free part of an output, for the executive and the table.
///
/// Thread safety: none; all from the core of its component. Time: O(1), hash_into() O(payload). Nothing
///                blocks.
/// Memory:        no heap.
class OutPortBase : public PortBase {
  public:
    /// Number of publications so far (wraps at 2^32).
    std::uint32_t get_sequence() const noexcept { return sequence_; }
    /// Instant of the last publication; without meaning before the first.
    Instant get_published_at() const noexcept { return published_at_; }
    /// Number of the write that is published; 0: none in this run.
    std::uint64_t get_published_revision() const noexcept { return published_revision_; }
    /// What became of the value that is published.
    /// @return kBufferFull (a queue that it feeds was full and refuses what it has no room for, see
    ///         FullPolicy::kDoNothing); else kOk, before the first publication as well.
    PortStatus get_status() const noexcept {
        const bool is_refused = refused_revision_ != 0U && refused_revision_ == published_revision_;
        return is_refused ? PortStatus::kBufferFull : PortStatus::kOk;
    }
    /// True when a value was written since the last publication.
    bool is_staged() const noexcept { return is_staged_; }

    /// Makes the staged value the published one. For the executive, at the close of the window.
    /// @param[in] now instant of publication. @return true when there was one.
    bool publish(Instant now) noexcept {
        if (!is_staged_) {
            return false;
        }
        ++sequence_;  // the staged slot is the published one from here on
        published_at_ = now;
        published_revision_ = revision_;
        is_staged_ = false;
        return true;
    }
    /// Throws the staged value away: its window overran. What was published before stays.
    void discard() noexcept { is_staged_ = false; }
    /// For the executive, before a run: nothing is staged or published in it yet. The value stays readable.
    void begin_run() noexcept {
        is_staged_ = false;
        published_revision_ = 0U;
    }
    /// For connections: a queue had no room for what a write gave. @param[in] revision its number.
    void note_refused(std::uint64_t revision) noexcept { refused_revision_ = revision; }
    /// Adds the published value, its sequence and instant. For the executive, after a publication.
    void hash_into(TraceHash& hash) const noexcept;

  protected:
    using HashPublished = void (*)(const OutPortBase&, TraceHash&) noexcept;

    template <typename Owner>
    constexpr OutPortBase(Owner& owner, const char* name, HashPublished hash) noexcept
        : PortBase(owner, name), hash_published_(hash) {}
    ~OutPortBase() = default;

    /// Slot of the published value. Each publication exchanges the two, so their parity tells which it is,
    /// across the wrap as well.
    std::size_t get_published_slot() const noexcept { return sequence_ & 1U; }
    std::size_t get_staged_slot() const noexcept { return (sequence_ + 1U) & 1U; }

    HashPublished hash_published_;
    std::uint64_t revision_{0U};  ///< writes so far
    /// Stands between the two revisions: side by side, a compiler stores both as one vector, and then each
    /// write waits for the vector of the write before.
    Instant published_at_{};
    std::uint64_t published_revision_{0U};  ///< of the writes, the one that is published
    std::uint64_t refused_revision_{0U};    ///< of the writes, the last that a full queue refused
    std::uint32_t sequence_{0U};
    bool is_staged_{false};
};

/// Type-free part of an input.
///
/// Thread safety: none; all from the core of its component. Time: O(1). Memory: no heap.
class InPortBase : public PortBase {
  public:
    /// False until the first value has arrived, and again from a restart() to the next one.
    bool has_value() const noexcept { return has_value_; }
    /// True when the value arrived since the last cycle in which its owner was Active or in Error and came
    /// through its first pass within the budget. A value that the owner had no chance to use stays new.
    bool is_new() const noexcept { return is_new_; }
    /// Instant at which the value was published, or handed on within the window; without meaning before
    /// has_value().
    Instant get_published_at() const noexcept { return published_at_; }
    /// Time since the value was published, or handed on within the window; without meaning before
    /// has_value(). @param[in] now start of the window, as in ContextHandle::now.
    Duration calc_age(Instant now) const noexcept { return now - published_at_; }
    /// What the value is worth in the cycle that begins at `now`.
    /// @return kBufferEmpty (nothing has arrived yet); kBufferTimeout (older than the limit that its
    ///         connection declares, or of a later instant than `now` and its tolerance); else kOk.
    PortStatus calc_status(Instant now) const noexcept {
        if (!has_value_) {
            return PortStatus::kBufferEmpty;
        }
        const Duration age = calc_age(now);
        return age > age_max_ || age.ns < -lead_max_.ns ? PortStatus::kBufferTimeout : PortStatus::kOk;
    }
    /// For the executive, after the owner's cycle.
    void mark_read() noexcept { is_new_ = false; }
    /// Instant of the last restart(); before the first one, and after one without an instant, before every
    /// other instant.
    Instant get_restarted_at() const noexcept { return restarted_at_; }
    /// Number of restarts (wraps at 2^32). Code that keeps a value of its own compares it and drops the
    /// value.
    std::uint32_t get_restart_count() const noexcept { return restart_count_; }
    /// For the executive. @param[in] age_max  limit of the connection that feeds this input, > 0.
    ///                    @param[in] lead_max tolerance for instants to come, >= 0.
    void set_age_limits(Duration age_max, Duration lead_max) noexcept {
        age_max_ = age_max;
        lead_max_ = lead_max;
    }

  protected:
    template <typename Owner>
    constexpr InPortBase(Owner& owner, const char* name) noexcept : PortBase(owner, name) {}
    ~InPortBase() = default;

    /// For connections: another one feeds this input from `boundary` on, or none. It has no value until one
    /// arrives that was published later.
    /// @param[in] revision last one of the source before the boundary; 0 for a source whose values are judged
    ///                     by their instants, and for none.
    void restart(Instant boundary, std::uint64_t revision) noexcept {
        restarted_at_ = boundary;
        revision_ = revision;
        ++restart_count_;
        has_value_ = false;
        is_new_ = false;
    }

    Instant published_at_{};
    Duration age_max_{kNoAgeLimit};
    Duration lead_max_{};
    Instant restarted_at_{kBeforeAll};
    std::uint64_t revision_{0U};  ///< write of the source that is held here
    std::uint32_t restart_count_{0U};
    bool has_value_{false};
    bool is_new_{false};
};

namespace detail {

/// Unit in which a processor with a cache moves memory [byte].
inline constexpr std::size_t kCacheLineSize{64U};
/// Place of a payload within a port. One of many lines begins with a line, since copies between places that
/// lie differently in their lines are slower; a smaller one is not worth the padding.
template <typename T>
struct PayloadSlot {
    static constexpr std::size_t kLeastAlignment = sizeof(T) >= 16U * kCacheLineSize ? kCacheLineSize : 1U;
    alignas(T) alignas(kLeastAlignment) T value{};
};

}  // namespace detail

/// The counts of an input that keeps the latest value.
inline QueueCounts count_no_queue(const InPortBase&) noexcept {
    return {};
}

/// Output of type T. The value is a trivially copyable payload with a field list (or a plain number).
///
/// Thread safety: written by its component, published by the executive of the same core.
/// Time: O(sizeof(T)) for write, O(1) for publish. Memory: two T, each at a multiple of 64 bytes from
/// 1 KiB on.
template <typename T>
class OutPort final : public OutPortBase {
    static_assert(is_payload<T>(),
                  "a payload needs MAMORI_FIELDS(Type, field, ...) and must be trivially copyable");

  public:
    using Payload = T;

    /// @param[in] owner the component that has this port as a member: `OutPort<double> speed{*this,
    /// "speed"}`.
    /// @param[in] name  port name with static storage, not nullptr.
    constexpr OutPort(Component& owner, const char* name) noexcept
        : OutPortBase(owner, name, &hash_published) {}
    /// A port that belongs to no component and to no table.
    constexpr OutPort(NoOwner owner, const char* name) noexcept : OutPortBase(owner, name, &hash_published) {}

    /// Stages a value for the close of the window; a second write in one cycle replaces the first. For the
    /// actions of its component.
    void write(const T& value) noexcept {
        slots_[get_staged_slot()].value = value;
        ++revision_;
        is_staged_ = true;
    }

    /// Last published value; a value-initialised T before the first publication. Stays as it is until the
    /// second write() after it.
    const T& get_published() const noexcept { return slots_[get_published_slot()].value; }

    /// What a connection moves: a value, the write it comes from, and when it counts.
    struct Sample {
        const T& value;          ///< lies in its port, to be copied at once
        std::uint64_t revision;  ///< 0: there is none yet
        Instant published_at;
    };
    /// For connections: the published value.
    Sample get_published_sample() const noexcept {
        return {get_published(), published_revision_, published_at_};
    }
    /// For connections within a window: the staged value ahead of its publication, or none.
    /// @param[in] now opening of the window, from which the value counts.
    Sample get_staged_sample(Instant now) const noexcept {
        return {slots_[get_staged_slot()].value, is_staged_ ? revision_ : 0U, now};
    }

  private:
    static void hash_published(const OutPortBase& base, TraceHash& hash) noexcept {
        hash.add(static_cast<const OutPort&>(base).get_published());
    }

    std::array<detail::PayloadSlot<T>, 2U> slots_{};
};

/// Input of type T that holds the latest value.
///
/// Thread safety: read by its component, filled by the executive of the same core.
/// Time: O(sizeof(T)). Memory: one T, at a multiple of 64 bytes from 1 KiB on.
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

    /// Latched value; a value-initialised T while has_value() is false. Stays as it is within an action; the
    /// reference is valid as long as the port.
    const T& read() const noexcept { return slot_.value; }

    /// As in InPortBase; the value that was held is not left to be read either.
    void restart(Instant boundary, std::uint64_t revision) noexcept {
        InPortBase::restart(boundary, revision);
        slot_.value = T{};
    }
    /// Takes a sample when it comes from a later write than what is held. For connections.
    void take(const typename OutPort<T>::Sample& sample) noexcept {
        if (sample.revision > revision_) {
            slot_.value = sample.value;
            revision_ = sample.revision;
            published_at_ = sample.published_at;
            has_value_ = true;
            is_new_ = true;
        }
    }

  private:
    detail::PayloadSlot<T> slot_{};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_DATA_PORT_HPP
