// SPDX-License-Identifier: MIT
#include "ledger_rig.hpp"

#include "sluice/ledger/hand_off_feed.hpp"
#include "sluice/timeline.hpp"

namespace sluice::host::test {

void LedgerTest::start(SluiceTimelineKind kind, std::uint32_t sets, const std::optional<FaultPlan>& fault,
                       std::unique_ptr<ledger::LogWriter> log) {
    host_.reset();
    ledger_ = std::make_unique<ledger::LiveLedger>(ledger::LedgerOptions{}, std::move(log));
    FluidHostConfig wanted = config();
    wanted.timeline = kind;
    wanted.image_sets = sets;
    wanted.wait_timeout_ns = wait_timeout_ns_;
    wanted.ledger = ledger_.get();
    wanted.fault = fault;
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
}

void LedgerTest::frames(std::uint64_t count, int layers) {
    FrameInput input = echoInput();
    input.flags = flags_;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t stamp = host_->frame() + without_fluid_ + 1;
        drawStamp(*screen_, stamp, layers);
        Status status = host_->submit(*screen_, input);
        const std::uint64_t frame = host_->frame();
        if (status) {
            status = host_->composite(*screen_);
        }
        if (!status) {
            ++without_fluid_;
            failures_.push_back(status.error().message());
            continue;
        }
        const sluice::host::test::Verdict seen = inspect(*host_, stamp);
        const bool whole = seen.stale == seen.texels;
        const auto verdict = seen.clean() ? ledger::Verdict::Fresh
                             : whole      ? ledger::Verdict::Stale
                                          : ledger::Verdict::Torn;
        (verdict == ledger::Verdict::Fresh ? fresh_ : whole ? stale_ : torn_) += 1;
        ledger::Event event;
        event.kind = ledger::EventKind::Witness;
        event.actor = ledger::kGlStream;
        event.object = ledger::resourceOf(SLUICE_IMAGE_FLUID_COLOUR, imageSetOf(frame, host_->info().image_sets));
        event.aux = static_cast<std::uint16_t>(verdict);
        event.frame = static_cast<std::uint32_t>(frame);
        event.value = verdict == ledger::Verdict::Fresh ? frame : 0;
        ledger_->record(event);
    }
}

void LedgerTest::finish() {
    host_.reset();
    const Status ended = ledger_->finish(ledger::End::Closed);
    EXPECT_TRUE(ended) << ended.error().message();
}

std::map<std::string, std::uint64_t> LedgerTest::found() const {
    std::map<std::string, std::uint64_t> ids;
    for (const ledger::Finding& finding : ledger_->findings()) {
        ids[std::string(ledger::findingInfo(finding.kind).id)] += finding.count;
    }
    return ids;
}

}  // namespace sluice::host::test
