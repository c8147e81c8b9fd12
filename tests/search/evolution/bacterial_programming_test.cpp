// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/evolution/bacterial_programming.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "kinfer/search/evolution/genetic_programming.hpp"
#include "kinfer/search/evolution/product_tree.hpp"

namespace kinfer {
namespace {

/// Affine maps x -> scale x + shift: a product that, like DH matrices, depends on the order of its leaves.
struct Affine {
  double scale = 1.0, shift = 0.0;
};
struct AffineLeaves {
  Affine random(Rng& rng) const { return {rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0)}; }
  void vary(std::span<Affine> leaves, Rng& rng) const {
    const double size = std::pow(10.0, rng.uniform(-5.0, 0.0));
    for (Affine& leaf : leaves) leaf = {leaf.scale + size * rng.normal(), leaf.shift + size * rng.normal()};
  }
};
using AffineTree = ProductTree<Affine>;
using AffineBreed = TreeOperators<Affine, AffineLeaves>;

/// Distance of the product from x -> 0.7 x + 3.1, which one leaf with a shift of at most 2 cannot reach.
double distance_from_target(const AffineTree& tree, double /*bound*/) {
  Affine all;
  for (const Affine& leaf : leaves(tree)) all = {all.scale * leaf.scale, all.scale * leaf.shift + all.shift};
  return std::hypot(all.scale - 0.7, all.shift - 3.1) + 1e-9 * leaf_count(tree);
}

/// Bit strings: another genome, whose parts are its bits.
struct BitBreed {
  using Genome = std::vector<bool>;
  Genome random(Rng rng) const {
    Genome bits(64);
    for (auto bit : bits) bit = rng.index(2) == 1;
    return bits;
  }
  std::size_t part_count(const Genome& bits) const { return bits.size(); }
  Genome mutate(Genome bits, std::size_t part, Rng rng) const {
    bits[part] = rng.index(2) == 1;
    return bits;
  }
  Genome transfer(const Genome& from, std::size_t part, Genome to, std::size_t, Rng) const {
    to[part] = from[part];
    return to;
  }
};

bool is_within(const AffineTree& tree, const DepthLimits& limits) {
  return subtree_end(tree, 0) == tree.nodes.size() && depth(tree) >= limits.min && depth(tree) <= limits.max &&
         leaf_count(tree) <= limits.max_leaves;
}

TEST(ProductTree, EveryOperationKeepsToTheDepthLimits) {
  for (const DepthLimits limits :
       {DepthLimits{1, 5, 8}, DepthLimits{2, 3, 3}, DepthLimits{1, 1, 1}, DepthLimits{3, 5, 16}}) {
    const AffineBreed breed({}, limits);
    Rng rng(3);
    AffineTree tree = breed.random(Rng(7));
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const AffineTree other = breed.random(rng.stream(i));
      ASSERT_TRUE(is_within(other, limits));
      const std::size_t part = rng.index(breed.part_count(other)), node = rng.index(breed.part_count(tree));
      tree = breed.transfer(other, part, tree, node, rng.stream(i));
      ASSERT_TRUE(is_within(tree, limits));
      tree = breed.mutate(tree, rng.index(breed.part_count(tree)), rng.stream(i));
      ASSERT_TRUE(is_within(tree, limits));
    }
  }
}

TEST(ProductTree, TheSubTreesOfABranchAreItsChildren) {
  const AffineTree a{{Affine{1, 0}}}, b{{Affine{2, 0}}}, c{{Affine{3, 0}}};
  const AffineTree tree = product(product(a, b), c);
  EXPECT_EQ(depth(tree), 3);
  EXPECT_THAT(node_depths(tree), testing::ElementsAre(1, 2, 3, 3, 2));
  EXPECT_EQ(subtree_end(tree, 1), 4u);
  const AffineTree turned = replace_subtree(tree, 1, c);
  ASSERT_EQ(leaf_count(turned), 2);
  EXPECT_EQ(leaves(turned)[0].scale, 3.0);
}

TEST(ProductTree, EachMutationDoesWhatItsNameSays) {
  const AffineBreed breed({}, {});
  const AffineTree tree =
      product(product(AffineTree{{Affine{1, 0}}}, AffineTree{{Affine{2, 0}}}), AffineTree{{Affine{3, 0}}});
  Rng rng(1);
  EXPECT_EQ(breed.mutated_subtree(tree, 0, SubtreeMutation::reparameterise, rng).nodes.size(), 5u);
  EXPECT_EQ(breed.mutated_subtree(tree, 0, SubtreeMutation::shrink, rng).nodes.size(), 1u);
  std::size_t largest = 0;
  for (int i = 0; i < 50; ++i)
    largest = std::max(largest, breed.mutated_subtree(tree, 4, SubtreeMutation::regrow, rng).nodes.size());
  EXPECT_GT(largest, 3u);
}

