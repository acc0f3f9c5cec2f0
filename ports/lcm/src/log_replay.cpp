// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/lcm/log_replay.hpp"

#include <unistd.h>

#include <charconv>
#include <cstring>
#include <string_view>

namespace mamori::ports::lcm {
namespace {

/// Text of one report; what exceeds the capacity is omitted.
class Line final {
  public:
    Line& operator<<(std::string_view text) noexcept {
        const std::size_t room = text_.size() - size_;
        const std::size_t count = text.size() < room ? text.size() : room;
        std::memcpy(text_.data() + size_, text.data(), count);
        size_ += count;
        return *this;
    }
    Line& operator<<(std::uint64_t number) noexcept { return add(number, 10); }
    Line& add(std::uint64_t number, int base) noexcept {
        std::array<char, 20U> digits{};
        const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number, base).ptr;
        return *this << std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
    }
    /// A line that cannot be written is lost.
    void write_to(int file) noexcept {
        *this << "\n";
        for (std::size_t done = 0U; done < size_;) {
            const ssize_t count = ::write(file, text_.data() + done, size_ - done);
            if (count <= 0) {
                return;
            }
            done += static_cast<std::size_t>(count);
        }
    }

  private:
    std::array<char, 1024U> text_{};
    std::size_t size_{0U};
};

void write_channel(const ReplayChannel& channel, int output) noexcept {
    const LinkNews news = channel.get_news(channel.receiver);
    Line line;
    line << "channel " << channel.name << ": used " << news.used << ", lost " << news.lost << ", damaged "
         << news.damaged << ", unordered " << news.unordered << ", initial " << news.initial << ", foreign "
         << news.foreign << ", truncated " << news.truncated << ", oversized " << news.oversized
         << ", overwritten " << news.overwritten << (news.is_closed ? ", closed" : "");
    line.write_to(output);
}

}  // namespace

Status LogReplay::open(Span<const ReplayChannel> channels, bool has_hash, int argc,
                       const char* const* argv) noexcept {
    Line line;
    if (argc != 3 || std::strcmp(argv[1], "--replay") != 0) {
        line << "usage: " << (argc > 0 ? argv[0] : "PROGRAM") << " --replay LOG";
        line.write_to(errors_);
        return Status::kBadParameter;
    }
    if (!has_hash) {
        line << "the system table has no trace_hash(); add it, or replays cannot be compared";
        line.write_to(errors_);
        return Status::kBadParameter;
    }
    path_ = argv[2];
    channels_ = channels;
    for (const ReplayChannel& channel : channels) {
        const Status status = player_.receive(channel.name, *channel.inbox);
        if (status != Status::kOk) {
            line << "channel '" << channel.name << "': " << get_advice(player_.get_fault());
            line.write_to(errors_);
            return status;
        }
    }
    if (player_.open(path_) != Status::kOk) {
        line << path_ << ": cannot be read, or is not a log of lcm-logger; specify the log";
        line.write_to(errors_);
        return Status::kError;
    }
    return Status::kOk;
}

bool LogReplay::advance(Instant start) noexcept {
    const bool has_ended = status_ != Status::kOk;
    status_ = player_.deliver_until(start);
    if (player_.get_event_count() != event_count_) {
        event_count_ = player_.get_event_count();
        last_event_ = start;
    }
    is_pause_too_long_ = status_ == Status::kOk && start - last_event_ > kPauseMax;
    return !has_ended && !is_pause_too_long_;
}

Status LogReplay::report(std::uint64_t frames) noexcept {
    for (const ReplayChannel& channel : channels_) {
        write_channel(channel, output_);
    }
    Line line;
    line << "events " << player_.get_event_count() << ", frames " << frames;
    line.write_to(output_);
    if (status_ != Status::kError && !is_pause_too_long_) {
        return Status::kOk;
    }
    Line error;
    error << path_ << ": " << (is_pause_too_long_ ? "no event for an hour before" : "damaged at")
          << " offset " << player_.get_offset() << "; the events before it were replayed";
    error.write_to(errors_);
    return Status::kError;
}

void LogReplay::report_hash(std::size_t core, std::uint64_t hash) noexcept {
    Line line;
    line << "core " << core << ": trace hash ";
    line.add(hash, 16).write_to(output_);
}

void LogReplay::report_failure() noexcept {
    Line line;
    line << "the system did not start or stop; check its components";
    line.write_to(errors_);
}

}  // namespace mamori::ports::lcm
