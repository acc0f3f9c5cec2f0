// SPDX-License-Identifier: Apache-2.0
#include "link_thread.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/assert.hpp"

namespace mamori::ports::lcm::detail {

namespace {

/// Not the 8 MiB of the usual limit, which mlockall() of a real-time process would lock.
constexpr std::size_t kStackSize = std::size_t{256U} * 1024U;

}  // namespace

Status start_thread(pthread_t& thread, int& stop, ThreadCall call, void* argument) noexcept {
    const int event = ::eventfd(0U, EFD_CLOEXEC);
    if (event < 0) {
        return Status::kError;
    }
    stop = event;  // the thread waits for it
    pthread_attr_t attributes;
    sigset_t all;
    sigset_t before;
    const sched_param priority{};
    MAMORI_ENSURE(1, ::sigfillset(&all) == 0);
    MAMORI_ENSURE(2, ::pthread_attr_init(&attributes) == 0);
    MAMORI_ENSURE(3, ::pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED) == 0);
    MAMORI_ENSURE(4, ::pthread_attr_setschedpolicy(&attributes, SCHED_OTHER) == 0);
    MAMORI_ENSURE(5, ::pthread_attr_setschedparam(&attributes, &priority) == 0);
    MAMORI_ENSURE(11, ::pthread_attr_setstacksize(&attributes, kStackSize) == 0);
    // The thread, and the threads that LCM starts in it, inherit the mask: signals go to other threads.
    MAMORI_ENSURE(6, ::pthread_sigmask(SIG_SETMASK, &all, &before) == 0);
    const int error = ::pthread_create(&thread, &attributes, call, argument);
    MAMORI_ENSURE(7, ::pthread_sigmask(SIG_SETMASK, &before, nullptr) == 0);
    MAMORI_ENSURE(8, ::pthread_attr_destroy(&attributes) == 0);
    if (error != 0) {
        static_cast<void>(::close(stop));
        stop = -1;
        return Status::kError;
    }
    return Status::kOk;
}

void stop_thread(pthread_t thread, int& stop) noexcept {
    const std::uint64_t one = 1U;
    MAMORI_ENSURE(9, ::write(stop, &one, sizeof one) == static_cast<ssize_t>(sizeof one));
    MAMORI_ENSURE(10, ::pthread_join(thread, nullptr) == 0);
    static_cast<void>(::close(stop));
    stop = -1;
}

bool wait_for(int file, int stop) noexcept {
    std::array<pollfd, 2U> files{{{file, POLLIN, 0}, {stop, POLLIN, 0}}};
    int count = 0;
    do {
        count = ::poll(files.data(), files.size(), -1);
    } while (count < 0 && errno == EINTR);
    return count > 0 && files[1].revents == 0 && (files[0].revents & POLLIN) != 0;
}

}  // namespace mamori::ports::lcm::detail
