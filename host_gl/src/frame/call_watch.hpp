// SPDX-License-Identifier: MIT
// Says when a call into the renderer does not come back.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string_view>
#include <thread>

#include "sluice/host_gl/isolation.hpp"
#include "sluice/plugin.h"

namespace sluice::host {

/// A thread that looks at the call that the GL thread is in. It can end nothing: a thread that is inside a plugin of
/// its own process cannot be taken out of it. It logs, once for each such call.
class CallWatch {
  public:
    using Log = std::function<void(SluiceLogLevel, std::string_view)>;

    /// A call is late after `patience_ns`; 0: nothing is watched and there is no thread. `log` is called on that
    /// thread. `limits`: after how long somebody else ends a call.
    CallWatch(std::uint64_t patience_ns, Log log, CallLimits limits = {});
    CallWatch(const CallWatch&) = delete;
    CallWatch& operator=(const CallWatch&) = delete;
    ~CallWatch();

    /// The GL thread is in `call` for as long as the object lives. One at a time.
    class Scope {
      public:
        Scope(CallWatch& watch, const char* call, std::uint64_t frame, std::uint64_t more_ns);
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;
        ~Scope();

      private:
        CallWatch& watch_;
    };
    /// `call` is a literal. `more_ns`: time that the call may take by its contract, on top of the patience.
    [[nodiscard]] Scope during(const char* call, std::uint64_t frame, std::uint64_t more_ns = 0) {
        return {*this, call, frame, more_ns};
    }

  private:
    void run();

    std::uint64_t patience_ns_;
    Log log_;
    CallLimits limits_;
    std::mutex mutex_;  // guards all below
    std::condition_variable wake_;
    bool stop_ = false;
    const char* call_ = nullptr;  ///< nullptr: in none, or in one that has been told
    std::uint64_t frame_ = 0;
    std::uint64_t begin_ns_ = 0;
    std::uint64_t late_ns_ = 0;
    std::thread thread_;
};

}  // namespace sluice::host
