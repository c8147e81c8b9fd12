// SPDX-License-Identifier: Apache-2.0
// A product of leaves, l1 × l2 × ..., as the tree on which the genetic operators act (paper 1, figs. 4, 6, 7).
//
// Every inner node is a × with two children. The nodes are stored in preorder in one array, so that a sub-tree is a
// range of it and the leaves, from front to back, are the factors of the product. A tree of one leaf has depth 1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/rng.hpp"

namespace kinfer {

template <class Leaf>
using TreeNode = std::optional<Leaf>;  ///< nullopt: an inner node, ×

template <class Leaf>
struct ProductTree {
  std::vector<TreeNode<Leaf>> nodes;  ///< preorder
};

struct DepthLimits {
  int min = 1, max = 5;  ///< of the whole tree, inclusive
  int max_leaves = 8;    ///< of the whole tree
};

/// One past the last node of the sub-tree that begins at `node`.
template <class Leaf>
std::size_t subtree_end(const ProductTree<Leaf>& tree, std::size_t node) {
  KINFER_EXPECT(node < tree.nodes.size());
  for (std::size_t missing = 1; missing > 0; ++node) missing += tree.nodes[node] ? -std::size_t{1} : std::size_t{1};
  return node;
}

/// Depth of each node, the root's being 1.
template <class Leaf>
std::vector<int> node_depths(const ProductTree<Leaf>& tree) {
  std::vector<int> depths, open{1};  // open: depths of the pending sub-trees, next one last
  for (const auto& node : tree.nodes) {
    depths.push_back(open.back());
    open.pop_back();
    if (!node) open.insert(open.end(), 2, depths.back() + 1);
  }
  return depths;
}

template <class Leaf>
int depth(const ProductTree<Leaf>& tree) {
  return std::ranges::max(node_depths(tree));
}

template <class Leaf>
int leaf_count(const ProductTree<Leaf>& tree) {
  return static_cast<int>((tree.nodes.size() + 1) / 2);  // a full binary tree
}

/// The factors of the product, in order.
template <class Leaf>
std::vector<Leaf> leaves(const ProductTree<Leaf>& tree) {
  std::vector<Leaf> factors;
  for (const auto& node : tree.nodes)
    if (node) factors.push_back(*node);
  return factors;
}

template <class Leaf>
ProductTree<Leaf> subtree(const ProductTree<Leaf>& tree, std::size_t node) {
  const auto begin = tree.nodes.begin();
  return {{begin + static_cast<std::ptrdiff_t>(node), begin + static_cast<std::ptrdiff_t>(subtree_end(tree, node))}};
}

/// The tree with the sub-tree at `node` replaced by `graft`.
template <class Leaf>
ProductTree<Leaf> replace_subtree(const ProductTree<Leaf>& tree, std::size_t node, const ProductTree<Leaf>& graft) {
  const auto end = static_cast<std::ptrdiff_t>(subtree_end(tree, node));
  ProductTree<Leaf> result;
  result.nodes.reserve(tree.nodes.size() + graft.nodes.size());
  result.nodes.assign(tree.nodes.begin(), tree.nodes.begin() + static_cast<std::ptrdiff_t>(node));
  result.nodes.insert(result.nodes.end(), graft.nodes.begin(), graft.nodes.end());
  result.nodes.insert(result.nodes.end(), tree.nodes.begin() + end, tree.nodes.end());
  return result;
}

/// left × right
template <class Leaf>
ProductTree<Leaf> product(const ProductTree<Leaf>& left, const ProductTree<Leaf>& right) {
  ProductTree<Leaf> result{{TreeNode<Leaf>{}}};
  for (const auto* side : {&left, &right})
    result.nodes.insert(result.nodes.end(), side->nodes.begin(), side->nodes.end());
  return result;
}

/// Reduces a sub-tree to `max_depth` levels and `max_leaves` leaves, by replacing it with a random child until it fits
/// ("if needed sub-tree depth must be reduced"). max_leaves at least 1.
template <class Leaf>
ProductTree<Leaf> reduce_tree(ProductTree<Leaf> tree, int max_depth, int max_leaves, Rng& rng) {
  while (depth(tree) > max_depth || leaf_count(tree) > max_leaves)
    tree = subtree(tree, rng.index(2) == 0 ? 1 : subtree_end(tree, 1));
  return tree;
}

/// Each node branches with this probability as long as the limits allow; full trees are rare.
constexpr double branch_probability = 0.5;

/// A random tree with leaves drawn by `leaf(rng)`.
template <class Leaf, class MakeLeaf>
ProductTree<Leaf> random_tree(int max_depth, int max_leaves, const MakeLeaf& leaf, Rng& rng) {
  if (max_depth <= 1 || max_leaves <= 1 || rng.uniform() >= branch_probability) return {{TreeNode<Leaf>{leaf(rng)}}};
  const int left_leaves = 1 + static_cast<int>(rng.index(static_cast<std::uint64_t>(max_leaves - 1)));
  const auto left = random_tree<Leaf>(max_depth - 1, left_leaves, leaf, rng);
  return product(left, random_tree<Leaf>(max_depth - 1, max_leaves - leaf_count(left), leaf, rng));
}

/// Deepens a tree below the minimum depth: its deepest leaf becomes itself × a new leaf.
template <class Leaf, class MakeLeaf>
ProductTree<Leaf> deepen_tree(ProductTree<Leaf> tree, int min_depth, const MakeLeaf& leaf, Rng& rng) {
  while (depth(tree) < min_depth) {
    const std::vector<int> depths = node_depths(tree);
    const auto deepest = static_cast<std::size_t>(std::ranges::max_element(depths) - depths.begin());
    tree =
        replace_subtree(tree, deepest, product(subtree(tree, deepest), ProductTree<Leaf>{{TreeNode<Leaf>{leaf(rng)}}}));
  }
  return tree;
}

/// The three kinds of bacterial mutation of a sub-tree (paper 1, fig. 6).
enum class SubtreeMutation {
  reparameterise,  ///< the same tree, other numbers in its leaves
  shrink,          ///< a single new leaf
  regrow           ///< a new random tree, or the old one × a new leaf
};

/// Trees as genomes: the operators of bacterial and genetic programming, for any generator of leaves with
///   Leaf random(Rng&) const, void vary(std::span<Leaf>, Rng&) const.
template <class Leaf, class Leaves>
class TreeOperators {
 public:
  using Genome = ProductTree<Leaf>;
  TreeOperators(Leaves leaves, DepthLimits limits) : leaves_(std::move(leaves)), limits_(limits) {
    KINFER_EXPECT(limits.min >= 1 && limits.max >= limits.min && limits.max_leaves >= limits.min);
  }

