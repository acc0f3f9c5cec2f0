// SPDX-License-Identifier: Apache-2.0
/// @file
/// Applies error patterns to every profile and compares the number that passes with a model of the definition
/// of the profile. Patterns: all of 1 and 2 bits up to 64 bytes, all of 3 bits up to 16 bytes, and all bursts
/// up to the width of the CRC. Bursts of 8 bits (up to 64 bytes) and 16 bits (up to 16 bytes) are applied one
/// by one; bursts of 32 and 64 bits (up to 64 bytes) are calculated by linear algebra. Prints the passing
/// patterns; exit status 1 with differences.
///
///     mamori_e2e_errors
///
/// @satisfies SWR-E2E-012      Design: docs/design/e2e.md#undetected-errors
#include <chrono>
#include <cstdio>

#include "error_model.hpp"
#include "error_patterns.hpp"

namespace mamori::safety::rig {
namespace {

std::size_t g_differences = 0U;

/// @return number of passing patterns and their description; "-" for none.
template <typename Case, typename Count>
void try_one(const char* what, std::size_t length, Count count) {
    RealTrial<Case> real{length};
    ModelTrial model{get_rules<Case>(), length};
    const std::uint64_t passed = count(real);
    const std::uint64_t expected = count(model);
    if (passed != 0U || passed != expected) {
        std::printf("  %zu bytes: %s: %llu pass%s", length, what, static_cast<unsigned long long>(passed),
                    passed == expected ? "\n" : "");
    }
    if (passed != expected) {
        std::printf(", the model says %llu\n", static_cast<unsigned long long>(expected));
        ++g_differences;
    }
}

template <typename Case>
void try_profile(const char* name, unsigned width) {
    std::printf("%s\n", name);
    const auto begin = std::chrono::steady_clock::now();
    const std::size_t most = Case::Profile::kLengthMax < 64U ? Case::Profile::kLengthMax : 64U;
    for (std::size_t length = Case::Profile::kHeaderSize; length <= most; ++length) {
        if (Case::Profile::find_fault(Case::make(length)) != ChannelFault::kNone) {
            std::printf("  %zu bytes: left out, a stuck line fits this identifier\n", length);
            continue;
        }
        try_one<Case>("1 bit", length, [](auto& trial) { return count_weight(trial, 1U); });
        try_one<Case>("2 bits", length, [](auto& trial) { return count_weight(trial, 2U); });
        if (length <= 16U) {
            try_one<Case>("3 bits", length, [](auto& trial) { return count_weight(trial, 3U); });
        }
        if (width == 8U || (width == 16U && length <= 16U)) {
            try_one<Case>("bursts", length, [width](auto& trial) { return count_bursts(trial, width); });
        }
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::printf("  %.1f s\n", took.count());
    static_cast<void>(std::fflush(stdout));
}

void judge_windows(const char* name, std::size_t length, std::size_t dependent) {
    if (dependent > 0U) {
        std::printf("  %s, %zu bytes: bursts pass in %zu windows of the checksum's width\n", name, length,
                    dependent);
    }
}

void try_wide_bursts() {
    std::printf("bursts of 32 and 64 bits\n");
    for (std::size_t length = 12U; length <= 64U; ++length) {
        judge_windows("P04, P44", length, count_dependent_windows<kCrc32P4>(length, 8U));
    }
    for (std::size_t length = 16U; length <= 64U; ++length) {
        judge_windows("P08", length, count_dependent_windows<kCrc32P4>(length, 0U));
    }
    for (std::size_t length = 20U; length <= 64U; ++length) {
        judge_windows("P07", length, count_dependent_windows<kCrc64>(length, 0U));
    }
}

}  // namespace
}  // namespace mamori::safety::rig

int main() {
    using namespace mamori::safety::rig;
    try_profile<P01Both>("P01 both", 8U);
    try_profile<P01Alternating>("P01 alternating", 8U);
    try_profile<P01Low>("P01 low", 8U);
    try_profile<P01Nibble>("P01 nibble", 8U);
    try_profile<P11Both>("P11 both", 8U);
    try_profile<P11Nibble>("P11 nibble", 8U);
    try_profile<P02>("P02", 8U);
    try_profile<P22>("P22", 8U);
    try_profile<P05>("P05", 16U);
    try_profile<P06>("P06", 16U);
    try_profile<P04>("P04", 32U);
    try_profile<P44>("P44", 32U);
    try_profile<P07>("P07", 64U);
    try_profile<P08>("P08", 32U);
    try_wide_bursts();
    std::printf("%zu differences from the model\n", g_differences);
    return g_differences == 0U ? 0 : 1;
}
