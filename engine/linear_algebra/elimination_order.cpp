#include "engine/linear_algebra/elimination_order.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <set>
#include <tuple>

namespace plumb {
namespace {

/// The links that are not eliminated yet, on bodies that merge as links are eliminated.
class Contraction {
 public:
  Contraction(const std::vector<Link>& links, int bodies)
      : links_(links),
        merged_into_(bodies),
        links_at_(bodies),
        alive_(links.size(), 1),
        seen_(links.size(), 0) {
    for (int body = 0; body < bodies; ++body) merged_into_[body] = body;
    for (int i = 0; i < static_cast<int>(links.size()); ++i) {
      if (links[i].a >= 0) links_at_[links[i].a].push_back(i);
      if (links[i].b >= 0 && links[i].b != links[i].a) links_at_[links[i].b].push_back(i);
    }
  }

  /// Returns the number of links that share a body with `link`; links that share both count twice.
  int degree(int link) {
    const int a = body_of(links_[link].a), b = body_of(links_[link].b);
    const int at_a = a < 0 ? 0 : static_cast<int>(links_at_[a].size()) - 1;
    const int at_b = b < 0 || b == a ? 0 : static_cast<int>(links_at_[b].size()) - 1;
    return at_a + at_b;
  }

  /// Removes `link`, merges its bodies, and returns the numbers of the links that it couples.
  std::vector<int> eliminate(int link) {
    assert(alive_[link]);
    alive_[link] = 0;
    int a = body_of(links_[link].a), b = body_of(links_[link].b);
    if (a < 0 || a == b) std::swap(a, b);
    std::vector<int> left;
    for (const int body : {a, a == b ? -1 : b}) {
      if (body < 0) continue;
      for (const int other : links_at_[body]) {
        if (alive_[other] && !seen_[other]) {
          seen_[other] = 1;
          left.push_back(other);
        }
      }
      links_at_[body].clear();
    }
    for (const int other : left) seen_[other] = 0;
    std::sort(left.begin(), left.end());
    if (a >= 0) links_at_[a] = left;
    if (a >= 0 && b >= 0) merged_into_[b] = a;
    return left;
  }

 private:
  int body_of(int body) {
    if (body < 0) return body;
    while (merged_into_[body] != body) {
      merged_into_[body] = merged_into_[merged_into_[body]];
      body = merged_into_[body];
    }
    return body;
  }

  const std::vector<Link>& links_;
  std::vector<int> merged_into_;            // union-find over bodies
  std::vector<std::vector<int>> links_at_;  // by body, except those merged into another
  std::vector<char> alive_, seen_;          // by link
};

/// Returns the number of links between each link and the fixed frame; breadth first.
std::vector<int> depths(const std::vector<Link>& links, int bodies) {
  std::vector<std::vector<int>> links_at(bodies);
  std::vector<int> depth(links.size(), std::numeric_limits<int>::max());
  std::vector<int> queue;
  for (int i = 0; i < static_cast<int>(links.size()); ++i) {
    for (const int body : {links[i].a, links[i].b}) {
      if (body >= 0) links_at[body].push_back(i);
    }
    if (links[i].a < 0 || links[i].b < 0) {
      depth[i] = 0;
      queue.push_back(i);
    }
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const int link = queue[next];
    for (const int body : {links[link].a, links[link].b}) {
      if (body < 0) continue;
      for (const int other : links_at[body]) {
        if (depth[other] <= depth[link] + 1) continue;
        depth[other] = depth[link] + 1;
        queue.push_back(other);
      }
      links_at[body].clear();  // every link at this body has a depth now
    }
  }
  return depth;
}

}  // namespace

EliminationOrder minimum_degree(const std::vector<Link>& links, int bodies) {
  Contraction graph(links, bodies);
  const std::vector<int> depth = depths(links, bodies);
  using Key = std::tuple<int, int, int>;  // degree, -depth, index
  std::set<Key> queue;
  std::vector<Key> keys(links.size());
  for (int i = 0; i < static_cast<int>(links.size()); ++i) {
    keys[i] = {graph.degree(i), -depth[i], i};
    queue.insert(keys[i]);
  }
  EliminationOrder order;
  order.below.resize(links.size());
  while (!queue.empty()) {
    const int link = std::get<2>(*queue.begin());
    assert(order.sequence.size() < links.size());
    queue.erase(queue.begin());
    order.sequence.push_back(link);
    order.below[link] = graph.eliminate(link);
    for (const int other : order.below[link]) {
      const Key key{graph.degree(other), -depth[other], other};
      if (key == keys[other]) continue;
      queue.erase(keys[other]);
      keys[other] = key;
      queue.insert(key);
    }
  }
  assert(order.sequence.size() == links.size());
  return order;
}

}  // namespace plumb
