// SPDX-License-Identifier: MIT
// What is on an X server's screen. Apart from the tests: Xlib's names are everybody's.
#pragma once

#include <memory>
#include <string>
#include <vector>

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name

namespace sluice::inject::test {

class ScreenView {
  public:
    explicit ScreenView(const std::string& display);
    ScreenView(const ScreenView&) = delete;
    ScreenView& operator=(const ScreenView&) = delete;
    ~ScreenView();
    [[nodiscard]] bool ok() const { return display_ != nullptr; }
    /// The upper left corner, 0xRRGGBB a pixel.
    [[nodiscard]] std::vector<unsigned long> look(int width, int height) const;
    /// Black, where no window is.
    void wipe() const;

  private:
    _XDisplay* display_;
};

}  // namespace sluice::inject::test
