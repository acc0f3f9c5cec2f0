// SPDX-License-Identifier: Apache-2.0
#include "mamori/timing/cost_run.hpp"

#include <gnu/libc-version.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>
#include <thread>

#include "mamori/table_dump/table_dump.hpp"
#include "reference_work.hpp"
#include "write_run.hpp"

namespace mamori::timing {
namespace {

using ports::posix_rt::FrameClock;
using ports::virtual_time::FrameRunner;
using ports::virtual_time::SimulatedCore;

/// From the first call of the clock to the first major frame.
constexpr Duration kLead{10'000'000};
/// Steps of mode switches and late stops do not belong to a cycle.
constexpr std::size_t kSpareSteps = 4096U;
constexpr std::size_t kStackSize = 256U * 1024U;
/// Far above realistic counts; keeps the sums below in range.
constexpr std::uint64_t kCyclesMax = 100'000'000U;

void do_nothing(void*, std::size_t, std::size_t) noexcept {}

void do_reference(void* argument, std::size_t, std::size_t) noexcept {
    static_cast<ReferenceWork*>(argument)->run();
}

using Times = std::array<std::int64_t, kReferenceCount>;

/// Times of a counted piece of work other than a step, by the same two readings.
/// @param[in] count 1 .. kReferenceCount times; the others stay 0.
Times calibrate(const FrameClock& clock, void (*work)(void*, std::size_t, std::size_t) noexcept,
                void* argument, std::size_t count) noexcept {
    Times times{};
    for (std::size_t i = 0U; i < count; ++i) {
        const Instant begin = clock.get_now();
        mamori_counted_step(work, argument, 0U);
        times[i] = (clock.get_now() - begin).ns;
    }
    return times;
}

std::string check(const std::vector<CostCore>& cores, const CostOptions& options) {
    if (cores.empty() || options.cycles == 0U || options.cycles > kCyclesMax || options.counted.every == 0U ||
        options.counted.first >= options.cycles || options.out.empty() || options.priority < 1 ||
        options.priority > 99) {
        return "a cost run requires a core, 1 .. " + std::to_string(kCyclesMax) +
               " cycles, --first below this number, --every of at least 1, a folder for its results, "
               "and "
               "a priority of 1 .. 99";
    }
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error) {
        return options.out + ": the folder cannot be created: " + error.message();
    }
    return {};
}

/// Memory for all steps of the counted frames.
std::size_t calc_room(const SystemView& view, const CostOptions& options) {
    const std::uint64_t counted =
        (options.cycles - options.counted.first + options.counted.every - 1U) / options.counted.every;
    std::uint64_t steps = 0U;
    for (std::size_t w = 0U; w < view.windows.size(); ++w) {
        const WindowRow& row = view.windows[w];
        steps += 2U * row.component_count * static_cast<std::uint64_t>(view.frame.ns / row.period.ns);
    }
    return kSpareSteps + static_cast<std::size_t>(steps * counted);
}

/// All memory of the run, allocated before it begins.
class CostSession final {
  public:
    CostSession(const std::vector<CostCore>& cores, Devices& devices, const CostOptions& options)
        : options_(options), devices_(devices), log_(0U, calc_room(get_view(cores), options)) {
        for (const CostCore& core : cores) {
            hosts_.push_back(std::make_unique<CountingHost>(core.clock, log_, core.executive.get_view(),
                                                            options.counted, clock_, options.is_paced));
            cores_.emplace_back(core.executive, core.clock, *hosts_.back());
        }
        facts_.cycles = options.cycles;
        facts_.counted = options.counted;
        facts_.is_paced = options.is_paced;
        facts_.frame = get_view(cores).frame;
        // Under callgrind, each calibration call takes milliseconds, so one call is used.
        facts_.calibration_count = options.is_paced ? kReferenceCount : 1U;
    }

    /// In real time on a separate thread, so that its real-time privileges end with the run.
    /// @throw std::system_error if no thread is available.
    void run() {
        if (options_.is_paced) {
            facts_.memory = ports::posix_rt::lock_memory(kStackSize);
            std::thread{[this]() noexcept {
                facts_.priority = ports::posix_rt::set_priority(pthread_self(), options_.priority);
                facts_.processor = ports::posix_rt::set_processor(pthread_self(), sched_getcpu());
                run_frames();
            }}.join();
        } else {
            run_frames();
        }
    }

    static const SystemView& get_view(const std::vector<CostCore>& cores) noexcept {
        return cores.front().executive.get_view();
    }
    CostFacts& get_facts() noexcept { return facts_; }
    const RunLog& get_log() const noexcept { return log_; }

  private:
    void run_frames() noexcept {
        // The minimum, because it is subtracted from each step: a disturbed reading would make all steps too
        // short.
        const Times empty = calibrate(clock_, &do_nothing, nullptr, facts_.calibration_count);
        facts_.empty = Duration{*std::min_element(
            empty.begin(), empty.begin() + static_cast<std::ptrdiff_t>(facts_.calibration_count))};
        Times reference = calibrate(clock_, &do_reference, &reference_, facts_.calibration_count);
        facts_.reference = take_median(reference);
        clock_ = FrameClock::starting_in(options_.is_paced ? kLead : Duration{0});
        FrameRunner runner{{cores_.data(), cores_.size()}, devices_};
        while (runner.get_frame_count() < options_.cycles) {
            runner.run_frame();
        }
    }

    const CostOptions& options_;
    Devices& devices_;
    RunLog log_;
    FrameClock clock_ = FrameClock::starting_in(Duration{0});
    ReferenceWork reference_;
    std::vector<std::unique_ptr<CountingHost>> hosts_;
    std::vector<SimulatedCore> cores_;
    CostFacts facts_;
};

TimingResult measure(const std::vector<CostCore>& cores, Devices& devices, const CostOptions& options) {
    std::string problem = remove_files(options.out);
    if (problem.empty()) {
        const std::string table = options.out + "/table.json";
        problem = options.save_table ? options.save_table(table)
                                     : table_dump::save_json(table, CostSession::get_view(cores));
    }
    if (!problem.empty()) {
        return {TimingOutcome::kFailed, problem};
    }
    CostSession session{cores, devices, options};
    session.run();
    CostFacts& facts = session.get_facts();
    facts.c_library = std::string{"glibc "} + gnu_get_libc_version();
    facts.compiler = MAMORI_TIMING_COMPILER;
    facts.flags = MAMORI_TIMING_FLAGS;
    if (options.tell_notes) {
        facts.notes = options.tell_notes();
    }
    problem = write_cost(options.out, session.get_log(), facts);
    return {problem.empty() ? TimingOutcome::kWhole : TimingOutcome::kFailed, problem};
}

}  // namespace

TimingResult run_cost(const std::vector<CostCore>& cores, Devices& devices, const CostOptions& options) {
    const std::string problem = check(cores, options);
    if (!problem.empty()) {
        return {TimingOutcome::kRefused, problem};
    }
    try {
        return measure(cores, devices, options);
    } catch (const std::bad_alloc&) {
        return {TimingOutcome::kFailed, "not enough memory for so many cycles: use fewer"};
    } catch (const std::system_error& error) {
        return {TimingOutcome::kFailed, std::string{"no thread can be created: "} + error.what()};
    }
}

}  // namespace mamori::timing
