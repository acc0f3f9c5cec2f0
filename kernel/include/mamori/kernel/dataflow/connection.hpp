// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a connection moves values: at window start of the sink, within a window and, between cores or
/// partitions, through a wait-free buffer.
///
/// @satisfies SWR-KRN-016, SWR-KRN-026, SWR-KRN-039, SWR-KRN-052, SWR-KRN-054
/// Design:   docs/design/kernel.md#connections, docs/design/kernel.md#counters
#ifndef MAMORI_KERNEL_CONNECTION_HPP
#define MAMORI_KERNEL_CONNECTION_HPP

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/dataflow/fifo_buffer.hpp"

namespace mamori {

/// Type-free part of the storage of a connection between cores or partitions. The table refers to the storage
/// by this type, which has no operations.
class CrossingBase {
  public:
    CrossingBase(const CrossingBase&) = delete;
    CrossingBase& operator=(const CrossingBase&) = delete;

  protected:
    constexpr CrossingBase() noexcept = default;
    ~CrossingBase() = default;
};

/// Storage of one connection between two cores or two partitions:
///     static mamori::Crossing<JointState> to_planner;
///     mamori::connect(monitor.joints, planner.joints, mamori::through(to_planner), mamori::any_age())
/// Planned instants decide which value the reader receives, not the relative speed of the cores. The storage
/// keeps the last two publications. Therefore, a reader that is late by less than one period of the writer
/// still receives the value of its planned window start.
///
/// Thread safety: one core writes, one core reads, neither waits. Time: deliver() copies one T, latch() at
///                most kEntriesMax. Memory: four T.
/// @tparam Word only tests specify another type.
template <typename T, typename Word = std::atomic<std::uint32_t>>
class Crossing final : public CrossingBase {
  public:
    constexpr Crossing() noexcept = default;

    /// For the executive of the writing core, immediately after the publication.
    void deliver(const TypedOutPort<T>& source) noexcept {
        const typename TypedOutPort<T>::Sample sample = source.get_published_sample();
        Entry& entry = buffer_.get_write_slot();
        entry.value = sample.value;
        entry.revision = sample.revision;
        entry.published_at = sample.published_at;
        entry.number = ++delivered_count_;
        entry.discarded = source.get_discarded_in_run();
        entry.run = source.get_run_revision();
        static_cast<void>(buffer_.publish());  // always succeeds: a full buffer overwrites its oldest entry
    }
    /// For the executive of the reading core, at its window start. The sink receives the newest value that
    /// was published by `opening`; a later value is left for a later window. A value from before the last
    /// restart() of the sink belongs to another mode and is ignored. If newer values have overwritten the
    /// value of this window start, the sink counts it.
    /// @param[in,out] sink always the same sink: it stores which value it has accepted.
    template <typename Sink>
    void latch(Sink& sink, Instant opening) noexcept {
        Status status = buffer_.peek();
        // Not more than can wait: what arrives meanwhile is later than `opening`.
        for (std::size_t i = 0U; i < kEntriesMax && is_due(status, opening); ++i) {
            take(sink, buffer_.get_front());
            buffer_.drop();
            status = buffer_.peek();
        }
        // kOk: the front is the first later value.
        if (status == Status::kOutOfResources ||
            (status == Status::kOk && buffer_.get_front().number != last_number_ + 1U)) {
            sink.record_missed();
        }
    }

    /// For the executive of the reading core, before it starts: drops the values in the buffer, which are
    /// from an earlier run. Instants cannot show this: the time line of a run may start before the end of the
    /// last run.
    template <typename Sink>
    void clear(Sink& sink) noexcept {
        for (std::size_t i = 0U; i < kEntriesMax && buffer_.peek() == Status::kOk; ++i) {
            last_number_ = buffer_.get_front().number;
            buffer_.drop();
        }
        sink.restart(kBeforeAll, 0U);
    }

  private:
    static constexpr std::size_t kKept = 2U;  ///< the last publication and the one before it
    /// Waiting entries, plus one that an earlier latch() left.
    static constexpr std::size_t kEntriesMax = kKept + 1U;
    struct Entry {
        T value{};
        std::uint64_t revision{0U};
        std::uint64_t number{0U};  ///< of the delivery: 1, 2, ...
        Instant published_at{};
        std::uint32_t discarded{0U};  ///< by the source before it, in its run
        std::uint32_t run{0U};        ///< revision of the source at the start of its run
    };

