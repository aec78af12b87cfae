// SPDX-License-Identifier: MIT
// The two counters of a hand-off in memory that two processes share.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::isolate {

enum class WaitEnd : std::uint8_t {
    Reached,
    Timeout,
    PeerDead,  ///< the counter will never move again
    Failed,    ///< the renderer's side has given up; failure() says with which code
    Broken     ///< the counter went back or leapt: whoever writes it breaks the protocol
};

/// One 64-bit word per direction, each with a futex word that moves when it does. A waiter never depends on the other
/// process to be woken: peerDied() of its own process wakes it, and it looks for itself several times a second.
/// Any thread of either process.
class SharedTimeline {
  public:
    /// Makes the memory; fd() is what the other process adopts.
    [[nodiscard]] static Result<std::unique_ptr<SharedTimeline>> create();
    /// Refuses memory of another size, or that the other side could still resize.
    [[nodiscard]] static Result<std::unique_ptr<SharedTimeline>> adopt(UniqueFd fd);
    SharedTimeline(const SharedTimeline&) = delete;
    SharedTimeline& operator=(const SharedTimeline&) = delete;
    ~SharedTimeline() = default;

    [[nodiscard]] int fd() const { return fd_.get(); }
    /// Raises a counter that this process writes. SLUICE_ERROR_INVALID_ARGUMENT unless it increases.
    [[nodiscard]] Status publish(SluiceDirection direction, std::uint64_t value);
    /// The counter as it stands, whoever wrote it.
    [[nodiscard]] std::uint64_t value(SluiceDirection direction) const;
    /// Blocks until the counter has reached `value`. What was reached before the peer died stays reached.
    [[nodiscard]] WaitEnd wait(SluiceDirection direction, std::uint64_t value, std::uint64_t timeout_ns);
    /// Wakes everyone who waits in this process or the other, to look again.
    void wake();

    /// The renderer's counter will not move again because of `code`; the other process learns of it.
    void fail(SluiceResult code);
    [[nodiscard]] SluiceResult failure() const;
    /// The other process is gone. Known to this process alone: nothing that the other one writes says so.
    void peerDied();
    [[nodiscard]] bool peerDead() const { return dead_; }

  private:
    struct Word {
        std::atomic<std::uint64_t> value;
        std::atomic<std::uint32_t> sequence;
        std::uint32_t padding[13];  ///< a cache line each
    };
    struct Page {
        std::array<Word, 2> words;
        std::atomic<std::int32_t> failure;
    };
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

    SharedTimeline(UniqueFd fd, Mapping mapping);
    [[nodiscard]] Word& word(SluiceDirection direction) const { return page_->words.at(direction); }
    /// False: the word is not what a counter can be after what was seen of it.
    [[nodiscard]] bool look(SluiceDirection direction, std::uint64_t& value);

    UniqueFd fd_;
    Mapping mapping_;
    Page* page_;
    std::atomic<bool> dead_{false};
    std::mutex mutex_;                        ///< of what follows
    std::array<std::uint64_t, 2> highest_{};  ///< seen or written so far
};

}  // namespace sluice::isolate
