#pragma once

#include <cstddef>
#include <vector>

namespace voqcal {

/// Sensors as nodes, 0 .. num_nodes - 1, pairs as links between two of them.
struct PairLink {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// What the links of a graph hold together.
struct PairGraph {
  /// By link; false: it closes a loop.
  std::vector<bool> is_in_tree;
  /// The links of a tree below `root`, in the order from it: the nearer end is known when the
  /// farther one is asked for.
  std::vector<std::size_t> tree_links;
  /// By node: which piece of the graph it is in; 0 is the root's.
  std::vector<int> piece;
  int num_pieces = 0;
  /// By link: of the links that share loops with it (its biconnected part), the share that is in
  /// the tree. 1: no loop has it.
  std::vector<double> tree_share;

  bool IsInLoop(std::size_t link) const { return tree_share[link] < 1.0; }
};

PairGraph GraphOf(std::size_t num_nodes, std::size_t root, const std::vector<PairLink>& links);

}  // namespace voqcal
