// SPDX-License-Identifier: Apache-2.0
#include "thread_list.hpp"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>

namespace mamori::timing {
namespace {

/// PF_KTHREAD in the field `flags` of /proc/PID/stat.
constexpr unsigned long kKernelThread = 0x00200000UL;
/// Index of this field, counted from the first one after the name.
constexpr int kFlagsField = 6;

std::array<std::atomic<std::int64_t>, 1024U> continued_ns;
std::atomic<std::size_t> continued_count{0U};

extern "C" void note_continuation(int) {
    timespec now{};
    static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &now));
    const std::size_t index = continued_count.fetch_add(1U, std::memory_order_relaxed);
    if (index < continued_ns.size()) {
        continued_ns[index].store(static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec,
                                  std::memory_order_relaxed);
    }
}

void set_handler(void (*handler)(int)) noexcept {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    static_cast<void>(sigaction(SIGCONT, &action, nullptr));
}

/// Reads `PID (NAME) STATE ...`; a name may contain blanks and brackets.
void read_name(NamedThread& thread) {
    const std::string id = std::to_string(thread.thread);
    std::ifstream in{"/proc/" + std::to_string(thread.process) + "/task/" + id + "/stat"};
    std::string line;
    std::getline(in, line);
    const std::size_t begin = line.find('(');
    const std::size_t end = line.rfind(')');
    if (begin == std::string::npos || end == std::string::npos) {
        return;
    }
    thread.name = line.substr(begin + 1U, end - begin - 1U);
    std::size_t field = end + 2U;
    for (int i = 0; i < kFlagsField && field != std::string::npos; ++i) {
        field = line.find(' ', field);
        field = field == std::string::npos ? field : field + 1U;
    }
    if (field != std::string::npos && thread.kind == ThreadKind::kOther &&
        (std::strtoul(line.c_str() + field, nullptr, 10) & kKernelThread) != 0UL) {
        thread.kind = ThreadKind::kKernel;
    }
}

}  // namespace

std::vector<NamedThread> list_threads(const std::vector<const SwitchLog*>& logs) {
    const auto own = static_cast<std::uint32_t>(getpid());
    std::map<std::uint32_t, NamedThread> threads;
    for (const SwitchLog* log : logs) {
        for (const Slice& slice : log->get_kept()) {
            if (slice.process != 0U && slice.thread != kUnknownThread) {
                const ThreadKind kind = slice.process == own ? ThreadKind::kOwn : ThreadKind::kOther;
                const int priority = slice.process == own ? kUnknownPriority : 0;
                threads.try_emplace(slice.thread,
                                    NamedThread{slice.thread, slice.process, kind, priority, {}});
            }
        }
    }
    for (const SwitchLog* log : logs) {
        for (const OwnThread& one : log->get_own_threads()) {
            const auto thread = threads.find(one.thread);
            if (thread != threads.end()) {
                thread->second.priority = std::max(thread->second.priority, one.priority);
            }
        }
    }
    std::vector<NamedThread> named;
    for (auto& [id, thread] : threads) {
        read_name(thread);
        if (thread.kind == ThreadKind::kOwn || !thread.name.empty()) {
            named.push_back(thread);
        }
    }
    return named;
}

void watch_continuations() noexcept {
    continued_count.store(0U, std::memory_order_relaxed);
    set_handler(&note_continuation);
}

std::vector<std::int64_t> end_continuations() {
    set_handler(SIG_DFL);
    const std::size_t count = std::min(continued_count.load(std::memory_order_relaxed), continued_ns.size());
    std::vector<std::int64_t> instants;
    instants.reserve(count);
    for (std::size_t i = 0U; i < count; ++i) {
        instants.push_back(continued_ns[i].load(std::memory_order_relaxed));
    }
    return instants;
}

}  // namespace mamori::timing
