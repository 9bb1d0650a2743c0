#include "core/sensor_network/pair_graph.hpp"

#include <gmock/gmock.h>

namespace voqcal {
namespace {

using ::testing::ElementsAre;

TEST(GraphOf, ATreeHasNoLoops) {
  const PairGraph graph = GraphOf(4, 1, {{0, 1}, {2, 1}, {2, 3}});
  EXPECT_EQ(graph.num_pieces, 1);
  EXPECT_THAT(graph.tree_links, ElementsAre(0, 1, 2));
  EXPECT_THAT(graph.tree_share, ElementsAre(1, 1, 1));
}

TEST(GraphOf, PiecesAreCountedFromTheRoots) {
  const PairGraph graph = GraphOf(5, 2, {{0, 1}, {2, 3}});
  EXPECT_EQ(graph.num_pieces, 3);
  EXPECT_THAT(graph.piece, ElementsAre(1, 1, 0, 0, 2));
}

// A triangle 0 1 2, a bridge 2 3, a square with a diagonal 3 4 5 6.
TEST(GraphOf, LoopsShareWhatTheirOwnTreeNeeds) {
  const PairGraph graph =
      GraphOf(7, 0, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 3}, {3, 5}});
  EXPECT_THAT(graph.tree_share,
              ElementsAre(2.0 / 3, 2.0 / 3, 2.0 / 3, 1.0, 0.6, 0.6, 0.6, 0.6, 0.6));
  EXPECT_TRUE(graph.IsInLoop(0));
  EXPECT_FALSE(graph.IsInLoop(3));
}

// Two triangles that meet in one node are two parts.
TEST(GraphOf, LoopsThatMeetInOneNodeAreApart) {
  const PairGraph graph = GraphOf(5, 2, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 2}});
  EXPECT_THAT(graph.tree_share, ::testing::Each(2.0 / 3));
}

}  // namespace
}  // namespace voqcal
