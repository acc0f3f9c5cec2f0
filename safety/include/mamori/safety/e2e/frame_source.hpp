// SPDX-License-Identifier: Apache-2.0
/// @file
/// How frames are taken out of an input of the kernel, each of them once: one that keeps the latest value, or
/// one that queues. Not for users.
///
/// @satisfies SWR-E2E-036      Design: docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_FRAME_SOURCE_HPP
#define MAMORI_SAFETY_E2E_FRAME_SOURCE_HPP

#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"

namespace mamori::safety::detail {

/// Frames of an input that keeps the latest value.
template <typename Port>
class LatestFrames final {
  public:
    constexpr explicit LatestFrames(Port& port) noexcept : port_(port) {}

    /// True for a frame that was not taken yet. The port calls a value new once more when the cycle that saw
    /// it did not end well; that is no new frame, and no publication has the instant of the one before.
    bool has_frame() const noexcept { return port_.is_new() && port_.get_published_at() != taken_at_; }
    /// The frame, for this action. @pre has_frame().
    const typename Port::Payload& take() noexcept {
        taken_at_ = port_.get_published_at();
        return port_.read();
    }
    /// The message that was taken last, until the input gets another. @pre take() since the last forget().
    const typename Port::Payload& get_taken() const noexcept { return port_.read(); }
    /// Of the input: what came before the last one is of another mode or run.
    std::uint32_t get_restart_count() const noexcept { return port_.get_restart_count(); }
    /// After a restart: the next frame may have the instant of one of an earlier run.
    void forget() noexcept { taken_at_ = kBeforeAll; }
    /// Of the frame that was taken.
    Instant get_published_at() const noexcept { return taken_at_; }

  private:
    Port& port_;
    Instant taken_at_{kBeforeAll};
};

/// Frames of an input that queues.
template <typename Port>
class QueuedFrames final {
  public:
    constexpr explicit QueuedFrames(Port& port) noexcept : port_(port) {}

    bool has_frame() noexcept { return port_.has_waiting(); }
    /// The oldest frame that waits, until the next call. @pre has_frame().
    const typename Port::Payload& take() noexcept {
        frame_.clear();  // what could not be read is no frame, and least of all the one before
        static_cast<void>(port_.read(frame_));
        return frame_;
    }
    const typename Port::Payload& get_taken() const noexcept { return frame_; }
    std::uint32_t get_restart_count() const noexcept { return port_.get_restart_count(); }
    void forget() noexcept {}
    Instant get_published_at() const noexcept { return port_.get_published_at(); }

  private:
    Port& port_;
    typename Port::Payload frame_{};
};

template <typename Port>
using FrameSource = std::conditional_t<Port::kIsQueue, QueuedFrames<Port>, LatestFrames<Port>>;

}  // namespace mamori::safety::detail

#endif  // MAMORI_SAFETY_E2E_FRAME_SOURCE_HPP
