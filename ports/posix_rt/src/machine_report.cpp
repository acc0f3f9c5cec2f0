// SPDX-License-Identifier: Apache-2.0
#include "mamori/kernel/base/text.hpp"
#include "mamori/ports/posix_rt/machine_options.hpp"

namespace mamori::ports::posix_rt {
namespace {

void append(MachineReportText& text, const char* characters) noexcept {
    for (const char character : make_text(characters)) {
        static_cast<void>(text.push_back(character));  // a text that is too long is truncated
    }
}

}  // namespace

const char* describe(MachineStep step) noexcept {
    switch (step) {
        case MachineStep::kNone:
            return "no failure";
        case MachineStep::kOptions:
            return "an option of the machine or the number of frames is out of range";
        case MachineStep::kRecorder:
            return "the file of the flight recorder cannot be used";
        case MachineStep::kSignals:
            return "another machine runs in this process";
        case MachineStep::kCrashHandlers:
            return "this process has other crash handlers";
        case MachineStep::kWindowThreads:
            return "the threads of the windows cannot be started, or work of an earlier run still hangs";
        case MachineStep::kStart:
            return "a component or the table prevents the start, or an action exceeded its budget";
        case MachineStep::kWatch:
            return "the thread of the schedule watch cannot be started";
        case MachineStep::kWatchdog:
            return "the thread of the watchdog cannot be started";
        case MachineStep::kRunnerThreads:
            return "the threads that run the windows cannot be started";
        case MachineStep::kFrames:
            return "the schedule watch closed the outputs";
        case MachineStep::kStop:
            return "a component failed at the stop, an action exceeded its budget, or work hangs";
    }
    return "unknown step";  // only a corrupted value gets here
}

MachineReportText describe(const MachineReport& report) noexcept {
    MachineReportText text;
    append(text, describe(report.failed_step));
    if (report.late_component != nullptr) {
        append(text, ": ");
        append(text, report.late_action);
        append(text, " of component ");
        append(text, report.late_component);
        append(text, " did not return within the action budget");
    }
    return text;
}

}  // namespace mamori::ports::posix_rt
