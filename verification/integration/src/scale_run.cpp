// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the system of scale_system.hpp and prints the results:
///
///     scale_run [--cycles N] [--watched] [--hash]
///
///     --cycles N   cycles at 1 kHz, a multiple of 10 from 10 on (default 10000)
/// --watched    read the complete introspection 1000 times per second of virtual time
///     --hash       print the trace hash only
///
/// @satisfies SWR-INS-006      Design: docs/design/kernel.md#scale
#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "scale_system.hpp"

namespace {

using mamori::verification::integration::kCyclesPerFrame;
using mamori::verification::integration::run_scale;

constexpr char kUsage[] = "usage: scale_run [--cycles N] [--watched] [--hash]";

int fail(const char* text, const char* word) {
    std::fprintf(stderr, "scale_run: %s '%s'\n%s\n", text, word, kUsage);
    return 2;
}

/// @return 0 for a text that is not a number of cycles.
std::uint64_t parse_cycles(const char* text) {
    char* end = nullptr;
    errno = 0;
    const unsigned long long value = std::strtoull(text, &end, 10);
    const bool is_number = *text >= '0' && *text <= '9' && *end == '\0' && errno == 0;
    return is_number && value % kCyclesPerFrame == 0U ? value : 0U;
}

}  // namespace

int main(int argc, char** argv) {
    std::uint64_t cycles = 10'000U;
    bool is_watched = false;
    bool is_hash_only = false;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--watched") == 0) {
            is_watched = true;
        } else if (std::strcmp(argv[i], "--hash") == 0) {
            is_hash_only = true;
        } else if (std::strcmp(argv[i], "--help") == 0) {
            std::puts(kUsage);
            return 0;
        } else if (std::strcmp(argv[i], "--cycles") != 0) {
            return fail("there is no option", argv[i]);
        } else if (i + 1 == argc) {
            return fail("a number must follow", argv[i]);
        } else {
            ++i;
            cycles = parse_cycles(argv[i]);
            if (cycles == 0U) {
                return fail("--cycles is a multiple of 10 from 10 on, not", argv[i]);
            }
        }
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto result = run_scale(cycles / kCyclesPerFrame, is_watched);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    if (is_hash_only) {
        std::printf("%016" PRIx64 "\n", result.trace_hash);
    } else {
        std::printf("{\"components\": 100, \"cores\": 2, \"cycles\": %" PRIu64
                    ", \"virtual_s\": %.3f, \"wall_s\": %.3f, "
                    "\"overruns\": %" PRIu64 ", \"lost\": %" PRIu64 ", \"rows_read\": %" PRIu64
                    ", \"trace_hash\": \"%016" PRIx64 "\"}\n",
                    cycles, static_cast<double>(cycles) * 1.0e-3, wall.count(), result.overrun_count,
                    result.lost_count, result.row_count, result.trace_hash);
    }
    return result.overrun_count == 0U ? 0 : 1;
}
