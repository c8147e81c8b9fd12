// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/initial_frames.hpp"

#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

/// Two parallel axes that turn against each other: the tool keeps its orientation, and nothing shows where its point
/// is. The file's own is kept then, whatever the noise.
TEST(InitialFrames, AToolThatThePosesDoNotShowIsThatOfTheFile) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Chain chain;
    for (int k = 0; k < 2; ++k) {
      Joint joint;
      joint.name = "J" + std::to_string(k + 1), joint.parent = k - 1;
      DhLink link;
      link.a = 0.4 - 0.1 * k;
      joint.link = link;
      chain.joints.push_back(joint);
    }
    chain.tool.xyz = {0.02, 0.01, 0.05};
    Rng rng(seed);
    PoseSet data;
    data.joints.resize(2, 40);
    for (int row = 0; row < 40; ++row) {
      const double q = rng.uniform(-2.0, 2.0);
      data.joints.col(row) << q, -q;
      Vec3 noise;
      for (double& value : noise) value = 2e-5 * rng.normal();
      data.points.push_back({.row = row, .position = forward(chain, VectorXd(data.joints.col(row))).position + noise});
    }
    const auto found = calibrate::with_estimated_frames(chain, data);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_LT((found->tool.xyz - chain.tool.xyz).norm(), 1e-3) << "seed " << seed;
  }
}

}  // namespace
}  // namespace kinfer
