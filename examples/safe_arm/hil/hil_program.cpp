// SPDX-License-Identifier: Apache-2.0
#include "hil_program.hpp"

#include <sched.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "arm_start.hpp"
#include "hil_messages.hpp"
#include "mamori/kernel/base/assert.hpp"
#include "run_record.hpp"

namespace safe_arm {
namespace {

using mamori::Duration;
using mamori::sim::FaultKind;
using mamori::sim::FaultPlan;
using mamori::sim::FaultSpan;

constexpr std::int64_t kNsPerS = 1'000'000'000;
constexpr Duration kUsualDelay = 50_ms;
constexpr int kLinkPriority = 60;  ///< of SCHED_FIFO

volatile std::sig_atomic_t g_is_stop_requested = 0;

void note_stop(int /*signal*/) noexcept {
    g_is_stop_requested = 1;
}

std::uint64_t to_frames(Duration time) noexcept {
    return static_cast<std::uint64_t>(time.ns / kFrame.ns);
}

/// A fault of the messages as an error on a link, on the time line of the kernel.
LinkErrorPlan make_link_error(const FaultPlan& fault, std::uint64_t seed) noexcept {
    LinkErrorPlan plan{};
    if (fault.kind != FaultKind::kMessageLost && fault.kind != FaultKind::kMessageLate) {
        return plan;
    }
    plan.seed = seed;
    plan.first_frame = to_frames(fault.at + kMotionStart);
    switch (fault.span) {
        case FaultSpan::kOnce:
            plan.frame_count = to_frames(mamori::sim::kOnceLength);
            break;
        case FaultSpan::kForTime:
            plan.frame_count = to_frames(fault.duration);
            break;
        case FaultSpan::kPersistent:
            plan.frame_count = std::numeric_limits<std::uint64_t>::max();
            break;
    }
    const bool is_late = fault.kind == FaultKind::kMessageLate;
    plan.error = is_late ? LinkError::kDelay : LinkError::kLoss;
    plan.delay_frames = to_frames(
        is_late ? Duration{static_cast<std::int64_t>(fault.magnitude * static_cast<double>(kNsPerS))}
                : kUsualDelay);
    return plan;
}

/// Gives each thread of this process, also threads of LCM, a fixed priority below that of the windows.
/// Without the right for it, the process continues and is late more often.
void raise_threads() {
    const sched_param priority{kLinkPriority};
    std::error_code error;
    for (const auto& task : std::filesystem::directory_iterator{"/proc/self/task", error}) {
        static_cast<void>(
            ::sched_setscheduler(std::stoi(task.path().filename().string()), SCHED_FIFO, &priority));
    }
}

}  // namespace

HilOptions parse_hil_options(const char* name, const char* what, int argc, const char* const* argv) {
    HilOptions result;
    RunOptions& run = result.run;
    std::string link{kLinkNames[static_cast<std::size_t>(Link::kCommand)]};
    std::string error;
    CLI::App app{what};
    app.add_option("--url", result.url, "URL of the LCM network; default: the variable LCM_DEFAULT_URL");
    app.add_option("--model", run.model, "Arm model file (YAML)")->required();
    app.add_option("--motion", run.motion, "Motion table: lines of time and 7 joint angles [s, rad]")
        ->required();
    app.add_option("--out", run.out, "Folder for the record of this program")->required();
    app.add_option("--frames", run.frames, "Major frames of 1 ms to run")
        ->required()
        ->check(CLI::PositiveNumber);
    app.add_option("--fault", run.fault_text, "Fault plan, as of `safe_arm run`");
    app.add_option("--link", link, "Link of the fault message_lost: device, drive, state or command")
        ->check(CLI::IsMember(std::vector<std::string>(kLinkNames.begin(), kLinkNames.end())));
    app.add_option("--error", error,
                   "What becomes of each message during the fault message_lost, instead of loss")
        ->check(CLI::IsMember(std::vector<std::string>(kLinkErrorNames.begin(), kLinkErrorNames.end())));
    app.add_option("--seed", run.seed, "Seed of damaged bits");
    app.add_option("--replay", result.replay, "Log of lcm-logger to replay in virtual time; only the kernel");
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp& help) {
        result.exit_code = app.exit(help);
        return result;
    } catch (const CLI::ParseError& parse_error) {
        result.exit_code = fail_hil(name, kHilExitUsage, parse_error.what());
        return result;
    }
    if (!run.fault_text.empty()) {
        const mamori::sim::ParsedFaultPlan parsed = mamori::sim::parse_fault_plan(run.fault_text);
        if (!parsed.plan.has_value()) {
            result.exit_code = fail_hil(name, kHilExitUsage, "--fault: " + parsed.error);
            return result;
        }
        run.fault = *parsed.plan;
    }
    result.error = make_link_error(run.fault, run.seed);
    if (!error.empty() && run.fault.kind != FaultKind::kMessageLost) {
        result.exit_code =
            fail_hil(name, kHilExitUsage, "--error: needs --fault kind=message_lost,at=SECONDS");
        return result;
    }
    result.error.link = static_cast<Link>(*find_name(kLinkNames, link));
    if (!error.empty()) {
        result.error.error = static_cast<LinkError>(*find_name(kLinkErrorNames, error));
    }
    return result;
}

