// SPDX-License-Identifier: MIT
// EchoTest with the shim in place of the real renderer.
#pragma once

#include "echo_rig.hpp"
#include "plugins/shim.hpp"

namespace sluice::host::test {

class ShimTest : public EchoTest {
  protected:
    void SetUp() override;
    /// The real renderer, unchanged.
    void resetShim() const;

    ShimControl* control_ = nullptr;  ///< lives in the library, reset for each test
};

}  // namespace sluice::host::test
