// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a connection moves values: at window start of the sink, within a window and, between cores or
/// partitions, through a wait-free buffer.
///
/// @satisfies SWR-KRN-016, SWR-KRN-026, SWR-KRN-039      Design: docs/design/kernel.md#connections
#ifndef MAMORI_KERNEL_CONNECTION_HPP
#define MAMORI_KERNEL_CONNECTION_HPP

#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/dataflow/triple_buffer.hpp"

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
/// Planned instants decide which value the reader receives, not the relative speed of the cores.
///
/// Thread safety: one core writes, one core reads, neither waits. Time: O(sizeof(T)). Memory: three T.
template <typename T>
class Crossing final : public CrossingBase {
  public:
    constexpr Crossing() noexcept = default;

    /// For the executive of the writing core, immediately after the publication.
    void deliver(const OutPort<T>& source) noexcept {
        const typename OutPort<T>::Sample sample = source.get_published_sample();
        Slot& slot = buffer_.get_write_slot();
        slot.value = sample.value;
        slot.revision = sample.revision;
        slot.published_at = sample.published_at;
        buffer_.publish();
    }
    /// For the executive of the reading core, at its window start. A value published after `opening` is left
    /// for the next window: the reader is late and keeps its previous value, because the value for this
    /// window has been overwritten. A value from before the last restart() of the sink belongs to another
    /// mode and is ignored.
    /// @param[in,out] sink always the same sink: it stores which value it has accepted.
    template <typename Sink>
    void latch(Sink& sink, Instant opening) noexcept {
        static_cast<void>(buffer_.update());
        const Slot& slot = buffer_.get_read_slot();
        if (slot.published_at <= opening && slot.published_at > sink.get_restarted_at()) {
            sink.take({slot.value, slot.revision, slot.published_at});
        }
    }

    /// For the executive of the reading core, before it starts: drops the value in the buffer, which is from
    /// an earlier run. Instants cannot show this: the time line of a run may start before the end of the last
    /// run.
    template <typename Sink>
    void clear(Sink& sink) noexcept {
        buffer_.drop();
        sink.restart(kBeforeAll, 0U);
    }

  private:
    struct Slot {
        T value{};
        std::uint64_t revision{0U};
        Instant published_at{};
    };
    TripleBuffer<Slot> buffer_{};
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
    bool may_leave_core{false};  ///< source and sink may run on two cores or in two partitions
    bool is_latest{false};       ///< only the newest value is kept, so the order of writer and reader matters
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
