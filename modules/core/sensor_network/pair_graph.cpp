#include "core/sensor_network/pair_graph.hpp"

#include <limits>
#include <numeric>

namespace voqcal {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// A tree below each root: by node, the link to its parent, and how deep it is.
struct Forest {
  std::vector<std::size_t> parent_link;
  std::vector<int> depth;
};

std::size_t OtherEnd(const PairLink& link, std::size_t node) {
  return link.from == node ? link.to : link.from;
}

// Breadth first: paths are short.
void Grow(std::size_t root, const std::vector<PairLink>& links, PairGraph* graph, Forest* forest) {
  std::vector<std::size_t> reached = {root};
  graph->piece[root] = graph->num_pieces;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::size_t node = reached[i];
    for (std::size_t l = 0; l < links.size(); ++l) {
      if (links[l].from != node && links[l].to != node) continue;
      const std::size_t next = OtherEnd(links[l], node);
      if (graph->piece[next] >= 0) continue;
      graph->piece[next] = graph->num_pieces;
      graph->is_in_tree[l] = true;
      graph->tree_links.push_back(l);
      forest->parent_link[next] = l;
      forest->depth[next] = forest->depth[node] + 1;
      reached.push_back(next);
    }
  }
  ++graph->num_pieces;
}

// The tree's links between the ends of a link that is not in it.
std::vector<std::size_t> TreePath(const PairLink& link,
                                  const std::vector<PairLink>& links,
                                  const Forest& forest) {
  std::vector<std::size_t> path;
  std::size_t a = link.from;
  std::size_t b = link.to;
  while (a != b) {
    std::size_t& deeper = forest.depth[a] >= forest.depth[b] ? a : b;
    path.push_back(forest.parent_link[deeper]);
    deeper = OtherEnd(links[path.back()], deeper);
  }
  return path;
}

// Links that are on one loop are of one part, and so are those that a third one joins so; the loops
// that the tree's other links close are enough to tell.
std::vector<std::size_t> PartsOf(const std::vector<PairLink>& links,
                                 const PairGraph& graph,
                                 const Forest& forest) {
  std::vector<std::size_t> part(links.size());
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (std::size_t l = 0; l < links.size(); ++l) {
    if (graph.is_in_tree[l]) continue;
    for (const std::size_t other : TreePath(links[l], links, forest)) {
      const std::size_t old = part[other];
      for (std::size_t& each : part) each = each == old ? part[l] : each;
    }
  }
  return part;
}

}  // namespace

PairGraph GraphOf(std::size_t num_nodes, std::size_t root, const std::vector<PairLink>& links) {
  PairGraph graph;
  graph.is_in_tree.assign(links.size(), false);
  graph.piece.assign(num_nodes, -1);
  Forest forest{std::vector<std::size_t>(num_nodes, kNone), std::vector<int>(num_nodes, 0)};
  Grow(root, links, &graph, &forest);
  for (std::size_t node = 0; node < num_nodes; ++node) {
    if (graph.piece[node] < 0) Grow(node, links, &graph, &forest);
  }
  const std::vector<std::size_t> part = PartsOf(links, graph, forest);
  std::vector<int> num_links(links.size(), 0);
  std::vector<int> num_in_tree(links.size(), 0);
  for (std::size_t l = 0; l < links.size(); ++l) {
    ++num_links[part[l]];
    num_in_tree[part[l]] += graph.is_in_tree[l] ? 1 : 0;
  }
  for (std::size_t l = 0; l < links.size(); ++l) {
    graph.tree_share.push_back(static_cast<double>(num_in_tree[part[l]]) / num_links[part[l]]);
  }
  return graph;
}

}  // namespace voqcal
