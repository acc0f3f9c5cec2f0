// SPDX-License-Identifier: Apache-2.0
/// @file
/// A component that records each action it is called with, and answers as a test tells it to.
#ifndef MAMORI_KERNEL_TESTS_SPY_COMPONENT_HPP
#define MAMORI_KERNEL_TESTS_SPY_COMPONENT_HPP

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mamori/kernel/component/component.hpp"

namespace mamori::testing_support {

using Calls = std::vector<std::string>;

/// Records "<name>.<action>" into a list that several spies may share, and the handle of each call.
/// `Base` is Component or a kind of it.
template <typename Base>
class SpyActions : public Base {
  public:
    /// @param[in] arguments those of the base's constructor.
    template <typename... Arguments>
    explicit SpyActions(Calls& calls, const Arguments&... arguments) : Base(arguments...), calls_(calls) {}

    /// Answers of actions by name; kOk for those that are not named.
    std::map<std::string, Status> answers;
    /// Called from within each action, after it was recorded.
    std::function<void(const std::string& action)> inside;
    std::vector<ContextHandle> handles;

    Status on_initialize() noexcept override { return record("on_initialize"); }
    Status on_finalize() noexcept override { return record("on_finalize"); }
    Status on_startup(ContextHandle h) noexcept override { return record("on_startup", h); }
    Status on_shutdown(ContextHandle h) noexcept override { return record("on_shutdown", h); }
    Status on_activated(ContextHandle h) noexcept override { return record("on_activated", h); }
    Status on_deactivated(ContextHandle h) noexcept override { return record("on_deactivated", h); }
    Status on_aborting(ContextHandle h) noexcept override { return record("on_aborting", h); }
    Status on_error(ContextHandle h) noexcept override { return record("on_error", h); }
    Status on_reset(ContextHandle h) noexcept override { return record("on_reset", h); }
    Status on_execute(ContextHandle h) noexcept override { return record("on_execute", h); }
    Status on_state_update(ContextHandle h) noexcept override { return record("on_state_update", h); }
    Status on_rate_changed(ContextHandle h) noexcept override { return record("on_rate_changed", h); }
    Status on_action(ContextHandle h) noexcept override { return record("on_action", h); }
    Status on_mode_changed(ContextHandle h) noexcept override { return record("on_mode_changed", h); }

  protected:
    ~SpyActions() = default;

  private:
    Status record(const std::string& action) {
        calls_.push_back(std::string(this->get_name()) + "." + action);
        if (inside) {
            inside(action);
        }
        const auto answer = answers.find(action);
        return answer == answers.end() ? Status::kOk : answer->second;
    }
    Status record(const std::string& action, ContextHandle handle) {
        handles.push_back(handle);
        return record(action);
    }

    Calls& calls_;
};

class SpyComponent final : public SpyActions<Component> {
  public:
    SpyComponent(const char* name, Calls& calls) : SpyActions(calls, name) {}
};

/// Takes the calls recorded so far out of the list.
inline Calls take(Calls& calls) {
    return std::exchange(calls, {});
}

}  // namespace mamori::testing_support

#endif  // MAMORI_KERNEL_TESTS_SPY_COMPONENT_HPP
