// SPDX-License-Identifier: MIT
#include "sluice/ledger/recording.hpp"

#include <unordered_map>

namespace sluice::ledger {

struct Recorder::State {
    Recording recording;
    std::unordered_map<std::uint32_t, std::uint32_t> actors, syncs, resources;  ///< the index that an id has now
    struct Frames {
        bool own = false;  ///< the actor has said Frame itself
        std::uint32_t frame = 0;
    };
    std::vector<Frames> frames;  ///< by index of actor

    std::uint32_t declareActor(std::uint32_t id, ActorKind kind, std::string_view name) {
        const auto index = static_cast<std::uint32_t>(recording.actors.size());
        recording.actors.push_back({kind, std::string(name)});
        frames.emplace_back();
        return actors[id] = index;
    }
    std::uint32_t declareSync(std::uint32_t id, SyncKind kind, std::string_view name, std::uint64_t initial) {
        const auto index = static_cast<std::uint32_t>(recording.syncs.size());
        recording.syncs.push_back({kind, std::string(name), initial});
        return syncs[id] = index;
    }
    std::uint32_t declareResource(std::uint32_t id, std::string_view name) {
        const auto index = static_cast<std::uint32_t>(recording.resources.size());
        recording.resources.push_back({std::string(name)});
        return resources[id] = index;
    }
    std::uint32_t actor(std::uint32_t id) {
        const auto found = actors.find(id);
        return found != actors.end() ? found->second
                                     : declareActor(id, ActorKind::HostThread, "actor " + std::to_string(id));
    }
    std::uint32_t object(const Event& event) {
        switch (objectUse(event)) {
            case ObjectUse::Actor:
                return actor(event.object);
            case ObjectUse::Sync: {
                const auto found = syncs.find(event.object);
                return found != syncs.end()
                           ? found->second
                           : declareSync(event.object, SyncKind::Timeline, "sync " + std::to_string(event.object), 0);
            }
            case ObjectUse::Resource: {
                const auto found = resources.find(event.object);
                return found != resources.end()
                           ? found->second
                           : declareResource(event.object, "resource " + std::to_string(event.object));
            }
            case ObjectUse::None:
                break;
        }
        return kNone;
    }
    void record(const Event& event) {
        RecordedEvent recorded{event, actor(event.actor), kNone, 0};
        recorded.event.sequence = recording.events.size();
        recorded.object = object(event);
        if (event.kind == EventKind::Frame) {
            frames[recorded.actor] = {true, static_cast<std::uint32_t>(event.value)};
        }
        recorded.frame = event.frame != 0 ? event.frame : frames[recorded.actor].frame;
        if (event.kind == EventKind::Submit && !frames[recorded.object].own) {
            frames[recorded.object].frame = recorded.frame;
        }
        recording.events.push_back(recorded);
    }
};

Recorder::Recorder() : state_(std::make_unique<State>()) {}
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;
Recorder::~Recorder() = default;

LogSink Recorder::sink() {
    State* state = state_.get();
    LogSink sink;
    sink.actor = [state](ActorId id, ActorKind kind, std::string_view name) { state->declareActor(id, kind, name); };
    sink.sync = [state](ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial, std::uint16_t) {
        state->declareSync(id, kind, name, initial);
    };
    sink.resource = [state](ObjectId id, std::string_view name, std::uint32_t, ActorId) {
        state->declareResource(id, name);
    };
    sink.event = [state](const Event& event) { state->record(event); };
    return sink;
}

Recording Recorder::take(const LogSummary& summary) {
    state_->recording.summary = summary;
    Recording taken = std::move(state_->recording);
    *state_ = State{};
    return taken;
}

Result<Recording> loadRecording(const std::string& path) {
    Recorder recorder;
    const Result<LogSummary> summary = readLog(path, recorder.sink());
    if (!summary) {
        return summary.error();
    }
    return recorder.take(summary.value());
}

}  // namespace sluice::ledger
