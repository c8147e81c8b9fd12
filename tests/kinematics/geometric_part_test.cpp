// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/geometric_part.hpp"

#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "support/random_field.hpp"

namespace kinfer {
namespace {

TEST(GeometricPart, FramesAreKeptAndGainsAreLeftOut) {
  const Chain reference = laws::dh_with_prismatic();
  Chain corrected = reference;
  corrected.tool.xyz.x() += 0.01;
  std::get<DhLink>(corrected.joints[1].link).a += 0.001;
  corrected.joints[1].gain = 1.01;  // a prismatic joint: 1 % of its position, along a straight line
  MatrixXd q = MatrixXd::Zero(4, 2);
  q(1, 0) = 0.5, q(1, 1) = -0.2;
  const GeometricPart part = geometric_part(corrected, reference, q);
  ASSERT_EQ(part.differences.size(), 1U);
  EXPECT_EQ(part.differences[0].kind, NonGeometricKind::gain);
  EXPECT_EQ(part.differences[0].joints, 1);
  EXPECT_NEAR(part.differences[0].max, 0.005, 1e-12);
  EXPECT_NEAR(part.differences[0].rms, std::sqrt((0.005 * 0.005 + 0.002 * 0.002) / 2), 1e-12);
  corrected.joints[1].gain = 1.0;
  EXPECT_LT((forward(part.chain, q.col(0)).position - forward(corrected, q.col(0)).position).norm(), 1e-15);
}

TEST(GeometricPart, NothingIsLeftOutOfARigidChain) {
  const Chain chain = laws::coupled();
  EXPECT_TRUE(geometric_part(chain, chain, MatrixXd::Zero(dof(chain), 1)).differences.empty());
}

TEST(GeometricPart, EveryKindIsNamed) {
  const Chain reference = laws::compliant();
  Chain corrected = reference;
  corrected.joints[0].harmonics = {{.order = 1, .sine = 1e-3, .cosine = 0}};
  corrected.joints[1].compliance *= 2;
  corrected.joints[2].backlash = 1e-4;
  corrected.joints[3].torque_compliance = 1e-6;
  corrected.joints[4].couplings = {{0, 0.01}};
  corrected.expansion = 1e-5;
  corrected.field = test::random_field(6, 3, Rng(1));
  std::string names;
  for (const auto& difference : geometric_part(corrected, reference, MatrixXd::Constant(6, 1, 0.3)).differences) {
    names += std::string(name(difference.kind)) + " ";
    EXPECT_EQ(difference.max > 0.0, !difference.depends_on_load) << names;
  }
  EXPECT_EQ(names, "coupling compliance torque_compliance backlash harmonics expansion field ");
}

}  // namespace
}  // namespace kinfer
