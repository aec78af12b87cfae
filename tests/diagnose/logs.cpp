// SPDX-License-Identifier: MIT
#include "logs.hpp"

#include <gtest/gtest.h>

#include "log_bytes.hpp"

namespace sluice::test {

using ledger::EventKind;

void writeEngineLog(const std::string& path, std::uint32_t frames, Seeded seeded) {
    auto created = ledger::LogWriter::create(path);
    ASSERT_TRUE(created.ok()) << created.error().message();
    ledger::LogWriter& log = *created.value();
    constexpr ledger::ActorId kThread = 0, kGl = 1, kQueue = 2;
    constexpr ledger::ObjectId kReady = 0, kDone = 1;
    log.declareActor(kThread, ledger::ActorKind::HostThread, "engine thread");
    log.declareActor(kGl, ledger::ActorKind::GlContext, "gl </script><b>bold</b>");
    log.declareActor(kQueue, ledger::ActorKind::VulkanQueue, "queue");
    log.declareSync(kReady, ledger::SyncKind::Timeline, "ready", 0, 0);
    log.declareSync(kDone, ledger::SyncKind::Timeline, "done", 0, 0);
    log.declareResource(0, "colour", 1, ledger::kNoActor);
    for (std::uint32_t k = 1; k <= frames; ++k) {
        const std::uint64_t us = 1000, t = 1000 * us * k;
        for (const ledger::ActorId actor : {kThread, kGl, kQueue}) {
            log.record(event(EventKind::Frame, actor, 0, k, t));
        }
        log.record(event(EventKind::Submit, kThread, kGl, k, t + 10 * us));
        log.record(event(EventKind::Write, kGl, 0, k, t + 20 * us, 200 * us));
        if (seeded != Seeded::DeadWait) {
            log.record(event(EventKind::Signal, kGl, kReady, k, t + 230 * us));
        }
        log.record(event(EventKind::Submit, kThread, kQueue, k, t + 240 * us));
        if (seeded != Seeded::MissingWait) {
            log.record(event(EventKind::Wait, kQueue, kReady, k, t + 245 * us));
        }
        log.record(event(EventKind::Read, kQueue, 0, k, t + 250 * us, 300 * us));
        log.record(event(EventKind::Signal, kQueue, kDone, k, t + 560 * us));
        if (seeded == Seeded::DeadWait) {
            log.record(event(EventKind::ActorEnd, kGl, 0, 0, t + 300 * us));
            return;
        }
        log.record(event(EventKind::WaitBegin, kThread, kDone, k, t + 450 * us));
        log.record(event(EventKind::Wait, kThread, kDone, k, t + 450 * us, 150 * us));
    }
}

}  // namespace sluice::test
