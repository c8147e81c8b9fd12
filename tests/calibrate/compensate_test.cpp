#include "kinfer/calibrate/compensate.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

using namespace test;

/// Distances between where the real robot goes and where the nominal model wanted it.
std::vector<double> misses(const Chain& real, const Chain& nominal, const MatrixXd& wanted,
                           const std::vector<Compensated>& sent) {
  std::vector<double> list;
  for (std::size_t i = 0; i < sent.size(); ++i)
    list.push_back((forward(real, sent[i].q).position - forward(nominal, wanted.col(i)).position).norm());
  return list;
}

TEST(Compensate, the_known_robot_goes_where_the_nominal_model_wanted_it) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  const MatrixXd q = measured(nominal, paper2_poses(50, noise_free)).joints;
  const auto sent = compensate_joints(real, nominal, q, 1);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent[i].reach != Reach::reached) continue;
    EXPECT_LT(misses(real, nominal, q, sent)[i], 1e-8);
    EXPECT_LT(angle_between(forward(real, sent[i].q).rotation, forward(nominal, q.col(i)).rotation), 1e-8);
  }
  EXPECT_GT(std::count_if(sent.begin(), sent.end(), [](const Compensated& c) { return c.reach == Reach::reached; }),
            45);
}

TEST(Compensate, what_is_left_is_the_error_of_the_identified_model) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  CalibrateTask task{nominal, {}, tracker, measured(real, paper2_poses(50, tracker)), {}, {}};
  const Chain found = calibrate(task, {.parameters = Paper24Parameters{}}, Rng(1)).value().estimate.chain;
  const PoseSet wanted = measured(nominal, paper2_poses(100, noise_free), 77);
  const auto sent = compensate_joints(found, nominal, wanted.joints, 1);
  PoseSet visited = wanted;
  for (std::size_t i = 0; i < sent.size(); ++i) visited.joints.col(i) = sent[i].q;
  const double before = median(misses(real, nominal, wanted.joints, [&] {
    std::vector<Compensated> uncorrected(100);
    for (int i = 0; i < 100; ++i) uncorrected[i].q = wanted.joints.col(i);
    return uncorrected;
  }()));
  // The model's own error at the compensated readings: what it says of the real robot there.
  for (PointMeasurement& point : visited.points) point.position = forward(real, visited.joints.col(point.row)).position;
  const double model_error = median(point_errors(found, visited));
  const double after = median(misses(real, nominal, wanted.joints, sent));
  EXPECT_GT(before, 0.5e-3);
  EXPECT_NEAR(after, model_error, 0.02 * model_error);
  EXPECT_LT(after, 0.05 * before);
}

TEST(Compensate, a_target_is_reached_by_the_real_tool_without_a_start) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  const MatrixXd q = measured(nominal, paper2_poses(20, noise_free)).joints;
  std::vector<ToolTarget> targets;
  for (int i = 0; i < 20; ++i) {
    const Pose wanted = forward(nominal, q.col(i));
    targets.push_back({wanted.position, wanted.rotation});
  }
  const auto sent = compensate_targets(real, nominal, targets, {}, 1, Rng(1));
  int reached = 0;
  for (int i = 0; i < 20; ++i) {
    if (sent[i].reach != Reach::reached) continue;
    ++reached;
    EXPECT_LT((forward(real, sent[i].q).position - targets[i].position).norm(), 1e-8);
  }
  EXPECT_GE(reached, 18);
}

TEST(Compensate, a_target_out_of_reach_is_said) {
  const Chain nominal = er20();
  const auto sent = compensate_targets(nominal, nominal, {{Vec3(9, 0, 0), std::nullopt}}, {}, 1, Rng(1));
  EXPECT_NE(sent[0].reach, Reach::reached);
  EXPECT_GT(sent[0].residual, 5.0);
}

TEST(Compensate, an_instruments_world_is_told_from_a_small_base_error) {
  const Chain nominal = er20();
  Chain near = nominal, far = nominal;
  near.base.xyz = Vec3(0.02, 0, 0);
  far.base.xyz = Vec3(2, 0, 0);
  EXPECT_EQ(believable_frames(near, nominal, {}), CompensationFrames::as_given);
  EXPECT_EQ(believable_frames(far, nominal, {}), CompensationFrames::robot);
  EXPECT_EQ(in_frames(far, nominal, CompensationFrames::robot).base.xyz, nominal.base.xyz);
}

TEST(Compensate, same_readings_for_1_2_and_7_threads) {
  const Chain nominal = er20(), real = with_table3_errors(nominal);
  const std::vector<ToolTarget> targets(9, {Vec3(1.0, 0.3, 0.8), std::nullopt});
  const auto one = compensate_targets(real, nominal, targets, {}, 1, Rng(1));
  for (const int threads : {2, 7}) {
    const auto other = compensate_targets(real, nominal, targets, {}, threads, Rng(1));
    for (std::size_t i = 0; i < targets.size(); ++i) EXPECT_EQ(one[i].q, other[i].q);
  }
}

}  // namespace
}  // namespace kinfer
