// SPDX-License-Identifier: Apache-2.0
/// @file
/// A pipe from a process of less trust to its test, which shows when no process has it any longer.
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

/// Longer than any of this takes on a machine that is busy.
constexpr int kPatience_ms = 20'000;

/// A pipe whose writing end a partition gets.
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
    /// All until nobody has the other end any more. Fails when somebody keeps it.
    std::string read_all() {
        close_writing_end();
        std::string text;
        std::array<char, 4096U> part{};
        for (;;) {
            pollfd watch{ends_[0U], POLLIN, 0};
            if (::poll(&watch, 1U, kPatience_ms) != 1) {
                ADD_FAILURE() << "somebody has kept the pipe";
                return text;
            }
            const ssize_t length = ::read(ends_[0U], part.data(), part.size());
            if (length <= 0) {
                return text;
            }
            text.append(part.data(), static_cast<std::size_t>(length));
        }
    }
    /// The next character.
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
