// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "mamori/ports/lcm/lcm_link.hpp"

namespace mamori::ports::lcm {

namespace {

/// liblcm takes the name of a channel to receive as a regular expression: only characters without a meaning
/// there.
bool is_channel_character(char character) noexcept {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           (character >= '0' && character <= '9') || character == '_' || character == '-' ||
           character == '/' || character == ':';
}

bool is_channel(const char* name) noexcept {
    const std::size_t length = ::strnlen(name, LcmLink::kChannelNameMax + 1U);
    bool is_valid = length >= 1U && length <= LcmLink::kChannelNameMax;
    for (std::size_t i = 0U; is_valid && i < length; ++i) {
        is_valid = is_channel_character(name[i]);
    }
    return is_valid;
}

}  // namespace

Status LcmLink::receive(const char* channel, MessageInbox& inbox) noexcept {
    if (is_open()) {
        return Status::kPreconditionNotMet;
    }
    if (!is_channel(channel)) {
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

}  // namespace mamori::ports::lcm
