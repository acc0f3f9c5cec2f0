// SPDX-License-Identifier: Apache-2.0
// Runs the system from start to end and writes its results as one line of JSON.
#include <array>

#include "arm_system.hpp"
#include "board.hpp"
#include "mamori/kernel/run/action_guard.hpp"
#include "mamori/kernel/table/action_budget.hpp"
#include "other_parts.hpp"
#include "safety_parts.hpp"

namespace proof {
namespace {

namespace virtual_time = mamori::ports::virtual_time;

constexpr std::uint64_t kFrameCount = 2000U;

void write_number(const char* name, std::uint64_t value) noexcept {
    std::array<char, 21U> digits{};  // 20 for the largest number, plus the terminator
    std::size_t first = digits.size() - 1U;
    // At most 20 rounds, because each round removes a digit.
    do {
        --first;
        digits[first] = static_cast<char>('0' + value % 10U);
        value /= 10U;
    } while (value != 0U);
    write_text(name);
    write_text(&digits[first]);
}

void on_failed_check(const mamori::AssertionRecord& record) noexcept {
    write_text(record.file);
    write_number(" line ", record.line);
    write_text(": a check failed\n");
    end_program(kFaulted);
}

bool is_refused(mamori::Status status, const char* what) noexcept {
    if (status == mamori::Status::kOk) {
        return false;
    }
    write_text(what);
    write_text(" was refused\n");
    return true;
}

class StartGuard final : public mamori::ActionGuard {
  public:
    explicit StartGuard(mamori::WindowHost& host) noexcept : ActionGuard(host, mamori::kActionBudget) {}

  private:
    void on_action_overrun(std::size_t, mamori::ComponentAction action) noexcept override {
        write_text(mamori::get_name(action));
        write_text(" exceeded its budget\n");
    }
};

}  // namespace

int run_program() noexcept {
    mamori::set_assertion_handler(&on_failed_check);
    StartGuard guard{virtual_host};
    if (is_refused(prepare_other_parts("slow"), "prepare the other parts") ||
        is_refused(prepare_safety_parts(), "prepare the parts of the safety layer") ||
        is_refused(prepare(), "prepare") || is_refused(executive.initialize(guard), "initialize") ||
        is_refused(executive.start(guard), "start")) {
        return kNotStarted;
    }
    ObedientDevices devices{virtual_host};
    virtual_time::SimulatedCore core{executive, virtual_host};
    virtual_time::FrameRunner runner{{&core, 1U}, devices};
    for (std::uint64_t frame = 0U; frame < kFrameCount; ++frame) {
        runner.run_frame();
    }
    if (is_refused(executive.stop(), "stop") || is_refused(executive.finalize(), "finalize")) {
        return kNotStarted;
    }
    const Facts facts = get_facts();
    write_number("{\"frames\": ", runner.get_frame_count());
    write_number(", \"overruns\": ", runner.get_overrun_count());
    write_number(", \"latched_faults\": ", facts.latched_count);
    write_number(", \"operational_frames\": ", facts.operational_frames);
    write_number(", \"trace_hash\": ", executive.get_trace_hash());
    write_number(", \"stack_used_bytes\": ", calc_stack_used());
    write_text("}\n");
    return kEnded;
}

}  // namespace proof
