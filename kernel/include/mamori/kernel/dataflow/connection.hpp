// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a connection moves values: at window start of the sink, within a window and, between cores or
/// partitions, through a wait-free buffer.
///
/// @satisfies SWR-KRN-016, SWR-KRN-026, SWR-KRN-039, SWR-KRN-052      Design:
/// docs/design/kernel.md#connections
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
    void deliver(const OutPort<T>& source) noexcept {
        const typename OutPort<T>::Sample sample = source.get_published_sample();
        Entry& entry = buffer_.get_write_slot();
        entry.value = sample.value;
        entry.revision = sample.revision;
        entry.published_at = sample.published_at;
        entry.number = ++delivered_count_;
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
    };

    /// Whether a peek() has found a value that was published by `opening`.
    bool is_due(Status status, Instant opening) const noexcept {
        return status == Status::kOk && buffer_.get_front().published_at <= opening;
    }
    template <typename Sink>
    void take(Sink& sink, const Entry& entry) noexcept {
        last_number_ = entry.number;
        if (entry.published_at > sink.get_restarted_at()) {
            sink.take({entry.value, entry.revision, entry.published_at});
        }
    }

    FifoBuffer<Entry, kKept, FullPolicy::kOverwrite, EmptyPolicy::kReadback, Word> buffer_{};
    std::uint64_t delivered_count_{0U};  ///< used by the writing core only
    std::uint64_t last_number_{0U};      ///< of the entry read or dropped last; used by the reading core only
};

/// Functions that the executive calls for a connection; one constant per pair of port types. nullptr: nothing
/// to do. The crossing is that of the row; nullptr, and not used, where the connection has none. Ports and
/// crossing have the types passed to connect(); nothing checks them again.
///
/// Calling context: deliver and hand_on on the core of the source, latch on the core of the sink.
struct ConnectionOperations {
    /// After a publication of the source.
    void (*deliver)(OutPortBase&, InPortBase&, CrossingBase*) noexcept {nullptr};
    /// At window start of the sink.
    void (*latch)(OutPortBase&, InPortBase&, CrossingBase*, Instant opening) noexcept {nullptr};
    /// Forwards the value after the cycle of the source, when the sink follows in the same window.
    void (*hand_on)(OutPortBase&, InPortBase&, Instant opening) noexcept {nullptr};
    /// When the connection ends or starts with the major frame at `boundary`, before the first latch in that
    /// frame. Values published until then belong to another mode.
    void (*restart)(OutPortBase&, InPortBase&, Instant boundary) noexcept {nullptr};
    /// Before the core of the sink starts: values published until then do not reach the sink.
    void (*clear)(OutPortBase&, InPortBase&, CrossingBase*) noexcept {nullptr};
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
    static void latch(OutPortBase& source, InPortBase& sink, CrossingBase*, Instant) noexcept {
        static_cast<Sink&>(sink).take(static_cast<OutPort<T>&>(source).get_published_sample());
    }
    static void hand_on(OutPortBase& source, InPortBase& sink, Instant opening) noexcept {
        static_cast<Sink&>(sink).take(static_cast<OutPort<T>&>(source).get_staged_sample(opening));
    }
    /// On one core, the revision decides, because a value may be forwarded exactly at the boundary. A value
    /// that an earlier window of the same major frame has published belongs to the new mode.
    static void restart(OutPortBase& source, InPortBase& sink, Instant boundary) noexcept {
        const std::uint64_t published = source.get_published_revision();
        const bool is_of_new_mode = published != 0U && source.get_published_at() > boundary;
        static_cast<Sink&>(sink).restart(boundary, is_of_new_mode ? published - 1U : published);
    }
    static void clear(OutPortBase&, InPortBase& sink, CrossingBase*) noexcept {
        static_cast<Sink&>(sink).restart(kBeforeAll, 0U);  // same core: begin_run() resets the source
    }
    static constexpr ConnectionOperations kOperations{nullptr, &latch, &hand_on, &restart,
                                                      &clear,  false,  true,     true};
};

/// As LatestConnection, through a buffer.
template <typename T, typename Sink>
struct CrossingConnection {
    static void deliver(OutPortBase& source, InPortBase&, CrossingBase* crossing) noexcept {
        static_cast<Crossing<T>*>(crossing)->deliver(static_cast<OutPort<T>&>(source));
    }
    static void latch(OutPortBase&, InPortBase& sink, CrossingBase* crossing, Instant opening) noexcept {
        static_cast<Crossing<T>*>(crossing)->latch(static_cast<Sink&>(sink), opening);
    }
    /// This core must not read what another core may be publishing: latch() compares instants instead.
    static void restart(OutPortBase&, InPortBase& sink, Instant boundary) noexcept {
        static_cast<Sink&>(sink).restart(boundary, 0U);
    }
    static void clear(OutPortBase&, InPortBase& sink, CrossingBase* crossing) noexcept {
        static_cast<Crossing<T>*>(crossing)->clear(static_cast<Sink&>(sink));
    }
    static constexpr ConnectionOperations kOperations{&deliver, &latch, nullptr, &restart,
                                                      &clear,   true,   true,    true};
};

/// A sink that queues every publication; the writer of the queue may be on another core.
template <typename T, typename Sink>
struct QueueConnection {
    static void deliver(OutPortBase& source, InPortBase& sink, CrossingBase*) noexcept {
        push(source, sink, static_cast<OutPort<T>&>(source).get_published_sample());
    }
    static void latch(OutPortBase&, InPortBase& sink, CrossingBase*, Instant opening) noexcept {
        static_cast<Sink&>(sink).open(opening);
    }
    static void hand_on(OutPortBase& source, InPortBase& sink, Instant opening) noexcept {
        push(source, sink, static_cast<OutPort<T>&>(source).get_staged_sample(opening));
        static_cast<Sink&>(sink).show_oldest();
    }
    static void restart(OutPortBase&, InPortBase& sink, Instant boundary) noexcept {
        static_cast<Sink&>(sink).restart(boundary, 0U);
    }
    static void clear(OutPortBase&, InPortBase& sink, CrossingBase*) noexcept {
        static_cast<Sink&>(sink).clear();
    }
    static constexpr ConnectionOperations kOperations{
        &deliver, &latch, &hand_on, &restart, &clear, Sink::kMayLeaveCore, false, true};

  private:
    static void push(OutPortBase& source, InPortBase& sink,
                     const typename OutPort<T>::Sample& sample) noexcept {
        if (static_cast<Sink&>(sink).push(sample) != Status::kOk) {
            source.note_refused(sample.revision);
        }
    }
};

}  // namespace detail

}  // namespace mamori

#endif  // MAMORI_KERNEL_CONNECTION_HPP