    /// Whether a peek() has found a value that was published by `opening`.
    bool is_due(Status status, Instant opening) const noexcept {
        return status == Status::kOk && buffer_.get_front().published_at <= opening;
    }
    template <typename Sink>
    void take(Sink& sink, const Entry& entry) noexcept {
        last_number_ = entry.number;
        if (entry.published_at > sink.get_restarted_at()) {
            count_gap(sink, entry);
            sink.take({entry.value, entry.revision, entry.published_at});
        }
    }
    /// Counts the values between the one that arrived last and `entry`. At the start of a run of the source,
    /// its counters begin with the run; at another restart of the sink, with `entry`.
    template <typename Sink>
    void count_gap(Sink& sink, const Entry& entry) noexcept {
        const bool is_new_run = entry.run != run_;
        if (is_new_run || sink.get_restart_count() != counted_restarts_) {
            counted_restarts_ = sink.get_restart_count();
            run_ = entry.run;
            discarded_ = is_new_run ? 0U : entry.discarded;
            sink.begin_counts(is_new_run ? entry.run : static_cast<std::uint32_t>(entry.revision - 1U));
        }
        sink.add_lost(entry.discarded - discarded_);
        discarded_ = entry.discarded;
    }

    FifoBuffer<Entry, kKept, FullPolicy::kOverwrite, EmptyPolicy::kReadback, Word> buffer_{};
    std::uint64_t delivered_count_{0U};  ///< used by the writing core only
    // Used by the reading core only.
    std::uint64_t last_number_{0U};       ///< of the entry read or dropped last
    std::uint32_t run_{kNoRun};           ///< Entry::run of the entry that arrived last
    std::uint32_t discarded_{0U};         ///< Entry::discarded of the entry that arrived last
    std::uint32_t counted_restarts_{0U};  ///< restarts of the sink that its counters contain
    static constexpr std::uint32_t kNoRun = 0xFFFFFFFFU;
};

/// What a connection joins. Ports and crossing have the types passed to connect(); nothing checks them again.
struct ConnectionEnds {
    OutPortBase* source{nullptr};
    InPortBase* sink{nullptr};
    CrossingBase* crossing{nullptr};  ///< storage of a connection that leaves its core or partition
};

/// Functions that the executive calls for a connection; one constant per pair of port types. nullptr: nothing
/// to do. The crossing is not used where the connection has none.
///
/// Calling context: deliver, hand_on and note_discarded on the core of the source, latch on the core of the
///                  sink.
struct ConnectionOperations {
    /// After a publication of the source.
    void (*deliver)(const ConnectionEnds&) noexcept {nullptr};
    /// At window start of the sink.
    void (*latch)(const ConnectionEnds&, Instant opening) noexcept {nullptr};
    /// Forwards the value after the cycle of the source, when the sink follows in the same window.
    void (*hand_on)(const ConnectionEnds&, Instant opening) noexcept {nullptr};
    /// When the connection ends or starts with the major frame at `boundary`, before the first latch in that
    /// frame: values published until then belong to another mode. With kBeforeAll, before the core of the
    /// sink starts: values published until then belong to another run.
    void (*restart)(const ConnectionEnds&, Instant boundary) noexcept {nullptr};
    /// Before the staged values of the source are discarded: the sink counts those that it has not received.
    void (*note_discarded)(const ConnectionEnds&) noexcept {nullptr};
    /// Source and sink may run on two cores or in two partitions. If so, `deliver` is set.
    bool may_leave_core{false};
    bool is_latest{false};  ///< only the newest value is kept, so the order of writer and reader matters
    /// Set by connect(). A flag, because with some sanitizers g++ does not compare the addresses with nullptr
    /// in a constant expression.
    bool is_set{false};
};

namespace detail {

/// A sink that keeps the latest value, on the core of the source.
template <typename T, typename Sink>
struct LatestConnection {
    static void latch(const ConnectionEnds& ends, Instant) noexcept {
        static_cast<Sink*>(ends.sink)->take(
            static_cast<TypedOutPort<T>*>(ends.source)->get_published_sample());
    }
    static void hand_on(const ConnectionEnds& ends, Instant opening) noexcept {
        const auto& source = *static_cast<TypedOutPort<T>*>(ends.source);
        static_cast<Sink*>(ends.sink)->take(source.get_staged_sample(opening));
    }
    /// On one core, the revision decides, because a value may be forwarded exactly at the boundary. A value
    /// that an earlier window of the same major frame has published belongs to the new mode.
    static void restart(const ConnectionEnds& ends, Instant boundary) noexcept {
        const OutPortBase& source = *ends.source;
        const std::uint64_t published = source.get_published_revision();
        const bool is_of_new_mode = published != 0U && source.get_published_at() > boundary;
        static_cast<Sink*>(ends.sink)->restart(boundary,
                                               is_of_new_mode ? published - 1U : source.get_revision());
    }
    static void note_discarded(const ConnectionEnds& ends) noexcept {
        ends.sink->note_discarded(ends.source->get_staged_count(), ends.source->get_revision());
    }
    static constexpr ConnectionOperations kOperations{nullptr,         &latch, &hand_on, &restart,
                                                      &note_discarded, false,  true,     true};
};

/// As LatestConnection, through a buffer.
template <typename T, typename Sink>
struct CrossingConnection {
    static void deliver(const ConnectionEnds& ends) noexcept {
        get_crossing(ends).deliver(*static_cast<TypedOutPort<T>*>(ends.source));
    }
    static void latch(const ConnectionEnds& ends, Instant opening) noexcept {
        get_crossing(ends).latch(*static_cast<Sink*>(ends.sink), opening);
    }
    /// This core must not read what another core may be publishing: latch() compares instants instead.
    static void restart(const ConnectionEnds& ends, Instant boundary) noexcept {
        Sink& sink = *static_cast<Sink*>(ends.sink);
        if (boundary == kBeforeAll) {
            get_crossing(ends).clear(sink);
        } else {
            sink.restart(boundary, 0U);
        }
    }
    static constexpr ConnectionOperations kOperations{&deliver, &latch, nullptr, &restart,
                                                      nullptr,  true,   true,    true};

