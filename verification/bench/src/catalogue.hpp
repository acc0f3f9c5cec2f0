// SPDX-License-Identifier: Apache-2.0
/// @file
/// All cases that this program can measure. CMake generates the source file that lists the available
/// reference implementations.
#ifndef MAMORI_VERIFICATION_BENCH_CATALOGUE_HPP
#define MAMORI_VERIFICATION_BENCH_CATALOGUE_HPP

#include <vector>

#include "subject.hpp"

namespace mamori::verification::bench {

/// The cases of the reference implementations; each adds itself to the cases that it supports.
struct PeerCases {
    std::vector<Case>& ports;
    std::vector<Case>& wake_ups;
};

/// @return all cases: port write and read, the same with a protected message, scheduler, wake-up, FIFO.
std::vector<Case> make_catalogue();

/// @name One function per file of subjects
/// @{
void add_port_floors(std::vector<Case>& ports);
void add_mamori_port(std::vector<Case>& ports);
void add_e2e_floors(std::vector<Case>& e2e);
void add_mamori_e2e(std::vector<Case>& e2e);
void add_scheduler_floors(std::vector<Case>& schedulers);
void add_mamori_executive(std::vector<Case>& schedulers);
void add_wake_up_floor(std::vector<Case>& wake_ups);
void add_mamori_wake_up(std::vector<Case>& wake_ups);
void add_fifo_floor(std::vector<Case>& fifos);
void add_mamori_fifo(std::vector<Case>& fifos);
/// @}

/// @name Written by CMake
/// @{
void add_peers(PeerCases cases);
std::vector<AbsentPeer> get_absent_peers();
/// @}

}  // namespace mamori::verification::bench

#endif  // MAMORI_VERIFICATION_BENCH_CATALOGUE_HPP
