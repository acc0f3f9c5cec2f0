// SPDX-License-Identifier: Apache-2.0
/// @file
/// Command line of `safe_arm`: what to run, with which fault, and where the record goes.
#ifndef EXAMPLES_SAFE_ARM_RUN_OPTIONS_HPP
#define EXAMPLES_SAFE_ARM_RUN_OPTIONS_HPP

#include <cstdint>
#include <string>

#include "mamori/simbody_sim/fault_plan.hpp"

namespace safe_arm {

struct RunOptions {
    std::string model;
    std::string motion;
    std::string out;
    std::string recorder;            ///< file of the flight recorder; empty: none
    mamori::sim::FaultPlan fault{};  ///< `at` counts from the start of the motion
    std::string fault_text;          ///< as the user wrote it; empty: fault-free
    std::uint64_t seed{1U};
    std::uint64_t frames{0U};         ///< 0: motion plus settling time
    std::uint64_t first_counted{0U};  ///< frame from which on a cost run counts
    std::uint64_t count_every{1U};    ///< of which frames then
    bool is_by_clock{false};          ///< a cost run runs in real time
    bool with_requests{false};        ///< a timing run requests introspection
};

/// What the command line asks for. exit_code < 0: go on with the options; else end with it (help was printed,
/// or one line with the error).
struct ParsedCommand {
    RunOptions options;
    std::string table;      ///< file for the system table; not empty: write it instead of running
    bool is_timing{false};  ///< run in real time and measure, `frames` frames
    bool is_cost{false};    ///< run so that steps can be counted, `frames` frames
    int exit_code{-1};
};

ParsedCommand parse_command(int argc, const char* const* argv);

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_RUN_OPTIONS_HPP
