// SPDX-License-Identifier: Apache-2.0
// grid_times drift SECONDS | grid_times introspection ROUNDS: prints figures as JSON; status 1 when the grid
// drifts or requests shift the start by 1 % of the period or more, 2 for wrong arguments.
#include <charconv>
#include <cstring>
#include <iostream>
#include <string>

#include "grid_figures.hpp"
#include "introspection_load.hpp"

namespace mamori::time_faults {
namespace {

constexpr std::uint64_t kRoundFrames = 500U;
constexpr const char* kNoStart = "grid_times: the system did not start, since no thread could be made\n";

const char* to_text(bool value) {
    return value ? "true" : "false";
}

int tell_drift(std::uint64_t seconds) {
    Grid grid;
    if (grid.open() != Status::kOk) {
        std::cerr << kNoStart;
        return 1;
    }
    const Drift drift = calc_drift(grid.run(seconds * 1000U));
    grid.close();
    std::cout << "{\"schema\": \"mamori.grid_drift/1\",\n \"frames\": " << drift.frames
              << ",\n \"planned_drift_ns\": " << drift.planned_ns
              << ",\n \"first_tenth_median_ns\": " << drift.first_median_ns
              << ",\n \"last_tenth_median_ns\": " << drift.last_median_ns
              << ",\n \"worst_lateness_ns\": " << drift.worst_ns
              << ",\n \"has_priority\": " << to_text(grid.has_priority())
              << ",\n \"is_steady\": " << to_text(drift.is_steady()) << "\n}\n";
    return drift.is_steady() ? 0 : 1;
}

std::string to_json(const Shift& shift) {
    return "{\"median_ns\": " + std::to_string(shift.median_ns) +
           ", \"lowest_ns\": " + std::to_string(shift.lowest_ns) +
           ", \"highest_ns\": " + std::to_string(shift.highest_ns) +
           ", \"is_small\": " + to_text(shift.is_small()) + "}";
}

int tell_load(std::uint64_t round_count) {
    Grid grid;
    IntrospectionLoad load{grid.get_introspection()};  // before this thread is bound to a processor
    if (grid.open() != Status::kOk) {
        std::cerr << kNoStart;
        return 1;
    }
    const std::vector<LoadRound> rounds = run_load_rounds(grid, load, round_count, kRoundFrames);
    grid.close();
    const Shift steady = calc_shift(rounds, &LoadRound::steady_ns);
    const Shift burst = calc_shift(rounds, &LoadRound::burst_ns);
    std::vector<std::int64_t> calm;
    for (const LoadRound& round : rounds) {
        calm.push_back(round.calm_ns);
    }
    std::cout << "{\"schema\": \"mamori.introspection_load/1\",\n \"period_ns\": " << kGridPeriod.ns
              << ",\n \"rounds\": " << rounds.size() << ",\n \"frames_per_turn\": " << kRoundFrames
              << ",\n \"requests\": " << load.get_request_count()
              << ",\n \"median_start_ns\": " << calc_quantile(calm) << ",\n \"steady\": " << to_json(steady)
              << ",\n \"burst\": " << to_json(burst)
              << ",\n \"has_priority\": " << to_text(grid.has_priority()) << "\n}\n";
    return steady.is_small() && burst.is_small() ? 0 : 1;
}

}  // namespace
}  // namespace mamori::time_faults

int main(int argc, char** argv) {
    std::uint64_t number = 0U;
    const std::string what = argc == 3 ? argv[1] : "";
    const char* const text = argc == 3 ? argv[2] : "";
    const char* const end = text + std::strlen(text);
    const std::from_chars_result result = std::from_chars(text, end, number);
    const bool is_number = result.ec == std::errc{} && result.ptr == end && number >= 1U && number <= 86'400U;
    if (is_number && what == "drift") {
        return mamori::time_faults::tell_drift(number);
    }
    if (is_number && what == "introspection") {
        return mamori::time_faults::tell_load(number);
    }
    std::cerr
        << "grid_times: expected 'drift SECONDS' or 'introspection ROUNDS', a whole number of 1 to 86400\n";
    return 2;
}
