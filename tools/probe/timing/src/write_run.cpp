// SPDX-License-Identifier: Apache-2.0
#include "write_run.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "npy.hpp"

namespace mamori::timing {
namespace {

using ports::posix_rt::Right;

/// Pointers to the rows of all cores, ordered by instant, then by core. The rows of each core are already
/// sorted.
template <typename Row, typename GetRows>
std::vector<const Row*> merge(const std::vector<const RunLog*>& logs, const GetRows& get_rows) {
    std::vector<const Row*> merged;
    for (const RunLog* log : logs) {
        std::vector<const Row*> rows;
        for (const Row& row : get_rows(*log)) {
            rows.push_back(&row);
        }
        std::vector<const Row*> both;
        std::merge(merged.begin(), merged.end(), rows.begin(), rows.end(), std::back_inserter(both),
                   [](const Row* a, const Row* b) { return a->release < b->release; });
        merged = std::move(both);
    }
    return merged;
}

std::string make_openings(const std::vector<const RunLog*>& logs) {
    NpyTable table{{{"release_ns", 8U}, {"woke_ns", 8U}, {"closed_ns", 8U}, {"window", 4U}, {"outcome", 4U}}};
    for (const OpeningRow* row :
         merge<OpeningRow>(logs, [](const RunLog& log) { return log.get_openings(); })) {
        table.add(row->release.ns);
        table.add(row->woke.ns);
        table.add(row->closed.ns);
        table.add(static_cast<std::int64_t>(row->window));
        table.add(static_cast<std::int64_t>(row->outcome));
    }
    return table.make();
}

/// Excludes steps that never began.
std::string make_steps(const std::vector<const RunLog*>& logs) {
    NpyTable table{{{"release_ns", 8U}, {"start_ns", 8U}, {"end_ns", 8U}, {"component", 4U}, {"pass", 4U}}};
    for (const StepRow* row : merge<StepRow>(logs, [](const RunLog& log) { return log.get_steps(); })) {
        // In this order, because outstanding work may end in between, and an end requires a start.
        const std::int64_t end = row->end_ns.load(std::memory_order_acquire);
        const std::int64_t start = row->start_ns.load(std::memory_order_relaxed);
        if (start != kNoInstant.ns) {
            table.add(row->release.ns);
            table.add(start);
            table.add(end);
            table.add(static_cast<std::int64_t>(row->component));
            table.add(static_cast<std::int64_t>(row->pass));
        }
    }
    return table.make();
}

std::string make_right(const Right& right) {
    return std::string{"{\"is_granted\": "} + (right.is_granted ? "true" : "false") +
           ", \"errno\": " + std::to_string(right.system_error) + "}";
}

std::string make_rights(const Right& priority, const Right& processor, const Right& memory) {
    return "{\"priority\": " + make_right(priority) + ", \"processor\": " + make_right(processor) +
           ", \"memory\": " + make_right(memory) + "}";
}

/// Makes a note plain text: characters that JSON would escape become blanks.
std::string make_plain(std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char letter) {
            return letter == '"' || letter == '\\' || static_cast<unsigned char>(letter) < 0x20U;
        },
        ' ');
    return text;
}

std::string make_list(const std::vector<std::string>& notes) {
    std::string list;
    for (const std::string& note : notes) {
        list += (list.empty() ? "\"" : ", \"") + make_plain(note) + "\"";
    }
    return "[" + list + "]";
}

/// Empty for a run without requests.
std::string make_requests(const RunFacts& facts) {
    if (facts.block_cycles == 0U) {
        return {};
    }
    std::string paces;
    for (const Pace pace : facts.paces) {
        paces += (paces.empty() ? "" : ", ") + std::to_string(static_cast<int>(pace));
    }
    return ",\n \"requests\": {\"block_cycles\": " + std::to_string(facts.block_cycles) +
           ", \"count\": " + std::to_string(facts.request_count) + ", \"paces\": [" + paces + "]}";
}

