// SPDX-License-Identifier: Apache-2.0
#include "link_errors.hpp"

#include <algorithm>

#include "hil_messages.hpp"

namespace safe_arm {
namespace {

using mamori::Status;
using mamori::ports::lcm::kFingerprintSize;

/// Added to a data identifier: no link of this system has the result.
constexpr std::uint32_t kUnknownSource = 0x100U;
constexpr std::uint32_t kOtherReceiver = 0x200U;

}  // namespace

Status FaultySink::send(mamori::Span<const std::byte> message) noexcept {
    if (target_ == nullptr) {
        return Status::kPreconditionNotMet;
    }
    if (message.size() > kMessageMax) {
        return Status::kBadParameter;
    }
    Message copy{};
    copy.size = message.size();
    std::copy(message.begin(), message.end(), copy.octets.begin());
    if (plan_.is_active(link_, frame_)) {
        ++injected_count_;
        return send_with_error(copy);
    }
    if (plan_.error == LinkError::kDelay) {
        return send_delayed(copy);  // behind those that wait
    }
    const Status status = forward(copy);
    if (held_count_ > 0U) {  // the first of two that change places
        held_count_ = 0U;
        static_cast<void>(forward(held_[first_]));
    }
    return status;
}

Status FaultySink::forward(const Message& message) noexcept {
    return target_->send({message.octets.data(), message.size});
}

Status FaultySink::send_with_error(Message& message) noexcept {
    Status status = Status::kOk;
    switch (plan_.error) {
        case LinkError::kCorruption:
            corrupt(message);
            return forward(message);
        case LinkError::kRepetition:
            status = forward(message);
            static_cast<void>(forward(message));
            return status;
        case LinkError::kSequence:
            if (held_count_ == 0U) {
                held_[first_] = message;
                held_count_ = 1U;
                return Status::kOk;
            }
            held_count_ = 0U;
            status = forward(message);
            static_cast<void>(forward(held_[first_]));
            return status;
        case LinkError::kLoss:
            return Status::kOk;
        case LinkError::kDelay:
            message.due_frame = frame_ + plan_.delay_frames;
            return send_delayed(message);
        case LinkError::kInsertion:
            static_cast<void>(forward(readdress(message, kUnknownSource)));
            return forward(message);
        case LinkError::kMasquerade: {
            status = forward(message);
            // Plausible content under the header of the true sender.
            const std::size_t body = kFingerprintSize + HilProfile::kHeaderSize;
            std::fill(message.octets.begin() + body, message.octets.begin() + message.size, std::byte{0U});
            static_cast<void>(forward(message));
            return status;
        }
        case LinkError::kAddressing:
            return forward(readdress(message, kOtherReceiver));
    }
    return Status::kError;  // only a corrupted value gets here
}

/// Messages leave in order: one without a delay waits for those before it.
Status FaultySink::send_delayed(const Message& message) noexcept {
    if (held_count_ == kHeld) {
        first_ = (first_ + 1U) % kHeld;
        --held_count_;
    }
    held_[(first_ + held_count_) % kHeld] = message;
    ++held_count_;
    Status status = Status::kOk;
    while (held_count_ > 0U && held_[first_].due_frame <= frame_) {
        status = forward(held_[first_]);
        first_ = (first_ + 1U) % kHeld;
        --held_count_;
    }
    return status;
}

void FaultySink::corrupt(Message& message) noexcept {
    const std::uint64_t flips = 1U + random_() % 3U;
    for (std::uint64_t i = 0U; i < flips; ++i) {
        const std::uint64_t bit = random_() % (message.size * 8U);
        message.octets[bit / 8U] ^= std::byte{1U} << static_cast<int>(bit % 8U);
    }
}

FaultySink::Message FaultySink::readdress(const Message& message, std::uint32_t offset) const noexcept {
    Message result = message;
    mamori::safety::SentIdChannel channel = channel_;
    channel.data_id += offset;
    std::uint32_t counter = 0U;
    const mamori::Span<std::byte> part = mamori::ports::lcm::get_protected_part(result.get());
    static_cast<void>(HilProfile::read(channel_, {part.data(), part.size()}, counter));
    HilProfile::write(channel, counter, part);
    return result;
}

}  // namespace safe_arm
