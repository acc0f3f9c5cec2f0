// SPDX-License-Identifier: Apache-2.0
/// @file
/// Components for the compile-must-fail cases. Each case compiles without MAMORI_BREAK and must not with it.
#ifndef MAMORI_KERNEL_TESTS_COMPILE_FAIL_PARTS_HPP
#define MAMORI_KERNEL_TESTS_COMPILE_FAIL_PARTS_HPP

#include "mamori/kernel/system/system.hpp"

class Producer final : public mamori::Component {
  public:
    constexpr Producer() noexcept : Component("producer") {}
    mamori::OutPort<double> real{*this, "real"};
    mamori::OutPort<int> whole{*this, "whole"};
    using Ports = mamori::Ports<&Producer::real, &Producer::whole>;
};
class Consumer final : public mamori::Component {
  public:
    constexpr Consumer() noexcept : Component("consumer") {}
    mamori::InPort<double> in{*this, "in"};
    using Ports = mamori::Ports<&Consumer::in>;
};

enum class Fault { kOverspeed, kTrackingLost };
enum class Reaction { kSs1, kSto };

using namespace mamori::literals;
inline Producer g_producer;
inline Producer g_second_producer;
inline Consumer g_consumer;
inline mamori::Crossing<double> g_crossing;

#endif  // MAMORI_KERNEL_TESTS_COMPILE_FAIL_PARTS_HPP
