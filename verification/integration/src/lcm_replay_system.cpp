// SPDX-License-Identifier: Apache-2.0
// A system that receives states over LCM, in real time and in its replay mode: tests/lcm_replay_test.cpp.
//
//     lcm_replay_system send COUNT     sends COUNT states on the channel STATE, one per 20 ms
//     lcm_replay_system run COUNT      receives in real time until state COUNT - 1, at most 60 s
//     lcm_replay_system --replay LOG   receives from a log in virtual time
#include <time.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "mamori/kernel/system/system.hpp"
#include "mamori/ports/lcm/lcm_link.hpp"
#include "mamori/ports/lcm/link_components.hpp"
#include "mamori/ports/lcm/log_replay.hpp"
#include "mamori/ports/posix_rt/machine.hpp"
#include "mamori/ports/virtual_time/machine.hpp"
#include "mamori/safety/e2e/profile_04.hpp"

namespace replay_sample {

struct State {
    std::uint32_t number{0U};
    double value{0.0};
};

}  // namespace replay_sample

MAMORI_LCM_FIELDS(replay_sample::State, number, value)

namespace {

using namespace mamori;
using namespace mamori::literals;
using namespace mamori::ports::lcm;
using replay_sample::State;

constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr const char* kChannelName = "STATE";
constexpr std::int64_t kPeriodNs = 20'000'000;
constexpr std::uint64_t kFramesMax = 60'000U;

using Profile = safety::E2eProfile04<>;
constexpr safety::SentIdChannel kChannel{0x0BADCAFEU, kChannelLengthMin<State, Profile>,
                                         kChannelLengthMax<State, Profile>, 0U};
using Message = LcmMessage<State, Profile, kChannel>;
using Queue = MessageQueue<Message, 16U>;

/// Sums up the states; the hash depends on each of them and on their order, not on instants.
class Observer final : public Component {
  public:
    constexpr Observer() noexcept : Component("observer") {}
    InPort<State> in{*this, "in"};
    OutPort<double> sum{*this, "sum"};
    using Ports = mamori::Ports<&Observer::in, &Observer::sum>;
    Status on_execute(ContextHandle) noexcept override {
        if (in.is_new()) {
            last = in.read();
            hash.add(last);
            ++count;
            sum.write(sum.get_published() + last.value);
        }
        return Status::kOk;
    }
    State last{};
    TraceHash hash{};
    std::uint32_t count{0U};
};

Queue queue;
LinkReceiver<Message, Queue> receiver{"receiver", queue, {50U}};
Observer observer;
constexpr auto kSystem =
    system(frame(1_ms), window("all", 0_ms, 800_us, budget(600_us), run(receiver, observer)),
           connect(receiver.out, observer.in, any_age()), modelled_time(receiver, 10_us),
           modelled_time(observer, 10_us), trace_hash());

int send(std::uint32_t count) {
    static LcmLink link;
    LcmSender sink{link, kChannelName};
    if (link.open(kUrl) != Status::kOk || sink.open() != Status::kOk) {
        std::fprintf(stderr, "lcm_replay_system: %s\n", get_advice(link.get_fault()));
        return 1;
    }
    safety::E2eProtector<Profile> protector{kChannel};
    std::array<std::byte, Message::kSizeMax> buffer{};
    timespec due{};
    static_cast<void>(clock_gettime(CLOCK_MONOTONIC, &due));
    for (std::uint32_t i = 0U; i < count; ++i) {
        const State state{i, 0.5 * i};
        const Result<std::size_t> size = encode_protected<Message>(state, protector, buffer);
        if (!size.has_value() || sink.send({buffer.data(), size.get_value()}) != Status::kOk) {
            return 1;
        }
        const std::int64_t next = due.tv_nsec + kPeriodNs;
        due = {due.tv_sec + next / 1'000'000'000, next % 1'000'000'000};
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
        }
    }
    return 0;
}

void print_states() {
    std::printf("states %u, last %u, hash %016llx\n", observer.count, observer.last.number,
                static_cast<unsigned long long>(observer.hash.get_value()));
}

int run_in_real_time(std::uint32_t count) {
    static LcmLink link;
    static ports::posix_rt::Machine<kSystem> machine;
    if (link.receive(kChannelName, queue) != Status::kOk || link.open(kUrl) != Status::kOk) {
        std::fprintf(stderr, "lcm_replay_system: %s\n", get_advice(link.get_fault()));
        return 1;
    }
    const Status status = machine.run(kFramesMax, [count](std::uint64_t frame) {
        if (frame == 0U) {
            std::puts("receiving");
            static_cast<void>(std::fflush(stdout));
        }
        if (observer.count > 0U && observer.last.number + 1U == count) {
            machine.request_stop();
        }
    });
    print_states();
    return status == Status::kOk ? 0 : 1;
}

ports::virtual_time::Machine<kSystem> virtual_machine;

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::strcmp(argv[1], "--replay") != 0) {
        const auto count = static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10));
        return std::strcmp(argv[1], "send") == 0 ? send(count) : run_in_real_time(count);
    }
    const std::array<ReplayChannel, 1U> channels{replay_channel(kChannelName, queue, receiver)};
    const int status = replay_main(virtual_machine, channels, argc, argv);
    if (status != 2) {
        print_states();
    }
    return status;
}
