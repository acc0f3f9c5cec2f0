// SPDX-License-Identifier: Apache-2.0
#include "run_recorder.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "arm_assumptions.hpp"
#include "arm_faults.hpp"
#include "run_record.hpp"
#include "safe_arm_system.hpp"
#include "safety_supervisor.hpp"
#include "table_output.hpp"

namespace safe_arm {
namespace {

using Json = nlohmann::ordered_json;
using mamori::Status;
using mamori::safety::kCycleEventNames;
using mamori::safety::Reaction;
using mamori::safety::SafeState;

/// Names of the enumerators from `first` to `last`, by number.
template <typename Enum>
Json make_names(Enum first, Enum last) {
    Json names = Json::object();
    for (auto number = static_cast<unsigned>(first); number <= static_cast<unsigned>(last); ++number) {
        names[std::to_string(number)] = get_name(static_cast<Enum>(number));
    }
    return names;
}

/// The table that `mamori log` reads: docs/design/recorder.md.
std::string make_name_table() {
    constexpr std::array<const char*, kCycleEventNames.size()> kArguments{
        "state", "fault", "reaction", "", "assumption", "cause", ""};
    Json codes = Json::object();
    for (std::size_t code = 0U; code < kCycleEventNames.size(); ++code) {
        codes[std::to_string(code)] = {{"name", kCycleEventNames[code]}, {"argument", kArguments[code]}};
    }
    Json faults = Json::object();
    for (std::size_t fault = 0U; fault < kArmFaultCount; ++fault) {
        faults[std::to_string(fault)] = get_fault_names()[fault];
    }
    Json assumptions = Json::object();
    for (const mamori::safety::AssumptionRow& row : safety_state.get_table().assumptions) {
        assumptions[std::to_string(row.assumption)] = row.name;
    }
    Json sources = {{"0", "supervisor"}};
    for (const mamori::Component* component : executive.get_view().components) {
        sources[std::to_string(sources.size())] = component->get_name();
    }
    Json causes = Json::object();
    for (std::size_t cause = 0U; cause < mamori::safety::kExpiryCauseNames.size(); ++cause) {
        causes[std::to_string(cause)] = mamori::safety::kExpiryCauseNames[cause];
    }
    const Json table = {{"sources", sources},
                        {"codes", codes},
                        {"arguments",
                         {{"state", make_names(SafeState::kSelfTest, SafeState::kLockedHold)},
                          {"fault", faults},
                          {"assumption", assumptions},
                          {"cause", causes},
                          {"reaction", make_names(Reaction::kNone, Reaction::kSto)}}}};
    return table.dump(1) + "\n";
}

const char* describe(Status status) {
    return status == Status::kUnsupported
               ? "was written by another release: move it away or name another file"
               : "is no recorder that can go on: move it away or name another file";
}

}  // namespace

std::string RunRecorder::begin(const std::string& path, mamori::EventLog& log) {
    const std::size_t size = mamori::flight::calc_region_size(kRecorderCapacity);
    if (file_.open(path.c_str(), size) != Status::kOk) {
        const int cause = file_.get_system_error();
        return path + ": the recorder file " + mamori::ports::posix_rt::describe(file_.get_error()) +
               (cause == 0 ? std::string{} : std::string{" ("} + std::strerror(cause) + ")");
    }
    const Status status = recorder_.open(file_.get_region());
    if (status != Status::kOk) {
        return path + ": the recorder file " + describe(status);
    }
    if (!replace_file(path + ".names.json", make_name_table())) {
        return path + ".names.json: cannot be written: the disk may be full";
    }
    return log.attach(recorder_) == Status::kOk ? std::string{}
                                                : path + ": the event log has a recorder already";
}

}  // namespace safe_arm
