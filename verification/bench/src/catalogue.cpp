// SPDX-License-Identifier: Apache-2.0
#include "catalogue.hpp"

#include "fifo_pair.hpp"

namespace mamori::verification::bench {
namespace {

/// The first words that a reader reads are 0, 1, 0, 1 ... A lost or old value changes their sum.
std::uint64_t calc_sum_of_words(std::uint64_t count, std::size_t) {
    return count / 2U;
}

/// The same sum for the entries of `count` operations.
std::uint64_t calc_sum_of_entries(std::uint64_t count, std::size_t size) {
    return calc_sum_of_words(count * kFifoEntries, size);
}

/// Each cycle runs each component once.
std::uint64_t calc_component_runs(std::uint64_t count, std::size_t components) {
    return count * components;
}

}  // namespace

std::vector<Case> make_catalogue() {
    std::vector<Case> ports;
    for (const std::size_t size : kPortSizes) {
        ports.push_back({"port", size, "ns per write and read", 1U, &calc_sum_of_words, {}});
    }
    add_mamori_port(ports);
    add_port_floors(ports);

    std::vector<Case> e2e;
    for (const std::size_t size : kE2eSizes) {
        e2e.push_back({"e2e", size, "ns per protected write and read", 1U, &calc_sum_of_words, {}});
    }
    add_mamori_e2e(e2e);
    add_e2e_floors(e2e);

    std::vector<Case> schedulers;
    for (const std::size_t count : kComponentCounts) {
        schedulers.push_back(
            {"scheduler", count, "ns per component and cycle", count, &calc_component_runs, {}});
    }
    add_mamori_executive(schedulers);
    add_scheduler_floors(schedulers);

    std::vector<Case> wake_ups{
        {"wake-up", 64U, "ns per wake-up, same processor", 2U, &calc_sum_of_words, {}}};
    add_mamori_wake_up(wake_ups);
    add_wake_up_floor(wake_ups);
    add_peers({ports, wake_ups});

    std::vector<Case> fifos;
    for (const std::size_t size : kFifoSizes) {
        fifos.push_back(
            {"fifo", size, "ns per entry, two processors", kFifoEntries, &calc_sum_of_entries, {}});
    }
    add_mamori_fifo(fifos);
    add_fifo_floor(fifos);

    std::vector<Case> all = std::move(ports);
    all.insert(all.end(), e2e.begin(), e2e.end());
    all.insert(all.end(), schedulers.begin(), schedulers.end());
    all.insert(all.end(), wake_ups.begin(), wake_ups.end());
    all.insert(all.end(), fifos.begin(), fifos.end());
    return all;
}

}  // namespace mamori::verification::bench
