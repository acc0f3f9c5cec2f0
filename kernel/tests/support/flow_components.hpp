// SPDX-License-Identifier: Apache-2.0
/// @file
/// Small components that make data flow visible: a counter, a relay that adds one, and a sink that notes.
#ifndef MAMORI_KERNEL_TESTS_FLOW_COMPONENTS_HPP
#define MAMORI_KERNEL_TESTS_FLOW_COMPONENTS_HPP

#include <vector>

#include "mamori/kernel/system/system.hpp"

namespace mamori::testing_support {

/// Writes `step`, 2 * `step`, ... one value per cycle while `is_writing`.
class Counter final : public Component {
  public:
    constexpr explicit Counter(const char* name = "counter") noexcept : Component(name) {}

    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Counter::out>;

    std::int64_t step{10};
    std::int64_t value{0};
    bool is_writing{true};
    bool is_updating{false};  ///< writes in the second pass as well
    Status answer{Status::kOk};

    Status on_execute(ContextHandle) noexcept override {
        if (is_writing) {
            value += step;
            out.write(value);
        }
        return answer;
    }
    Status on_state_update(ContextHandle) noexcept override {
        if (is_updating) {
            out.write(-value);
        }
        return Status::kOk;
    }
};

/// Writes what it reads plus one.
class Relay final : public Component {
  public:
    constexpr explicit Relay(const char* name = "relay") noexcept : Component(name) {}

    InPort<std::int64_t> in{*this, "in"};
    OutPort<std::int64_t> out{*this, "out"};
    using Ports = mamori::Ports<&Relay::in, &Relay::out>;

    Status on_execute(ContextHandle) noexcept override {
        out.write(in.read() + 1);
        return Status::kOk;
    }
};

/// Notes each cycle: what it read, whether that was new, and how old it was.
class Sink final : public Component {
  public:
    struct Note {
        std::int64_t value;
        bool is_new;
        Duration age;
        Instant now;
    };

    explicit Sink(const char* name = "sink") noexcept : Component(name) {}

    InPort<std::int64_t> in{*this, "in"};
    using Ports = mamori::Ports<&Sink::in>;

    std::vector<Note> notes;

    Status on_execute(ContextHandle context) noexcept override {
        notes.push_back({in.read(), in.is_new(), in.calc_age(context.now), context.now});
        return Status::kOk;
    }
    std::vector<std::int64_t> get_values() const {
        std::vector<std::int64_t> values;
        for (const Note& note : notes) {
            values.push_back(note.value);
        }
        return values;
    }
};

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_FLOW_COMPONENTS_HPP
