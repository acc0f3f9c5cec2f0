// SPDX-License-Identifier: Apache-2.0
// partition_worker SEED: the process in parallel to the safety system. It has its own system table and
// answers each request. On a signal, it floods or corrupts until it is killed. Only the campaign starts it.
#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <charconv>
#include <cstring>
#include <random>
#include <thread>

#include "mamori/kernel/run/executive.hpp"
#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/posix_rt/core_runner.hpp"
#include "mamori/ports/posix_rt/guarded_host.hpp"
#include "mamori/ports/posix_rt/partition_link.hpp"
#include "mamori/ports/posix_rt/partition_process.hpp"
#include "mamori/ports/posix_rt/shared_memory.hpp"
#include "messages.hpp"

namespace mamori::partition_faults {
namespace {

using namespace ports::posix_rt;  // NOLINT: this program is made of them

/// The program has stopped its normal work.
std::atomic<bool> is_wild{false};

class Worker final : public Component {
  public:
    constexpr Worker() noexcept : Component("worker") {}
    InPort<Request> request{*this, "request"};
    OutPort<Answer> answer{*this, "answer"};
    using Ports = mamori::Ports<&Worker::request, &Worker::answer>;

    Status on_execute(ContextHandle) noexcept override {
        if (is_wild.load(std::memory_order_relaxed)) {
            return Status::kOk;
        }
        Answer next{++sequence_, request.read().sequence, 0U};
        next.check = calc_check(next);
        answer.write(next);
        return Status::kOk;
    }

  private:
    std::uint64_t sequence_{0U};
};

FrameReader request_reader;
FrameWriter answer_writer;
PartitionReceiver<Request> receiver{"receiver", request_reader};
Worker worker;
PartitionSender<Answer> sender{"sender", answer_writer};
constexpr auto kSystem =
    system(frame(1_ms), window("listen", 0_us, 450_us, budget(400_us), mamori::run(receiver, worker)),
           window("tell", 450_us, 450_us, budget(400_us), mamori::run(sender)),
           connect(receiver.out, worker.request, any_age()), connect(worker.answer, sender.in, any_age()));
MAMORI_CHECK(kSystem);
ExecutiveFor executive{kSystem};
std::array<WindowThread, 2U> threads;

/// Processes that only compute, and their maximum run time.
constexpr int kHogs{2};
constexpr unsigned kHogSeconds{2U};

class Diary final {
  public:
    Diary(FrameWriter& writer, const FrameClock& clock) : writer_(writer), clock_(clock) {}
    void write(Note note) {
        const auto byte = static_cast<std::byte>(note);
        static_cast<void>(writer_.write({&byte, 1U}, clock_.get_now()));
    }

  private:
    FrameWriter& writer_;
    const FrameClock& clock_;
};

/// Writes valid replies as fast as possible, and starts processes that compute.
[[noreturn]] void flood(Span<std::byte> region, const FrameClock& clock, Diary& diary) {
    diary.write(Note::kBegun);
    for (int i = 0; i < kHogs; ++i) {
        if (::fork() == 0) {
            static_cast<void>(::alarm(kHogSeconds));
            for (volatile int spin = 0;; spin = spin == 0 ? 1 : 0) {
            }
        }
    }
    FrameWriter writer;
    std::array<std::byte, PartitionSender<Answer>::kCapacity> buffer{};
    static_cast<void>(writer.open(region, buffer.size()));
    for (std::uint64_t i = 1U;; ++i) {
        Answer answer{i, 0U, 0U};
        answer.check = calc_check(answer);
        const Result<std::size_t> length = encode(answer, {buffer.data(), buffer.size()}, kFrameOrder);
        static_cast<void>(writer.write({buffer.data(), length.get_value()}, clock.get_now()));
        if (i == kFloodBurst) {
            diary.write(Note::kDone);
        }
    }
}

/// Repeatedly writes random words to the complete memory of the replies.
[[noreturn]] void corrupt(Span<std::byte> region, std::uint64_t seed, Diary& diary) {
    std::mt19937_64 random{seed};
    auto* const words = reinterpret_cast<std::uint64_t*>(region.data());
    diary.write(Note::kBegun);
    for (bool is_first = true;; is_first = false) {
        for (std::size_t i = 0U; i < region.size() / sizeof(std::uint64_t); ++i) {
            __atomic_store_n(&words[i], random(), __ATOMIC_RELAXED);
        }
        if (is_first) {
            diary.write(Note::kDone);
        }
    }
}

Status open(SharedMemory& memory, int place, std::size_t capacity, SharedAccess access) {
    return memory.adopt(kFirstPartitionDescriptor + place, calc_frame_region_size(capacity), access);
}

int serve(std::uint64_t seed) {
    constexpr std::size_t kRequest = decltype(receiver)::kCapacity;
    constexpr std::size_t kAnswer = decltype(sender)::kCapacity;
    static FrameClock clock = FrameClock::at_epoch(0);
    static SharedMemory requests;
    static SharedMemory answers;
    static SharedMemory notes;
    static FrameWriter note_writer;
    if (find_partition_clock(clock) != Status::kOk ||
        open(requests, kRequestPlace, kRequest, SharedAccess::kRead) != Status::kOk ||
        open(answers, kAnswerPlace, kAnswer, SharedAccess::kWrite) != Status::kOk ||
        open(notes, kDiaryPlace, kNoteCapacity, SharedAccess::kWrite) != Status::kOk ||
        request_reader.open(requests.get_region(), kRequest) != Status::kOk ||
        answer_writer.open(answers.get_writable_region(), kAnswer) != Status::kOk ||
        note_writer.open(notes.get_writable_region(), kNoteCapacity) != Status::kOk) {
        return 1;
    }
    sigset_t signals;
    if (sigemptyset(&signals) + sigaddset(&signals, kFloodSignal) + sigaddset(&signals, kCorruptionSignal) !=
            0 ||
        pthread_sigmask(SIG_BLOCK, &signals, nullptr) != 0) {
        return 1;
    }
    static GuardedHost host{threads, clock, {}};
    static CoreRunner runner{executive, host, clock};
    if (host.open() != Status::kOk || executive.initialize() != Status::kOk ||
        executive.start() != Status::kOk) {
        return 1;
    }
    std::thread thread{[] { runner.run_until_stopped(); }};
    Diary diary{note_writer, clock};
    diary.write(Note::kRuns);
    int signal = 0;
    while (sigwait(&signals, &signal) != 0) {
    }
    is_wild.store(true, std::memory_order_relaxed);
    if (signal == kFloodSignal) {
        flood(answers.get_writable_region(), clock, diary);
    }
    corrupt(answers.get_writable_region(), seed, diary);
}

}  // namespace
}  // namespace mamori::partition_faults

int main(int argc, char** argv) {
    std::uint64_t seed = 0U;
    if (argc != 2 || std::from_chars(argv[1], argv[1] + std::strlen(argv[1]), seed).ec != std::errc{}) {
        return 2;
    }
    return mamori::partition_faults::serve(seed);
}
