// SPDX-License-Identifier: Apache-2.0
/// @file
/// The sending end of a protected message, in front of an ordinary output of the kernel.
///
/// @satisfies SWR-E2E-030, SWR-E2E-037, SWR-E2E-038      Design: docs/design/e2e.md#ports
#ifndef MAMORI_SAFETY_E2E_OUT_PORT_HPP
#define MAMORI_SAFETY_E2E_OUT_PORT_HPP

#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/payload/cdr.hpp"
#include "mamori/safety/e2e/frame.hpp"
#include "mamori/safety/e2e/message.hpp"
#include "mamori/safety/e2e/protector.hpp"

namespace mamori::safety {

/// Sends values of a message. The output stands in the component's list of ports, this beside it:
///     mamori::OutPort<SafeSpeed::Frame> out{*this, "speed"};
///     mamori::safety::E2eOutPort<SafeSpeed> speed{out};
///
/// @tparam Message  an E2eMessage.
/// @tparam FrameT   payload of the output: an E2eFrame with room for the message.
///
/// Thread safety: none; belongs to the component of the output. Time: O(length of the frame).
/// Memory: one frame, no heap.
template <typename Message, typename FrameT = typename Message::Frame>
class E2eOutPort final {
    static_assert(FrameT::capacity() >= Message::kLengthMax,
                  "frames of the port have no room for the message");

  public:
    using Value = typename Message::Value;
    using Profile = typename Message::Profile;

    /// @param[in] port    must outlive this object; nobody else writes to it.
    /// @param[in] counter of the first frame, 0 .. Profile::kCounterMax; see E2eProtector.
    constexpr explicit E2eOutPort(OutPort<FrameT>& port,
                                  std::uint32_t counter = Profile::kFirstCounter) noexcept
        : port_(port), protector_({}, counter) {}
    E2eOutPort(const E2eOutPort&) = delete;
    E2eOutPort& operator=(const E2eOutPort&) = delete;

    /// Stages a protected frame for the close of the window. A second write in one cycle replaces the first,
    /// under its counter. A frame that is discarded, since its window overran, is a lost one to the receiver.
    /// @return kOk; kBadParameter (an enumeration holds none of its enumerators) and kPreconditionNotMet (the
    ///         first counter is refused), both with nothing staged beyond what was.
    Status write(const Value& value) noexcept {
        static_cast<void>(frame_.resize(Message::kLengthMax));
        const Span<std::byte> room = detail::edit_bytes(frame_).subspan(
            Message::kPayloadAt, Message::kLengthMax - Message::kPayloadAt);
        const Result<std::size_t> size = encode(value, room, Message::kByteOrder);
        if (!size.has_value()) {
            return size.get_status();
        }
        static_cast<void>(frame_.resize(Message::kPayloadAt + size.get_value()));
        if (port_.is_staged()) {
            protector_.take_back();
        }
        const Status status = protector_.protect(detail::edit_bytes(frame_));
        if (status == Status::kOk) {
            port_.write(frame_);
        }
        return status;
    }

    /// Counter of the next frame of a new cycle.
    constexpr std::uint32_t get_counter() const noexcept { return protector_.get_counter(); }

  private:
    OutPort<FrameT>& port_;
    E2eProtector<Profile, ConstantChannel<Message::kChannel>> protector_;
    FrameT frame_{};
};

}  // namespace mamori::safety

#endif  // MAMORI_SAFETY_E2E_OUT_PORT_HPP
