// SPDX-License-Identifier: Apache-2.0
// A loop of 1 kHz next to a background window of 50 ms on one processor, in pairs with the loop alone:
//     background_run [FRAMES [PAIRS [PROCESSOR]]]
// Each pair runs in a process of its own, so that nothing of one reaches the next. A pair is inconclusive if
// fixed priorities were not granted or the host delayed a window by more than its budget, which discards its
// data. Ends with 0; 1: in a conclusive pair, data differ from virtual time or an overrun is not named; or
// the median of the ratios of the p99 lateness is above 1.10 over at least 10 pairs; 2: wrong arguments; 3:
// no pair is conclusive.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "background_system.hpp"

namespace {

constexpr double kRatioMax = 1.10;
constexpr std::size_t kPairsMin = 10U;

/// @return `otherwise` without the argument; -2 if it is not in -1 .. 10000.
long read_argument(int count, char** words, int index, long otherwise) {
    if (index >= count) {
        return otherwise;
    }
    char* end = nullptr;
    const long value = std::strtol(words[index], &end, 10);
    return *end == '\0' && end != words[index] && value >= -1 && value <= 10'000 ? value : -2;
}

struct Pair {
    mamori::verification::BackgroundResult both;
    double alone_us{-1.0};
};

Pair run_pair(long number, std::uint64_t frames, int processor) {
    Pair pair;
    if (number % 2 == 0) {
        pair.alone_us = mamori::verification::run_alone(frames, processor);
    }
    pair.both = mamori::verification::run_with_background(frames, processor);
    if (number % 2 != 0) {
        pair.alone_us = mamori::verification::run_alone(frames, processor);
    }
    return pair;
}

/// @return the pair, run in a child process; `has_run` is false if that failed.
Pair run_apart(long number, std::uint64_t frames, int processor) {
    Pair pair;
    std::array<int, 2U> ends{};
    if (pipe(ends.data()) != 0) {
        return pair;
    }
    const pid_t child = fork();
    if (child == 0) {
        const Pair own = run_pair(number, frames, processor);
        _exit(write(ends[1], &own, sizeof own) == static_cast<ssize_t>(sizeof own) ? 0 : 1);
    }
    static_cast<void>(close(ends[1]));
    if (child < 0 || read(ends[0], &pair, sizeof pair) != static_cast<ssize_t>(sizeof pair)) {
        pair = Pair{};
    }
    static_cast<void>(close(ends[0]));
    if (child > 0) {
        static_cast<void>(waitpid(child, nullptr, 0));
    }
    return pair;
}

}  // namespace

int main(int count, char** words) {
    const long frames = read_argument(count, words, 1, 100);
    const long pairs = read_argument(count, words, 2, 1);
    const long processor = read_argument(count, words, 3, -1);
    if (frames < 1 || pairs < 1 || processor < -1 || count > 4) {
        std::fputs("usage: background_run [FRAMES [PAIRS [PROCESSOR]]], 1 .. 10000 each; processor -1: any\n",
                   stderr);
        return 2;
    }
    bool is_correct = true;
    long conclusive = 0;
    std::vector<double> ratios;
    for (long number = 0; number < pairs; ++number) {
        const Pair pair = run_apart(number, static_cast<std::uint64_t>(frames), static_cast<int>(processor));
        const mamori::verification::BackgroundResult& both = pair.both;
        const bool is_conclusive = both.has_run && both.is_realtime && both.other == 0U;
        ratios.push_back(both.lateness_us / pair.alone_us);
        std::printf(
            "pair %ld: data %s; overruns: caused %llu, named %llu; others %llu; p99 lateness %.1f us, "
            "alone %.1f us, ratio %.3f; background latest by %.1f us%s\n",
            number, both.are_equal ? "equal" : "differ", static_cast<unsigned long long>(both.caused),
            static_cast<unsigned long long>(both.named), static_cast<unsigned long long>(both.other),
            both.lateness_us, pair.alone_us, ratios.back(), both.background_us,
            is_conclusive ? "" : "; inconclusive: the host delayed windows or granted no priorities");
        std::fflush(stdout);
        conclusive += is_conclusive ? 1 : 0;
        is_correct =
            is_correct && both.has_run && (!is_conclusive || (both.are_equal && both.named == both.caused));
    }
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2U),
                     ratios.end());
    const double median = ratios[ratios.size() / 2U];
    std::printf("median ratio %.3f over %zu pairs; %ld of them conclusive\n", median, ratios.size(),
                conclusive);
    if (!is_correct || (ratios.size() >= kPairsMin && median > kRatioMax)) {
        return 1;
    }
    return conclusive > 0 ? 0 : 3;
}
