// SPDX-License-Identifier: MIT
#include "random_program.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace sluice::ledger::test {
namespace {

const std::vector<ActorKind> kCast = {ActorKind::GlContext,    ActorKind::VulkanQueue, ActorKind::HostThread,
                                      ActorKind::BridgeThread, ActorKind::VulkanQueue, ActorKind::Process};

bool isThread(ActorKind kind) {
    return kind == ActorKind::HostThread || kind == ActorKind::BridgeThread;
}

/// Appends events in an order in which they can really happen, and hands over wherever the next access needs it.
class Builder {
  public:
    Builder(Choices& choices, bool simple) : choices_(choices), simple_(simple), execution_(start()) {}

    Program build() {
        while (!choices_.empty() && size_ + 40 < kMaxNodes) {
            step();
        }
        return std::move(program_);
    }

  private:
    const Program& start() {
        program_.actors = kCast;
        program_.ops.resize(kCast.size());
        batch_.resize(kCast.size(), 0);
        // Two timelines of each actor's own: a plain one and one with lists.
        for (std::size_t i = 0; i < 2 * kCast.size(); ++i) {
            program_.syncs.push_back({SyncKind::Timeline, i >= kCast.size()});
        }
        value_.resize(program_.syncs.size(), 0);
        last_signal_.resize(program_.syncs.size(), -1);
        return program_;
    }

    ActorId anyActor() { return static_cast<ActorId>(choices_.below(static_cast<std::uint32_t>(kCast.size()))); }

    void emit(ActorId actor, EventKind kind, ObjectId object, std::uint64_t value = 0, std::uint16_t aux = 0) {
        Op op;
        op.event.kind = kind;
        op.event.actor = actor;
        op.event.object = object;
        op.event.value = value;
        op.event.aux = aux;
        op.batch = kind == EventKind::Submit ? ++batch_[object] : batch_[actor];
        if (!execution_.run(actor, op)) {
            throw std::logic_error("the generator made an event that cannot happen");
        }
        program_.ops[actor].push_back(op);
        ++size_;
    }

    void step() {
        const ActorId actor = anyActor();
        switch (choices_.below(10)) {
            case 0:
                return submit(actor, anyActor());
            case 1:
                if (choices_.below(2) == 0) {
                    nameSome(actor, choices_.below(1U << kResources));
                    return raise(actor, static_cast<ObjectId>(kCast.size() + actor));
                }
                if (last_signal_[actor] < 0 || execution_.before(last_signal_[actor], actor)) {
                    raise(actor, actor);
                }
                return;
            case 2: {
                // Any value that was reached, so old ones too.
                const auto sync = choices_.below(static_cast<std::uint32_t>(2 * kCast.size()));
                const auto reached = static_cast<std::uint32_t>(value_[sync]);
                if (sync >= kCast.size()) {
                    nameSome(actor, choices_.below(1U << kResources));
                }
                return emit(actor, EventKind::Wait, sync, reached == 0 ? 0 : choices_.below(reached + 1));
            }
            case 3:
                return access(actor, EventKind::Layout);
            case 4:
            case 5:
            case 6:
                return access(actor, EventKind::Write);
            default:
                return access(actor, EventKind::Read);
        }
    }

    void submit(ActorId thread, ActorId stream) {
        if (isThread(kCast[thread]) && !isThread(kCast[stream]) && kCast[stream] != ActorKind::Process) {
            emit(thread, EventKind::Submit, stream);
        }
    }

    void access(ActorId actor, EventKind kind) {
        const ObjectId r = choices_.below(kResources);
        const ActorId owner = owner_[r];
        const bool transfer = owner != kNoActor && owner != actor;
        const bool acquires = transfer || (owner == kNoActor && choices_.below(8) == 0);
        std::uint64_t pair = 0;
        if (transfer) {
            pair = layouts(r);
            emit(owner, EventKind::Release, r, pair, choices_.below(2) == 0 ? actor : kNoActor);
        }
        const Execution::Access* write = nullptr;
        for (const auto& earlier : execution_.accesses[r]) {
            const bool conflict = acquires || kind != EventKind::Read || earlier.event.kind != EventKind::Read;
            if (conflict && earlier.actor != actor && !execution_.before(earlier.node, actor)) {
                handOff(earlier.actor, actor, r);
            }
            write = earlier.event.kind != EventKind::Read ? &earlier : write;
        }
        if (write != nullptr && write->actor != actor && !execution_.visible(write->node, actor, r)) {
            plainHandOff(write->actor, actor);
        }
        if (acquires) {
            // Vulkan's second half of a transfer repeats the pair, others start from what the first half left.
            const bool repeat = transfer && choices_.below(2) == 0;
            emit(actor, EventKind::Acquire, r, repeat ? pair : layouts(r), transfer ? owner : kNoActor);
            owner_[r] = actor;
        }
        switch (kind) {
            case EventKind::Write:
                return emit(actor, kind, r, ++version_[r]);
            case EventKind::Layout:
                return emit(actor, kind, r, layouts(r));
            default:
                emit(actor, kind, r, choices_.below(2) == 0 ? version_[r] : 0);
                if (choices_.below(3) == 0) {
                    emit(actor, EventKind::Witness, r, version_[r], static_cast<std::uint16_t>(Verdict::Fresh));
                }
        }
    }

