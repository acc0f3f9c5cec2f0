// SPDX-License-Identifier: Apache-2.0
#include "channel_name.hpp"
#include "mamori/ports/lcm/lcm_link.hpp"

namespace mamori::ports::lcm {

Status LcmLink::receive(const char* channel, MessageInbox& inbox) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    if (!detail::is_channel_name(channel)) {
        fault_ = LinkFault::kChannel;
        return Status::kBadParameter;
    }
    if (channel_count_ == kChannelsMax) {
        fault_ = LinkFault::kSubscribe;
        return Status::kOutOfResources;
    }
    channels_[channel_count_] = {channel, &inbox};
    ++channel_count_;
    return Status::kOk;
}

Status LcmSender::open() noexcept {
    is_open_ = detail::is_channel_name(channel_);
    fault_ = is_open_ ? LinkFault::kNone : LinkFault::kChannel;
    return is_open_ ? Status::kOk : Status::kBadParameter;
}

Status LcmSender::send(Span<const std::byte> message) noexcept {
    return is_open_ ? link_.publish(channel_, message) : Status::kPreconditionNotMet;
}

}  // namespace mamori::ports::lcm
