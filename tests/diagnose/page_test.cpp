// SPDX-License-Identifier: MIT
// The page of `sluice diagnose --html`, opened in a real Chromium without a network.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <regex>

#include "../cli/program.hpp"
#include "logs.hpp"

namespace sluice::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    return static_cast<std::size_t>(
        std::distance(std::sregex_iterator(text.begin(), text.end(), expression), std::sregex_iterator()));
}

class Page : public ProgramTest {
  protected:
    void SetUp() override {
        ProgramTest::SetUp();
        // scripts/test sets SLUICE_REQUIRE_CHROMIUM: there a missing browser is a failure.
        if (std::string(SLUICE_CHROMIUM).empty()) {
            if (std::getenv("SLUICE_REQUIRE_CHROMIUM") != nullptr) {
                FAIL() << "chromium was not found when CMake configured (install scripts/packages.txt, configure anew)";
            }
            GTEST_SKIP() << "no chromium on this machine (apt-get install chromium): the page was not opened";
        }
    }
    /// The page of a log, as the document stands after its script has run.
    std::string dom(std::uint32_t frames, Seeded seeded, const std::string& words = "", const std::string& place = "") {
        writeEngineLog(at("a.log").string(), frames, seeded);
        const Outcome made = run("diagnose a.log --quiet --html page.html " + words);
        EXPECT_LE(made.code, 1) << made.err;
        page_ = read("page.html");
        // --virtual-time-budget would hang on some builds; the page draws before its load event, so none is needed.
        const std::string command =
            "timeout 100 '" SLUICE_CHROMIUM
            "' --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
            "--disable-component-update --disable-sync --window-size=1400,1000 --user-data-dir='" +
            at("profile").string() + "' --dump-dom 'file://" + at("page.html").string() + place + "' >'" +
            at("dom.html").string() + "' 2>'" + at("chromium.err").string() + "'";
        EXPECT_EQ(std::system(command.c_str()), 0) << read("chromium.err");
        return read("dom.html");
    }
    std::string page_;
};

TEST_F(Page, ARaceIsDrawnWithLanesArrowsAndFindings) {
    const std::string text = dom(4, Seeded::MissingWait);
    EXPECT_THAT(text, HasSubstr("data-ready=\"1\"")) << "the script ran to its end";
    EXPECT_THAT(text, HasSubstr("data-errors=\"0\"")) << "and without an error";
    EXPECT_EQ(count(text, "class=\"lane\" data-actor="), 3U);
    EXPECT_EQ(count(text, "class=\"arrow( held)?\""), 2U) << "of the two frames shown, the thread's waits";
    EXPECT_GE(count(text, "class=\"finding error[^\"]*\""), 1U);
    EXPECT_GE(count(text, "class=\"mark error[^\"]*\""), 1U);
    EXPECT_GE(count(text, "class=\"missing\""), 1U);
    EXPECT_EQ(count(text, "class=\"stall\""), 2U + 1U) << "two waits, and the legend's";
    EXPECT_GE(count(text, "class=\"critical\""), 3U);
    EXPECT_EQ(count(text, "class=\"bar "), 4U) << "one per frame";
    EXPECT_THAT(text, HasSubstr("race-read-after-write"));
    EXPECT_THAT(text, HasSubstr("<h1 id=\"verdict\" class=\"found\">"));
}

TEST_F(Page, ACleanLogIsDrawnAndSaysSo) {
    const std::string text = dom(3, Seeded::Nothing);
    EXPECT_THAT(text, HasSubstr("data-errors=\"0\""));
    EXPECT_THAT(text, HasSubstr("<h1 id=\"verdict\" class=\"clean\">clean"));
    EXPECT_EQ(count(text, "class=\"arrow( held)?\""), 4U) << "two hand-offs in each of two frames";
    EXPECT_EQ(count(text, "class=\"mark error"), 0U);
}

TEST_F(Page, AWaitForNobodyIsShadedAndExplained) {
    const std::string text = dom(1, Seeded::DeadWait);
    EXPECT_THAT(text, HasSubstr("data-errors=\"0\""));
    EXPECT_EQ(count(text, "class=\"stall never\""), 1U);
    EXPECT_THAT(text, HasSubstr("wait-unsatisfiable"));
    EXPECT_EQ(count(text, "class=\"chain\""), 1U);
}

TEST_F(Page, NamesOfALogStayText) {
    const std::string text = dom(1, Seeded::Nothing);
    EXPECT_THAT(text, HasSubstr("data-errors=\"0\""));
    EXPECT_THAT(text, Not(HasSubstr("<b>bold</b>")));
    EXPECT_THAT(text, HasSubstr("&lt;b&gt;bold"));
}

TEST_F(Page, NothingIsFetched) {
    const std::string text = dom(1, Seeded::Nothing);
    EXPECT_EQ(count(page_, "(src|href)\\s*="), 0U);
    EXPECT_THAT(page_, HasSubstr("default-src 'none'"));
    // The namespace of SVG is a name, not an address that is opened.
    EXPECT_EQ(count(page_, "https?://(?!www\\.w3\\.org/2000/svg)"), 0U);
}

TEST_F(Page, AThousandFramesOpenAtTheOneThatIsAskedFor) {
    const std::string text = dom(1000, Seeded::MissingWait, "", "#frame=700");
    EXPECT_THAT(text, HasSubstr("data-ready=\"1\""));
    EXPECT_THAT(text, HasSubstr("data-errors=\"0\""));
    EXPECT_THAT(text, HasSubstr(">Frame 700<"));
    EXPECT_LT(count(text, "data-event="), 100U) << "only the window is drawn";
    EXPECT_LT(page_.size(), 3U << 20U);
}

TEST_F(Page, ARangeOfFramesIsAllThatThePageHolds) {
    const std::string text = dom(50, Seeded::Nothing, "--frames 10..19");
    EXPECT_EQ(count(text, "class=\"bar "), 10U);
    EXPECT_THAT(text, HasSubstr("this page has frames 10 to 19"));
}

}  // namespace
}  // namespace sluice::test
