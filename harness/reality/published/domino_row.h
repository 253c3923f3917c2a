#pragma once

namespace plumb::harness::reality {

/// A long row of equal upright blocks.
struct DominoRow {
  double height = 1, thickness = 0.2, gap = 0.4;  ///< m
  double friction = 0;                            ///< between blocks
  double gravity = 9.81;                          ///< m/s^2
};

/// Returns the speed at which a long row topples, m/s, by the closed model of J. M. J. van Leeuwen, The
/// domino effect, Am. J. Phys. 78 (2010) 721. Its assumptions: feet do not slip, impacts do not rebound, and
/// every block keeps sliding on the next one. Rows in which the wave stops have a speed of 0.
double toppling_speed(const DominoRow& row);

}  // namespace plumb::harness::reality
