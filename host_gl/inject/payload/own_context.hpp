// SPDX-License-Identifier: MIT
// A desktop GL context of the payload's own for a program of OpenGL ES: nothing can be composited in ES itself (it
// copies no depth), but colour and depth belong to the surface, and a context of either kind may draw into that.
#pragma once

#include <memory>

#include "payload/gl_calls.hpp"
#include "sluice/result.hpp"

namespace sluice::inject {

class OwnContext {
  public:
    /// For the surface that is current in `program`, which must be of EGL.
    [[nodiscard]] static Result<std::unique_ptr<OwnContext>> create(const GlCalls& gl, const CurrentContext& program);
    OwnContext(const OwnContext&) = delete;
    OwnContext& operator=(const OwnContext&) = delete;
    /// EGL itself waits with its end until no thread has it current.
    ~OwnContext();

    /// While one lives, the own context is current, with the surfaces of the program's; then the program's again.
    class Turn {
      public:
        explicit Turn(const OwnContext& of);
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        ~Turn();
        /// Whether it came about: a surface of another config is refused.
        [[nodiscard]] bool ok() const { return ok_; }

      private:
        const GlCalls& gl_;
        unsigned api_;
        void *display_, *draw_, *read_, *context_;
        bool ok_;
    };

  private:
    OwnContext(const GlCalls& gl, void* display, void* context) : gl_(gl), display_(display), context_(context) {}
    const GlCalls& gl_;
    void *display_, *context_;
};

}  // namespace sluice::inject
