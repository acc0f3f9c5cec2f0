// SPDX-License-Identifier: Apache-2.0
/// @file
/// Components of the tables in these tests.
#ifndef MAMORI_TABLE_DUMP_TESTS_PARTS_HPP
#define MAMORI_TABLE_DUMP_TESTS_PARTS_HPP

#include "mamori/kernel/dataflow/queue_in_port.hpp"
#include "mamori/kernel/system/system.hpp"

namespace mamori::table_dump::testing_support {

class Source final : public Component {
  public:
    constexpr explicit Source(const char* name) noexcept : Component(name) {}
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Source::out>;
};
class Filter final : public Component {
  public:
    constexpr explicit Filter(const char* name) noexcept : Component(name) {}
    InPort<double> in{*this, "in"};
    InPort<double, Need::kOptional> hint{*this, "hint"};
    OutPort<double> out{*this, "out"};
    using Ports = mamori::Ports<&Filter::in, &Filter::hint, &Filter::out>;
};
class Logger final : public Component {
  public:
    constexpr explicit Logger(const char* name) noexcept : Component(name) {}
    QueueInPort<double, 4U> in{*this, "in"};
    using Ports = mamori::Ports<&Logger::in>;
};

enum class Fault { kOverspeed, kTrackingLost };
enum class Reaction { kNone, kSs1, kSto };

}  // namespace mamori::table_dump::testing_support

#endif  // MAMORI_TABLE_DUMP_TESTS_PARTS_HPP
