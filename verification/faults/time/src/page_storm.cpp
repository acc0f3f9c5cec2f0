// SPDX-License-Identifier: Apache-2.0
#include "page_storm.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <string>

namespace mamori::time_faults {
namespace {

constexpr std::size_t kSize = 64U << 20U;
constexpr std::size_t kPage = 4096U;

/// Uses only functions that are permitted between fork and exec.
[[noreturn]] void blow(unsigned seconds) noexcept {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    alarm(seconds);
    while (getppid() != 1) {
        void* const memory = mmap(nullptr, kSize, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (memory == MAP_FAILED) {
            _exit(1);
        }
        madvise(memory, kSize, MADV_NOHUGEPAGE);  // a huge page would cause one fault instead of 512
        auto* const bytes = static_cast<volatile char*>(memory);
        for (std::size_t i = 0U; i < kSize; i += kPage) {
            bytes[i] = 1;
        }
        munmap(memory, kSize);
    }
    _exit(0);
}

}  // namespace

PageStorm::PageStorm(unsigned seconds) noexcept : process_(seconds > 0U ? fork() : -1) {
    if (process_ == 0) {
        blow(seconds);
    }
}

bool PageStorm::stop() noexcept {
    if (!is_under_way()) {
        return false;
    }
    const bool has_blown = waitpid(process_, nullptr, WNOHANG) == 0;
    if (has_blown) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    process_ = -1;
    return has_blown;
}

bool has_locked_pages() {
    std::ifstream status{"/proc/self/status"};
    std::string word;
    while (status >> word) {
        if (word == "VmLck:") {
            std::size_t size_kb = 0U;
            return status >> size_kb && size_kb > 0U;
        }
    }
    return false;
}

void PageMeter::look() noexcept {
    rusage usage{};
    if (getrusage(RUSAGE_THREAD, &usage) != 0) {
        return;
    }
    if (first_major_ < 0) {
        first_major_ = usage.ru_majflt;
        first_minor_ = usage.ru_minflt;
    }
    major_.store(usage.ru_majflt - first_major_, std::memory_order_relaxed);
    minor_.store(usage.ru_minflt - first_minor_, std::memory_order_relaxed);
}

}  // namespace mamori::time_faults
