// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: the list of a component's ports.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
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
