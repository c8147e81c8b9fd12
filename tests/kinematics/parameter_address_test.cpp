// SPDX-License-Identifier: Apache-2.0
// Laws of the numbers of a chain: each has a place, a name and a dimension of its own.
#include "kinfer/kinematics/parameter_address.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

/// A machine with every kind of number.
Chain chain_with_everything() {
  Chain chain = laws::urdf_arm();
  chain.joints[2].link = DhLink{{0.1, 0.2, 0.3, 0.4, 0.5}};
  chain.joints[6].link = MdhLink{{0.6, 0.7, 0.8, 0.9, 1.0}};
  chain.joints[1].harmonics = {{1.0, 0.01, 0.02}, {2.0, 0.03, 0.04}};
  chain.joints[5].couplings = {{1, 0.1}, {2, 0.2}};
  chain.targets = {{"left", Vec3(1, 2, 3)}, {"right", Vec3(4, 5, 6)}};
  chain.mountings = {{.name = "bench", .base = Frame{}, .tool = {}}, {.name = "wall", .base = Frame{}, .tool = {}}};
  chain.fixtures.anchors = {Vec3(1, 0, 0), Vec3(0, 1, 0)};
  chain.fixtures.sockets = {{"ball", Vec3(1, 1, 0)}};
  chain.fixtures.planes = {{.name = "table"}, {.name = "side"}};
  chain.fixtures.stations = {{.name = "mast"}};
  return chain;
}

std::vector<ParameterAddress> every_address(const Chain& chain) {
  std::vector<ParameterAddress> all = non_geometric_addresses(chain);
  for (const ParameterSet& set : {all_parameters(chain, {}), setup_parameters(chain, {})})
    for (const Parameter& p : set.parameters)
      if (std::ranges::find(all, p.at) == all.end()) all.push_back(p.at);
  for (const Field field : {Field::x, Field::y, Field::z}) all.push_back(GravityNumber{field});
  return all;
}

TEST(ParameterAddresses, EachIsAPlaceOfItsOwn) {
  const Chain chain = chain_with_everything();
  const auto all = every_address(chain);
  EXPECT_GT(all.size(), 110u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Chain changed = chain;
    set_value_at(changed, all[i], 1234.5);
    for (std::size_t k = 0; k < all.size(); ++k)
      EXPECT_EQ(value_at(changed, all[k]), k == i ? 1234.5 : value_at(chain, all[k]))
          << name_of(chain, all[i]) << " and " << name_of(chain, all[k]);
  }
}

TEST(ParameterAddresses, EachHasANameOfItsOwn) {
  const Chain chain = chain_with_everything();
  std::set<std::string> names;
  for (const ParameterAddress& at : every_address(chain)) {
    const std::string name = name_of(chain, at);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(name.find(' '), std::string::npos) << name;
  }
  for (const char* name : {"base_x@wall", "target_right_z", "socket_ball_x", "plane_side_offset", "anchor2_y",
                           "station_mast_rz", "sin2q2", "coupling6_3", "gravity_z", "expansion"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(ParameterAddresses, BelongToAJointAFrameAnObjectOrTheWholeRobot) {
  const Chain chain = chain_with_everything();
  for (const ParameterAddress& at : every_address(chain)) {
    const bool is_whole = std::holds_alternative<GravityNumber>(at) || std::holds_alternative<ExpansionNumber>(at);
    EXPECT_EQ(is_joint_parameter(at) + is_frame_parameter(at) + is_object_parameter(at) + is_whole, 1)
        << name_of(chain, at);
    EXPECT_EQ(joint_number(at) != nullptr, is_joint_parameter(at));
    EXPECT_EQ(is_own_frame_parameter(at, SetupFrame::base) || is_own_frame_parameter(at, SetupFrame::tool),
              is_frame_parameter(at) && name_of(chain, at).find('@') == std::string::npos)
        << name_of(chain, at);
  }
}

/// Dimensional analysis: in a machine with all lengths doubled, and angles as they were, all distances double.
TEST(Quantities, AreTheDimensionsThatKinematicsNeeds) {
  for (Chain chain : {laws::er20_with_errors(), laws::coupled(), laws::dh_with_prismatic(), laws::urdf_arm()}) {
    Chain large = chain;
    for (const ParameterAddress& at : every_address(chain))
      if (quantity_of(at) == Quantity::length) set_value_at(large, at, 2.0 * value_at(chain, at));
    const VectorXd q = laws::random_q(chain, Rng(3));
    VectorXd large_q = q;
    const std::vector<int> active = active_joints(chain);
    for (std::size_t k = 0; k < active.size(); ++k)
      if (translates(chain.joints[static_cast<std::size_t>(active[k])].type)) large_q[static_cast<int>(k)] *= 2.0;
    const Pose small = forward(chain, q), grown = forward(large, large_q);
    EXPECT_LT((grown.rotation - small.rotation).norm(), 1e-12) << chain.name;
    EXPECT_LT((grown.position - 2.0 * small.position).norm(), 1e-12) << chain.name;
  }
}

TEST(Quantities, AFullTurnOfAnAngleOfARowChangesNothing) {
  const Chain chain = laws::dh_with_prismatic();
  const VectorXd q = laws::random_q(chain, Rng(4));
  const Pose before = forward(chain, q);
  for (const ParameterAddress& at : every_address(chain)) {
    const JointNumber* number = joint_number(at);
    if (!number || quantity_of(at) != Quantity::angle || number->field == Field::backlash) continue;
    Chain turned = chain;
    set_value_at(turned, at, value_at(chain, at) + 2.0 * std::numbers::pi);
    const Pose after = forward(turned, q);
    EXPECT_LT((after.position - before.position).norm() + (after.rotation - before.rotation).norm(), 1e-12)
        << name_of(chain, at);
  }
}

TEST(Quantities, EachHasAUnitOfItsOwn) {
  std::set<std::string_view> units;
  for (const Quantity quantity : {Quantity::length, Quantity::angle, Quantity::ratio, Quantity::compliance,
                                  Quantity::expansion, Quantity::acceleration})
    EXPECT_TRUE(units.insert(unit(quantity)).second) << unit(quantity);
}

TEST(FieldsOf, AFixtureAreTheNumbersThatItHas) {
  Chain chain = chain_with_everything();
  for_each_fixture_list(chain.fixtures, [&](const auto& row, const auto& list) {
    const FixtureKind kind = fixture_kind(row.kind);
    for (int i = 0; i < static_cast<int>(list.size()); ++i)
      for (const Field field : fields_of(list[static_cast<std::size_t>(i)])) {
        const FixtureNumber at{kind, i, field};
        EXPECT_EQ(field_of(at), field);
        EXPECT_EQ(quantity_of(at) == Quantity::angle, is_rotation(field)) << name_of(chain, at);
        Chain changed = chain;
        set_value_at(changed, at, 0.75);
        EXPECT_EQ(value_at(changed, at), 0.75) << name_of(chain, at);
      }
  });
  EXPECT_DEATH(value_at(chain, FixtureNumber{fixture_kind("plane"), 0, Field::x}), "a plane has no x");
  EXPECT_DEATH(value_at(chain, FixtureNumber{fixture_kind("socket"), 1, Field::x}), "entry 1 of 1");
}

}  // namespace
}  // namespace kinfer