TEST(BacterialProgramming, FindsAProductThatNoSingleLeafIs) {
  const auto outcome = evolve_bacteria(AffineBreed({}, {}), GenomeCost<AffineTree>(distance_from_target),
                                       {.individuals = 20, .generations = 60}, Rng(1));
  EXPECT_LT(outcome.cost, 1e-3);
}

TEST(BacterialProgramming, TheBestNeverGetsWorseAndTheCounterCountsEveryEvaluation) {
  std::atomic<std::int64_t> calls = 0;
  const GenomeCost<AffineTree> cost = [&](const AffineTree& tree, double bound) {
    ++calls;
    return distance_from_target(tree, bound);
  };
  for (const Pairing pairing : {Pairing::halves, Pairing::mirrored}) {
    calls = 0;
    const auto outcome =
        evolve_bacteria(AffineBreed({}, {}), cost, {.individuals = 9, .generations = 12, .pairing = pairing}, Rng(2));
    EXPECT_EQ(outcome.evaluations, calls);
    EXPECT_EQ(outcome.best_history.size(), 13u);
    EXPECT_TRUE(std::ranges::is_sorted(outcome.best_history, std::greater<>()));
    EXPECT_EQ(outcome.stop, Stop::budget_spent);
  }
}

TEST(BacterialProgramming, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    return evolve_bacteria(AffineBreed({}, {}), GenomeCost<AffineTree>(distance_from_target),
                           {.individuals = 15, .generations = 20, .threads = threads}, Rng(5));
  };
  const auto one = run(1);
  for (const int threads : {2, 7}) {
    const auto many = run(threads);
    EXPECT_EQ(one.best_history, many.best_history);
    EXPECT_EQ(one.median_history, many.median_history);
  }
}

TEST(BacterialProgramming, StoppingEvaluationsAboveTheBoundChangesNothing) {
  const GenomeCost<AffineTree> impatient = [](const AffineTree& tree, double bound) {
    const double cost = distance_from_target(tree, bound);
    return cost < bound ? cost : unbounded;
  };
  const BacterialOptions options{.individuals = 15, .generations = 20};
  EXPECT_EQ(
      evolve_bacteria(AffineBreed({}, {}), impatient, options, Rng(5)).best_history,
      evolve_bacteria(AffineBreed({}, {}), GenomeCost<AffineTree>(distance_from_target), options, Rng(5)).best_history);
}

TEST(BacterialProgramming, WorksOnAnyGenome) {
  const GenomeCost<BitBreed::Genome> zeros = [](const BitBreed::Genome& bits, double) {
    return static_cast<double>(std::ranges::count(bits, false));
  };
  const auto outcome =
      evolve_bacteria(BitBreed{}, zeros, {.individuals = 10, .generations = 500, .target_cost = 0.0}, Rng(1));
  EXPECT_EQ(outcome.stop, Stop::target_reached);
}

TEST(BacterialProgramming, NonFiniteCostsNeverWin) {
  const GenomeCost<BitBreed::Genome> cost = [](const BitBreed::Genome& bits, double) {
    return bits[0] ? std::nan("") : static_cast<double>(std::ranges::count(bits, false));
  };
  const auto outcome = evolve_bacteria(BitBreed{}, cost, {.individuals = 10, .generations = 20}, Rng(1));
  EXPECT_FALSE(outcome.best[0]);
  EXPECT_LT(outcome.cost, 64.0);
}

TEST(BacterialProgramming, StopsWhenTheObserverRequests) {
  const auto outcome = evolve_bacteria(
      BitBreed{}, GenomeCost<BitBreed::Genome>([](const auto&, double) { return 1.0; }), {}, Rng(1),
      [](const Progress& p) { return p.iteration < 3 ? ObserverDecision::proceed : ObserverDecision::stop; });
  EXPECT_EQ(outcome.stop, Stop::cancelled);
  EXPECT_EQ(outcome.generations, 3);
}

TEST(GeneticProgramming, FindsTheProductTooAndGivesTheSameBitsForAnyNumberOfThreads) {
  const auto run = [](int threads) {
    return evolve_by_crossover(AffineBreed({}, {}), GenomeCost<AffineTree>(distance_from_target),
                               {.individuals = 50, .generations = 100, .threads = threads}, Rng(1));
  };
  const auto one = run(1);
  EXPECT_LT(one.cost, 0.05);
  EXPECT_TRUE(std::ranges::is_sorted(one.best_history, std::greater<>()));
  EXPECT_EQ(one.best_history, run(7).best_history);
}

}  // namespace
}  // namespace kinfer
