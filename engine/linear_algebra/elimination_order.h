#pragma once

#include <vector>

namespace plumb {

/// A block of constraint rows between two bodies; -1: not a moving body.
struct Link {
  int a = -1, b = -1;
};

/// Elimination order of the blocks of J M^-1 J^T, and the blocks that each one then couples.
struct EliminationOrder {
  std::vector<int> sequence;            ///< blocks, first eliminated first
  std::vector<std::vector<int>> below;  ///< by block: later blocks in its column of L
};

/// Computes a minimum-degree order of the graph whose nodes are links and whose edges join links that share a
/// body. Eliminating a link joins all links at its two bodies, as if the bodies were one. Among equals, links
/// farthest from the fixed frame go first. Leaves before roots, as in articulated-body methods, adds inverse
/// masses instead of subtracting nearly equal ones.
EliminationOrder minimum_degree(const std::vector<Link>& links, int bodies);

}  // namespace plumb