  private:
    static Crossing<T>& get_crossing(const ConnectionEnds& ends) noexcept {
        return *static_cast<Crossing<T>*>(ends.crossing);
    }
};

/// A sink that queues every value; the writer of the queue may be on another core.
/// @tparam Source OutPort or QueueOutPort.
template <typename Source, typename Sink>
struct QueueConnection {
    static void deliver(const ConnectionEnds& ends) noexcept {
        push_all(ends, get_source(ends).get_published_sample());
    }
    static void latch(const ConnectionEnds& ends, Instant opening) noexcept { get_sink(ends).open(opening); }
    static void hand_on(const ConnectionEnds& ends, Instant opening) noexcept {
        push_all(ends, get_source(ends).get_staged_sample(opening));
        get_sink(ends).show_oldest();
    }
    static void restart(const ConnectionEnds& ends, Instant boundary) noexcept {
        if (boundary == kBeforeAll) {
            get_sink(ends).clear();
        } else {
            get_sink(ends).restart(boundary, 0U);
        }
    }
    static void note_discarded(const ConnectionEnds& ends) noexcept {
        get_sink(ends).note_discarded(ends.source->get_staged_count(), ends.source->get_revision());
    }
    static constexpr ConnectionOperations kOperations{
        &deliver, &latch, &hand_on, &restart, &note_discarded, Sink::kMayLeaveCore, false, true};

  private:
    using Sample = typename Source::Sample;
    static Source& get_source(const ConnectionEnds& ends) noexcept {
        return *static_cast<Source*>(ends.source);
    }
    static Sink& get_sink(const ConnectionEnds& ends) noexcept { return *static_cast<Sink*>(ends.sink); }
    /// @param[in] newest of the values of one cycle.
    static void push_all(const ConnectionEnds& ends, const Sample& newest) noexcept {
        if constexpr (Source::kIsQueue) {
            if (newest.revision == 0U) {
                return;  // nothing is staged
            }
            const auto values = get_source(ends).get_values();
            std::uint64_t revision = newest.revision - values.size();
            for (const typename Source::Payload& value : values) {
                ++revision;
                push(ends, {value, revision, newest.published_at});
            }
        } else {
            push(ends, newest);
        }
    }
    static void push(const ConnectionEnds& ends, const Sample& sample) noexcept {
        Sink& queue = get_sink(ends);
        const std::uint32_t overwritten_count = queue.get_overwritten_count();
        if (queue.push(sample) != Status::kOk) {
            ends.source->note_refused(sample.revision);
        } else if (queue.get_overwritten_count() != overwritten_count) {
            ends.source->note_overwritten();
        }
    }
};

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONNECTION_HPP
