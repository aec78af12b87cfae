// SPDX-License-Identifier: MIT
// What the renderer's process does about each message of its host.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "isolate/carriers.hpp"
#include "isolate/host_end.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/shared_timeline.hpp"

namespace sluice::isolate {

/// The answer to a call that returned `result`, with what it filled in.
template <typename T>
Returned said(SluiceResult result, const SluiceError& error, const T& filled) {
    Returned answer;
    answer.result = result;
    answer.message.assign(&error.message[0], strnlen(&error.message[0], sizeof(error.message)));
    answer.filled = filled;
    return answer;
}
inline Returned said(SluiceResult result, const SluiceError& error) {
    return said(result, error, std::monostate{});
}

/// One host's calls, one after the other, until its channel ends.
class Server {
  public:
    Server(const SluiceRendererApi& api, const Channel& channel) : api_(api), channel_(channel), host_(channel) {}
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() { destroyRenderer(); }

    [[nodiscard]] Status run();

  private:
    // ---- calls of the host
    Message handle(const Hello& hello, UniqueFd& with);
    Message handle(const Describe& call, UniqueFd& with);
    Message handle(const Explain& call, UniqueFd& with);
    Message handle(const Create& call, UniqueFd& with);
    Message handle(const Info& call, UniqueFd& with);
    Message handle(const Resize& call, UniqueFd& with);
    Message handle(const SetParticles& call, UniqueFd& with);
    Message handle(const SetEnvironment& call, UniqueFd& with);
    Message handle(const SetSimulation& call, UniqueFd& with);
    Message handle(const Simulate& call, UniqueFd& with);
    Message handle(const SimulationStats& call, UniqueFd& with);
    Message handle(const SimulationBodies& call, UniqueFd& with);
    Message handle(const SetBody& call, UniqueFd& with);
    Message handle(const SetFlow& call, UniqueFd& with);
    Message handle(const ResetSimulation& call, UniqueFd& with);
    Message handle(const SubmitFrame& call, UniqueFd& with);
    Message handle(const Poll& call, UniqueFd& with);
    Message handle(const TimelineValue& call, UniqueFd& with);
    Message handle(const TimelineExport& call, UniqueFd& with);
    Message handle(const ProbeFormat& call, UniqueFd& with);
    Message handle(const Destroy& call, UniqueFd& with);
    /// What only this side says.
    template <typename T>
    Message handle(const T& /*call*/, UniqueFd& /*with*/) {
        breach_ = breachOfHost("it sent a " + std::string(T::kName) + " where a call was expected");
        return Answer{};
    }

    /// Whether the plugin's table goes that far (ABI 1.1).
    [[nodiscard]] bool simulates(SluiceError& error) const;
    /// Likewise ABI 1.2.
    [[nodiscard]] bool moves(SluiceError& error) const;
    void destroyRenderer();

    const SluiceRendererApi& api_;
    const Channel& channel_;
    HostEnd host_;
    Hello hello_;
    std::unique_ptr<SharedTimeline> timeline_;
    SluiceHostServices services_{};
    SluiceRenderer* renderer_ = nullptr;
    std::optional<Carriers> carriers_;
    bool host_value_matters_ = true;
    std::optional<Promise> accepted_;  ///< a frame whose value is told after submit_frame has returned
    std::uint64_t call_ = 0;
    std::vector<UniqueFd> fds_;  ///< that came with it
    std::optional<Error> breach_;
};

}  // namespace sluice::isolate
