// SPDX-License-Identifier: Apache-2.0
// notice_run FRAMES INJECTIONS SEED: the run of two_nodes.hpp at length. Ends with 1 if an injection was
// missed or a fault invented, with 2 for wrong arguments.
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include "two_nodes.hpp"

int main(int argc, char** argv) {
    using mamori::verification::notice::Outcome;
    const unsigned long long frames = argc == 4 ? std::strtoull(argv[1], nullptr, 10) : 0U;
    const unsigned long long injections = argc == 4 ? std::strtoull(argv[2], nullptr, 10) : 0U;
    if (frames == 0U || injections > frames / 400U) {
        static_cast<void>(
            std::fprintf(stderr, "notice_run: specify FRAMES >= 1, INJECTIONS <= FRAMES / 400, and SEED\n"));
        return 2;
    }
    const auto seed = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
    const Outcome outcome =
        mamori::verification::notice::run_two_nodes(frames, static_cast<std::uint32_t>(injections), seed);
    std::uint32_t injected = 0U;
    for (std::size_t i = 0U; i < outcome.injected.size(); ++i) {
        injected += outcome.injected[i];
        std::printf("injection %zu: %" PRIu32 ", reported after at most %" PRId64 " us\n", i,
                    outcome.injected[i], outcome.delay_max_ns[i] / 1000);
    }
    std::printf("frames %" PRIu64 ", messages %" PRIu64 ", lost %" PRIu64 ", injected %" PRIu32
                ", missed %" PRIu32 ", invented %" PRIu32 ", seed %" PRIu32 "\n",
                outcome.frames, outcome.sent, outcome.lost, injected, outcome.missed, outcome.invented, seed);
    return outcome.missed == 0U && outcome.invented == 0U ? 0 : 1;
}