int fail_hil(const char* name, int exit_code, const std::string& message) {
    std::cerr << name << ": " << message << '\n';
    return exit_code;
}

int open_hil_link(const char* name, mamori::ports::lcm::LcmLink& link, const std::string& url) {
    const mamori::Status status = link.open(url.empty() ? nullptr : url.c_str());
    if (status == mamori::Status::kOk) {
        raise_threads();
        return kHilExitOk;
    }
    const int exit_code = status == mamori::Status::kUnsupported ? kHilExitMissing : kHilExitFailed;
    return fail_hil(name, exit_code, get_advice(link.get_fault()));
}

int write_hil_report(const char* name, const std::string& out, const char* file,
                     const nlohmann::ordered_json& report) {
    const std::filesystem::path path = std::filesystem::path{out} / file;
    return replace_file(path, report.dump(1) + "\n")
               ? kHilExitOk
               : fail_hil(name, kHilExitFailed, path.string() + ": cannot be written: the disk may be full");
}

nlohmann::ordered_json to_json(const mamori::ports::lcm::LinkNews& news) {
    return {{"used", news.used},           {"lost", news.lost},           {"damaged", news.damaged},
            {"unordered", news.unordered}, {"initial", news.initial},     {"foreign", news.foreign},
            {"truncated", news.truncated}, {"oversized", news.oversized}, {"overwritten", news.overwritten},
            {"is_closed", news.is_closed}};
}

bool is_stop_requested() noexcept {
    return g_is_stop_requested != 0;
}

void catch_stop_signals() noexcept {
    struct sigaction action{};
    action.sa_handler = &note_stop;
    static_cast<void>(::sigaction(SIGTERM, &action, nullptr));
    static_cast<void>(::sigaction(SIGINT, &action, nullptr));
}

Doorbell::Doorbell(mamori::ports::lcm::MessageInbox& queue) noexcept
    : MessageInbox(queue.get_limits()), queue_(queue) {
    MAMORI_ENSURE(1, ::sem_init(&bell_, 0, 0U) == 0);
}

Doorbell::~Doorbell() {
    static_cast<void>(::sem_destroy(&bell_));
}

bool Doorbell::wait_until(std::int64_t deadline_ns) noexcept {
    const timespec deadline{static_cast<time_t>(deadline_ns / kNsPerS),
                            static_cast<long>(deadline_ns % kNsPerS)};
    if (::sem_clockwait(&bell_, CLOCK_MONOTONIC, &deadline) != 0) {
        return false;
    }
    while (::sem_trywait(&bell_) == 0) {
    }
    return true;
}

void Doorbell::store(mamori::Span<const std::byte> message) noexcept {
    queue_.put(message);
    static_cast<void>(::sem_post(&bell_));
}

std::int64_t read_monotonic_ns() noexcept {
    timespec now{};
    static_cast<void>(::clock_gettime(CLOCK_MONOTONIC, &now));
    return std::int64_t{now.tv_sec} * kNsPerS + now.tv_nsec;
}

}  // namespace safe_arm