  Genome random(Rng rng) const {
    return deepen_tree(random_tree<Leaf>(limits_.max, limits_.max_leaves, maker(), rng), limits_.min, maker(), rng);
  }

  std::size_t part_count(const Genome& genome) const { return genome.nodes.size(); }

  Genome mutate(const Genome& genome, std::size_t node, Rng rng) const {
    return insert_subtree(genome, node, mutated_subtree(genome, node, static_cast<SubtreeMutation>(rng.index(3)), rng),
                          rng);
  }

  Genome transfer(const Genome& from, std::size_t part, const Genome& to, std::size_t node, Rng rng) const {
    return insert_subtree(to, node, subtree(from, part), rng);
  }

  /// The sub-tree at `node`, mutated.
  Genome mutated_subtree(const Genome& genome, std::size_t node, SubtreeMutation how, Rng& rng) const {
    if (how == SubtreeMutation::shrink) return {{TreeNode<Leaf>{leaves_.random(rng)}}};
    Genome tree = subtree(genome, node);
    if (how == SubtreeMutation::regrow) return regrow_subtree(tree, rng);
    std::vector<Leaf> factors = leaves(tree);
    leaves_.vary(std::span<Leaf>(factors), rng);
    auto next = factors.begin();
    for (auto& place : tree.nodes)
      if (place) place = *next++;
    return tree;
  }

 private:
  auto maker() const {
    return [this](Rng& rng) { return leaves_.random(rng); };
  }

  Genome regrow_subtree(const Genome& old, Rng& rng) const {
    if (rng.index(2) == 0) return random_tree<Leaf>(limits_.max, limits_.max_leaves, maker(), rng);
    const Genome leaf{{TreeNode<Leaf>{leaves_.random(rng)}}};
    return rng.index(2) == 0 ? product(leaf, old) : product(old, leaf);
  }

  /// The genome with `graft` in place of the sub-tree at `node`, reduced or deepened to the limits.
  Genome insert_subtree(const Genome& genome, std::size_t node, const Genome& graft, Rng& rng) const {
    const int others = leaf_count(genome) - leaf_count(subtree(genome, node));
    const int levels = limits_.max - node_depths(genome)[node] + 1;
    return deepen_tree(replace_subtree(genome, node, reduce_tree(graft, levels, limits_.max_leaves - others, rng)),
                       limits_.min, maker(), rng);
  }

  Leaves leaves_;
  DepthLimits limits_;
};

}  // namespace kinfer
