// SPDX-License-Identifier: Apache-2.0
#include "mamori/ports/posix_rt/partition_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace mamori::ports::posix_rt {
namespace {

bool is_control(char character) noexcept {
    const auto code = static_cast<unsigned char>(character);
    return (code < 0x20U && character != '\t') || code == 0x7FU;
}

/// The second set of control characters (ISO 6429, C1) has two octets in UTF-8: C2 80 .. C2 9F.
bool is_second_control(char before, char character) noexcept {
    return static_cast<unsigned char>(before) == 0xC2U && static_cast<unsigned char>(character) >= 0x80U &&
           static_cast<unsigned char>(character) <= 0x9FU;
}

void close_end(int& end) noexcept {
    if (end >= 0) {
        static_cast<void>(::close(end));
    }
    end = -1;
}

/// Only the reading end is non-blocking: the two ends of a pipe have separate flags.
bool open_pipe(int& reading, int& writing) noexcept {
    std::array<int, 2U> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return false;
    }
    reading = ends[0U];
    writing = ends[1U];
    return ::fcntl(reading, F_SETFL, O_NONBLOCK) == 0;
}

}  // namespace

PartitionOutput::PartitionOutput(const char* name) noexcept {
    for (Stream& stream : streams_) {
        std::size_t size = 0U;
        stream.line[size] = '[';
        ++size;
        for (std::size_t i = 0U; i < kNameMax && name[i] != '\0'; ++i) {
            stream.line[size] = name[i];
            ++size;
        }
        stream.line[size] = ']';
        stream.line[size + 1U] = ' ';
        prefix_size_ = size + 2U;
        stream.size = prefix_size_;
    }
}

PartitionOutput::~PartitionOutput() {
    close_all();
}

Status PartitionOutput::open() noexcept {
    if (streams_[0U].reading >= 0) {
        return Status::kPreconditionNotMet;
    }
    for (Stream& stream : streams_) {
        if (!open_pipe(stream.reading, stream.writing)) {
            close_all();
            return Status::kOutOfResources;
        }
    }
    return Status::kOk;
}

std::size_t PartitionOutput::forward(int output, int errors) noexcept {
    const std::size_t count = forward_stream(streams_[0U], output);
    return count + forward_stream(streams_[1U], errors);
}

std::size_t PartitionOutput::forward_rest(int output, int errors) noexcept {
    const std::size_t count = forward(output, errors);
    if (streams_[0U].size > prefix_size_) {
        write_line(streams_[0U], output);
    }
    if (streams_[1U].size > prefix_size_) {
        write_line(streams_[1U], errors);
    }
    return count;
}

std::size_t PartitionOutput::forward_stream(Stream& stream, int target) noexcept {
    std::size_t count = 0U;
    std::array<char, 4096U> part{};
    while (count < kForwardMax) {
        const std::size_t left = kForwardMax - count;
        const ssize_t length = ::read(stream.reading, part.data(), left < part.size() ? left : part.size());
        if (length <= 0) {
            break;  // no output; after a signal, the next call reads it
        }
        for (std::size_t i = 0U; i < static_cast<std::size_t>(length); ++i) {
            take(stream, part[i], target);
        }
        count += static_cast<std::size_t>(length);
    }
    return count;
}

void PartitionOutput::take(Stream& stream, char character, int target) noexcept {
    if (character == '\n') {
        write_line(stream, target);
        return;
    }
    if (character == '\r') {
        return;
    }
    if (stream.size == prefix_size_ + kLineMax) {
        write_line(stream, target);
    }
    stream.line[stream.size] = is_control(character) ? '?' : character;
    if (is_second_control(stream.line[stream.size - 1U], character)) {
        stream.line[stream.size - 1U] = '?';
        stream.line[stream.size] = '?';
    }
    ++stream.size;
}

void PartitionOutput::write_line(Stream& stream, int target) noexcept {
    stream.line[stream.size] = '\n';
    const std::size_t size = stream.size + 1U;
    stream.size = prefix_size_;
    ssize_t written = -1;
    do {
        written = ::write(target, stream.line.data(), size);
    } while (written < 0 && errno == EINTR);
    if (written != static_cast<ssize_t>(size)) {
        ++lost_count_;
    }
}

void PartitionOutput::close_all() noexcept {
    for (Stream& stream : streams_) {
        close_end(stream.reading);
        close_end(stream.writing);
    }
}

}  // namespace mamori::ports::posix_rt
