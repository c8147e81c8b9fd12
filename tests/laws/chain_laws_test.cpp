// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "laws/slow_chain.hpp"

namespace kinfer {
namespace {

using laws::Mat4;

constexpr Load load{.payload = 12.0};
constexpr double rounding = 1e-13;         // [m], [1]
constexpr double torque_rounding = 1e-11;  // [m] deflections by the numeric torques of the reference
constexpr double difference = 1e-7;        // relative to the largest entry of the column

Mat4 matrix(const Pose& pose) {
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = pose.rotation;
  m.topRightCorner<3, 1>() = pose.position;
  return m;
}

double distance(const Mat4& a, const Mat4& b) {
  return (a - b).cwiseAbs().maxCoeff();
}
double distance(const Pose& a, const Pose& b) {
  return distance(matrix(a), matrix(b));
}

/// Twist that leads from one pose to another, divided by `step`.
Eigen::Matrix<double, 6, 1> twist_rate(const Mat4& from, const Mat4& to, double step) {
  Eigen::Matrix<double, 6, 1> twist;
  twist.head<3>() = (to - from).topRightCorner<3, 1>() / step;
  twist.tail<3>() = log_so3(to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose()) / step;
  return twist;
}

class ChainLaws : public testing::TestWithParam<Chain> {
 protected:
  const Chain& chain() const { return GetParam(); }
  ParameterSet parameters() const { return all_parameters(chain(), {}); }

