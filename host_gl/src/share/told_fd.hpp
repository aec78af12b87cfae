// SPDX-License-Identifier: MIT
// A descriptor of which the ledger hears.
#pragma once

#include <utility>

#include "sluice/fd.hpp"
#include "sluice/ledger/share_feed.hpp"

namespace sluice::host {

/// Owns one descriptor, as UniqueFd does, and tells `feed` (nullptr: nobody) that it is there and how it went.
class ToldFd {
  public:
    ToldFd(UniqueFd fd, ledger::ShareFeed* feed) : fd_(std::move(fd)), feed_(feed) {
        if (feed_ != nullptr && fd_.valid()) {
            feed_->opened(fd_.get());
        }
    }
    ToldFd(const ToldFd&) = delete;
    ToldFd& operator=(const ToldFd&) = delete;
    ~ToldFd() {
        if (feed_ != nullptr && fd_.valid()) {
            feed_->closed(fd_.get());
        }
    }

    [[nodiscard]] int get() const { return fd_.get(); }
    [[nodiscard]] bool valid() const { return fd_.valid(); }
    /// OpenGL has it now.
    void given() {
        if (feed_ != nullptr) {
            feed_->given(fd_.get());
        }
        static_cast<void>(fd_.release());
    }
    /// What took it has closed it, and told so.
    void closedElsewhere() { static_cast<void>(fd_.release()); }
    /// A call that failed may have closed it or not: told as closed, and the caller sees to it that it is.
    [[nodiscard]] int gone() {
        if (feed_ != nullptr) {
            feed_->closed(fd_.get());
        }
        return fd_.release();
    }

  private:
    UniqueFd fd_;
    ledger::ShareFeed* feed_;
};

}  // namespace sluice::host
