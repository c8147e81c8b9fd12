// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/turn_watch.hpp"

#include "kinfer/track/rows/row_block.hpp"
#include "track/tracked_case.hpp"

namespace kinfer::track {
namespace {

BlockMeasurement turned(BlockMeasurement block, std::size_t sensor, const Vec3& turn) {
  const Mat3 rotation = exp_so3(turn);
  block.sensors[sensor].rate = rotation * block.sensors[sensor].rate;
  block.sensors[sensor].force = rotation * block.sensors[sensor].force;
  return block;
}

/// The next block of rows of a filter in the middle of a drive.
struct NextBlock {
  ChainFilter filter;
  BlockMeasurement block;
};
NextBlock next_block() {
  const Case& given = still_excavator();
  Tracker tracker(given.model);
  RowBlock block(given.model.sensors.size());
  InsRow row;
  std::size_t r = 0;
  for (; row.time < 17.0; ++r) {
    test::fill_row(given.drive.recording, r, row);
    tracker.add(row);
  }
  while (!block.is_complete(0.02)) {
    test::fill_row(given.drive.recording, r++, row);
    block.add(row);
  }
  ChainFilter filter = tracker.filter();
  filter.predict(block.mean().time);
  return {filter, block.mean()};
}

/// The likelihood's derivative by differences: a sample that is turned by less is one of a mounting that is turned by
/// more.
TEST(TurnScore, IsTheDerivativeOfTheLikelihood) {
  const NextBlock next = next_block();
  const auto likelihood = [&](std::size_t sensor, const Vec3& turn) {
    ChainFilter copy = next.filter;
    copy.update(turned(next.block, sensor, turn));
    return copy.innovations().log_likelihood;
  };
  ChainFilter updated = next.filter;
  updated.update(next.block);
  constexpr double step = 1e-4;
  for (const std::size_t sensor : {0u, 2u, 5u})
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 turn = step * Vec3::Unit(axis);
      const TurnScore& score = updated.innovations().turn[sensor];
      const double least = likelihood(sensor, -turn), most = likelihood(sensor, turn);
      const double scale = std::sqrt(score.information(axis, axis));
      EXPECT_NEAR(score.score[axis], (least - most) / (2.0 * step), 0.06 * scale)
          << sensor << axis;  // of the predicted sample
      EXPECT_NEAR(score.information(axis, axis),
                  (2.0 * likelihood(sensor, Vec3::Zero()) - least - most) / (step * step),
                  0.02 * score.information(axis, axis) + 1e-3 * scale / step)
          << sensor << axis;
    }
}

}  // namespace
}  // namespace kinfer::track