  template <class Law>
  void at_random_poses(Law&& law) const {
    for (std::uint64_t k = 0; k < 20; ++k) law(laws::random_q(chain(), Rng(6).stream(k)));
  }
};

TEST_P(ChainLaws, ForwardIsTheProductOfThePrintedMatrices) {
  at_random_poses([&](const VectorXd& q) {
    const Mat4 slow = laws::slow_tool(chain(), q, laws::slow_torques(chain(), q, load.payload));
    EXPECT_LT(distance(matrix(forward(chain(), q, load)), slow), torque_rounding);
  });
}

TEST_P(ChainLaws, EveryJointFrameIsTheProductOfThePrintedMatrices) {
  at_random_poses([&](const VectorXd& q) {
    const VectorXd torques = laws::slow_torques(chain(), q, load.payload);
    const std::vector<Pose> frames = joint_frames(chain(), q, load);
    ASSERT_EQ(frames.size(), chain().joints.size());
    for (int j = 0; j < static_cast<int>(frames.size()); ++j) {
      EXPECT_LT(distance(matrix(frames[j]), laws::slow_joint(chain(), j, q, torques)), torque_rounding)
          << "joint " << j;
    }
  });
}

TEST_P(ChainLaws, TorqueOfGravityIsTheSlopeOfThePotentialEnergy) {
  at_random_poses([&](const VectorXd& q) {
    const VectorXd fast = gravity_torques(chain(), q, load), slow = laws::slow_torques(chain(), q, load.payload);
    ASSERT_EQ(fast.size(), slow.size());
    for (Eigen::Index j = 0; j < fast.size(); ++j) EXPECT_NEAR(fast[j], slow[j], 1e-6) << "joint " << j;
  });
}

TEST_P(ChainLaws, TheEvaluatorAgreesWithForward) {
  const PoseEvaluator all(chain(), parameters()), none(chain(), with_only_free(parameters(), {}));
  Twists twists;
  at_random_poses([&](const VectorXd& q) {
    const Pose expected = forward(chain(), q, load);
    EXPECT_LT(distance(all.pose(q, load), expected), rounding);
    EXPECT_LT(distance(all.pose_and_derivative(q, load, twists), expected), rounding);
    EXPECT_LT(distance(none.pose_and_derivative(q, load, twists), expected), rounding);
    EXPECT_EQ(twists.cols(), 0);
  });
}

TEST_P(ChainLaws, JacobianIsTheSlopeOfForwardWithConstantTorques) {
  at_random_poses([&](const VectorXd& q) {
    const Twists twists = jacobian(chain(), q, load);
    const VectorXd torques = gravity_torques(chain(), q, load);
    ASSERT_EQ(twists.cols(), dof(chain()));
    constexpr double h = 1e-6;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const VectorXd step = h * VectorXd::Unit(q.size(), k);
      const auto slope =
          twist_rate(laws::slow_tool(chain(), q - step, torques), laws::slow_tool(chain(), q + step, torques), 2 * h);
      EXPECT_LT((twists.col(k) - slope).cwiseAbs().maxCoeff(), difference * (1 + slope.norm())) << "reading " << k;
    }
  });
}

TEST_P(ChainLaws, DerivativeByEveryParameterIsTheSlopeWithConstantTorques) {
  const ParameterSet set = parameters();
  const PoseEvaluator evaluator(chain(), set);
  Twists twists;
  at_random_poses([&](const VectorXd& q) {
    evaluator.pose_and_derivative(q, load, twists);
    const VectorXd torques = gravity_torques(chain(), q, load);
    const VectorXd x = pack(set, chain());
    ASSERT_EQ(twists.cols(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double h = 1e-6 / std::max(1.0, twists.col(i).norm());  // moves the tool by some 1e-6
      const VectorXd step = h * VectorXd::Unit(x.size(), i);
      const auto slope = twist_rate(laws::slow_tool(unpack(set, chain(), x - step), q, torques),
                                    laws::slow_tool(unpack(set, chain(), x + step), q, torques), 2 * h);
      EXPECT_LT((twists.col(i) - slope).cwiseAbs().maxCoeff(), difference * (1 + slope.norm()))
          << set.parameters[i].name << "\n"
          << twists.col(i).transpose() << "\n"
          << slope.transpose();
    }
  });
}

TEST_P(ChainLaws, ColumnsFollowTheFreeParametersWhateverIsFree) {
  const ParameterSet all = parameters();
  const PoseEvaluator evaluator(chain(), all);
  Twists every, some;
  at_random_poses([&](const VectorXd& q) {
    evaluator.pose_and_derivative(q, load, every);
    for (const int stride : {1, 2, 5, 7}) {
      ParameterSet set = all;
      std::vector<Eigen::Index> kept;
      for (std::size_t i = 0; i < set.parameters.size(); ++i) {
        set.parameters[i].free = i % stride == 0;
        if (i % stride == 0) kept.push_back(static_cast<Eigen::Index>(i));
      }
      PoseEvaluator(chain(), set).pose_and_derivative(q, load, some);
      ASSERT_EQ(some.cols(), set.free_count());
      for (std::size_t c = 0; c < kept.size(); ++c) {
        EXPECT_LT((some.col(static_cast<Eigen::Index>(c)) - every.col(kept[c])).norm(), 1e-12 * (1 + every.norm()));
      }
    }
  });
}

TEST_P(ChainLaws, PackingAndUnpackingLoseNothing) {
  const ParameterSet set = parameters();
  const VectorXd nominal = pack(set, chain());
  const Chain same = unpack(set, chain(), nominal);
  at_random_poses(
      [&](const VectorXd& q) { EXPECT_EQ(distance(forward(same, q, load), forward(chain(), q, load)), 0.0); });
  VectorXd x = nominal;
  Rng rng(3);
  for (double& value : x) value += rng.normal();
  EXPECT_EQ(pack(set, unpack(set, chain(), x)), x);
}

TEST_P(ChainLaws, NominalValuesAreThoseOfTheChain) {
  const ParameterSet set = parameters();
  const VectorXd x = pack(set, chain());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    EXPECT_EQ(set.parameters[i].nominal, x[i]);
    EXPECT_GT(set.parameters[i].scale, 0.0);
    EXPECT_EQ(set.find(set.parameters[i].name), &set.parameters[i]) << "two parameters are called the same";
  }
}

TEST_P(ChainLaws, MovingTheBaseMovesTheToolRigidly) {
  const Pose shift = Pose::from_xyz_rpy({1, 2, 3}, {0.3, -0.4, 0.5});
  Chain moved = chain();
  moved.base = Frame::from_pose(shift * chain().base.pose());
  moved.gravity = shift.rotation * chain().gravity;
  at_random_poses([&](const VectorXd& q) {
    EXPECT_LT(distance(forward(moved, q, load), shift * forward(chain(), q, load)), 1e-12);
  });
}

TEST_P(ChainLaws, FoldingConstantRotationsMovesNothing) {
  const Chain folded = with_small_rotations_folded(chain());
  EXPECT_EQ(folded.base.small_rotation, Vec3::Zero());
  EXPECT_EQ(folded.tool.small_rotation, Vec3::Zero());
  at_random_poses(
      [&](const VectorXd& q) { EXPECT_LT(distance(forward(folded, q, load), forward(chain(), q, load)), 1e-12); });
}

TEST_P(ChainLaws, RotationsStayRotations) {
  at_random_poses([&](const VectorXd& q) {
    const Mat3 r = forward(chain(), q, load).rotation;
    EXPECT_LT((r * r.transpose() - Mat3::Identity()).norm(), 1e-13);
    EXPECT_GT(r.determinant(), 0.0);
  });
}

INSTANTIATE_TEST_SUITE_P(every, ChainLaws, testing::ValuesIn(laws::examples()),
                         [](const auto& instance) { return laws::test_name(instance.param); });

}  // namespace
}  // namespace kinfer
