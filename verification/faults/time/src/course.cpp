// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/course_file.hpp"
#include "time_faults.hpp"
#include "victims.hpp"

namespace mamori::time_faults {
namespace {

std::int64_t to_number(std::size_t index) noexcept {
    return index == kNoIndex ? -1 : static_cast<std::int64_t>(index);
}

}  // namespace

bool write_course(const Request& request, const Course& course, const char* path) {
    const Duration span = kWatchLimits.rate.span;
    std::vector<Duration> lengths;
    for (const WindowRow& row : get_executive().get_view().windows) {
        lengths.push_back(row.length);
    }
    const std::vector<std::size_t> window_of{kWindowOf.begin(), kWindowOf.end()};
    verification::CourseFile file{"time"};
    file.add("seed", request.seed);
    file.add("defect", verification::get_name(request.defect));
    file.add("frames", request.frame_count);
    file.add("requested", request.injection_count);
    file.add("has_priority", course.has_priority);
    file.add("has_storm", course.has_storm);
    file.add("has_locked_memory", course.has_locked_memory);
    file.add("major_faults", course.major_faults);
    file.add("minor_faults", course.minor_faults);
    file.add("requests", course.requests);
    file.add("reads_under_way", course.reads_under_way);
    file.add("frame_ns", kTick.ns);
    file.add("budget_ns", kBudget.ns);
    file.add("loss_min_ns", kLossMin.ns);
    file.add("overdue_bound_ns", kTick.ns);
    file.add("rate_bound_ns", (span + span + kTick).ns);
    file.add("causes", {"work", "lock", "stuck_guard"});
    file.add("watch_faults", {"none", "overdue", "fast_clock", "slow_clock"});
    file.add("host", course.host);
    file.add<std::size_t>(
        "components", window_of,
        {{"window", [](const std::size_t& row) { return static_cast<std::int64_t>(row); }}});
    file.add<Duration>("windows", lengths, {{"length_ns", [](const Duration& row) { return row.ns; }}});
    file.add<Report>("reports", course.reports,
                     {{"is_overrun", [](const Report& row) { return std::int64_t{row.is_overrun}; }},
                      {"window", [](const Report& row) { return to_number(row.window); }},
                      {"component", [](const Report& row) { return to_number(row.component); }},
                      {"release_ns", [](const Report& row) { return row.release.ns; }},
                      {"woke_ns", [](const Report& row) { return row.woke.ns; }},
                      {"at_ns", [](const Report& row) { return row.at.ns; }},
                      {"runner_delay_ns", [](const Report& row) { return row.runner_delay.ns; }},
                      {"component_delay_ns", [](const Report& row) { return row.component_delay.ns; }}});
    file.add<Overrun>("overruns", course.overruns,
                      {{"component", [](const Overrun& row) { return to_number(row.component); }},
                       {"cause", [](const Overrun& row) { return static_cast<std::int64_t>(row.cause); }},
                       {"begin_ns", [](const Overrun& row) { return row.begin.ns; }},
                       {"end_ns", [](const Overrun& row) { return row.end.ns; }}});
    file.add<Delay>("delays", course.delays,
                    {{"window", [](const Delay& row) { return to_number(row.window); }},
                     {"release_ns", [](const Delay& row) { return row.release.ns; }},
                     {"end_ns", [](const Delay& row) { return row.end.ns; }}});
    file.add<Hold>("holds", course.holds,
                   {{"due_ns", [](const Hold& row) { return row.due.ns; }},
                    {"end_ns", [](const Hold& row) { return row.end.ns; }}});
    file.add<ClockFault>("clock_faults", course.clock_faults,
                         {{"begin_ns", [](const ClockFault& row) { return row.begin.ns; }},
                          {"end_ns", [](const ClockFault& row) { return row.end.ns; }},
                          {"ppm", [](const ClockFault& row) { return row.ppm; }}});
    file.add<Found>("findings", course.found,
                    {{"fault", [](const Found& row) { return static_cast<std::int64_t>(row.finding.fault); }},
                     {"due_ns", [](const Found& row) { return row.finding.due.ns; }},
                     {"seen_ns", [](const Found& row) { return row.finding.seen.ns; }},
                     {"cleared_ns", [](const Found& row) { return row.cleared.ns; }}});
    file.add("stalls", course.stalls);
    file.add("late_polls", course.late_polls);
    file.add("runner_delays", course.runner_delays);
    return file.write(path);
}

}  // namespace mamori::time_faults
