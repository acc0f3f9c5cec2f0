// SPDX-License-Identifier: Apache-2.0
/// @file
/// The replay mode of a program: runs its system with the messages of a log of lcm-logger, and prints
/// counters and hashes that are equal in each replay. `./mamori lcm replay LOG PROGRAM` runs it twice.
///
///     static mamori::ports::virtual_time::Machine<kSystem> machine;
///     int main(int argc, char** argv) {
///         return replay_main(machine, {{replay_channel("STATE", queue, receiver)}}, argc, argv);
///     }
///
/// @satisfies SWR-LCM-014, SWR-LCM-015      Design: docs/design/lcm.md#transports
#ifndef MAMORI_PORTS_LCM_LOG_REPLAY_HPP
#define MAMORI_PORTS_LCM_LOG_REPLAY_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "mamori/kernel/base/span.hpp"
#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/base/time.hpp"
#include "mamori/kernel/run/devices.hpp"
#include "mamori/kernel/run/executives.hpp"
#include "mamori/ports/lcm/link_components.hpp"
#include "mamori/ports/lcm/log_player.hpp"
#include "mamori/ports/lcm/message_queue.hpp"

namespace mamori::ports::lcm {

/// One channel of a replay. Made by replay_channel().
struct ReplayChannel {
    const char* name;
    MessageInbox* inbox;
    const void* receiver;
    LinkNews (*get_news)(const void* receiver);
};

/// @param[in] name channel of the log. @param[in] queue, receiver must outlive the replay.
template <typename Queue, typename Receiver>
constexpr ReplayChannel replay_channel(const char* name, Queue& queue, const Receiver& receiver) noexcept {
    return {name, &queue, &receiver,
            [](const void* pointer) noexcept { return static_cast<const Receiver*>(pointer)->get_news(); }};
}

/// Delivers a log at the start of each major frame, and reports the run.
///
/// Thread safety: none. Time: reads and writes files. Memory: a LogPlayer; no heap.
class LogReplay final {
  public:
    /// Longest time without an event: a longer one is a change of the clock of the logger, not a pause.
    static constexpr Duration kPauseMax{3'600'000'000'000};

    /// @param[in] output, errors file descriptors of the results and of the messages.
    LogReplay(int output, int errors) noexcept : output_(output), errors_(errors) {}

    /// Opens the log. Prints one line if it is not kOk.
    /// @param[in] channels, argv must outlive this object. @param[in] argv program, `--replay`, path of the
    /// log.
    /// @param[in] has_hash whether the table has trace_hash().
    /// @return kOk; kBadParameter (arguments, channel name, or no hash); kOutOfResources (channels);
    ///         kError (the log cannot be read, or does not begin with an event of LCM).
    Status open(Span<const ReplayChannel> channels, bool has_hash, int argc,
                const char* const* argv) noexcept;
    /// Delivers the events up to `start`. @return whether the system runs on: true until one frame after the
    /// last event, or until the log is damaged.
    bool advance(Instant start) noexcept;
    /// Prints counters, number of frames and one hash, and the place of damage.
    /// @return kOk; kError (the log is damaged, or a pause is longer than kPauseMax).
    Status report(std::uint64_t frames) noexcept;
    /// Prints the hash of a core, after report().
    void report_hash(std::size_t core, std::uint64_t hash) noexcept;
    /// Prints that the system did not start or stop.
    void report_failure() noexcept;

  private:
    LogPlayer player_;
    Span<const ReplayChannel> channels_{};
    const char* path_{""};
    int output_;
    int errors_;
    Status status_{Status::kOk};  ///< of the last delivery
    std::uint64_t event_count_{0U};
    Instant last_event_{0};
    bool is_pause_too_long_{false};
};

namespace detail {

/// Devices of a replay; stops the machine at its end.
template <typename Machine>
class ReplayDevices final : public Devices {
  public:
    ReplayDevices(LogReplay& replay, Machine& machine) noexcept : replay_(replay), machine_(machine) {}
    void sample(std::uint64_t /*frame*/, Instant start) noexcept override {
        if (!replay_.advance(start)) {
            machine_.request_stop();
        }
    }

  private:
    LogReplay& replay_;
    Machine& machine_;
};

}  // namespace detail

/// Runs the system of `machine` in the arguments `PROGRAM --replay LOG` until the end of the log and prints
/// the result. Senders of the system need not be open.
/// @param[in] machine virtual_time::Machine of a table with trace_hash(), not run yet.
/// @return exit status of the program: 0; 1 (the log is damaged, or the system did not start or stop);
///         2 (wrong arguments, or not a log).
template <typename Machine>
int replay_main(Machine& machine, Span<const ReplayChannel> channels, int argc,
                const char* const* argv) noexcept {
    static LogReplay replay(1, 2);
    ExecutiveGroup& executives = machine.get_executives();
    const bool has_hash = executives.get(0U).get_view().has_trace_hash;
    if (replay.open(channels, has_hash, argc, argv) != Status::kOk) {
        return 2;
    }
    detail::ReplayDevices<Machine> devices{replay, machine};
    if (machine.run(devices) != Status::kOk) {
        replay.report_failure();
        return 1;
    }
    const Status status = replay.report(machine.get_frame_count());
    for (std::size_t core = 0U; core < executives.size(); ++core) {
        replay.report_hash(core, executives.get(core).get_trace_hash());
    }
    return status == Status::kOk ? 0 : 1;
}

}  // namespace mamori::ports::lcm

#endif  // MAMORI_PORTS_LCM_LOG_REPLAY_HPP
