// SPDX-License-Identifier: MIT
// Whose session is whose. A context is current on one thread at most, so its session is touched by one thread at a
// time: the one that has claimed it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "payload/session.hpp"

namespace sluice::inject {

/// All sessions of a process; none is ever destroyed. Any thread.
class Sessions {
  public:
    /// The live one of a context that is current on this thread, which has it from now on; NULL if there is none.
    Session* claim(const CurrentContext& current);
    /// A new one, claimed.
    Session& add(std::unique_ptr<Session> made);
    /// This thread has no more to do with it. True: its context was destroyed meanwhile, and nobody else can reach it
    /// any more, so that this thread is to end it.
    [[nodiscard]] bool release(Session& session);
    /// Of contexts that are, or have been, destroyed. Those that are returned are nobody's, to be ended by this thread;
    /// of the others the context lives as long as it is current on another thread, which then ends them (release).
    [[nodiscard]] std::vector<Session*> retire(const std::function<bool(const CurrentContext&)>& destroyed);
    /// Each, those that have ended, too. One that is not `free` is another thread's: it is not to be asked anything.
    void visit(const std::function<void(Session&, bool free)>& what);

  private:
    struct Entry {
        std::unique_ptr<Session> session;
        bool doomed = false;  ///< its context was destroyed while it was current on another thread
    };

    std::mutex mutex_;
    std::vector<Entry> entries_;
};

}  // namespace sluice::inject
