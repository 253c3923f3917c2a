#pragma once

#include <array>
#include <string_view>

/// Names of the members of each enumeration and variant in the scene format, in their order of declaration.
namespace plumb {

inline constexpr std::array<std::string_view, 3> kBodyTypeNames{"static", "kinematic", "dynamic"};
inline constexpr std::array<std::string_view, 5> kCombineNames{"geometric_mean", "product", "maximum",
                                                               "minimum", "average"};
inline constexpr std::array<std::string_view, 2> kSimultaneousNames{"sequence", "together"};
inline constexpr std::array<std::string_view, 3> kImpactNames{"newton", "poisson", "stronge"};
inline constexpr std::array<std::string_view, 2> kFrameNames{"world", "body"};
inline constexpr std::array<std::string_view, 6> kGeometryNames{"circle",  "box",     "capsule",
                                                                "polygon", "segment", "chain"};
inline constexpr std::array<std::string_view, 11> kJointNames{"revolute", "distance", "prismatic", "weld",
                                                              "wheel",    "motor",    "mouse",     "gear",
                                                              "pulley",   "ratchet",  "friction"};
inline constexpr std::array<std::string_view, 9> kForceNames{
    "linear_drag", "quadratic_drag",   "point_force",   "torque",        "spring",
    "attraction",  "sinusoidal_force", "formula_force", "formula_spring"};

}  // namespace plumb
