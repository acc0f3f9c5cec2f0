// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a component in C as a component of a system table. The derived class has the struct and the ports of
/// the component as members; all memory is static and constant-initialised:
///
///     class Gain final : public mamori::CComponent {
///       public:
///         constexpr Gain() noexcept : CComponent("gain", gain_actions, &self_) {}
///         mamori::InPort<double> in{*this, "in"};
///         mamori::OutPort<double> out{*this, "out"};
///         using Ports = mamori::Ports<&Gain::in, &Gain::out>;
///
///       private:
///         struct Gain self_ {mamori::c_port(in), mamori::c_port(out)};
///     };
///
/// @satisfies SWR-CIF-001, SWR-CIF-002, SWR-CIF-003, SWR-CIF-005
/// Design: docs/design/kernel.md#components-in-c
#ifndef MAMORI_KERNEL_C_COMPONENT_HPP
#define MAMORI_KERNEL_C_COMPONENT_HPP

#include <cstdint>
#include <type_traits>

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/c/component.h"
#include "mamori/kernel/component/component.hpp"
#include "mamori/kernel/dataflow/data_port.hpp"

namespace mamori {

namespace detail {

/// @return the status with the number `code`; kError for a number that is not a return code.
template <typename Code>
constexpr Status to_status(Code code) noexcept {
    const auto number = static_cast<std::uint64_t>(code);  // a negative number is a large one
    return number <= MAMORI_PRECONDITION_NOT_MET ? static_cast<Status>(number) : Status::kError;
}

/// The initial value of a MAMORI_IN_PORT.
template <typename Port>
class CInput final {
    using T = typename Port::Payload;

  public:
    constexpr explicit CInput(const Port& port) noexcept : port_(&port) {}
    template <typename CPort>
    constexpr operator CPort() const noexcept {  // NOLINT: implicit on purpose
        static_assert(std::is_same_v<decltype(CPort::read), const T* (*)(const void*)>,
                      "a port has the same payload type in C and in C++");
        return {port_, &read, &is_new, &calc_status};
    }

  private:
    static const Port& as_port(const void* port) noexcept { return *static_cast<const Port*>(port); }
    static const T* read(const void* port) noexcept { return &as_port(port).read(); }
    static bool is_new(const void* port) noexcept { return as_port(port).is_new(); }
    static MamoriPortStatus calc_status(const void* port, MamoriContext context) noexcept {
        return static_cast<MamoriPortStatus>(as_port(port).calc_status(Instant{context.now_ns}));
    }

    const Port* port_;
};

/// The initial value of a MAMORI_OUT_PORT.
template <typename T>
class COutput final {
  public:
    constexpr explicit COutput(OutPort<T>& port) noexcept : port_(&port) {}
    template <typename CPort>
    constexpr operator CPort() const noexcept {  // NOLINT: implicit on purpose
        static_assert(std::is_same_v<decltype(CPort::write), void (*)(void*, const T*)>,
                      "a port has the same payload type in C and in C++");
        return {port_, &write};
    }

  private:
    static void write(void* port, const T* value) noexcept { static_cast<OutPort<T>*>(port)->write(*value); }

    OutPort<T>* port_;
};

}  // namespace detail

/// The initial value of the port in C that reads `port` or writes to it; `port` must outlive it.
template <typename T, Need kNeed>
constexpr detail::CInput<InPort<T, kNeed>> c_port(const InPort<T, kNeed>& port) noexcept {
    return detail::CInput<InPort<T, kNeed>>(port);
}
template <typename T>
constexpr detail::COutput<T> c_port(OutPort<T>& port) noexcept {
    return detail::COutput<T>(port);
}

/// Calls the actions in C. They run as the actions of any component: in order, never reentrantly, within the
/// budget of the window. Failures, reports and supervision do not differ.
///
/// Thread safety: as Component. Time: O(1) plus the action. Memory: no heap.
class CComponent : public Component {
  public:
    Status on_initialize() noexcept override { return call(actions_.on_initialize); }
    Status on_finalize() noexcept override { return call(actions_.on_finalize); }
    Status on_startup(ContextHandle context) noexcept override { return call(actions_.on_startup, context); }
    Status on_shutdown(ContextHandle context) noexcept override {
        return call(actions_.on_shutdown, context);
    }
    Status on_activated(ContextHandle context) noexcept override {
        return call(actions_.on_activated, context);
    }
    Status on_deactivated(ContextHandle context) noexcept override {
        return call(actions_.on_deactivated, context);
    }
    Status on_aborting(ContextHandle context) noexcept override {
        return call(actions_.on_aborting, context);
    }
    Status on_error(ContextHandle context) noexcept override { return call(actions_.on_error, context); }
    Status on_reset(ContextHandle context) noexcept override { return call(actions_.on_reset, context); }
    Status on_execute(ContextHandle context) noexcept override { return call(actions_.on_execute, context); }
    Status on_state_update(ContextHandle context) noexcept override {
        return call(actions_.on_state_update, context);
    }
    Status on_rate_changed(ContextHandle context) noexcept override {
        return call(actions_.on_rate_changed, context);
    }

  protected:
    /// @param[in] name    as for Component. @param[in] actions must outlive this object.
    /// @param[in] self    struct of the component, passed to each action; usually a member of this object.
    constexpr CComponent(const char* name, const MamoriActions& actions, void* self) noexcept
        : Component(name), actions_(actions), self_(self) {}
    CComponent(const char* name, const MamoriActions&& actions, void* self) = delete;
    ~CComponent() = default;

  private:
    Status call(MamoriLifeAction action) const noexcept {
        return action == nullptr ? Status::kOk : detail::to_status(action(self_));
    }
    Status call(MamoriAction action, ContextHandle context) const noexcept {
        return action == nullptr ? Status::kOk
                                 : detail::to_status(action(self_, {context.id, context.now.ns}));
    }

    const MamoriActions& actions_;
    void* self_;
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_C_COMPONENT_HPP
