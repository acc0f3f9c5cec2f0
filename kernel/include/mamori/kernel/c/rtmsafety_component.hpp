// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a component with the C interface of RTMSafety: a create function that stores ten callbacks without
/// argument. The component and its headers stay unchanged; this header needs none of them.
///
///     extern "C" {
///     #include "SPEED.h"
///     }
///     class Speed final : public mamori::RtmSafetyComponent<&SPEED_create> {
///       public:
///         constexpr Speed() noexcept : RtmSafetyComponent("speed") {}
///     };
///
/// @satisfies SWR-CIF-010, SWR-CIF-011      Design: docs/design/kernel.md#components-in-c
/// Source:   public code generator of RTMSafety (OpenRTP-aist, branch svn/work_ForRTMSafety)
#ifndef MAMORI_KERNEL_RTMSAFETY_COMPONENT_HPP
#define MAMORI_KERNEL_RTMSAFETY_COMPONENT_HPP

#include "mamori/kernel/base/status.hpp"
#include "mamori/kernel/c/c_component.hpp"
#include "mamori/kernel/component/component.hpp"

namespace mamori {

/// @tparam kCreate the create function, `ReturnCode_t Name_create(Name_t* pself)`.
template <auto kCreate, typename Function = decltype(kCreate)>
class RtmSafetyComponent {
    static_assert(sizeof(Function) == 0U, "a create function is ReturnCode_t Name_create(Name_t* pself)");
};

/// Calls the callbacks. A callback that the create function does not store is an action that succeeds. The
/// callbacks receive no argument and their data are global: one object at a time is alive. on_state_update
/// and on_rate_changed have no callback.
///
/// Thread safety: as Component. Time: O(1) plus the callback. Memory: one Object, no heap.
/// @tparam Code return codes with the numbers of OMG RTC. @tparam Object struct with the ten members.
template <auto kCreate, typename Code, typename Object>
class RtmSafetyComponent<kCreate, Code (*)(Object*)> : public Component {
    static_assert(kCreate != nullptr, "a create function is not null");

  public:
    /// Calls the create function, then onInitialize.
    /// @return the first code that is not kOk; kPreconditionNotMet if another object is alive; otherwise kOk.
    Status on_initialize() noexcept override {
        if (owner != nullptr && owner != this) {
            return Status::kPreconditionNotMet;
        }
        object_ = Object{};
        Status result = detail::to_status(kCreate(&object_));
        if (result == Status::kOk) {
            result = call(object_.onInitialize);
        } else {
            object_ = Object{};
        }
        owner = result == Status::kOk ? this : nullptr;
        return result;
    }
    Status on_finalize() noexcept override {
        owner = nullptr;
        return call(object_.onFinalize);
    }
    Status on_startup(ContextHandle) noexcept override { return call(object_.onStartup); }
    Status on_shutdown(ContextHandle) noexcept override { return call(object_.onShutdown); }
    Status on_activated(ContextHandle) noexcept override { return call(object_.onActivated); }
    Status on_deactivated(ContextHandle) noexcept override { return call(object_.onDeactivated); }
    Status on_aborting(ContextHandle) noexcept override { return call(object_.onAborting); }
    Status on_error(ContextHandle) noexcept override { return call(object_.onError); }
    Status on_reset(ContextHandle) noexcept override { return call(object_.onReset); }
    Status on_execute(ContextHandle) noexcept override { return call(object_.onExecute); }

  protected:
    /// @param[in] name as for Component.
    constexpr explicit RtmSafetyComponent(const char* name) noexcept : Component(name) {}
    ~RtmSafetyComponent() = default;

  private:
    static Status call(Code (*callback)()) noexcept {
        return callback == nullptr ? Status::kOk : detail::to_status(callback());
    }

    inline static const RtmSafetyComponent* owner{nullptr};  // of the global data of the component in C
    Object object_{};
};

}  // namespace mamori

#endif  // MAMORI_KERNEL_RTMSAFETY_COMPONENT_HPP
