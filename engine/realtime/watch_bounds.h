#pragma once

/// Bounds that the watch of the fixed-step driver checks. All are fractions of the scene's own sizes and
/// energies.
namespace plumb::bounds {

/// A joint's gap, of the distance from the anchor to the centre of its body (or the length of a rod). The
/// direct solver closes joints to rounding.
inline constexpr double kGap = 0.005;

/// How deep two shapes may lie in each other, of the width of the narrower one that moves.
inline constexpr double kOverlap = 0.008;

/// How deep what a body stands on may have sunk, down to the ground, each of the width of the wider one.
inline constexpr double kSag = 0.03;
/// Above this sag the violation is reported at once.
inline constexpr double kSunk = 0.5;

/// How far the top of a tower may sway, of its width, by what the sweeps leave (`sway_of`); and what substeps
/// are chosen for.
inline constexpr double kSway = 0.04, kSteadySway = 0.02;

/// How many times as many substeps a tower may ask for: one that needs more is for a direct solver.
inline constexpr double kMostForTowers = 8;

/// Energy gained, or lost where nothing takes any, of the most that has been in motion. Velocity Verlet's
/// error is (w h)^2/4 of it at most, for a mode of frequency w (Hairer, Lubich and Wanner, Geometric
/// Numerical Integration, 2006, ch. I.5).
inline constexpr double kEnergy = 0.04;

/// The same where nothing takes any, when it stays so far off for `kDriftSteps` on end: the method's own
/// error comes and goes with the motion, what roundings add up to stays.
inline constexpr double kDrift = 0.008;
inline constexpr int kDriftSteps = 1'000'000;

/// Steps for which a bound must be missed before it is said; and an overlap or sag, as a column's bodies land
/// one after the other.
inline constexpr int kLasting = 15, kSettling = 30;

/// Energy comes and goes with the motion, and an impact that goes through a heap leaves overlaps that take a
/// second to dissolve: a step with energy within its bound, or with less of an overlap, takes back a quarter
/// of one that misses.
inline constexpr int kRecurrence = 4;

/// Maximum ratio of a dissolving penetration or sag to that of the step before.
inline constexpr double kDissolving = 0.998;

/// How many times over a bound may be missed for that while.
inline constexpr double kAtOnce = 60;

/// How far rounding may move a body's position, of the body's own size.
inline constexpr double kRounding = 4;

/// Roundings of positions that may add up in the account of energy before it says anything.
inline constexpr double kRoundings = 4096;

}  // namespace plumb::bounds
