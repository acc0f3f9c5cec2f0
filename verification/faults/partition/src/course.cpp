// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>

#include "campaign.hpp"
#include "mamori/verification/course_file.hpp"

namespace mamori::partition_faults {
namespace {

std::int64_t to_number(std::uint64_t count) noexcept {
    return static_cast<std::int64_t>(count);
}

/// Maximum number of recorded skipped messages, because corrupted memory may show any number.
constexpr std::uint64_t kSkippedShown = 1'000'000U;

void add(verification::CourseFile& file, const char* key, const std::vector<Opening>& openings) {
    file.add<Opening>(key, openings,
                      {{"window", [](const Opening& row) { return to_number(row.window); }},
                       {"release_ns", [](const Opening& row) { return row.release.ns; }}});
}

/// The intervals that can explain why a window was late. The many other intervals are not needed.
std::vector<Stall> select_foreign(const Course& course) {
    std::vector<Stall> selected;
    auto span = course.foreign.begin();
    for (const TimedOpening& window : course.openings) {
        if (!window.is_missed && !window.is_overrun) {
            continue;
        }
        while (span != course.foreign.end() && span->end < window.opening.release) {
            ++span;
        }
        for (; span != course.foreign.end() && span->begin < window.end; ++span) {
            selected.push_back(*span);
        }
    }
    return selected;
}

}  // namespace

bool write_course(const CampaignRequest& request, const Course& course, const char* path) {
    const char* const commit = std::getenv("MAMORI_COMMIT");
    verification::CourseFile file{"partition"};
    file.add("commit", commit == nullptr ? "unknown" : commit);
    file.add("seed", request.seed);
    file.add("defect", verification::get_name(request.defect));
    file.add("requested", request.fault_count);
    file.add("has_priority", course.has_priority);
    file.add("has_run", *course.trouble == '\0');
    file.add("is_too_slow", course.is_too_slow);
    file.add("trouble", course.trouble);
    file.add("frame_ns", kFrame.ns);
    file.add("silent_frames", std::uint64_t{kSilentFrames});
    file.add("skipped_max", kSkippedMax);
    file.add("reaction_time_ns", kReactionTime.ns);
    file.add("kinds", {"kill", "stop", "flood", "corrupt"});
    file.add("faults", {"silent", "flooding", "corrupt", "internal", "none"});
    file.add("knows_foreign", course.knows_foreign);
    file.add("host", course.host);
    file.add<Injected>("injections", course.injections,
                       {{"kind", [](const Injected& row) { return static_cast<std::int64_t>(row.kind); }},
                        {"is_injected", [](const Injected& row) { return std::int64_t{row.is_done}; }},
                        {"begin_ns", [](const Injected& row) { return row.begin.ns; }},
                        {"injected_ns", [](const Injected& row) { return row.done.ns; }},
                        {"end_ns", [](const Injected& row) { return row.over.ns; }}});
    file.add<ReactionBegin>(
        "reactions", course.reactions,
        {{"at_ns", [](const ReactionBegin& row) { return row.at.ns; }},
         {"fault", [](const ReactionBegin& row) { return static_cast<std::int64_t>(row.fault); }},
         {"is_declared", [](const ReactionBegin& row) { return std::int64_t{row.is_declared}; }}});
    file.add<Reception>(
        "receptions", course.receptions,
        {{"at_ns", [](const Reception& row) { return row.at.ns; }},
         {"is_answer", [](const Reception& row) { return std::int64_t{row.is_answer}; }},
         {"is_check_right", [](const Reception& row) { return std::int64_t{row.is_check_right}; }},
         {"is_malformed", [](const Reception& row) { return std::int64_t{row.is_malformed}; }},
         {"skipped", [](const Reception& row) { return to_number(std::min(row.skipped, kSkippedShown)); }}});
    file.add<TimedOpening>(
        "windows", course.openings,
        {{"window", [](const TimedOpening& row) { return to_number(row.opening.window); }},
         {"release_ns", [](const TimedOpening& row) { return row.opening.release.ns; }},
         {"woke_ns", [](const TimedOpening& row) { return row.woke.ns; }},
         {"end_ns", [](const TimedOpening& row) { return row.end.ns; }},
         {"is_missed", [](const TimedOpening& row) { return std::int64_t{row.is_missed}; }},
         {"is_overrun", [](const TimedOpening& row) { return std::int64_t{row.is_overrun}; }}});
    add(file, "ran", course.ran);
    add(file, "expected", course.expected);
    file.add("stalls", course.stalls);
    file.add("late_polls", course.late_polls);
    file.add("foreign", select_foreign(course));
    return file.write(path);
}

}  // namespace mamori::partition_faults
