// SPDX-License-Identifier: MIT
// A log in memory, its ids resolved: what the reports and the drawings of a log are computed from. 64 bytes an event.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sluice/ledger/log.hpp"
#include "sluice/ledger/object_use.hpp"

namespace sluice::ledger {

inline constexpr std::uint32_t kNone = 0xFFFFFFFF;

struct RecordedActor {
    ActorKind kind{};
    std::string name;
};
struct RecordedSync {
    SyncKind kind{};
    std::string name;
    std::uint64_t initial = 0;
};
struct RecordedResource {
    std::string name;
};

/// An event with indices into the Recording in the place of ids, which a log may use again for new objects.
struct RecordedEvent {
    Event event;
    std::uint32_t actor = kNone;   ///< into actors
    std::uint32_t object = kNone;  ///< into syncs, resources or (Submit) actors by the event's kind; descriptors: kNone
    /// Event::frame; where that is 0, of the actor's last Frame event; where there was none, of its last submission.
    std::uint32_t frame = 0;
};

struct Recording {
    std::vector<RecordedActor> actors;
    std::vector<RecordedSync> syncs;
    std::vector<RecordedResource> resources;
    std::vector<RecordedEvent> events;  ///< in the log's order; Event::sequence is the index
    LogSummary summary;
};

/// Gathers a Recording from declarations and events as they come. What was never declared is named as the Ledger names
/// it: "actor 3", "sync 5", "resource 0".
class Recorder {
  public:
    Recorder();
    Recorder(Recorder&&) noexcept;
    Recorder& operator=(Recorder&&) noexcept;
    ~Recorder();
    /// Writes into this object, which has to outlive it.
    [[nodiscard]] LogSink sink();
    [[nodiscard]] Recording take(const LogSummary& summary);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// A whole log; the errors are readLog's.
[[nodiscard]] Result<Recording> loadRecording(const std::string& path);

}  // namespace sluice::ledger
