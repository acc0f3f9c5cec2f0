// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/log_player.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

#include "channel_name.hpp"

namespace mamori::ports::lcm {

namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01U;
constexpr std::size_t kHeaderSize = 28U;  ///< sync word, number, time [us], lengths of channel and message
constexpr std::int64_t kNsPerUs = 1000;

template <typename Number>
Number load(const std::byte* source) noexcept {
    return mamori::detail::load<true, Number>(source, std::make_index_sequence<sizeof(Number)>{});
}

/// @return octets read, fewer than `size` only at the end of the file or after an error.
std::size_t read_all(int file, void* target, std::size_t size) noexcept {
    std::size_t done = 0U;
    while (done < size) {
        const ssize_t count = ::read(file, static_cast<char*>(target) + done, size - done);
        const bool is_interrupted = count < 0 && errno == EINTR;
        if (count <= 0 && !is_interrupted) {
            break;
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0U;
    }
    return done;
}

}  // namespace

Status LogPlayer::receive(const char* channel, MessageInbox& inbox) noexcept {
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
    fault_ = LinkFault::kNone;
    return Status::kOk;
}

Status LogPlayer::open(const char* path) noexcept {
    if (file_ >= 0) {
        return Status::kPreconditionNotMet;
    }
    file_ = ::open(path, O_RDONLY | O_CLOEXEC);
    offset_ = 0U;
    event_count_ = 0U;
    first_us_ = 0;
    due_us_ = 0;
    state_ = file_ >= 0 ? read_event() : State::kDamaged;
    if (state_ != State::kPending) {
        close();
        return Status::kError;
    }
    first_us_ = due_us_;
    due_us_ = 0;
    return Status::kOk;
}

void LogPlayer::close() noexcept {
    if (file_ >= 0) {
        static_cast<void>(::close(file_));
        file_ = -1;
    }
    state_ = State::kEnd;
}

Status LogPlayer::deliver_until(Instant now) noexcept {
    while (state_ == State::kPending && due_us_ <= now.ns / kNsPerUs) {
        deliver();
        ++event_count_;
        offset_ = end_;
        state_ = read_event();
    }
    if (state_ == State::kDamaged) {
        return Status::kError;
    }
    return state_ == State::kPending ? Status::kOk : Status::kPreconditionNotMet;
}

LogPlayer::State LogPlayer::read_event() noexcept {
    std::array<std::byte, kHeaderSize> header{};
    const std::size_t count = read_all(file_, header.data(), header.size());
    if (count == 0U) {
        return State::kEnd;
    }
    const auto name_size = load<std::uint32_t>(header.data() + 20U);
    const auto size = load<std::uint32_t>(header.data() + 24U);
    if (count != header.size() || load<std::uint32_t>(header.data()) != kSyncWord ||
        name_size > kChannelNameMax || size > static_cast<std::uint32_t>(std::numeric_limits<int>::max()) ||
        read_all(file_, name_.data(), name_size) != name_size) {
        return State::kDamaged;
    }
    name_[name_size] = '\0';
    const std::size_t kept = size < kMessageMax ? size : kMessageMax;
    std::size_t rest = size - kept;
    if (read_all(file_, message_.data(), kept) != kept) {
        return State::kDamaged;
    }
    std::array<std::byte, 4096U> skipped{};
    while (rest > 0U) {
        const std::size_t part = rest < skipped.size() ? rest : skipped.size();
        if (read_all(file_, skipped.data(), part) != part) {
            return State::kDamaged;
        }
        rest -= part;
    }
    size_ = size;
    end_ = offset_ + kHeaderSize + name_size + size;
    // As unsigned numbers, because a damaged log has any instants.
    due_us_ = static_cast<std::int64_t>(load<std::uint64_t>(header.data() + 12U) -
                                        static_cast<std::uint64_t>(first_us_));
    return State::kPending;
}

void LogPlayer::deliver() noexcept {
    for (std::size_t i = 0U; i < channel_count_; ++i) {
        if (std::strcmp(channels_[i].name, name_.data()) != 0) {
            continue;
        }
        if (size_ > kMessageMax) {
            channels_[i].inbox->put_oversized();
        } else {
            channels_[i].inbox->put({message_.data(), size_});
        }
    }
}

}  // namespace mamori::ports::lcm
