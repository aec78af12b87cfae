// SPDX-License-Identifier: MIT
// What crosses, as the two sides tell of it, without a driver: one fact at a time is not so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "sluice/export_mark.hpp"
#include "sluice/ledger/share_feed.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kExported = 40;   // the renderer's descriptor
constexpr int kDuplicate = 41;  // what OpenGL is given

/// How the renderer's word reaches the host.
enum class Word { Here, Elsewhere, None };

/// One image on its way. What a test changes is not so.
struct Story {
    SluiceImageExport made{};     ///< what the renderer has done
    SluiceImageExport offered{};  ///< what the host is told
    MemoryFacts told;             ///< what the host tells OpenGL
    SluiceRendererCapabilities renderer{};
    SluiceHostCapabilities host{};
    bool closes = true, gives = true, refuses = false, canary = false;
    int closed_again = -1;

    Story() {
        made.struct_size = sizeof(made);
        made.role = SLUICE_IMAGE_FLUID_COLOUR;
        made.image_set = 1;
        made.allocation_size = 8192;
        made.fd = kExported;
        made.dedicated = 1;
        offered = made;
        told.size = made.allocation_size;
        told.dedicated = 1;
        renderer.device_uuid[0] = 7;
        renderer.driver_uuid[0] = 9;
        host.device_uuid_count = 2;  // the second is the renderer's
        host.device_uuids[0][0] = 6;
        host.device_uuids[1][0] = 7;
        host.driver_uuid[0] = 9;
    }
};

std::vector<std::string> findingsOf(const Story& story, Word word = Word::Here) {
    LiveLedger ledger;
    ShareFeed feed(ledger);
    SluiceHostServices services{};
    services.user = &feed;
    services.trace = [](void* user, const SluiceTraceEvent* event) { static_cast<ShareFeed*>(user)->trace(*event); };
    if (word == Word::Elsewhere) {
        services.trace = [](void* user, const SluiceTraceEvent* event) {
            SluiceTraceEvent sent = *event;
            sent.value = valueElsewhere(sent);
            static_cast<ShareFeed*>(user)->trace(sent);
        };
    }
    if (word != Word::None) {
        markExport(services, story.made);
    }
    feed.offered(story.offered);
    feed.opened(kDuplicate);
    if (story.refuses) {
        feed.closed(kDuplicate);
        feed.handedBack(story.offered);
    } else {
        if (story.gives) {
            feed.given(kDuplicate);
        }
        feed.imported(story.offered, story.told);
        if (story.closes) {
            feed.closed(story.offered.fd);
        }
    }
    feed.closed(story.closed_again);
    if (story.canary) {
        feed.canaryEnds();
    }
    HandOffFeed frames(ledger, SLUICE_TIMELINE_BRIDGED, 2);
    frames.imagesMade(SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_COLOUR));
    feed.imagesMade(story.renderer, story.host);
    frames.imagesDestroyed(true);
    EXPECT_TRUE(ledger.finish(End::Closed));
    std::vector<std::string> all;
    for (const Finding& finding : ledger.findings()) {
        all.push_back(std::string(findingInfo(finding.kind).id) + ": " + finding.sentence);
    }
    return all;
}

TEST(ShareFeed, IsSilentWhereBothSidesAgreeWhicheverWayTheRenderersWordComes) {
    for (const Word word : {Word::Here, Word::Elsewhere, Word::None}) {
        EXPECT_THAT(findingsOf({}, word), IsEmpty());
        Story refused;
        refused.refuses = true;
        EXPECT_THAT(findingsOf(refused, word), IsEmpty()) << "refused, it is the renderer's again";
        Story canary;
        canary.canary = true;
        canary.made.role = canary.offered.role = SLUICE_IMAGE_CANARY;
        canary.made.image_set = canary.offered.image_set = 0;
        EXPECT_THAT(findingsOf(canary, word), IsEmpty());
    }
}

