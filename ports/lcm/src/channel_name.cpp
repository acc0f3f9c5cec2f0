// SPDX-License-Identifier: Apache-2.0
#include "channel_name.hpp"

#include <cstddef>
#include <cstring>

#include "mamori/ports/lcm/lcm_link.hpp"
#include "mamori/ports/lcm/log_player.hpp"

namespace mamori::ports::lcm::detail {

namespace {

static_assert(LcmLink::kChannelNameMax == LogPlayer::kChannelNameMax, "a logged channel can be received");

/// liblcm takes the name of a channel to receive as a regular expression: only characters without a meaning
/// there.
bool is_channel_character(char character) noexcept {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           (character >= '0' && character <= '9') || character == '_' || character == '-' ||
           character == '/' || character == ':';
}

}  // namespace

bool is_channel_name(const char* name) noexcept {
    const std::size_t length = ::strnlen(name, LcmLink::kChannelNameMax + 1U);
    bool is_valid = length >= 1U && length <= LcmLink::kChannelNameMax;
    for (std::size_t i = 0U; is_valid && i < length; ++i) {
        is_valid = is_channel_character(name[i]);
    }
    return is_valid;
}

}  // namespace mamori::ports::lcm::detail
