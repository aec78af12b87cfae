// SPDX-License-Identifier: MIT
// A current GL context for a test, and small things to draw and to look at.
#pragma once

#include <dirent.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>

#include "sluice/host_gl/context.hpp"

namespace sluice::host::test {

/// One context per test case.
class GlTest : public ::testing::Test {
  protected:
    void SetUp() override {
        Result<GlContext> context = GlContext::create();
        ASSERT_TRUE(context) << context.error().message();
        context_.emplace(std::move(context).value());
        const Status current = context_->makeCurrent();
        ASSERT_TRUE(current) << current.error().message();
    }
    [[nodiscard]] GlContext& context() { return *context_; }

  private:
    std::optional<GlContext> context_;
};

/// Open descriptors of this process.
[[nodiscard]] inline int openDescriptors() {
    std::unique_ptr<DIR, int (*)(DIR*)> directory(opendir("/proc/self/fd"), closedir);
    int count = 0;
    while (readdir(directory.get()) != nullptr) {
        ++count;
    }
    return count - 3;  // ".", ".." and the directory's own
}

/// Whether no more than `count` descriptors are open, at once or soon: threads of drivers may have a file open for a
/// moment.
[[nodiscard]] inline bool descriptorsReturnTo(int count) {
    for (int i = 0; i < 500 && openDescriptors() > count; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return openDescriptors() <= count;
}

/// A texture with storage, nearest filters and one level; freed with the context current.
class TestTexture {
  public:
    TestTexture(GLenum internal, GLenum format, GLenum type, std::uint32_t width, std::uint32_t height,
                const void* pixels) {
        glGenTextures(1, &name_);
        glBindTexture(GL_TEXTURE_2D, name_);
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), static_cast<GLsizei>(width),
                     static_cast<GLsizei>(height), 0, format, type, pixels);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glBindTexture(GL_TEXTURE_2D, 0);
    }
    TestTexture(const TestTexture&) = delete;
    TestTexture& operator=(const TestTexture&) = delete;
    ~TestTexture() { glDeleteTextures(1, &name_); }
    [[nodiscard]] GLuint name() const { return name_; }

  private:
    GLuint name_ = 0;
};

/// Work that keeps a software rasteriser busy for a while: `layers` blended screen-filling quads.
inline void drawHeavily(int layers) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBegin(GL_QUADS);
    for (int i = 0; i < layers; ++i) {
        glColor4f(0.3F, 0.5F, 0.7F, 0.01F);
        glVertex2f(-1.0F, -1.0F);
        glVertex2f(1.0F, -1.0F);
        glVertex2f(1.0F, 1.0F);
        glVertex2f(-1.0F, 1.0F);
    }
    glEnd();
    glDisable(GL_BLEND);
}

}  // namespace sluice::host::test