std::string make_facts(const std::vector<const RunLog*>& logs, const RunFacts& facts) {
    std::uint64_t lost = 0U;
    for (const RunLog* log : logs) {
        lost += log->get_lost_count();
    }
    return "{\"schema\": \"mamori.timing_run/1\",\n \"cycles\": {\"asked\": " +
           std::to_string(facts.asked_cycles) + ", \"run\": " + std::to_string(facts.run_cycles) +
           "},\n \"is_partial\": " + (facts.is_partial ? "true" : "false") +
           ",\n \"frame_ns\": " + std::to_string(facts.frame.ns) +
           ",\n \"reference_ns\": " + std::to_string(facts.reference.ns) +
           ",\n \"lost_rows\": " + std::to_string(lost) + ",\n \"notes\": " + make_list(facts.notes) +
           ",\n \"findings\": " + make_list(facts.findings) + make_requests(facts) +
           ",\n \"rights\": " + make_rights(facts.priority, facts.processor, facts.memory) + "\n}\n";
}

std::string make_cost_facts(const RunLog& log, const CostFacts& facts) {
    return "{\"schema\": \"mamori.cost_run/1\",\n \"cycles\": " + std::to_string(facts.cycles) +
           ",\n \"first\": " + std::to_string(facts.counted.first) +
           ",\n \"every\": " + std::to_string(facts.counted.every) +
           ",\n \"is_paced\": " + (facts.is_paced ? "true" : "false") +
           ",\n \"frame_ns\": " + std::to_string(facts.frame.ns) +
           ",\n \"calibration_count\": " + std::to_string(facts.calibration_count) +
           ",\n \"empty_ns\": " + std::to_string(facts.empty.ns) +
           ",\n \"reference_ns\": " + std::to_string(facts.reference.ns) +
           ",\n \"lost_rows\": " + std::to_string(log.get_lost_count()) + ",\n \"compiler\": \"" +
           make_plain(facts.compiler) + "\",\n \"flags\": \"" + make_plain(facts.flags) +
           "\",\n \"c_library\": \"" + make_plain(facts.c_library) +
           "\",\n \"notes\": " + make_list(facts.notes) +
           ",\n \"rights\": " + make_rights(facts.priority, facts.processor, facts.memory) + "\n}\n";
}

bool write_whole(const std::string& path, const std::string& content) {
    const std::string partial = path + ".part";
    std::error_code error;
    {
        std::ofstream out{partial, std::ios::binary};
        out.write(content.data(), static_cast<std::streamsize>(content.size()));
        out.close();
        if (out) {
            std::filesystem::rename(partial, path, error);
            if (!error) {
                return true;
            }
        }
    }
    std::filesystem::remove(partial, error);
    return false;
}

constexpr const char* kOpenings = "openings.npy";
constexpr const char* kSteps = "steps.npy";
constexpr const char* kFacts = "run.json";

/// Name and content of a file.
using File = std::pair<std::string, std::string>;

std::string write_files(const std::string& folder, const std::vector<File>& files) {
    for (const auto& [name, content] : files) {
        if (!write_whole(folder + "/" + name, content)) {
            return folder + "/" + name +
                   ": cannot be written; check the folder, its permissions and its room";
        }
    }
    return {};
}

}  // namespace

std::string remove_files(const std::string& folder) {
    // run.json is removed first, because without it no folder counts as complete.
    for (const char* name : {kFacts, kOpenings, kSteps}) {
        std::error_code error;
        std::filesystem::remove(folder + "/" + name, error);
        if (error) {
            return folder + "/" + name + ": an earlier result cannot be removed: " + error.message();
        }
    }
    return {};
}

std::string write_run(const std::string& folder, const std::vector<const RunLog*>& logs,
                      const RunFacts& facts) {
    return write_files(
        folder,
        {{kOpenings, make_openings(logs)}, {kSteps, make_steps(logs)}, {kFacts, make_facts(logs, facts)}});
}

std::string write_cost(const std::string& folder, const RunLog& log, const CostFacts& facts) {
    return write_files(folder, {{kSteps, make_steps({&log})}, {kFacts, make_cost_facts(log, facts)}});
}

}  // namespace mamori::timing
