// SPDX-License-Identifier: MIT
// The other process as this one sees it: started, asked one thing at a time, and its end noticed whatever anybody waits
// for.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "isolate/child.hpp"
#include "sluice/fd.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "sluice/result.hpp"
#include "stress/process/messages.hpp"

namespace sluice::stress {

/// start and call on one thread, the rest on any. Whoever lets go of it has ended and reaped the process.
class VulkanProcess {
  public:
    VulkanProcess() = default;
    VulkanProcess(const VulkanProcess&) = delete;
    VulkanProcess& operator=(const VulkanProcess&) = delete;
    ~VulkanProcess();
    [[nodiscard]] Status start();

    struct Reply {
        Answer answer;
        std::vector<UniqueFd> fds;
    };
    /// `doing` is what is said if the process ends meanwhile; `fds_back`: how many descriptors the answer must bring.
    [[nodiscard]] Result<Reply> call(const Request& request, std::span<const int> fds, std::size_t fds_back,
                                     const std::string& doing);

    /// Its end will end every wait for these, and for no others any more. Its end, if it has come already.
    [[nodiscard]] std::optional<Error> endsWaitsFor(std::vector<isolate::SharedTimeline*> timelines);
    [[nodiscard]] std::optional<Error> ended();
    [[nodiscard]] std::string name() const;

  private:
    void watch();
    /// Kills it, for what only this process knows.
    void condemn(std::string blame);
    /// Blocks until the end is known.
    [[nodiscard]] Error gone();

    host::Child child_;
    isolate::Channel channel_;
    std::mutex mutex_;  ///< of what follows
    std::condition_variable ended_;
    std::vector<isolate::SharedTimeline*> waited_for_;
    std::string doing_ = "its start";
    std::string blame_;
    std::optional<Error> end_;
    std::thread watcher_;
};

}  // namespace sluice::stress
