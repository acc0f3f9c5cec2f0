// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: the list of a component's ports.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/system/system.hpp"
#include "parts.hpp"

// A component without arguments omits one of its ports.
namespace port_not_listed {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double, mamori::Need::kOptional> first{*this, "first"};
    mamori::InPort<double, mamori::Need::kOptional> speed{*this, "speed"};
    mamori::OutPort<double> last{*this, "last"};
#ifdef MAMORI_BREAK_PORT_NOT_LISTED
    using Ports = mamori::Ports<&Monitor::first, &Monitor::last>;
#else
    using Ports = mamori::Ports<&Monitor::first, &Monitor::speed, &Monitor::last>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace port_not_listed

// A component with a name as its argument has no list of ports.
namespace no_port_listed {
class Monitor final : public mamori::Component {
  public:
    constexpr explicit Monitor(const char* name) noexcept : Component(name) {}
    mamori::InPort<double, mamori::Need::kOptional> speed{*this, "speed"};
#ifndef MAMORI_BREAK_NO_PORT_LISTED
    using Ports = mamori::Ports<&Monitor::speed>;
#endif
};
Monitor g_monitor{"monitor"};
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace no_port_listed

// A connected port is listed twice.
namespace port_listed_twice {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double> speed{*this, "speed"};
#ifdef MAMORI_BREAK_PORT_LISTED_TWICE
    using Ports = mamori::Ports<&Monitor::speed, &Monitor::speed>;
#else
    using Ports = mamori::Ports<&Monitor::speed>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms),
    mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_producer, g_monitor)),
    mamori::connect(g_producer.real, g_monitor.speed, mamori::any_age()));
MAMORI_CHECK(kSystem);
}  // namespace port_listed_twice

// Two ports have one name.
namespace port_named_twice {
#ifdef MAMORI_BREAK_PORT_NAMED_TWICE
constexpr const char* kSecondName = "left";
#else
constexpr const char* kSecondName = "right";
#endif
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::InPort<double, mamori::Need::kOptional> left{*this, "left"};
    mamori::OutPort<double> right{*this, kSecondName};
    using Ports = mamori::Ports<&Monitor::left, &Monitor::right>;
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace port_named_twice

// A listed port is constructed without its component.
namespace port_not_owned {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK_PORT_NOT_OWNED
    mamori::OutPort<double> speed{mamori::kNoOwner, "speed"};
#else
    mamori::OutPort<double> speed{*this, "speed"};
#endif
    using Ports = mamori::Ports<&Monitor::speed>;
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace port_not_owned

// A port has a name only.
namespace port_without_owner {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK_PORT_WITHOUT_OWNER
    mamori::OutPort<double> speed{"speed"};
#else
    mamori::OutPort<double> speed{*this, "speed"};
#endif
};
}  // namespace port_without_owner

// A component lists a port of another component.
namespace port_of_other_component {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::OutPort<double> speed{*this, "speed"};
#ifdef MAMORI_BREAK_PORT_OF_OTHER_COMPONENT
    using Ports = mamori::Ports<&Producer::real>;
#else
    using Ports = mamori::Ports<&Monitor::speed>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace port_of_other_component

// A list with an entry that is not a port: 1 a parameter, 2 an action, 3 an object, 4 an action of the base.
namespace list_without_port {
inline mamori::OutPort<double> g_port{mamori::kNoOwner, "port"};
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::OutPort<double> speed{*this, "speed"};
    mamori::Parameter<int> gain{*this, "gain", 1};
    mamori::Status on_execute(mamori::ContextHandle) noexcept override { return mamori::Status::kOk; }
    using Parameters = mamori::Parameters<&Monitor::gain>;
#ifndef MAMORI_BREAK_LIST_WITHOUT_PORT
    using Ports = mamori::Ports<&Monitor::speed>;
#elif MAMORI_BREAK_LIST_WITHOUT_PORT == 1
    using Ports = mamori::Ports<&Monitor::gain, &Monitor::speed>;
#elif MAMORI_BREAK_LIST_WITHOUT_PORT == 2
    using Ports = mamori::Ports<&Monitor::speed, &Monitor::on_execute>;
#elif MAMORI_BREAK_LIST_WITHOUT_PORT == 3
    using Ports = mamori::Ports<&Monitor::speed, &g_port>;
#else
    using Ports = mamori::Ports<&Monitor::speed, &Monitor::on_reset>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace list_without_port

// The list of ports is private, so the table cannot read it.
namespace port_list_private {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::OutPort<double> speed{*this, "speed"};
#ifdef MAMORI_BREAK_PORT_LIST_PRIVATE
  private:
#endif
    using Ports = mamori::Ports<&Monitor::speed>;
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace port_list_private

// A port has an empty name (1) or none (2). Ports of a base class may be listed.
namespace port_without_name {
#ifdef MAMORI_BREAK_PORT_WITHOUT_NAME
constexpr const char* kName = MAMORI_BREAK_PORT_WITHOUT_NAME == 1 ? "" : nullptr;
#else
constexpr const char* kName = "speed";
#endif
class Sensor : public mamori::Component {
  public:
    constexpr Sensor() noexcept : Component("sensor") {}
    mamori::OutPort<double> out{*this, "out"};
};
class Monitor final : public Sensor {
  public:
    mamori::OutPort<double> speed{*this, kName};
    using Ports = mamori::Ports<&Sensor::out, &Monitor::speed>;
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace port_without_name

// A port without a name is not listed either.
namespace unlisted_port_without_name {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK_UNLISTED_PORT_WITHOUT_NAME
    mamori::OutPort<double> speed{*this, nullptr};
#endif
};
Monitor g_monitor;
constexpr auto kSystem = mamori::system(
    mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us), mamori::run(g_monitor)));
MAMORI_CHECK(kSystem);
}  // namespace unlisted_port_without_name
