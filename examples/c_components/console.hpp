// SPDX-License-Identifier: Apache-2.0
// ConsoleIn and ConsoleOut: components in C++ at both ends of SimpleIO. They do not block: the devices of
// the program read the console before a major frame and print after it.
#ifndef CONSOLE_HPP
#define CONSOLE_HPP

#include "mamori/kernel/dataflow/data_port.hpp"
#include "mamori/kernel/system/port_list.hpp"
#include "simple_io.h"

MAMORI_FIELDS(Number, sec, nsec, data)

/// Sends a number that was entered.
class ConsoleIn final : public mamori::Component {
  public:
    constexpr ConsoleIn() noexcept : Component("console_in") {}
    mamori::OutPort<Number> out{*this, "out"};
    using Ports = mamori::Ports<&ConsoleIn::out>;

    /// For the devices: the number for the next cycle.
    void enter(std::int32_t number) noexcept {
        entered_ = number;
        is_entered_ = true;
    }
    mamori::Status on_execute(mamori::ContextHandle context) noexcept override {
        if (is_entered_) {
            constexpr std::int64_t kNsPerSecond = 1'000'000'000;
            const std::int64_t now = context.now.ns;
            out.write({static_cast<std::uint32_t>(now / kNsPerSecond),
                       static_cast<std::uint32_t>(now % kNsPerSecond), entered_});
            is_entered_ = false;
        }
        return mamori::Status::kOk;
    }

  private:
    std::int32_t entered_{0};
    bool is_entered_{false};
};

/// Receives a number to print.
class ConsoleOut final : public mamori::Component {
  public:
    constexpr ConsoleOut() noexcept : Component("console_out") {}
    mamori::InPort<Number> in{*this, "in"};
    using Ports = mamori::Ports<&ConsoleOut::in>;

    /// For the devices: the number of the last cycle; nullptr: none.
    const Number* get_received() const noexcept { return is_received_ ? &in.read() : nullptr; }
    mamori::Status on_execute(mamori::ContextHandle) noexcept override {
        is_received_ = in.is_new();
        return mamori::Status::kOk;
    }

  private:
    bool is_received_{false};
};

#endif
