// SPDX-License-Identifier: Apache-2.0
// Laws of every instrument's residual: its Jacobian is its slope, and at the truth it is the noise.
#include <gtest/gtest.h>

#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "support/differences.hpp"
#include "support/instruments.hpp"
#include "support/random_field.hpp"

namespace kinfer {
namespace {

using namespace test;

/// A robot with every feature that a chain can have, and fixtures of every kind that instruments refer to.
Chain rich_robot() {
  Chain chain = with_table3_errors(er20());
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({0.4, -0.3, 0.2}, {0.1, -0.2, 0.5}));
  chain.tool = Frame::from_pose(Pose::from_xyz_rpy({0.03, 0.02, 0.1}, {0.3, 0.4, -0.5}));
  chain.targets = {{"side", Vec3(0.03, -0.02, 0.05)}};
  chain.masses = {{2, Vec3(0.4, 0, 0), 120.0}, {4, Vec3(0, 0, 0.1), 60.0}};
  chain.joints[1].compliance = 2e-6;
  chain.joints[2].torque_compliance = 3e-6;
  chain.joints[3].backlash = 1e-4;
  chain.joints[0].harmonics = {{1.0, 1e-4, -2e-4}, {2.0, 3e-4, 1e-4}};
  chain.joints[4].harmonics = {{7.5, -1e-4, 2e-4}};
  chain.joints[2].couplings = {{1, 0.02}};
  chain.joints[5].couplings = {{4, -0.3}, {3, 1e-3}};
  chain.expansion = 2e-5;
  chain.reference_temperature = 20.0;
  chain.field = random_field(6, 5, Rng(8));
  Fixtures& around = chain.fixtures;
  around.anchors = {Vec3(1.8, -0.9, 0.1), Vec3(0.0, 2.0, 0.5)};
  around.sockets = {{"a", Vec3(1.0, 0.2, 0.5)}, {"b", Vec3(0.9, 0.4, 0.5)}};
  around.planes = {{.name = "table", .rotation = rot_x(0.2), .small_rotation = Vec3(0.01, 0.02, 0.0), .offset = 0.4}};
  around.socket_distances = {{0, 1, 0.2, 1e-4}};
  chain.mountings = {{.name = "second",
                      .base = Frame::from_pose(Pose::from_xyz_rpy({2, 1, 0}, {0, 0.1, 1})),
                      .tool = Frame::from_pose(Pose::from_xyz_rpy({0, 0.1, 0}, {0.2, 0, 0}))},
                     {.name = "elbow", .base = {}, .tool = chain.tool, .tip = 3}};
  return chain;
}

/// Covariance of three unequal and correlated variances about `scale`.
Mat3 skewed_covariance(double scale) {
  const Mat3 root = (Mat3() << 1.0, 0.0, 0.0, 0.7, 0.5, 0.0, -0.3, 0.4, 2.0).finished();
  return scale * root * root.transpose();
}

PoseSet all_kinds(const Chain& chain) {
  PoseSet set = readings_of(measured(chain, paper2_poses(12, noise_free)));
  set.payload.assign(12, 5.0);
  set.temperature.assign(12, 27.0);
  set.torques = 10.0 * set.joints;
  set.torques(2, 3) = std::numeric_limits<double>::quiet_NaN();
  set = with_approach(set);
  set.mounting = {-1, -1, -1, -1, -1, -1, 0, 0, 0, 1, 1, 1};
  measure_points(set, chain, tracker, Rng(3));
  set.targets = {"side"};
  set.points.push_back({2, 0, Vec3(1, 2, 3), Vec3(1e-3, 2e-3, 3e-3)});
  const auto [sd, axes] = principal_deviations(skewed_covariance(1e-6));
  set.points[4].sd = sd, set.points[4].axes = axes;
  set.points.push_back({3, 0, Vec3(1, 2, 3), sd, axes});
  const std::vector<Pose> poses = true_poses(chain, set);
  for (int row = 0; row < set.rows(); row += 2)
    set.orientations.push_back({row, Quat(rot_x(0.02) * poses[row].rotation), Vec3(1e-3, 2e-3, 3e-3)});
  set.orientations[1].sd = sd, set.orientations[1].axes = axes;
  set.orientations[2].covariance_with_point = 0.1e-6 * rot_x(0.4);  // beside a point of full covariance
  set.orientations[3].covariance_with_point = 0.1e-6 * rot_x(-0.3), set.orientations[3].sd = sd,
  set.orientations[3].axes = axes;
  measure_distances(set, chain, 1e-3, Rng(4));
  measure_pairs(set, chain, 1e-3, Rng(5));
  measure_tilts(set, chain, 0.05, Rng(6));
  set.contacts = {{0, 0}, {1, 1}, {7, 0}, {10, 1}};
  set.plane_contacts = {{3, 0}, {8, 0}};
  return set;
}

/// Every number of the chain and of its fixtures, geometric or not.
ParameterSet everything(const Chain& chain) {
  ParameterSet set = all_parameters(chain, {});
  const ParameterSet around = setup_parameters(chain, {});
  set.parameters.insert(set.parameters.end(), around.parameters.begin(), around.parameters.end());
  const auto add = [&](const ParameterAddress& at) { set.parameters.push_back(parameter_at(chain, at, 1e-3)); };
  for (int j = 0; j < static_cast<int>(chain.joints.size()); ++j) {
    add(JointNumber{j, Field::torque_compliance}), add(JointNumber{j, Field::backlash});
    for (int term = 0; term < static_cast<int>(chain.joints[j].harmonics.size()); ++term)
      add(JointNumber{j, Field::sine, term}), add(JointNumber{j, Field::cosine, term});
  }
  add(ExpansionNumber{});
  for (const Field field : {Field::x, Field::y, Field::z}) add(GravityNumber{field});
  return set;
}

/// Compliance is left at zero: its torques are held constant in the derivative, which differences do not do.
TEST(ResidualKinds, JacobianOfAllInstrumentsInAllMountingsEqualsDifferences) {
  Chain chain = rich_robot();
  chain.joints[1].compliance = 0.0;
  const PoseSet data = all_kinds(chain);
  ParameterSet set = everything(chain);
  std::erase_if(set.parameters, [](const Parameter& p) { return field_of(p.at) == Field::compliance; });
  Weights weights = weights_of(data, Instrument{.sigma = 1e-3, .sigma_angle = 1e-3, .sigma_tilt = 1e-2});
  const Residuals problem = pose_residuals(chain, set, data, weights);
  const VectorXd x = pack(set, chain);
  const auto [jacobian, expected] = testing::jacobians(problem, x);
  for (Eigen::Index k = 0; k < x.size(); ++k)
    EXPECT_LT((jacobian.col(k) - expected.col(k)).norm(), 1e-6 * (10.0 + expected.col(k).norm()))
        << set.parameters[k].name;
}

TEST(ResidualKinds, AFullCovarianceWeightsTheErrorByItsInverse) {
  const Chain chain = er20();
  PoseSet set = measured(chain, paper2_poses(3, noise_free));
  const Mat3 covariance = skewed_covariance(4e-6);
  const auto [sd, axes] = principal_deviations(covariance);
  EXPECT_TRUE(covariance_of(sd, axes).isApprox(covariance, 1e-12));
  const Vec3 off(1e-3, -2e-3, 3e-3);
  const Mat3 rotated = exp_so3(off);
  const std::vector<Pose> poses = true_poses(chain, set);
  set.points.resize(1);
  set.points[0].position += off, set.points[0].sd = sd, set.points[0].axes = axes;
  set.orientations = {{2, Quat(rotated * poses[2].rotation), sd, axes}};
  const Weights weights = weights_of(set, Instrument{.sigma = 1.0, .sigma_angle = 1.0});
  const ParameterSet nothing;
  VectorXd r;
  pose_residuals(chain, nothing, set, weights).evaluate(VectorXd(0), r, nullptr);
  const double expected = off.dot(*solve_spd(covariance, off));
  EXPECT_NEAR(r.head<3>().squaredNorm(), expected, 1e-9 * expected);
  EXPECT_NEAR(r.tail<3>().squaredNorm(), expected, 1e-9 * expected);
  EXPECT_NEAR(point_errors(chain, set)[0], off.norm(), 1e-12) << "errors stay errors";
}

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Point and orientation of one row with a 6 x 6 covariance, displaced by `off` (point, rotation).
struct OnePose {
  Mat6 covariance = Mat6::Zero();
  Vec6 off = Vec6::Zero();
  PoseSet set;
};

OnePose one_pose(const Chain& chain) {
  OnePose one;
  Rng rng(11);
  Mat6 root;
  for (Eigen::Index k = 0; k < 36; ++k) root(k) = 1e-3 * rng.normal();
  one.covariance = root * root.transpose();
  one.off << 1e-3, -2e-3, 3e-3, -2e-3, 1e-3, 1.5e-3;
  one.set = measured(chain, paper2_poses(3, noise_free));
  one.set.points.resize(2);
  one.set.points[1].position += one.off.head<3>();
  const PrincipalDeviations point = principal_deviations(one.covariance.topLeftCorner<3, 3>()),
                            rotation = principal_deviations(one.covariance.bottomRightCorner<3, 3>());
  one.set.points[1].sd = point.sd, one.set.points[1].axes = point.axes;
  const Quat rotated(exp_so3(one.off.tail<3>()) * true_poses(chain, one.set)[1].rotation);
  one.set.orientations = {{1, rotated, rotation.sd, rotation.axes, Mat3(one.covariance.topRightCorner<3, 3>())}};
  return one;
}

TEST(ResidualKinds, SixRowsOfAPoseWeightItsErrorByTheInverseOfTheirCovariance) {
  const Chain chain = er20();
  const OnePose one = one_pose(chain);
  const ParameterSet nothing;
  VectorXd r;
  const auto squares = [&](const PoseSet& set, const Weights& weights) {
    pose_residuals(chain, nothing, set, weights).evaluate(VectorXd(0), r, nullptr);
    return r.squaredNorm();
  };
  const double expected = one.off.dot(*solve_spd(one.covariance, one.off));
  EXPECT_NEAR(squares(one.set, weights_of(one.set, Instrument{.sigma = 1.0})), expected, 1e-8 * expected);
  const double excess = 0.7e-3, rotation_excess = 0.4e-3;  // model error that is added to both blocks
  Mat6 wider = one.covariance;
  wider.topLeftCorner<3, 3>() += excess * excess * Mat3::Identity();
  wider.bottomRightCorner<3, 3>() += rotation_excess * rotation_excess * Mat3::Identity();
  ExcessNoise more;
  more.of[index(kind_of<PointMeasurement>)] = excess;
  more.of[index(kind_of<OrientationMeasurement>)] = rotation_excess;
  const double less = one.off.dot(*solve_spd(wider, one.off));
  EXPECT_NEAR(squares(one.set, weights_of(one.set, Instrument{.sigma = 1.0}, more)), less, 1e-8 * less);
}

TEST(ResidualKinds, AnOrientationWhosePointIsNotKeptHasItsOwnCovariance) {
  const Chain chain = er20();
  const OnePose one = one_pose(chain);
  const PoseSet alone = keep_measurements(one.set, {true, false, true});
  const ParameterSet nothing;
  VectorXd r;
  pose_residuals(chain, nothing, alone, weights_of(alone, Instrument{.sigma = 1.0})).evaluate(VectorXd(0), r, nullptr);
  const Vec3 rotation = one.off.tail<3>();
  const double expected = rotation.dot(one.covariance.bottomRightCorner<3, 3>().inverse() * rotation);
  EXPECT_NEAR(r.tail<3>().squaredNorm(), expected, 1e-8 * expected);
}

TEST(ResidualKinds, AtTheTruthTheResidualsAreTheNoise) {
  const Chain chain = rich_robot();
  const PoseSet data = all_kinds(chain);
  EXPECT_NEAR(rms(residual_norms(kind_of<DistanceMeasurement>, chain, data)), 1e-3, 0.4e-3);
  EXPECT_NEAR(rms(residual_norms(kind_of<PairDistance>, chain, data)), 1e-3, 0.7e-3);
  EXPECT_NEAR(rms(residual_norms(kind_of<TiltMeasurement>, chain, data)), 0.05 * std::sqrt(2.0), 0.03);
  for (const double error : residual_norms(kind_of<OrientationMeasurement>, chain, data))
    EXPECT_NEAR(error, 0.02, 1e-9);
}

TEST(ResidualKinds, ADrawWireDoesNotDependOnTheBase) {
  Chain chain = rich_robot();
  const PoseSet data = all_kinds(chain);
  const std::vector<double> before = residual_norms(kind_of<DistanceMeasurement>, chain, data);
  chain.base.xyz += Vec3(1, 2, 3);
  chain.base.rotation = rot_x(0.7) * chain.base.rotation;
  PoseSet unloaded = data;  // gravity would deflect the rotated robot otherwise
  chain.joints[1].compliance = 0.0;
  Chain straight = rich_robot();
  straight.joints[1].compliance = 0.0;
  const std::vector<double> here = residual_norms(kind_of<DistanceMeasurement>, straight, unloaded),
                            there = residual_norms(kind_of<DistanceMeasurement>, chain, unloaded);
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(here[i], there[i], 1e-12);
}

TEST(ResidualKinds, BlocksAreDroppedAndKeptAsListed) {
  const PoseSet data = all_kinds(rich_robot());
  const std::vector<Block> blocks = blocks_of(data);
  std::vector<bool> kept(blocks.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i % 3 != 0;
  const std::vector<Block> left = blocks_of(keep_measurements(data, kept));
  std::size_t next = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    EXPECT_EQ(left[next].kind, blocks[i].kind);
    EXPECT_EQ(left[next].row, blocks[i].row);
    ++next;
  }
  EXPECT_EQ(next, left.size());
}

TEST(ResidualKinds, ForwardAgreesWithTheEvaluatorOnAllNonGeometricTerms) {
  const Chain chain = rich_robot();
  const PoseSet data = all_kinds(chain);
  for (int row = 0; row < 6; ++row) {
    const Load load = load_at(chain, data, row);
    const Pose slow = forward(chain, data.joints.col(row), load);
    const Pose fast = PoseEvaluator(chain, {}).pose(data.joints.col(row), load);
    EXPECT_LT((slow.position - fast.position).norm(), 1e-13);
    EXPECT_LT((slow.rotation - fast.rotation).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace kinfer
