// SPDX-License-Identifier: MIT
// Where the box of water stands in a program whose units and axes nobody has told. Pure.
#pragma once

#include "payload/settings.hpp"
#include "tracker/frame_tracker.hpp"

namespace sluice::inject {

/// The program's camera as the fluid sees it: metres, and the fluid's own axes.
struct PlacedCamera {
    Matrix view = kIdentity, projection = kIdentity;
};

/// Which way is up in a world that is seen so: +z where the eye is level over the ground of such a world and not over
/// that of the other kind, or over both but less steep; else +y.
[[nodiscard]] Triple upOf(const Matrix& view);

/// In the program's world as it stands, or upright before the eye of the first frame: its centre at the distance of
/// what that eye sees, and scaled so that it fills a good part of the picture unless the plan knows the unit.
class Placement {
  public:
    /// `distance`: in units of the lens, 0 if unknown.
    Placement(const WaterPlan& plan, const FoundCamera& first, double distance);
    [[nodiscard]] PlacedCamera camera(const FoundCamera& found) const;
    [[nodiscard]] double unitsPerMetre() const { return 1.0 / metres_; }
    /// Of the program's world.
    [[nodiscard]] const Triple& up() const { return up_; }

  private:
    Triple up_{0, 1, 0};
    double metres_ = 1.0;            ///< per unit of the lens
    Matrix from_fluid_ = kIdentity;  ///< the fluid's axes to the program's world, in metres
};

}  // namespace sluice::inject
