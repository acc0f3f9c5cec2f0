// SPDX-License-Identifier: Apache-2.0
/// @file
/// A pipe from an untrusted process to its test. It ends when no process holds its writing end.
#ifndef MAMORI_PORTS_POSIX_RT_TESTS_LINE_HPP
#define MAMORI_PORTS_POSIX_RT_TESTS_LINE_HPP

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <string>

#include "mamori/ports/posix_rt/partition_process.hpp"

namespace mamori::ports::posix_rt {

/// Longer than each of these actions takes on a busy host.
constexpr int kPatience_ms = 20'000;

/// A pipe. The partition gets its writing end.
class Line final {
  public:
    Line() { EXPECT_EQ(::pipe2(ends_.data(), O_CLOEXEC), 0); }
    Line(const Line&) = delete;
    Line& operator=(const Line&) = delete;
    ~Line() {
        close_writing_end();
        static_cast<void>(::close(ends_[0U]));
    }
    int get_writing_end() const { return ends_[1U]; }
    void close_writing_end() {
        if (ends_[1U] >= 0) {
            static_cast<void>(::close(ends_[1U]));
        }
        ends_[1U] = -1;
    }
    /// Reads until no process holds the writing end. Fails after kPatience_ms.
    std::string read_all() {
        close_writing_end();
        std::string text;
        std::array<char, 4096U> part{};
        for (;;) {
            pollfd watch{ends_[0U], POLLIN, 0};
            if (::poll(&watch, 1U, kPatience_ms) != 1) {
                ADD_FAILURE() << "a process still holds the pipe";
                return text;
            }
            const ssize_t length = ::read(ends_[0U], part.data(), part.size());
            if (length <= 0) {
                return text;
            }
            text.append(part.data(), static_cast<std::size_t>(length));
        }
    }
    /// Reads the next character.
    char read_one() {
        char character = '\0';
        EXPECT_EQ(::read(ends_[0U], &character, 1U), 1);
        return character;
    }

  private:
    std::array<int, 2U> ends_{-1, -1};
};

inline PartitionState wait_for_end(PartitionProcess& process) {
    for (int i = 0; i < kPatience_ms && process.check() == PartitionState::kRunning; ++i) {
        static_cast<void>(::poll(nullptr, 0U, 1));
    }
    return process.check();
}

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_TESTS_LINE_HPP
