// SPDX-License-Identifier: MIT
// Owns one compiled display list.
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace sluice::host {

/// Move-only; freed with the context current.
class DisplayList {
  public:
    DisplayList() = default;
    /// Compiles the GL calls of `emit` without executing them.
    template <typename Emit>
    explicit DisplayList(const Emit& emit) : name_(glGenLists(1)) {
        glNewList(name_, GL_COMPILE);
        emit();
        glEndList();
    }
    DisplayList(DisplayList&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    DisplayList& operator=(DisplayList&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    DisplayList(const DisplayList&) = delete;
    DisplayList& operator=(const DisplayList&) = delete;
    ~DisplayList() {
        if (name_ != 0) {
            glDeleteLists(name_, 1);
        }
    }

    void call() const { glCallList(name_); }

  private:
    GLuint name_ = 0;
};

}  // namespace sluice::host
