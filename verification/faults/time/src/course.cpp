// SPDX-License-Identifier: Apache-2.0
#include "mamori/verification/course_file.hpp"
#include "time_faults.hpp"

namespace mamori::time_faults {
namespace {

std::int64_t to_number(std::size_t index) noexcept {
    return index == kNoIndex ? -1 : static_cast<std::int64_t>(index);
}

}  // namespace

bool write_course(const Request& request, const Plan& plan, const Course& course, const Verdict& verdict,
                  const char* path) {
    verification::CourseFile file{"time"};
    file.add("seed", request.seed);
    file.add("defect", verification::get_name(request.defect));
    file.add("frames", verdict.frames);
    file.add("requested", verdict.requested);
    file.add("has_priority", verdict.has_priority);
    file.add("has_storm", verdict.has_storm);
    file.add("has_locked_memory", verdict.has_locked_memory);
    file.add("major_faults", verdict.major_faults);
    file.add("minor_faults", verdict.minor_faults);
    file.add("requests", verdict.requests);
    file.add("reads_under_way", verdict.reads_under_way);
    file.add("frame_ns", kTick.ns);
    file.add("budget_ns", plan.budget.ns);
    file.add("loss_min_ns", kLossMin.ns);
    file.add("overdue_bound_ns", plan.watch.overdue.ns);
    file.add("rate_bound_ns", plan.watch.rate.ns);
    file.add("causes", {"work", "lock", "stuck_guard"});
    file.add("watch_faults", {"none", "overdue", "fast_clock", "slow_clock"});
    file.add("host", verdict.host);
    file.add<std::size_t>(
        "components", plan.window_of,
        {{"window", [](const std::size_t& row) { return static_cast<std::int64_t>(row); }}});
    file.add<Duration>("windows", plan.window_lengths,
                       {{"length_ns", [](const Duration& row) { return row.ns; }}});
    file.add<Report>("reports", course.reports,
                     {{"is_overrun", [](const Report& row) { return std::int64_t{row.is_overrun}; }},
                      {"window", [](const Report& row) { return to_number(row.window); }},
                      {"component", [](const Report& row) { return to_number(row.component); }},
                      {"release_ns", [](const Report& row) { return row.release.ns; }},
                      {"woke_ns", [](const Report& row) { return row.woke.ns; }},
                      {"at_ns", [](const Report& row) { return row.at.ns; }},
                      {"runner_delay_ns", [](const Report& row) { return row.kept_off.ns; }},
                      {"component_delay_ns", [](const Report& row) { return row.component_kept_off.ns; }}});
    file.add<Deed>("overruns", course.deeds,
                   {{"component", [](const Deed& row) { return to_number(row.component); }},
                    {"cause", [](const Deed& row) { return static_cast<std::int64_t>(row.cause); }},
                    {"begin_ns", [](const Deed& row) { return row.begin.ns; }},
                    {"end_ns", [](const Deed& row) { return row.end.ns; }}});
    file.add<Delay>("delays", course.delays,
                    {{"window", [](const Delay& row) { return to_number(row.window); }},
                     {"release_ns", [](const Delay& row) { return row.release.ns; }},
                     {"end_ns", [](const Delay& row) { return row.end.ns; }}});
    file.add<Hold>("holds", course.watch.holds,
                   {{"due_ns", [](const Hold& row) { return row.due.ns; }},
                    {"end_ns", [](const Hold& row) { return row.end.ns; }}});
    file.add<ClockFault>("clock_faults", course.watch.clock_faults,
                         {{"begin_ns", [](const ClockFault& row) { return row.begin.ns; }},
                          {"end_ns", [](const ClockFault& row) { return row.end.ns; }},
                          {"ppm", [](const ClockFault& row) { return row.ppm; }}});
    file.add<Found>("findings", course.watch.found,
                    {{"fault", [](const Found& row) { return static_cast<std::int64_t>(row.finding.fault); }},
                     {"due_ns", [](const Found& row) { return row.finding.due.ns; }},
                     {"seen_ns", [](const Found& row) { return row.finding.seen.ns; }},
                     {"cleared_ns", [](const Found& row) { return row.cleared.ns; }}});
    file.add("stalls", course.stalls);
    file.add("late_polls", course.late_looks);
    file.add("runner_delays", course.runner_delays);
    return file.write(path);
}

}  // namespace mamori::time_faults
