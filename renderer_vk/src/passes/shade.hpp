// SPDX-License-Identifier: MIT
// The last pass: colour, coverage and window depth into the shared images. One pipeline per combination of needs.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

class ShadePass {
  public:
    /// Builds the pipeline that `plan` needs, unless it was built before.
    Status prepare(const Device& device, const Plan& plan);
    void record(const PassContext& context) const;

  private:
    using Key = std::array<std::uint32_t, 9>;  ///< the specialisation constants of shade.comp
    static Key keyOf(const Plan& plan);
    std::map<Key, Pipeline> pipelines_;
};

}  // namespace sluice::vk
