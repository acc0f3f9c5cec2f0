// SPDX-License-Identifier: Apache-2.0
/// @file
/// Faults of time, put into a system that runs by the clock: work that takes too long, windows that are
/// released too late, at random places and of random size. Judges whether each was seen, in time and under
/// its name, and that nothing else was.
#ifndef MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
#define MAMORI_TIME_FAULTS_TIME_FAULTS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "mamori/kernel/system_table.hpp"
#include "mamori/kernel/time.hpp"

namespace mamori::time_faults {

/// Frame of the system: what "within one tick" means.
inline constexpr Duration kTick{1'000'000};
/// Frames between two faults, at least: the longest fault and its aftermath.
inline constexpr std::uint64_t kDistance = 10U;

enum class Kind : std::uint8_t {
    kLoop,        ///< a component computes for too long
    kSleep,       ///< a component waits for too long
    kLateRelease  ///< the thread that opens the windows comes too late
};

struct Injection {
    std::uint64_t frame{0U};
    Kind kind{Kind::kLoop};
    std::size_t place{0U};  ///< component, or window of a late release
    Duration size{};        ///< 1.1 to 4 ticks
};

/// Frames and faults of a run. `frame_count` must hold kDistance frames for each fault.
struct Request {
    std::uint64_t frame_count{0U};
    std::size_t injection_count{0U};
    std::uint64_t seed{1U};
};

/// The same request gives the same faults, in the order of their frames.
std::vector<Injection> make_injections(const Request& request);

/// A report of the executive.
struct Report {
    bool is_overrun{false};
    std::size_t window{0U};
    std::size_t component{kNoIndex};  ///< of an overrun
    Instant release{};                ///< of the opening
    Instant woke{};
    Instant at{};
    Duration lateness{};  ///< of a late release
};

/// What became of a run. All is well when nearly all faults took effect, each was seen, and nothing was
/// misnamed, unseen, tardy or invented.
struct Verdict {
    std::uint64_t frames{0U};
    std::uint64_t requested{0U};      ///< faults
    std::uint64_t injected{0U};       ///< that took effect; one may not when the machine stood still
    std::uint64_t seen{0U};           ///< reported, under the right name
    std::uint64_t misnamed{0U};       ///< reported in its time, under another name only
    std::uint64_t unseen{0U};         ///< not reported at all
    std::uint64_t tardy{0U};          ///< reported more than a tick after its deadline, while the machine ran
    std::uint64_t tardy_by_host{0U};  ///< likewise, while the machine stood still
    std::uint64_t invented{0U};       ///< reported without a fault, while the machine ran
    std::uint64_t by_host{0U};        ///< reported without a fault, while the machine stood still
    std::uint64_t stalls{0U};  ///< times at which the machine stood still for a tenth of a tick or more
    Duration longest_stall{};
    std::vector<std::int64_t> detection_ns{};  ///< from the deadline of each overrun to its report
    std::vector<Report> unexplained{};         ///< those that were invented
    bool has_priority{false};

    /// A fault may miss its place while the machine stands still; more than a few that do are no test.
    bool is_well() const noexcept {
        return 20U * injected >= 19U * requested && seen == injected &&
               misnamed + unseen + tardy + invented == 0U;
    }
};

/// Runs it: `frame_count` ticks. To be called once per process.
Verdict run(const Request& request);

/// One JSON document.
std::string to_json(const Request& request, const Verdict& verdict);

}  // namespace mamori::time_faults

#endif  // MAMORI_TIME_FAULTS_TIME_FAULTS_HPP
