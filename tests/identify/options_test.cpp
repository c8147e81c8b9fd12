// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/options.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace kinfer {
using namespace identify;
namespace {

std::string complaint(const IdentifyOptions& options) {
  const auto checked = check(options);
  return checked ? "" : checked.error().what;
}

std::string described(const IdentifyOptions& options, const std::string& name) {
  const auto list = describe(options);
  const auto at = std::ranges::find(list, name, &std::pair<std::string, std::string>::first);
  return at == list.end() ? "(no effect)" : at->second;
}

TEST(IdentifyOptions, TheDefaultsAreValid) {
  EXPECT_EQ(complaint({}), "");
}

TEST(IdentifyOptions, ValuesOutOfRangeAreRefusedByName) {
  EXPECT_EQ(complaint({.motion = {.smoothing = 2.0}}), "--smoothing 2: expected 0 .. 1 s");
  EXPECT_EQ(complaint({.engine = BacterialProgramming{.depth = {.min = 4, .max = 2}}}),
            "--max-depth 2: less than --min-depth 4");
  EXPECT_EQ(complaint({.engine = BacterialProgramming{.depth = {.min = 4, .max = 5, .max_leaves = 3}}}),
            "--max-leaves 3: too few for --min-depth 4");
}

TEST(IdentifyOptions, WhatOnlyTheRefinementUsesIsRefusedWithoutIt) {
  IdentifyOptions graded{.geometry = GeometrySource::searched};
  graded.refine.grade = sensor_grade("noise");
  EXPECT_EQ(complaint(graded), "--grade has no effect with --geometry searched");
  IdentifyOptions taped{.geometry = GeometrySource::searched};
  taped.refine.facts.tapes.push_back({"ins0-ins1", "ins1-ins2", 1.0, 1e-3, {}});
  EXPECT_EQ(complaint(taped), "--facts has no effect with --geometry searched");
}

TEST(IdentifyOptions, AreDescribedByThoseThatHaveAnEffect) {
  EXPECT_EQ(described({}, "--engine"), "bmp");
  EXPECT_EQ(described({}, "--individuals"), "10");
  EXPECT_EQ(described({}, "--max-depth"), "(no effect)");
  const IdentifyOptions paper{.engine = BacterialProgramming{.terminals = JointVariableKind::euler},
                              .geometry = GeometrySource::searched};
  EXPECT_EQ(described(paper, "--engine"), "bp");
  EXPECT_EQ(described(paper, "--terminals"), "euler");
  EXPECT_EQ(described(paper, "--individuals"), "100");
  EXPECT_EQ(described(paper, "--max-leaves"), "8");
  EXPECT_EQ(described(paper, "--grade"), "(no effect)");
  EXPECT_EQ(described({.engine = Enumeration{.rows = 50}}, "--rows"), "50");
  EXPECT_EQ(described({.engine = Enumeration{}}, "--generations"), "(no effect)");
}

TEST(IdentifyOptions, GivenLinksAreDescribedAsTheyAreGiven) {
  EXPECT_EQ(described({.tree = {{"ins0", "ins1"}, {"ins1", "left-arm"}}}, "--tree"), "ins0-ins1,ins1:left-arm");
  EXPECT_EQ(described({.sensors = {"a", "b"}}, "--sensors"), "a,b");
}

TEST(IdentifyOptions, WhatAnUpdateTakesFromTheOlderChainIsRefused) {
  IdentifyOptions update;
  update.refine.known = TrackingModel{};
  EXPECT_EQ(complaint(update), "");
  EXPECT_EQ(described(update, "--engine"), "(no effect)");
  IdentifyOptions with_tree = update, with_root = update, with_zero = update, searched = update;
  with_tree.tree = {{"a", "b"}};
  with_root.root = "a";
  with_zero.refine.zeros = {{.joint = "a-b"}};
  searched.geometry = GeometrySource::searched;
  EXPECT_EQ(complaint(with_tree), "--tree has no effect with --update, which keeps that of the chain");
  EXPECT_EQ(complaint(with_root), "--root has no effect with --update, which keeps that of the chain");
  EXPECT_EQ(complaint(with_zero), "--zero has no effect with --update, which keeps that of the chain");
  EXPECT_NE(complaint(searched), "");
}

}  // namespace
}  // namespace kinfer
