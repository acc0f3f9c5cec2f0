// SPDX-License-Identifier: Apache-2.0
// What the compiler rejects: the list of a component's parameters.
// Each namespace compiles, and does not with its MAMORI_BREAK_<NAME>.
#include "mamori/kernel/system/system.hpp"

using namespace mamori::literals;

template <typename... Cs>
constexpr auto make_table(Cs&... components) {
    return mamori::system(mamori::frame(1_ms), mamori::window("w", 0_us, 100_us, mamori::budget(50_us),
                                                              mamori::run(components...)));
}

// A component without arguments omits one of its parameters.
namespace parameter_not_listed {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::Parameter<int> first{*this, "first", 1};
    mamori::Parameter<double> limit{*this, "limit", 1.0, mamori::between(0.1, 3.0)};
    mamori::Parameter<int> last{*this, "last", 1};
#ifdef MAMORI_BREAK_PARAMETER_NOT_LISTED
    using Parameters = mamori::Parameters<&Monitor::first, &Monitor::last>;
#else
    using Parameters = mamori::Parameters<&Monitor::first, &Monitor::limit, &Monitor::last>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_not_listed

// A component with a name as its argument has no list of parameters.
namespace no_parameter_listed {
class Monitor final : public mamori::Component {
  public:
    constexpr explicit Monitor(const char* name) noexcept : Component(name) {}
    mamori::Parameter<int> gain{*this, "gain", 1};
#ifndef MAMORI_BREAK_NO_PARAMETER_LISTED
    using Parameters = mamori::Parameters<&Monitor::gain>;
#endif
};
Monitor g_monitor{"monitor"};
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace no_parameter_listed

// The list of parameters is private, so the table cannot read it.
namespace parameter_list_private {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::Parameter<int> gain{*this, "gain", 1};
#ifdef MAMORI_BREAK_PARAMETER_LIST_PRIVATE
  private:
#endif
    using Parameters = mamori::Parameters<&Monitor::gain>;
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_list_private

// A parameter is listed twice. The second component of the table is the faulty one.
namespace parameter_listed_twice {
class Other final : public mamori::Component {
  public:
    constexpr Other() noexcept : Component("other") {}
    mamori::Parameter<int> gain{*this, "gain", 1};
    using Parameters = mamori::Parameters<&Other::gain>;
};
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::Parameter<int> gain{*this, "gain", 1};
#ifdef MAMORI_BREAK_PARAMETER_LISTED_TWICE
    using Parameters = mamori::Parameters<&Monitor::gain, &Monitor::gain>;
#else
    using Parameters = mamori::Parameters<&Monitor::gain>;
#endif
};
Other g_other;
Monitor g_monitor;
constexpr auto kSystem = make_table(g_other, g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_listed_twice

// Two parameters have one name.
namespace parameter_named_twice {
#ifdef MAMORI_BREAK_PARAMETER_NAMED_TWICE
constexpr const char* kSecondName = "left";
#else
constexpr const char* kSecondName = "right";
#endif
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::Parameter<int> left{*this, "left", 1};
    mamori::Parameter<int> right{*this, kSecondName, 1};
    using Parameters = mamori::Parameters<&Monitor::left, &Monitor::right>;
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_named_twice

// A parameter has no name, or an empty one (MAMORI_BREAK_... is 1).
namespace parameter_without_name {
#ifdef MAMORI_BREAK_PARAMETER_WITHOUT_NAME
constexpr const char* kName = MAMORI_BREAK_PARAMETER_WITHOUT_NAME == 1 ? "" : nullptr;
#else
constexpr const char* kName = "gain";
#endif
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::Parameter<int> gain{*this, kName, 1};
    using Parameters = mamori::Parameters<&Monitor::gain>;
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_without_name

// A listed parameter is constructed without its component.
namespace parameter_not_owned {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK_PARAMETER_NOT_OWNED
    mamori::Parameter<int> gain{mamori::kNoOwner, "gain", 1};
#else
    mamori::Parameter<int> gain{*this, "gain", 1};
#endif
    using Parameters = mamori::Parameters<&Monitor::gain>;
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_not_owned

// A parameter has a name and a value only.
namespace parameter_without_owner {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
#ifdef MAMORI_BREAK_PARAMETER_WITHOUT_OWNER
    mamori::Parameter<double> gain{"gain", 1.0};
#else
    mamori::Parameter<double> gain{*this, "gain", 1.0};
#endif
};
}  // namespace parameter_without_owner

// A component lists a parameter of another component.
namespace parameter_of_other_component {
class Other final : public mamori::Component {
  public:
    constexpr Other() noexcept : Component("other") {}
    mamori::Parameter<int> gain{*this, "gain", 1};
    using Parameters = mamori::Parameters<&Other::gain>;
};
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::Parameter<int> gain{*this, "gain", 1};
#ifdef MAMORI_BREAK_PARAMETER_OF_OTHER_COMPONENT
    using Parameters = mamori::Parameters<&Other::gain>;
#else
    using Parameters = mamori::Parameters<&Monitor::gain>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace parameter_of_other_component

// A list of parameters with a port (1) or an action (2).
namespace list_without_parameter {
class Monitor final : public mamori::Component {
  public:
    constexpr Monitor() noexcept : Component("monitor") {}
    mamori::OutPort<double> speed{*this, "speed"};
    mamori::Parameter<int> gain{*this, "gain", 1};
    using Ports = mamori::Ports<&Monitor::speed>;
#ifndef MAMORI_BREAK_LIST_WITHOUT_PARAMETER
    using Parameters = mamori::Parameters<&Monitor::gain>;
#elif MAMORI_BREAK_LIST_WITHOUT_PARAMETER == 1
    using Parameters = mamori::Parameters<&Monitor::gain, &Monitor::speed>;
#else
    using Parameters = mamori::Parameters<&Monitor::gain, &Monitor::on_reset>;
#endif
};
Monitor g_monitor;
constexpr auto kSystem = make_table(g_monitor);
MAMORI_CHECK(kSystem);
}  // namespace list_without_parameter
