// SPDX-License-Identifier: MIT
// A hand on the mouse and keyboard of an X server, and an eye on its screen.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

struct _XDisplay;  // NOLINT(bugprone-reserved-identifier): Xlib's own name

namespace window::test {

/// Asks again and again; false when it has not come true in that time.
[[nodiscard]] bool until(const std::function<bool()>& condition,
                         std::chrono::seconds longest = std::chrono::seconds(60));

struct Rgb {
    int width = 0, height = 0;
    std::vector<std::uint8_t> values;  ///< three a pixel, rows from above
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return values.data() + (static_cast<std::ptrdiff_t>(y) * width + x) * 3;
    }
    bool operator==(const Rgb&) const = default;
};

/// The one window of a program, by its title; places are the window's own.
class Hand {
  public:
    Hand(const std::string& display, const std::string& title);
    Hand(const Hand&) = delete;
    Hand& operator=(const Hand&) = delete;
    ~Hand();
    /// The window is there, and its keys arrive.
    [[nodiscard]] bool ok() const { return window_ != 0; }

    void move(int x, int y);
    void button(unsigned number, bool down);
    void click(unsigned number);
    void key(unsigned long symbol);
    void resize(unsigned width, unsigned height);
    void show(bool shown);
    /// As a window manager asks for it.
    void close();
    /// What is on the screen there.
    [[nodiscard]] Rgb look();

  private:
    void flush();
    _XDisplay* display_ = nullptr;
    unsigned long window_ = 0;
};

}  // namespace window::test
