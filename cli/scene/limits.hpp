// SPDX-License-Identifier: MIT
// Ranges of scene values, and how to say them.
#pragma once

#include <string>

namespace sluice::scene {

/// Numbers between low and high; an open end excludes its bound.
struct Range {
    double low, high;
    bool low_open = false;
    [[nodiscard]] bool holds(double value) const {
        return (low_open ? value > low : value >= low) && value <= high;  // false for NaN
    }
    /// "a number in [0, 1]"
    [[nodiscard]] std::string text(const char* what) const;
};

inline constexpr double kWorld = 1.0e6;  ///< metres; beyond it, 32-bit floats hold no shape of a splash
inline constexpr Range kAnyLength{-kWorld, kWorld};
inline constexpr Range kPositiveLength{0.0, kWorld, true};
inline constexpr Range kLength{0.0, kWorld};
inline constexpr Range kLight{0.0, 1.0e6};  ///< linear radiance
inline constexpr Range kUnit{0.0, 1.0};
inline constexpr Range kAbsorption{0.0, 1.0e6};  ///< per metre
inline constexpr Range kDegrees{-36000.0, 36000.0};

}  // namespace sluice::scene
