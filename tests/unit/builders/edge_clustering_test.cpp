// The rounds of EBBVH against a plain sequential greedy pairing, each way of running them forced in turn.
#include "builders/parts/edge_clustering.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "boxwood/builders.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood::builders {
namespace {

using testing::Boxes;
using Links = std::vector<ClusterLink>;

struct Rounds {
  std::vector<std::array<std::uint32_t, 2>> merges;
  std::vector<std::uint32_t> pairs;

  friend bool operator==(const Rounds&, const Rounds&) = default;
};

double half_area(const Box& box) {
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return x * y + y * z + z * x;
}

/// The listing as it stands: every round looks at every link.
Rounds oracle(const Boxes& references, Links links, const GrowthGate& gate, std::uint32_t most_rounds) {
  Rounds result;
  Boxes boxes = references;
  std::vector<std::uint32_t> counts(boxes.size(), 1), now(boxes.size());
  for (std::size_t i = 0; i < now.size(); ++i) now[i] = std::uint32_t(i);
  for (std::uint32_t round = 0; round < most_rounds || most_rounds == 0; ++round) {
    std::vector<std::uint32_t> partner(boxes.size(), ~0u);
    std::uint32_t pairs = 0;
    for (ClusterLink& link : links) {
      if (link.a == link.b || partner[link.a] != ~0u || partner[link.b] != ~0u) continue;
      const Box both = merge(boxes[link.a], boxes[link.b]);
      const bool too_many = gate.size != 0 && counts[link.a] + counts[link.b] > gate.size;
      const double sum = half_area(boxes[link.a]) + half_area(boxes[link.b]);
      if (too_many || (gate.area != 0 && half_area(both) > gate.area * sum)) {
        link.b = link.a;
        continue;
      }
      const auto made = std::uint32_t(boxes.size());
      boxes.push_back(both);
      counts.push_back(counts[link.a] + counts[link.b]);
      partner.push_back(0);  // not before the next round
      partner[link.a] = partner[link.b] = made;
      result.merges.push_back({link.a, link.b});
      ++pairs;
    }
    for (ClusterLink& link : links)
      for (std::uint32_t* end : {&link.a, &link.b})
        if (partner[*end] != ~0u && partner[*end] != 0) *end = partner[*end];
    result.pairs.push_back(pairs);
    if (pairs == 0) break;
  }
  return result;
}

Rounds run(const Boxes& boxes, const Links& links, const GrowthGate& gate, std::uint32_t rounds,
           const EdgeClustering::Ways& ways, Executor& executor) {
  const refs::ReferenceSet set = testing::reference_set(boxes);
  AlignedBuffer<ClusterLink> copy(links.size());
  std::copy(links.begin(), links.end(), copy.begin());
  MergeForest forest(set.references.span(), {}, {}, 1, executor);
  EdgeClustering clustering(forest, std::move(copy), gate, ways, executor);
  const BuildContext context{executor};
  EXPECT_TRUE(clustering.run({.rounds = rounds}, BuildMonitor(context, 1)));
  Rounds result{{}, clustering.pairs_by_round()};
  for (std::uint32_t m = 0; m < clustering.merged(); ++m) {
    const auto cluster = std::uint32_t(boxes.size() + m);
    result.merges.push_back({forest.left(cluster), forest.right(cluster)});
  }
  return result;
}

struct Way {
  const char* name;
  EdgeClustering::Ways ways;
};
constexpr std::size_t kNever = std::size_t{1} << 40;
const Way kWays[] = {{"sequence", {kNever, 1, kNever}},
                     {"parallel", {0, 1, kNever}},
                     {"heaps after one round", {kNever, 1, 0}},
                     {"heaps after one parallel round", {0, 1, 0}},
                     {"as it comes", {1000, 1, 16}}};

void expect_as_in_oracle(const Boxes& boxes, const Links& links, const GrowthGate& gate, std::uint32_t rounds = 0) {
  const Rounds expected = oracle(boxes, links, gate, rounds);
  const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, 8);
  ThreadExecutor threads(8);
  SequentialExecutor sequential;
  for (const auto& [name, ways] : kWays) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(run(boxes, links, gate, rounds, ways, sequential) == expected);
    EXPECT_TRUE(run(boxes, links, gate, rounds, ways, threads) == expected);
  }
}

/// Links in random order, between neighbours in a row of `width`, and some between any two.
Links random_links(std::uint32_t count, std::uint32_t width, std::size_t far, std::uint32_t seed) {
  std::mt19937 random(seed);
  Links links;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t step : {1u, width})
      if (i + step < count && random() % 8 != 0) links.push_back({i, i + step});
  for (std::size_t i = 0; i < far; ++i)
    links.push_back({std::uint32_t(random() % count), std::uint32_t(random() % count)});
  std::shuffle(links.begin(), links.end(), random);
  return links;
}

TEST(EdgeClustering, RandomMeshesAndGatesAsInSequence) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const Boxes boxes = testing::soup(700 + 100 * seed, seed);
    const Links links = random_links(std::uint32_t(boxes.size()), 20 + seed, seed % 3 * 100, seed);
    expect_as_in_oracle(boxes, links, {});
    expect_as_in_oracle(boxes, links, {.area = 4});
    expect_as_in_oracle(boxes, links, {.size = 5});
    expect_as_in_oracle(boxes, links, {}, 3);
  }
}

TEST(EdgeClustering, ManyLinksTakeTheParallelWayFar) {
  const Boxes boxes = testing::soup(20000, 3);
  expect_as_in_oracle(boxes, random_links(20000, 140, 0, 9), {}, 4);
}

TEST(EdgeClustering, ChainOfEverBetterLinksAsInSequence) {
  // Only one link at a time ranks first at both of its ends.
  const Boxes boxes = testing::soup(9000, 5);
  Links links;
  for (std::uint32_t i = 0; i + 1 < boxes.size(); ++i) links.push_back({i, i + 1});
  expect_as_in_oracle(boxes, links, {});
  std::reverse(links.begin(), links.end());
  expect_as_in_oracle(boxes, links, {});
}

TEST(EdgeClustering, RepeatedLinksAndLinksToItselfAsInSequence) {
  const Boxes boxes = testing::soup(50, 6);
  Links links;
  for (std::uint32_t i = 0; i < 50; ++i) {
    links.push_back({i, i});
    for (int repeat = 0; repeat < 3; ++repeat) links.push_back({i, (i * 7 + 3) % 50});
  }
  expect_as_in_oracle(boxes, links, {});
}

TEST(EdgeClustering, StarMergesOneARoundAsInSequence) {
  const Boxes boxes = testing::soup(400, 7);
  Links links;
  for (std::uint32_t i = 1; i < boxes.size(); ++i) links.push_back({i % 2 ? 0 : i, i % 2 ? i : 0});
  expect_as_in_oracle(boxes, links, {});
}

TEST(EdgeClustering, LargeStarIsLinear) {
  // A quarter of a million rounds; a round that looked at all links would make this take minutes.
  const std::uint32_t count = 250'000;
  const Boxes boxes(count, Box{{0, 0, 0}, {1, 1, 1}});
  Links links;
  for (std::uint32_t i = 1; i < count; ++i) links.push_back({0, i});
  SequentialExecutor executor;
  const Rounds rounds = run(boxes, links, {}, 0, {}, executor);
  EXPECT_EQ(rounds.merges.size(), count - 1);
  EXPECT_EQ(rounds.pairs.size(), count);  // and one that finds nothing
  EXPECT_EQ(rounds.pairs.front(), 1u);
}

}  // namespace
}  // namespace boxwood::builders
