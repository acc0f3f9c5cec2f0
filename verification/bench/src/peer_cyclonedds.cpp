// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reference implementation: CycloneDDS through its C API, writer and reader in one participant, so that the
/// path contains no network.
#include <dds/dds.h>

#include <stdexcept>
#include <string>

#include "catalogue.hpp"
#include "peer_cyclonedds.h"
#include "wake_up_pair.hpp"

namespace mamori::verification::bench {
namespace {

template <std::size_t kSize>
const dds_topic_descriptor_t& get_descriptor();
template <>
const dds_topic_descriptor_t& get_descriptor<8U>() {
    return mamori_bench_Message8_desc;
}
template <>
const dds_topic_descriptor_t& get_descriptor<64U>() {
    return mamori_bench_Message64_desc;
}
template <>
const dds_topic_descriptor_t& get_descriptor<1024U>() {
    return mamori_bench_Message1024_desc;
}
template <>
const dds_topic_descriptor_t& get_descriptor<65536U>() {
    return mamori_bench_Message65536_desc;
}

/// Only the loopback interface, no multicast: a benchmark must not send data to a network.
constexpr const char* kConfiguration =
    "<General><Interfaces><NetworkInterface name='lo' multicast='false'/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>";

dds_entity_t check(dds_entity_t entity, const char* what) {
    if (entity < 0) {
        throw std::runtime_error(std::string{what} + ": " + dds_strretcode(-entity));
    }
    return entity;
}

/// One domain for all sizes; exists until the program ends.
dds_entity_t get_participant() {
    static const dds_entity_t participant = [] {
        check(dds_create_domain(0U, kConfiguration), "dds_create_domain");
        return check(dds_create_participant(0U, nullptr, nullptr), "dds_create_participant");
    }();
    return participant;
}

/// Both ends of a topic.
template <std::size_t kSize>
class Topic final {
  public:
    explicit Topic(const char* name) {
        const dds_entity_t topic =
            check(dds_create_topic(get_participant(), &get_descriptor<kSize>(), name, nullptr, nullptr),
                  "dds_create_topic");
        dds_qos_t* const qos = dds_create_qos();
        dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
        reader_ = check(dds_create_reader(get_participant(), topic, qos, nullptr), "dds_create_reader");
        writer_ = check(dds_create_writer(get_participant(), topic, qos, nullptr), "dds_create_writer");
        dds_delete_qos(qos);
    }
    ~Topic() {
        dds_delete(writer_);
        dds_delete(reader_);
    }
    Topic(const Topic&) = delete;
    Topic& operator=(const Topic&) = delete;

    dds_entity_t get_reader() const noexcept { return reader_; }
    void write(const Message<kSize>& message) { dds_write(writer_, message.data()); }
    /// @return true if there was a message.
    bool take(Message<kSize>& message) {
        void* samples[1] = {message.data()};
        dds_sample_info_t info;
        return dds_take(reader_, samples, &info, 1U, 1U) == 1;
    }

  private:
    dds_entity_t reader_{};
    dds_entity_t writer_{};
};

template <std::size_t kSize>
class CycloneDds final : public Subject {
  public:
    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            topic_.write(values_[i]);
            if (topic_.take(read_)) {
                touch(read_);
                sum += read_[0];
            }
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    Message<kSize> read_{};
    Topic<kSize> topic_{("bench" + std::to_string(kSize)).c_str()};
};

/// A separate topic; the reader sleeps in a wait set.
class DdsMailbox final {
  public:
    explicit DdsMailbox(const char* name)
        : topic_(name), waiting_(check(dds_create_waitset(get_participant()), "dds_create_waitset")) {
        const dds_entity_t arrival =
            check(dds_create_readcondition(topic_.get_reader(), DDS_ANY_STATE), "dds_create_readcondition");
        check(dds_waitset_attach(waiting_, arrival, 0), "dds_waitset_attach");
    }
    ~DdsMailbox() { dds_delete(waiting_); }
    DdsMailbox(const DdsMailbox&) = delete;
    DdsMailbox& operator=(const DdsMailbox&) = delete;

    void post(const Message<64U>& message) { topic_.write(message); }
    Message<64U> await() {
        Message<64U> message{};
        while (!topic_.take(message)) {
            check(dds_waitset_wait(waiting_, nullptr, 0U, DDS_INFINITY), "dds_waitset_wait");
        }
        return message;
    }

  private:
    Topic<64U> topic_;
    dds_entity_t waiting_;
};

}  // namespace

void add_cyclonedds(PeerCases cases) {
    add_to_ports<CycloneDds>(cases.ports, "CycloneDDS");
    cases.wake_ups[0].candidates.push_back({"CycloneDDS", &make_subject<WakeUpPair<DdsMailbox>>});
}

}  // namespace mamori::verification::bench