    std::uint64_t layouts(ObjectId resource) {
        const std::uint32_t next = 1 + choices_.below(3);
        return std::uint64_t{next} << 32U | std::exchange(layout_[resource], next);
    }

    void raise(ActorId actor, ObjectId timeline) {
        emit(actor, EventKind::Signal, timeline, value_[timeline] += 1 + choices_.below(3));
        last_signal_[timeline] = execution_.last(actor);
    }

    void plainHandOff(ActorId from, ActorId to) {
        // A timeline may change hands where its last signal is known to have happened.
        ObjectId sync = from;
        if (!simple_) {
            const ActorId other = anyActor();
            sync = last_signal_[other] < 0 || execution_.before(last_signal_[other], from) ? other : from;
            if (last_signal_[sync] >= 0 && !execution_.before(last_signal_[sync], from)) {
                return fence(from, to);
            }
        }
        const std::uint64_t old = value_[sync];
        raise(from, sync);
        emit(to, EventKind::Wait, sync, old + 1 + choices_.below(static_cast<std::uint32_t>(value_[sync] - old)));
    }

    void fence(ActorId from, ActorId to) {
        program_.syncs.push_back({SyncKind::Fence, false});
        const auto sync = static_cast<ObjectId>(program_.syncs.size() - 1);
        emit(from, EventKind::Signal, sync);
        if (isThread(kCast[to])) {
            emit(to, EventKind::WaitBegin, sync);
        }
        emit(to, EventKind::Wait, sync);
    }

    void binary(ActorId from, ActorId to) {
        auto& [sync, waited] = binaries_.try_emplace({from, to}, 0U, -1).first->second;
        if (simple_ || waited < 0 || !execution_.before(waited, from)) {
            program_.syncs.push_back({SyncKind::Binary, false});
            sync = static_cast<ObjectId>(program_.syncs.size() - 1);
        }
        emit(from, EventKind::Signal, sync);
        emit(to, EventKind::Wait, sync);
        waited = execution_.last(to);
    }

    void nameSome(ActorId actor, std::uint32_t mask) {
        for (ObjectId r = 0; r < kResources; ++r) {
            if ((mask >> r & 1U) != 0) {
                emit(actor, EventKind::Names, r);
            }
        }
    }

    void listed(ActorId from, ActorId to, ObjectId resource) {
        const auto sync = static_cast<ObjectId>(kCast.size() + from);
        for (const ActorId side : {from, to}) {
            nameSome(side, choices_.below(1U << kResources) | 1U << resource);
            if (side == from) {
                raise(side, sync);
            } else {
                emit(side, EventKind::Wait, sync, value_[sync]);
            }
        }
    }

    void handOff(ActorId from, ActorId to, ObjectId resource) {
        switch (choices_.below(5)) {
            case 0:
                return fence(from, to);
            case 1:
                return binary(from, to);
            case 2:
                return listed(from, to, resource);
            case 3:
                if (isThread(kCast[from]) && !isThread(kCast[to]) && kCast[to] != ActorKind::Process) {
                    return submit(from, to);
                }
                [[fallthrough]];
            default:
                return plainHandOff(from, to);
        }
    }

    Choices& choices_;
    bool simple_;
    Program program_;
    std::vector<std::uint32_t> batch_;
    std::vector<std::uint64_t> value_;
    std::vector<int> last_signal_;
    std::map<std::pair<ActorId, ActorId>, std::pair<ObjectId, int>> binaries_;
    std::array<std::uint64_t, kResources> version_{};
    std::array<std::uint32_t, kResources> layout_{};
    std::array<ActorId, kResources> owner_{kNoActor, kNoActor, kNoActor, kNoActor};
    std::size_t size_ = 0;
    Execution execution_;
};

}  // namespace

Program wellOrdered(Choices& choices, bool simple) {
    return Builder(choices, simple).build();
}

}  // namespace sluice::ledger::test
