// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "time_faults.hpp"

namespace mamori::time_faults {
namespace {

std::string to_text(const Report& report) {
    return std::string{"{\"is_overrun\": "} + (report.is_overrun ? "true" : "false") +
           ", \"window\": " + std::to_string(report.window) +
           ", \"component\": " + (report.is_overrun ? std::to_string(report.component) : "null") +
           ", \"release_ns\": " + std::to_string(report.release.ns) +
           ", \"woke_ns\": " + std::to_string(report.woke.ns) +
           ", \"at_ns\": " + std::to_string(report.at.ns) +
           ", \"lateness_ns\": " + std::to_string(report.lateness.ns) + "}";
}

/// Fields of one object, line by line.
class Fields final {
  public:
    void add(const char* key, const std::string& value) {
        text_ += (text_.empty() ? "\"" : ",\n \"") + std::string{key} + "\": " + value;
    }
    void add(const char* key, std::uint64_t value) { add(key, std::to_string(value)); }
    void add(const char* key, std::int64_t value) { add(key, std::to_string(value)); }
    void add_flag(const char* key, bool value) { add(key, std::string{value ? "true" : "false"}); }
    /// Median, 99 of 100, and the greatest.
    void add_times(const std::string& key, std::vector<std::int64_t> values) {
        std::sort(values.begin(), values.end());
        const auto quantile = [&values](std::size_t percent) {
            return values.empty() ? std::int64_t{0} : values[(values.size() - 1U) * percent / 100U];
        };
        add((key + "_p50_ns").c_str(), quantile(50U));
        add((key + "_p99_ns").c_str(), quantile(99U));
        add((key + "_max_ns").c_str(), quantile(100U));
    }
    std::string get_object() const { return "{" + text_ + "}"; }

  private:
    std::string text_;
};

std::string to_text(const Deed& deed) {
    Fields fields;
    fields.add("component", std::uint64_t{deed.component});
    fields.add("begin_ns", deed.begin.ns);
    fields.add("end_ns", deed.end.ns);
    return fields.get_object();
}

std::string to_text(const ports::posix_rt::GridFinding& finding) {
    const bool is_overdue = finding.fault == ports::posix_rt::GridFault::kOverdue;
    Fields fields;
    fields.add_flag("is_overdue", is_overdue);
    fields.add("due_ns", is_overdue ? std::to_string(finding.due.ns) : "null");
    fields.add("seen_ns", finding.seen.ns);
    return fields.get_object();
}

template <typename Element>
std::string to_list(const std::vector<Element>& elements) {
    std::string list;
    for (const Element& element : elements) {
        list += (list.empty() ? "\n  " : ",\n  ") + to_text(element);
    }
    return "[" + list + "]";
}

std::string to_text(const WatchVerdict& watch) {
    Fields fields;
    fields.add("holds", watch.holds);
    fields.add("holds_seen", watch.holds_seen);
    fields.add("clock_faults", watch.clock_faults);
    fields.add("clock_faults_seen", watch.clock_faults_seen);
    fields.add("masked", watch.masked);
    fields.add("misnamed", watch.misnamed);
    fields.add("unseen", watch.unseen);
    fields.add("tardy", watch.tardy);
    fields.add("tardy_by_host", watch.tardy_by_host);
    fields.add("invented", watch.invented);
    fields.add("by_host", watch.by_host);
    fields.add_times("overdue", watch.overdue_ns);
    fields.add_times("rate", watch.rate_ns);
    fields.add("unexplained", to_list(watch.unexplained));
    fields.add_flag("is_well", watch.is_well());
    return fields.get_object();
}

}  // namespace

std::string to_json(const Request& request, const Verdict& verdict) {
    Fields fields;
    fields.add("schema", std::string{"\"mamori.time_faults/3\""});
    fields.add("seed", request.seed);
    fields.add("frames", verdict.frames);
    fields.add("requested", verdict.requested);
    fields.add("injected", verdict.injected);
    fields.add("seen", verdict.seen);
    fields.add("misnamed", verdict.misnamed);
    fields.add("unseen", verdict.unseen);
    fields.add("tardy", verdict.tardy);
    fields.add("tardy_by_host", verdict.tardy_by_host);
    fields.add("invented", verdict.invented);
    fields.add("by_host", verdict.by_host);
    fields.add("suspected", verdict.suspected);
    fields.add("stalls", verdict.host.stalls);
    fields.add("longest_stall_ns", verdict.host.longest_stall.ns);
    fields.add_times("detection", verdict.detection_ns);
    fields.add("unexplained", to_list(verdict.unexplained));
    fields.add("overlooked", to_list(verdict.overlooked));
    fields.add("locked_out", verdict.locked_out);
    fields.add("locked_out_seen", verdict.locked_out_seen);
    fields.add("watch", to_text(verdict.watch));
    fields.add("requests", verdict.requests);
    fields.add("reads_under_way", verdict.reads_under_way);
    fields.add("major_faults", verdict.major_faults);
    fields.add("minor_faults", verdict.minor_faults);
    fields.add_flag("has_storm", verdict.has_storm);
    fields.add_flag("has_locked_memory", verdict.has_locked_memory);
    fields.add_flag("has_priority", verdict.has_priority);
    const verification::RunFinding finding = verification::assess_run(verdict.get_evidence());
    fields.add("defect", std::string{"\""} + verification::get_name(request.defect) + "\"");
    fields.add("verdict", std::string{"\""} + get_name(finding.verdict) + "\"");
    fields.add("reason", "\"" + finding.reason + "\"");
    return fields.get_object() + "\n";
}

}  // namespace mamori::time_faults
