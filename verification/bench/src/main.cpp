// SPDX-License-Identifier: Apache-2.0
/// @file
/// The benchmark program: measures the requested cases and writes the samples as JSON. It evaluates nothing;
/// verification/bench does.
///
/// @satisfies SWR-BEN-001, SWR-BEN-002      Design: docs/design/bench.md#method
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "catalogue.hpp"
#include "grid_wake_ups.hpp"
#include "rounds.hpp"

namespace mamori::verification::bench {
namespace {

using nlohmann::json;

struct Options {
    Effort effort{};
    std::vector<std::string> only{};
    GridRequest grid{};
    std::string out{};
};

/// @return exit status.
int write(const nlohmann::json& document, const std::string& path) {
    std::ofstream file(path);
    file << document.dump(1) << '\n';
    file.close();
    if (!file) {
        std::cerr << path << ": the samples could not be written; check the folder\n";
        return 1;
    }
    return 0;
}

json to_json(const std::vector<AbsentPeer>& absent) {
    json list = json::array();
    for (const AbsentPeer& peer : absent) {
        list.push_back({{"name", peer.name}, {"reason", peer.reason}});
    }
    return list;
}

json to_json(const Measured& measured) {
    json subjects = json::array();
    for (const Series& series : measured.series) {
        subjects.push_back(
            {{"name", series.name}, {"batch_count", series.batch_count}, {"rounds_ns", series.rounds}});
    }
    return {{"metric", measured.metric},
            {"size", measured.size},
            {"unit", measured.unit},
            {"subjects", subjects},
            {"absent", to_json(measured.absent)}};
}

std::vector<Case> select(const std::vector<std::string>& only) {
    std::vector<Case> cases = make_catalogue();
    const auto is_unwanted = [&only](const Case& each) {
        return !only.empty() && std::find(only.begin(), only.end(), each.metric) == only.end();
    };
    cases.erase(std::remove_if(cases.begin(), cases.end(), is_unwanted), cases.end());
    return cases;
}

int run(const Options& options) {
    const auto tell = [](const std::string& line) { std::cout << line << std::endl; };
    const std::vector<Measured> results = measure(select(options.only), options.effort, tell);
    json document{{"schema", "mamori.bench.samples/1"},
                  {"compiler", MAMORI_BENCH_COMPILER},
                  {"flags", MAMORI_BENCH_FLAGS},
                  {"effort",
                   {{"rounds", options.effort.rounds},
                    {"batches", options.effort.batches},
                    {"batch_ns", options.effort.batch_ns}}},
                  {"absent", to_json(get_absent_peers())},
                  {"cases", json::array()}};
    for (const Measured& each : results) {
        document["cases"].push_back(to_json(each));
    }
    return write(document, options.out);
}

int run_grid(const Options& options) {
    return write({{"schema", "mamori.bench.grid/1"}, {"lateness_ns", measure_grid(options.grid)}},
                 options.out);
}

}  // namespace
}  // namespace mamori::verification::bench

int main(int argc, char** argv) {
    mamori::verification::bench::Options options;
    CLI::App app{"Measures Mamori's operations beside floors and peers; ./mamori bench judges the samples."};
    app.add_option("--out", options.out, "JSON file for the samples")->required();
    app.add_option("--rounds", options.effort.rounds, "rounds")->check(CLI::Range(1, 1000));
    app.add_option("--batches", options.effort.batches, "batches of each subject in a round")
        ->check(CLI::Range(1, 1000));
    app.add_option("--batch-ns", options.effort.batch_ns, "least time of one batch [ns]")
        ->check(CLI::Range(1, 1'000'000'000));
    app.add_option("--only", options.only, "metrics to measure")
        ->check(CLI::IsMember({"port", "e2e", "scheduler", "wake-up", "fifo"}));
    CLI::App* const grid =
        app.add_subcommand("grid", "wake-ups on a grid of 1 kHz instead; needs the rights");
    grid->add_option("--cycles", options.grid.cycles, "wake-ups")
        ->required()
        ->check(CLI::Range(1, 1'000'000));
    grid->add_option("--priority", options.grid.priority, "of SCHED_FIFO")->check(CLI::Range(2, 99));
    grid->add_option("--processor", options.grid.processor, "where all threads run")
        ->check(CLI::Range(0, 1023));
    CLI11_PARSE(app, argc, argv);
    try {
        if (grid->parsed()) {
            return mamori::verification::bench::run_grid(options);
        }
        return mamori::verification::bench::run(options);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
