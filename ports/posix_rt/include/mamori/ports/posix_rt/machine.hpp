// SPDX-License-Identifier: Apache-2.0
/// @file
/// A complete system in real time: checks the table and owns executives, hosts, threads, schedule watch,
/// software watchdog, crash handlers and signal handlers, and starts and stops them in the correct order.
///
///     static mamori::ports::posix_rt::Machine<kSystem> machine;
///     int main() { return machine.run(20U, print) == mamori::Status::kOk ? 0 : 1; }
///
/// The same program runs in virtual time with mamori::ports::virtual_time::Machine.
///
/// @satisfies SWR-PRT-070, SWR-PRT-071, SWR-PRT-072, SWR-PRT-073, SWR-PRT-074, SWR-PRT-081, SWR-PRT-082
/// @satisfies SWR-PRT-085
///     Design: docs/design/posix_rt.md#machine
#ifndef MAMORI_PORTS_POSIX_RT_MACHINE_HPP
#define MAMORI_PORTS_POSIX_RT_MACHINE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "mamori/kernel/run/devices.hpp"
#include "mamori/kernel/run/executives.hpp"
#include "mamori/kernel/system/system_rules.hpp"
#include "mamori/kernel/table/action_budget.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/machine_options.hpp"
#include "mamori/ports/posix_rt/machine_run.hpp"

namespace mamori::ports::posix_rt {

template <const auto& kTable,
          typename Cores = std::make_index_sequence<mamori::detail::count_cores(make_view(kTable))>>
class Machine;

/// Must have static storage: work that hangs keeps its thread.
///
/// Thread safety: request_stop() from any thread or signal handler; all other functions from one thread.
/// Time:          run() waits in real time. Memory: no heap; the stacks of its threads.
/// @tparam kTable constexpr system table of static storage duration. A violated rule is named by the compiler
///                as MAMORI_CHECK names it.
template <const auto& kTable, std::size_t... kCores>
class Machine<kTable, std::index_sequence<kCores...>> final {
    static_assert(mamori::detail::keeps_rules<kTable>(), "the system table violates the rule named above");
    static_assert(has_publication_margin(make_view(kTable)),
                  "in real time, a table with a connection between cores states publication_margin(...)");
    static constexpr std::size_t kCoreCount = sizeof...(kCores);
    static constexpr std::size_t kFirstCore = mamori::detail::find_first_core(make_view(kTable));

  public:
    explicit Machine(const MachineOptions& options = {}) noexcept
        : options_(options),
          hosts_{GuardedHost{threads_, kTable.windows, kCores, clock_, get_window_place(options, kCores)}...},
          runners_{CoreRunner{executives_.get(kCores), hosts_[kCores], clock_}...} {
        for (std::size_t window = 0U; window < threads_.size(); ++window) {
            const WindowRow& row = kTable.windows[window];
            const std::size_t declared = row.stack_kib * std::size_t{1024U};
            static_cast<void>(threads_[window].set_execution_budget(row.execution_budget));
            static_cast<void>(
                threads_[window].set_stack_size(declared == 0U ? 0U : declared + kThreadStackMin));
        }
    }
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;
    ~Machine() = default;

    /// Starts the system, runs the next `frames` major frames, closes the outputs and stops the system.
    /// SIGINT, SIGTERM or request_stop() end the run earlier. A later call continues on the same time line.
    /// @param[in] frames > 0.
    /// @return kOk; else get_report() names the failed step: kBadParameter (options or frames are out of
    ///         range, or the calling thread has a fixed priority that the watches are not above);
    ///         kOutOfResources (no thread, or no space for the recorder file); kPreconditionNotMet (another
    ///         machine or other CrashHandlers are active in this process, or work of a window still hangs);
    ///         kError (the schedule watch closed the outputs, or an action exceeded the action_budget() of
    ///         the table); or the failure of MappedFile::open(), FlightRecorder::open(),
    ///         ExecutiveGroup::start() or stop().
    Status run(std::uint64_t frames, Devices& devices) noexcept {
        const SystemView view = make_view(kTable);
        DeviceCaller caller{view, kFirstCore, devices, clock_, run_};
        std::array<GridBeat, kCoreCount> beats{
            GridBeat{view, kCores, kCores == kFirstCore ? &caller : nullptr}...};
        std::array<RunnerThread, kCoreCount> threads{};
        constexpr Duration kBudget = choose_action_budget(kTable.action_budgets);
        std::array<MachineGuard, kCoreCount> guards{
            MachineGuard{hosts_[kCores], kBudget, executives_.get(kCores), run_}...};
        const std::array<ActionGuard*, kCoreCount> guard_pointers{&guards[kCores]...};
        for (std::size_t core = 0U; core < kCoreCount; ++core) {
            runners_[core].set_observer(&beats[core]);
            threads[core].place = get_place(options_, core, 0, options_.runner_stack);
        }
        return run_.run(
            {executives_, clock_, hosts_, runners_, beats, threads, guard_pointers, caller, kFirstCore},
            options_, frames);
    }
    /// Runs until SIGINT, SIGTERM or request_stop().
    Status run(Devices& devices) noexcept { return run(MachineRun::kAllFrames, devices); }
    /// The same without devices.
    Status run(std::uint64_t frames = MachineRun::kAllFrames) noexcept {
        NoDevices devices;
        return run(frames, devices);
    }
    /// Calls `after_frame` with the number of each major frame after its last window on the first core.
    template <typename Action, typename = std::enable_if_t<std::is_invocable_v<Action&, std::uint64_t>>>
    Status run(std::uint64_t frames, Action after_frame) noexcept {
        AfterFrame<Action> devices{after_frame};
        return run(frames, devices);
    }

    /// No window starts after the current major frame. Without a run: the next run has no major frame.
    /// Async-signal-safe.
    void request_stop() noexcept { run_.request_stop(); }

    /// Executives and modes of the system.
    Executives<kTable>& get_executives() noexcept { return executives_; }
    /// Time line of the system; its instant 0 is the start of major frame 0 of the first run.
    const FrameClock& get_clock() const noexcept { return clock_; }
    /// Result of the last run().
    const MachineReport& get_report() const noexcept { return run_.get_report(); }

  private:
    /// @param[in] below steps of priority.
    static ThreadPlace get_place(const MachineOptions& options, std::size_t core, int below,
                                 std::size_t stack) noexcept {
        const std::size_t background_of = mamori::detail::find_background_of(make_view(kTable), core);
        const std::size_t place = background_of == kNoIndex ? core : background_of;
        // A priority out of range is rejected by run(); here, the difference must not overflow.
        const int priority = options.priority >= MachineOptions::kPriorityMin ? options.priority : 0;
        const int steps = background_of == kNoIndex ? below : below + 2;
        const int lower = priority - steps * MachineOptions::kPriorityStep;
        return {lower > 0 ? lower : 0,
                place < options.processors.size() ? options.processors[place] : ThreadPlace::kAnyProcessor,
                stack};
    }
    static ThreadPlace get_window_place(const MachineOptions& options, std::size_t core) noexcept {
        return get_place(options, core, 1, options.window_stack);
    }

    MachineOptions options_;
    Executives<kTable> executives_{};
    FrameClock clock_{FrameClock::at_epoch(0)};
    std::array<WindowThread, mamori::detail::TableType<kTable>::kWindowCount> threads_{};
    std::array<GuardedHost, kCoreCount> hosts_;
    std::array<CoreRunner, kCoreCount> runners_;
    MachineRun run_{};
};

}  // namespace mamori::ports::posix_rt

#endif  // MAMORI_PORTS_POSIX_RT_MACHINE_HPP
