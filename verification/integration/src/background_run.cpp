// SPDX-License-Identifier: Apache-2.0
// A loop of 1 kHz next to a background window of 50 ms on one processor, in pairs with the loop alone:
//     background_run [FRAMES [PAIRS [PROCESSOR]]]
// Ends with 0; 1: data differ from virtual time, an overrun is not named, or the median of the ratios of the
// p99 lateness is above 1.10 over at least 10 pairs; 2: wrong arguments; 3: inconclusive, since fixed
// priorities were not granted or the host delayed a window by more than its budget, which discards its data.
#include <algorithm>
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
    bool is_conclusive = true;
    std::vector<double> ratios;
    for (long pair = 0; pair < pairs; ++pair) {
        double alone = -1.0;
        const auto run_lonely = [&] {
            alone = mamori::verification::run_alone(static_cast<std::uint64_t>(frames),
                                                    static_cast<int>(processor));
        };
        if (pair % 2 == 0) {
            run_lonely();
        }
        const mamori::verification::BackgroundResult both = mamori::verification::run_with_background(
            static_cast<std::uint64_t>(frames), static_cast<int>(processor));
        if (pair % 2 != 0) {
            run_lonely();
        }
        ratios.push_back(both.lateness_us / alone);
        std::printf(
            "pair %ld: data %s; overruns: caused %llu, named %llu; others %llu; p99 lateness %.1f us, "
            "alone %.1f us, ratio %.3f; background latest by %.1f us\n",
            pair, both.are_equal ? "equal" : "DIFFER", static_cast<unsigned long long>(both.caused),
            static_cast<unsigned long long>(both.named), static_cast<unsigned long long>(both.other),
            both.lateness_us, alone, ratios.back(), both.background_us);
        is_correct = is_correct && both.has_run && both.are_equal && both.named == both.caused;
        is_conclusive = is_conclusive && both.is_realtime && both.other == 0U;
    }
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2U),
                     ratios.end());
    const double median = ratios[ratios.size() / 2U];
    std::printf("median ratio %.3f over %zu pairs%s\n", median, ratios.size(),
                is_conclusive ? "" : "; inconclusive: the host delayed windows or granted no priorities");
    if (!is_conclusive) {
        return 3;
    }
    return is_correct && (ratios.size() < kPairsMin || median <= kRatioMax) ? 0 : 1;
}
