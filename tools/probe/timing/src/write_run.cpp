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

/// steps.npy, and one row for each of them in step_use.npy. Both exclude steps that never began.
struct StepFiles {
    std::string steps;
    std::string use;
};

StepFiles make_steps(const std::vector<const RunLog*>& logs) {
    NpyTable use{{{"cpu_ns", 8U}, {"voluntary", 4U}, {"involuntary", 4U}}};
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
            const bool is_known = end != kNoInstant.ns;
            use.add(is_known ? row->cpu_ns : kNoInstant.ns);
            use.add(is_known ? row->voluntary : 0U);
            use.add(is_known ? row->involuntary : 0U);
        }
    }
    return {table.make(), use.make()};
}

/// One row for each of openings.npy.
std::string make_window_use(const std::vector<const RunLog*>& logs) {
    NpyTable table{{{"own_ns", 8U},
                    {"outside_ns", 8U},
                    {"thread", 4U},
                    {"state", 4U},
                    {"reading_ns", 8U},
                    {"reading_cpu_ns", 8U},
                    {"runner_cpu_ns", 8U}}};
    for (const OpeningRow* row :
         merge<OpeningRow>(logs, [](const RunLog& log) { return log.get_openings(); })) {
        table.add(row->use.own.ns);
        table.add(row->use.outside.ns);
        table.add(row->use.thread);
        table.add(row->state);
        table.add(row->reading.ns);
        table.add(row->reading_cpu_ns);
        table.add(row->runner_cpu_ns);
    }
    return table.make();
}

std::string make_slices(const SwitchFacts& facts) {
    NpyTable table{
        {{"begin_ns", 8U}, {"end_ns", 8U}, {"core", 4U}, {"thread", 4U}, {"process", 4U}, {"left", 4U}}};
    for (std::size_t core = 0U; core < facts.cores.size(); ++core) {
        for (const Slice& slice : facts.cores[core].log->get_kept()) {
            table.add(slice.begin.ns);
            table.add(slice.end.ns);
            table.add(static_cast<std::int64_t>(core));
            table.add(slice.thread);
            table.add(slice.process);
            table.add(slice.is_preempted ? 0 : 1);
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

std::string make_core(const CoreSwitches& core) {
    std::string threads;
    for (const std::uint32_t thread : core.window_threads) {
        threads += (threads.empty() ? "" : ", ") + std::to_string(thread);
    }
    return "{\"right\": " + make_right(core.right) + ", \"processor\": " + std::to_string(core.processor) +
           ", \"runner\": " + std::to_string(core.log->get_runner()) + ", \"window_threads\": [" + threads +
           "], \"lost\": " + std::to_string(core.log->get_lost_count()) + "}";
}

std::string make_thread(const NamedThread& thread) {
    return "{\"thread\": " + std::to_string(thread.thread) +
           ", \"process\": " + std::to_string(thread.process) +
           ", \"kind\": " + std::to_string(static_cast<int>(thread.kind)) +
           ", \"priority\": " + std::to_string(thread.priority) + ", \"name\": \"" + make_plain(thread.name) +
           "\"}";
}

std::string make_switches(const SwitchFacts& facts) {
    std::string cores;
    for (const CoreSwitches& core : facts.cores) {
        cores += (cores.empty() ? "" : ", ") + make_core(core);
    }
    std::string threads;
    for (const NamedThread& thread : facts.threads) {
        threads += (threads.empty() ? "" : ", ") + make_thread(thread);
    }
    std::string continued;
    for (const Instant instant : facts.continued) {
        continued += (continued.empty() ? "" : ", ") + std::to_string(instant.ns);
    }
    return "{\"cores\": [" + cores + "], \"threads\": [" + threads + "], \"continued_ns\": [" + continued +
           "]}";
}

std::string make_states(const std::vector<SystemState>& states) {
    std::string list;
    for (const SystemState& state : states) {
        list += (list.empty() ? "{\"name\": \"" : ", {\"name\": \"") + make_plain(state.name) +
                "\", \"is_operating\": " + (state.is_operating ? "true" : "false") + "}";
    }
    return list;
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
           ",\n \"findings\": " + make_list(facts.findings) + make_requests(facts) + ",\n \"states\": [" +
           make_states(facts.states) + "]" + ",\n \"switches\": " + make_switches(facts.switches) +
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
constexpr const char* kWindowUse = "window_use.npy";
constexpr const char* kStepUse = "step_use.npy";
constexpr const char* kSlices = "slices.npy";
constexpr const char* kFacts = "run.json";

/// Name and content of a file.
using File = std::pair<std::string, std::string>;

std::string write_files(const std::string& folder, const std::vector<File>& files) {
    for (const auto& [name, content] : files) {
        if (!write_whole(folder + "/" + name, content)) {
            return folder + "/" + name +
                   ": cannot be written; check the folder, its permissions and the free space";
        }
    }
    return {};
}

}  // namespace

std::string remove_files(const std::string& folder) {
    // run.json is removed first, because without it no folder counts as complete.
    for (const char* name : {kFacts, kOpenings, kSteps, kWindowUse, kStepUse, kSlices}) {
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
    StepFiles steps = make_steps(logs);
    return write_files(folder, {{kOpenings, make_openings(logs)},
                                {kSteps, std::move(steps.steps)},
                                {kWindowUse, make_window_use(logs)},
                                {kStepUse, std::move(steps.use)},
                                {kSlices, make_slices(facts.switches)},
                                {kFacts, make_facts(logs, facts)}});
}

std::string write_cost(const std::string& folder, const RunLog& log, const CostFacts& facts) {
    return write_files(folder, {{kSteps, make_steps({&log}).steps}, {kFacts, make_cost_facts(log, facts)}});
}

}  // namespace mamori::timing
