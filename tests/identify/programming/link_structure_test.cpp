// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_structure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "identify/example_machine.hpp"
#include "kinfer/identify/programming/structure_fit.hpp"

namespace kinfer {
using namespace identify;
namespace {

using enum AngleKind;

TEST(LinkStructure, HasASignatureOfItsOwn) {
  std::set<std::uint32_t> keys;
  const auto all = enumerate_structures(3);
  for (const LinkStructure& s : all) keys.insert(signature(s));
  EXPECT_EQ(keys.size(), all.size());
  EXPECT_EQ(keys.count(signature({})), 0U);
  EXPECT_NE(signature({{{}}}), signature({{{}, {}}})) << "leaves of zeros count";
}

TEST(LinkStructure, CountsItsConstantsAndLengths) {
  EXPECT_EQ(constant_count(revolute_structure()), 5);
  EXPECT_EQ(parameter_count(revolute_structure()), 11);  // d of the last two leaves is one number too many
  EXPECT_EQ(constant_count({{{zero, signal}}}), 0);
  EXPECT_EQ(parameter_count({{{zero, signal}}}), 2);
  for (const AngleKind kind : {zero, constant, signal, offset_signal}) {
    EXPECT_EQ(has_constant(kind), kind == constant || kind == offset_signal);
    EXPECT_EQ(constant_count({{{kind, zero}}}), has_constant(kind) ? 1 : 0);
    EXPECT_EQ(uses_signal_once({{{kind, zero}}}), kind == signal || kind == offset_signal);
  }
  EXPECT_FALSE(uses_signal_once({{{signal, offset_signal}}}));
}

TEST(LinkStructure, IsDisplayedLeafByLeaf) {
  EXPECT_EQ(text(revolute_structure()), "theta c alpha c | theta q+c alpha c | theta c alpha 0");
  EXPECT_EQ(text({{{signal, zero}}}), "theta q alpha 0");
}

TEST(LinkStructure, EveryStructureIsReachedFromTheSimplestByNeighbours) {
  std::map<std::uint32_t, LinkStructure> reached, border{{signature({{{signal, zero}}}), {{{signal, zero}}}}};
  while (!border.empty()) {
    reached.insert(border.begin(), border.end());
    std::map<std::uint32_t, LinkStructure> next;
    for (const auto& [key, structure] : border)
      for (const LinkStructure& other : neighbour_structures(structure))
        if (!reached.contains(signature(other))) next.emplace(signature(other), other);
    border = std::move(next);
  }
  EXPECT_EQ(reached.size(), enumerate_structures(3).size());
}

TEST(LinkStructure, ANeighbourHasAtMostOneLeafMoreOrLess) {
  for (const LinkStructure& s : enumerate_structures(2))
    for (const LinkStructure& other : neighbour_structures(s)) {
      EXPECT_LE(std::max(s.leaves.size(), other.leaves.size()) - std::min(s.leaves.size(), other.leaves.size()), 1U);
      EXPECT_LE(std::abs(parameter_count(s) - parameter_count(other)), 4) << text(s) << " -> " << text(other);
    }
}

TEST(LinkStructure, ARandomOneDependsOnItsSeedOnly) {
  const StructureOperators operators;
  std::set<std::uint32_t> drawn;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    EXPECT_EQ(operators.random(Rng(seed)), operators.random(Rng(seed)));
    drawn.insert(signature(operators.random(Rng(seed))));
  }
  EXPECT_GT(drawn.size(), 60U);
}

TEST(LinkStructure, TransferPutsTheLeafIntoItsPlace) {
  const StructureOperators operators;
  const LinkStructure from{{{constant, constant}, {zero, signal}}}, to{{{signal, zero}, {constant, zero}}};
  EXPECT_EQ(operators.part_count(to), 2U);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(operators.transfer(from, 0, to, 1, Rng(seed)), (LinkStructure{{{signal, zero}, {constant, constant}}}));
    const LinkStructure both = operators.transfer(from, 1, to, 1, Rng(seed));  // two signals: one of them is dropped
    EXPECT_TRUE(both == (LinkStructure{{{signal, zero}, {zero, zero}}}) ||
                both == (LinkStructure{{{zero, zero}, {zero, signal}}}))
        << text(both);
  }
}

TEST(LinkStructure, AllFormsOfTheGeneralRevoluteJointFitItExactly) {
  const JointSignal hinge = test::wave(0.6, 0.9, 1.0);
  const auto parent = test::swinging_parent(test::wave(0.5, 0.7, 0.3));
  const auto child = propagate(parent, test::general_hinge(), {&hinge, 1});
  const StructureFitter fitter(parent, child, {&hinge, 1}, test::all_rows(600), {.length_prior = 1e-6});
  for (const LinkStructure& structure : revolute_structures()) {
    EXPECT_TRUE(uses_signal_once(structure));
    EXPECT_LT(fitter.fit(structure).j, 1e-4) << text(structure);
  }
  EXPECT_GT(fitter.fit({{{signal, constant}}}).j, 0.1) << "one leaf is no general joint";
  EXPECT_GT(fitter.effective_sample_count(), 1.0);
  EXPECT_LT(fitter.effective_sample_count(), 600.0) << "a smooth motion repeats itself";
}

}  // namespace
}  // namespace kinfer
