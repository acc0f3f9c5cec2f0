// SPDX-License-Identifier: Apache-2.0
#include "run_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string_view>
#include <vector>

#include "mamori/simbody_sim/nearest_name.hpp"

namespace safe_arm {
namespace {

constexpr int kExitUsage = 2;

/// The conversion to an unsigned number would wrap a negative one round. @return what is wrong, or nothing.
std::string check_not_negative(const std::string& text) {
    return text.find('-') == std::string::npos ? std::string{} : "'" + text + "' must be 0 or more";
}

const std::vector<std::string_view> kWords{
    "run",    "table", "timing",   "cost",    "--model",    "--motion", "--out",      "--fault", "--first",
    "--seed", "--by",  "--frames", "--every", "--recorder", "--cycles", "--requests", "--help"};

/// @return the first word that is neither known nor the value of an option.
std::string find_unknown_word(int argc, const char* const* argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view word{argv[i]};
        const bool is_known =
            std::find(kWords.begin(), kWords.end(), word.substr(0U, word.find('='))) != kWords.end();
        if (!is_known) {
            return std::string{word};
        }
        if (word.substr(0U, 2U) == "--" && word != "--requests" && word.find('=') == std::string_view::npos) {
            ++i;
        }
    }
    return {};
}

/// @param[out] pace by what the run goes, once the command line is read.
CLI::App* add_cost(CLI::App& app, RunOptions& options, std::string& pace) {
    CLI::App* cost =
        app.add_subcommand("cost", "Run so that the cost of each step can be told; `mamori cost` shows it.");
    cost->add_option("--model", options.model, "Arm model file (YAML)")->required();
    cost->add_option("--motion", options.motion, "Motion table; without one the arm holds its position");
    cost->add_option("--fault", options.fault_text, "Fault plan, as of `run`");
    cost->add_option("--out", options.out, "Folder for the rows")->required();
    cost->add_option("--cycles", options.frames, "Frames of 1 ms to run")
        ->required()
        ->check(CLI::PositiveNumber);
    cost->add_option("--first", options.first_counted, "First frame that is counted")
        ->check(check_not_negative);
    cost->add_option("--every", options.count_every, "Of the frames from there on")
        ->check(CLI::PositiveNumber);
    cost->add_option("--by", pace, "clock: each window at its instant; count: as fast as it goes")
        ->required()
        ->check(CLI::IsMember({"clock", "count"}));
    return cost;
}

}  // namespace

ParsedCommand parse_command(int argc, const char* const* argv) {
    ParsedCommand result;
    RunOptions& options = result.options;
    CLI::App app{"Safe arm: a safety module of RT components guards a simulated arm that follows a motion."};
    app.require_subcommand(1);
    CLI::App* run = app.add_subcommand("run", "Run one scenario in virtual time and write its record.");
    run->add_option("--model", options.model, "Arm model file (YAML)")->required();
    run->add_option("--motion", options.motion, "Motion table: lines of time and 7 joint angles [s, rad]")
        ->required();
    run->add_option("--out", options.out, "Folder for run.json, series.csv and events.csv")->required();
    run->add_option(
        "--fault", options.fault_text,
        "Fault plan, e.g. kind=encoder_freeze,joint=2,channel=a,at=2.0 (at: seconds of the motion, "
        "before its end). Kinds: " +
            mamori::sim::list_fault_kinds());
    run->add_option("--seed", options.seed, "Seed that the record names")
        ->check(check_not_negative)
        ->capture_default_str();
    run->add_option("--frames", options.frames, "Frames of 1 ms to run; 0: the motion plus 2 s")
        ->check(check_not_negative);
    run->add_option("--recorder", options.recorder,
                    "File of a flight recorder: takes the events as they happen, outlives a crash; read it "
                    "by `mamori log`");
    CLI::App* table = app.add_subcommand("table", "Write the system table as JSON; `mamori table` shows it.");
    table->add_option("--out", result.table, "File for the table")->required();
    CLI::App* timing =
        app.add_subcommand("timing", "Run in real time and measure; `mamori timing` shows it.");
    timing->add_option("--model", options.model, "Arm model file (YAML)")->required();
    timing->add_option("--motion", options.motion, "Motion table; without one the arm holds its position");
    timing->add_option("--out", options.out, "Folder for the measured times")->required();
    timing->add_option("--cycles", options.frames, "Frames of 1 ms to run")
        ->required()
        ->check(CLI::PositiveNumber);
    timing->add_flag("--requests", options.with_requests,
                     "Request introspection in some blocks of frames, and record in which");
    std::string pace;
    CLI::App* cost = add_cost(app, options, pace);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp& help) {
        result.exit_code = app.exit(help);
        return result;
    } catch (const CLI::ParseError& error) {
        const std::string word = find_unknown_word(argc, argv);
        std::cerr << "safe_arm: ";
        if (word.empty()) {
            std::cerr << error.what();
        } else {
            std::cerr << "'" << word << "' is not known; did you mean '"
                      << mamori::sim::find_nearest_name(word, kWords) << "'?";
        }
        std::cerr << " See 'safe_arm run --help'.\n";
        result.exit_code = kExitUsage;
        return result;
    }
    result.is_timing = timing->parsed();
    result.is_cost = cost->parsed();
    options.is_by_clock = pace == "clock";
    if (!options.fault_text.empty()) {
        const mamori::sim::ParsedFaultPlan parsed = mamori::sim::parse_fault_plan(options.fault_text);
        if (!parsed.plan.has_value()) {
            std::cerr << "safe_arm: --fault: " << parsed.error << '\n';
            result.exit_code = kExitUsage;
            return result;
        }
        options.fault = *parsed.plan;
    }
    return result;
}

}  // namespace safe_arm
