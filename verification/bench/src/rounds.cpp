// SPDX-License-Identifier: Apache-2.0
#include "rounds.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <stdexcept>

namespace mamori::verification::bench {
namespace {

/// A created subject and its current results.
struct Runner {
    std::unique_ptr<Subject> subject;
    std::uint64_t batch_count{1U};
    std::vector<double> batches_ns{};  ///< of this round, per operation
};

/// @return time of `count` operations [ns].
double time_batch(Subject& subject, const Case& of, const std::string& name, std::uint64_t count) {
    const auto start = std::chrono::steady_clock::now();
    const std::uint64_t sum = subject.run(count);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    if (sum != of.calc_expected(count, of.size)) {
        throw std::runtime_error(of.metric + " " + std::to_string(of.size) + ", " + name +
                                 ": values were lost, so its time means nothing");
    }
    return taken.count();
}

/// Finds a number of operations that takes at least `batch_ns`, and warms up the subject.
void calibrate(Runner& runner, const Case& of, const std::string& name, std::uint64_t batch_ns) {
    constexpr std::uint64_t kCountMax = std::uint64_t{1} << 40U;
    constexpr int kAttempts = 5;
    double shortest = 0.0;
    while (runner.batch_count < kCountMax && shortest < static_cast<double>(batch_ns)) {
        runner.batch_count *= 2U;
        // The minimum of several runs, because one interrupted run would make the batch too small.
        shortest = time_batch(*runner.subject, of, name, runner.batch_count);
        for (int i = 1; i < kAttempts; ++i) {
            shortest = std::min(shortest, time_batch(*runner.subject, of, name, runner.batch_count));
        }
    }
}

double calc_median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2U;
    return values.size() % 2U == 1U ? values[middle] : (values[middle - 1U] + values[middle]) / 2.0;
}

/// Creates the subjects of a case and finds their batch sizes.
std::vector<Runner> prepare(const Case& of, const Effort& effort, Measured& result) {
    std::vector<Runner> runners;
    for (const Candidate& candidate : of.candidates) {
        Runner runner;
        try {
            runner.subject = candidate.make();
        } catch (const std::exception& error) {
            result.absent.push_back({candidate.name, error.what()});
            continue;
        }
        calibrate(runner, of, candidate.name, effort.batch_ns);
        result.series.push_back({candidate.name, runner.batch_count, {}});
        runners.push_back(std::move(runner));
    }
    return runners;
}

/// One visit of a case: the subjects alternate, and the first subject changes from batch to batch.
void visit(const Case& of, std::vector<Runner>& runners, const Effort& effort, Measured& result) {
    for (std::uint32_t batch = 0U; batch < effort.batches; ++batch) {
        for (std::size_t turn = 0U; turn < runners.size(); ++turn) {
            const std::size_t next = (turn + batch) % runners.size();
            Runner& runner = runners[next];
            const double taken =
                time_batch(*runner.subject, of, result.series[next].name, runner.batch_count);
            runner.batches_ns.push_back(taken / static_cast<double>(runner.batch_count));
        }
    }
    for (std::size_t i = 0U; i < runners.size(); ++i) {
        result.series[i].rounds.push_back(calc_median(runners[i].batches_ns) /
                                          static_cast<double>(of.operations));
        runners[i].batches_ns.clear();
    }
}

}  // namespace

std::vector<Measured> measure(const std::vector<Case>& cases, const Effort& effort,
                              const std::function<void(const std::string&)>& tell) {
    std::vector<Measured> results;
    std::vector<std::vector<Runner>> runners;
    for (const Case& of : cases) {
        tell("preparing " + of.metric + " " + std::to_string(of.size));
        results.push_back({of.metric, of.size, of.unit, {}, {}});
        runners.push_back(prepare(of, effort, results.back()));
    }
    for (std::uint32_t round = 1U; round <= effort.rounds; ++round) {
        tell("round " + std::to_string(round) + " of " + std::to_string(effort.rounds));
        for (std::size_t i = 0U; i < cases.size(); ++i) {
            visit(cases[i], runners[i], effort, results[i]);
        }
    }
    return results;
}

}  // namespace mamori::verification::bench
