// SPDX-License-Identifier: Apache-2.0
/// @file
/// Peer: CycloneDDS through its C API, writer and reader in one participant, so that no network is in the
/// path.
#include <dds/dds.h>

#include <stdexcept>
#include <string>

#include "catalogue.hpp"
#include "peer_cyclonedds.h"

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

/// Only this machine's loopback, no multicast: a benchmark must not speak to anybody's network.
constexpr const char* kConfiguration =
    "<General><Interfaces><NetworkInterface name='lo' multicast='false'/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>";

dds_entity_t check(dds_entity_t entity, const char* what) {
    if (entity < 0) {
        throw std::runtime_error(std::string{what} + ": " + dds_strretcode(-entity));
    }
    return entity;
}

/// One domain for all sizes; it lives as long as the program.
dds_entity_t get_participant() {
    static const dds_entity_t participant = [] {
        check(dds_create_domain(0U, kConfiguration), "dds_create_domain");
        return check(dds_create_participant(0U, nullptr, nullptr), "dds_create_participant");
    }();
    return participant;
}

template <std::size_t kSize>
class CycloneDds final : public Subject {
  public:
    CycloneDds() {
        const std::string name = "bench" + std::to_string(kSize);
        const dds_entity_t topic = check(
            dds_create_topic(get_participant(), &get_descriptor<kSize>(), name.c_str(), nullptr, nullptr),
            "dds_create_topic");
        dds_qos_t* const qos = dds_create_qos();
        dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
        reader_ = check(dds_create_reader(get_participant(), topic, qos, nullptr), "dds_create_reader");
        writer_ = check(dds_create_writer(get_participant(), topic, qos, nullptr), "dds_create_writer");
        dds_delete_qos(qos);
    }

    std::uint64_t run(std::uint64_t count) override {
        std::uint64_t sum = 0U;
        for (std::uint64_t i = 0U; i < count; ++i) {
            const Message<kSize>& value = values_[i];
            dds_write(writer_, value.data());
            void* samples[1] = {read_.data()};
            dds_sample_info_t info;
            if (dds_take(reader_, samples, &info, 1U, 1U) == 1) {
                touch(read_);
                sum += read_[0];
            }
        }
        return sum;
    }

  private:
    WrittenValues<kSize> values_;
    Message<kSize> read_{};
    dds_entity_t reader_{};
    dds_entity_t writer_{};
};

}  // namespace

void add_cyclonedds(std::vector<Case>& ports) {
    add_to_ports<CycloneDds>(ports, "CycloneDDS");
}

}  // namespace mamori::verification::bench
