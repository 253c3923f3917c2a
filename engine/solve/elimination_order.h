#pragma once

#include <vector>

namespace plumb {

/// A block of constraint rows between two bodies, -1 where nothing moves.
struct Link {
  int a = -1, b = -1;
};

/// In which order to eliminate the blocks of J M^-1 J^T, and which blocks each one then still couples.
struct EliminationOrder {
  std::vector<int> sequence;            ///< blocks, first eliminated first
  std::vector<std::vector<int>> below;  ///< by block: those eliminated later that its column of L reaches
};

/// Minimum degree on the graph whose nodes are links and whose edges join links that share a body.
/// Eliminating a link joins all links at its two bodies, which is the graph with the two bodies made one.
/// Among equals those farthest from the fixed frame go first: leaves before roots, as in articulated-body
/// methods, which adds inverse masses instead of subtracting nearly equal ones.
EliminationOrder minimum_degree(const std::vector<Link>& links, int bodies);

}  // namespace plumb