TEST(ShareFeed, TellsOfEachFactThatIsNotSo) {
    const auto wrong = [](const std::function<void(Story&)>& change) {
        Story story;
        change(story);
        return findingsOf(story);
    };
    EXPECT_THAT(
        wrong([](Story& s) { s.told.dedicated = 0; }),
        ElementsAre("import-dedicated-mismatch: host thread imports FLUID_COLOUR of set 1 with the dedicated flag 0, "
                    "but renderer exported it with 1."));
    EXPECT_THAT(
        wrong([](Story& s) { s.told.size = 4096; }),
        ElementsAre("import-size-mismatch: host thread imports FLUID_COLOUR of set 1 with size 4096, but renderer "
                    "exported it with 8192."));
    EXPECT_THAT(wrong([](Story& s) { s.told.tiling = 1; }), ElementsAre(HasSubstr("import-tiling-mismatch: ")));
    EXPECT_THAT(wrong([](Story& s) { s.host.device_uuids[1][0] = 8; }), ElementsAre(HasSubstr("device UUID 06")));
    EXPECT_THAT(wrong([](Story& s) { s.host.driver_uuid[0] = 8; }), ElementsAre(HasSubstr("driver UUID 08")));
    EXPECT_THAT(wrong([](Story& s) { s.host.device_uuid_count = 0; }), IsEmpty()) << "a host that cannot tell";
    EXPECT_THAT(wrong([](Story& s) { s.closes = false; }),
                ElementsAre(HasSubstr("fd-leaked: Descriptor 40, opened by renderer ")));
    EXPECT_THAT(wrong([](Story& s) { s.gives = false; }),
                ElementsAre(HasSubstr("fd-leaked: Descriptor 41, opened by host thread ")));
    EXPECT_THAT(wrong([](Story& s) { s.offered.fd = 50; }), ElementsAre(HasSubstr("fd-leaked: Descriptor 40")))
        << "the host was brought another, and closed that";
    EXPECT_THAT(wrong([](Story& s) { s.closed_again = kExported; }), ElementsAre(HasSubstr("fd-closed-twice: ")));
    EXPECT_THAT(wrong([](Story& s) { s.closed_again = kDuplicate; }), ElementsAre(HasSubstr("fd-closed-twice: ")));
    EXPECT_THAT(wrong([](Story& s) {
                    s.canary = true;
                    s.made.role = s.offered.role = SLUICE_IMAGE_CANARY;
                    s.made.image_set = s.offered.image_set = 0;
                    s.told.dedicated = 0;
                }),
                ElementsAre(HasSubstr("import-dedicated-mismatch: host thread imports canary ")));
}

/// Where the renderer says nothing beside it, what it offers is taken for what it has made.
TEST(ShareFeed, HoldsTheOfferAgainstTheRenderersOwnWord) {
    Story story;
    story.made.dedicated = 0;
    EXPECT_THAT(findingsOf(story, Word::Here), ElementsAre(HasSubstr("import-dedicated-mismatch: ")));
    EXPECT_THAT(findingsOf(story, Word::Elsewhere), ElementsAre(HasSubstr("import-dedicated-mismatch: ")));
    EXPECT_THAT(findingsOf(story, Word::None), IsEmpty());
}

TEST(ShareFeed, AResizeBeginsAnew) {
    LiveLedger ledger;
    ShareFeed feed(ledger);
    HandOffFeed frames(ledger, SLUICE_TIMELINE_BRIDGED, 2);
    Story story;
    for (const std::uint64_t size : {8192U, 4096U, 12288U}) {
        story.offered.allocation_size = story.told.size = size;
        feed.offered(story.offered);
        feed.imported(story.offered, story.told);
        feed.closed(kExported);
        if (size == 4096) {
            feed.forget();  // a resize that failed
            continue;
        }
        frames.imagesDestroyed(true);
        frames.imagesMade(SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_COLOUR));
        feed.imagesMade(story.renderer, story.host);
    }
    EXPECT_TRUE(ledger.finish(End::Closed));
    EXPECT_THAT(ledger.findings(), IsEmpty());
}

TEST(ExportMark, ReadsWhatItWrote) {
    Story story;
    struct Sent {
        std::string name;
        SluiceTraceEvent event{};
        int count = 0;
    } sent;
    SluiceHostServices services{};
    services.user = &sent;
    services.trace = [](void* user, const SluiceTraceEvent* event) {
        Sent& to = *static_cast<Sent*>(user);
        to = {event->name, *event, to.count + 1};
    };
    markExport(services, story.made);
    ASSERT_EQ(sent.count, 1);
    EXPECT_EQ(sent.name, "export FLUID_COLOUR[1]");
    SluiceTraceEvent event = sent.event;
    event.name = sent.name.c_str();
    const std::optional<ExportMark> mark = exportMark(event);
    ASSERT_TRUE(mark);
    EXPECT_EQ(mark->role, static_cast<std::uint32_t>(SLUICE_IMAGE_FLUID_COLOUR));
    EXPECT_EQ(mark->image_set, 1U);
    EXPECT_EQ(mark->size, 8192U);
    EXPECT_EQ(mark->dedicated, 1U);
    EXPECT_EQ(mark->fd, kExported);
    event.value = valueElsewhere(event);
    ASSERT_TRUE(exportMark(event));
    EXPECT_EQ(exportMark(event)->fd, -1);
    EXPECT_EQ(exportMark(event)->dedicated, 1U);

    for (const char* name : {"export FLUID_COLOUR", "export FLUID_COLOUR[]", "export FLUID_COLOUR[1]x", "export X[1]",
                             "export FLUID_COLOUR[4]", "export FLUID_COLOUR[-1]", "export ]", "exporting", ""}) {
        event.name = name;
        EXPECT_FALSE(exportMark(event)) << name;
    }
    event.name = nullptr;
    EXPECT_FALSE(exportMark(event));
    event.name = "export FLUID_COLOUR[1]";
    event.track = SLUICE_TRACK_RENDERER_QUEUE;
    EXPECT_FALSE(exportMark(event));
    EXPECT_EQ(valueElsewhere(event), event.value);
    story.made.role = 99;
    markExport(services, story.made);
    services.trace = nullptr;
    markExport(services, Story().made);
    EXPECT_EQ(sent.count, 1);
}

}  // namespace
}  // namespace sluice::ledger
