// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the programs of plant, kernel and controller have in common: command line, waiting for messages, and
/// the figures of a link.
///
/// @satisfies SWR-HIL-005      Design: docs/design/safe_arm.md#hardware-in-the-loop
#ifndef EXAMPLES_SAFE_ARM_HIL_HIL_PROGRAM_HPP
#define EXAMPLES_SAFE_ARM_HIL_HIL_PROGRAM_HPP

#include <semaphore.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "link_errors.hpp"
#include "mamori/ports/lcm/lcm_link.hpp"
#include "mamori/ports/lcm/link_components.hpp"
#include "run_options.hpp"

namespace safe_arm {

inline constexpr int kHilExitOk = 0;
inline constexpr int kHilExitFailed = 1;
inline constexpr int kHilExitUsage = 2;
inline constexpr int kHilExitMissing = 3;

/// Command line of one program. exit_code < 0: run with the options; else end with it.
struct HilOptions {
    std::string url;
    RunOptions run;
    LinkErrorPlan error{};  ///< of `run.fault`, if it is one of a link
    std::string replay;     ///< log that the kernel replays; empty: none
    int exit_code{-1};
};

/// @param[in] name of the program, for messages. @param[in] what it does, for --help.
HilOptions parse_hil_options(const char* name, const char* what, int argc, const char* const* argv);

/// Prints `name: message` to the standard error. @return exit_code.
int fail_hil(const char* name, int exit_code, const std::string& message);

/// Opens the link. @return kHilExitOk; else the exit status, after a message.
int open_hil_link(const char* name, mamori::ports::lcm::LcmLink& link, const std::string& url);

/// Writes `file` into the folder `out`. @return the exit status, after a message.
int write_hil_report(const char* name, const std::string& out, const char* file,
                     const nlohmann::ordered_json& report);

nlohmann::ordered_json to_json(const mamori::ports::lcm::LinkNews& news);

/// True after SIGTERM or SIGINT, once catch_stop_signals() was called.
bool is_stop_requested() noexcept;
void catch_stop_signals() noexcept;

/// Wakes a thread for each message, which continues to a queue.
class Doorbell final : public mamori::ports::lcm::MessageInbox {
  public:
    /// @param[in] queue must outlive this object.
    explicit Doorbell(mamori::ports::lcm::MessageInbox& queue) noexcept;
    ~Doorbell();

    /// Waits for a message, a signal, or `deadline_ns` of CLOCK_MONOTONIC. @return true: messages wait.
    bool wait_until(std::int64_t deadline_ns) noexcept;

  private:
    void store(mamori::Span<const std::byte> message) noexcept override;
    std::uint32_t get_overwritten_count() const noexcept override { return 0U; }

    mamori::ports::lcm::MessageInbox& queue_;
    sem_t bell_{};
};

/// CLOCK_MONOTONIC [ns].
std::int64_t read_monotonic_ns() noexcept;

}  // namespace safe_arm

#endif  // EXAMPLES_SAFE_ARM_HIL_HIL_PROGRAM_HPP
