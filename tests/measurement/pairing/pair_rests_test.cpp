// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/pairing/pair_rests.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A program: point k is held for dwell[k] seconds, reached in one second.
struct Program {
  std::vector<Vec3> points;
  std::vector<double> dwell;
};

Program program_of(int count, bool equal_dwells, Rng rng) {
  Program program;
  for (int k = 0; k < count; ++k) {
    program.points.push_back(0.6 * normal_vector(rng));
    program.dwell.push_back(equal_dwells ? 2.0 : rng.uniform(1.0, 3.0));
  }
  return program;
}

struct Stream {
  std::vector<double> time;
  MatrixXd values;
};

/// Sampled at `rate` from `skip` points on; its clock shows `offset` more and runs faster by `drift`.
Stream stream_of(const Program& program, double rate, double noise, double offset, double drift, std::size_t skip,
                 Rng rng) {
  std::vector<double> time;
  std::vector<Vec3> values;
  double begin = 0.0;
  for (std::size_t k = 0; k < program.points.size(); ++k) {
    const double hold = program.dwell[k], end = begin + hold + 1.0;
    for (double t = begin; t < end; t += 1.0 / rate) {
      const double part = std::clamp(t - begin - hold, 0.0, 1.0), s = part * part * (3.0 - 2.0 * part);
      const Vec3 next = k + 1 < program.points.size() ? program.points[k + 1] : program.points[k];
      if (k < skip) continue;
      time.push_back(t * (1.0 + drift) + offset);
      values.push_back(program.points[k] + s * (next - program.points[k]) + noise * Vec3(rng.normal(), 0, 0));
      values.back().y() += noise * rng.normal();
      values.back().z() += noise * rng.normal();
    }
    begin = end;
  }
  Stream stream{time, MatrixXd(3, values.size())};
  for (std::size_t i = 0; i < values.size(); ++i) stream.values.col(static_cast<Eigen::Index>(i)) = values[i];
  return stream;
}

RestLists lists_of(const Program& program, double offset, double drift, std::size_t skip) {
  const Stream robot = stream_of(program, 50.0, 1e-6, 0.0, 0.0, 0, Rng(7)),
               tracker = stream_of(program, 30.0, 2e-5, offset, drift, skip, Rng(8));
  return {.joints = find_rests(robot.time, robot.values), .measured = find_rests(tracker.time, tracker.values)};
}

TEST(FindRests, EveryPointOfAProgramIsARest) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Program program = program_of(12, false, Rng(seed));
    const Stream stream = stream_of(program, 30.0, 2e-5, 0.0, 0.0, 0, Rng(seed).stream(1));
    const std::vector<Rest> rests = find_rests(stream.time, stream.values);
    ASSERT_EQ(rests.size(), 12u) << "seed " << seed;
    for (std::size_t k = 0; k < rests.size(); ++k) {
      EXPECT_LT((rests[k].mean - program.points[k]).norm(), 1e-3);
      EXPECT_GE(rests[k].end - rests[k].begin, program.dwell[k] - 0.3);
    }
  }
}

TEST(FindRests, AStreamThatNeverMovesOrIsShortHasNoneOrOne) {
  EXPECT_TRUE(find_rests({0.0, 0.1}, MatrixXd::Zero(3, 2)).empty());
  std::vector<double> time(100);
  for (std::size_t i = 0; i < time.size(); ++i) time[i] = 0.02 * static_cast<double>(i);
  EXPECT_LE(find_rests(time, MatrixXd::Zero(3, 100)).size(), 1u);
}

TEST(RestsOfList, EqualRowsInARowAreRepeats) {
  MatrixXd values(1, 5);
  values << 1.0, 1.2, 3.0, 1.0, 1.0;
  MatrixXd keys(1, 5);
  keys << 0, 0, 1, 0, 0;
  const std::vector<Rest> rests = rests_of_list(values, {}, keys);
  ASSERT_EQ(rests.size(), 3u);
  EXPECT_NEAR(rests[0].mean[0], 1.1, 1e-12);
  EXPECT_NEAR(rests[0].scatter[0], std::sqrt(0.02), 1e-12);
  EXPECT_EQ(rests[1].scatter[0], 0.0);
  EXPECT_EQ(rests_of_list(values, {"a", "a", "b", "c", "c"}, {}).size(), 3u);
  EXPECT_EQ(rests_of_list(values, {}, {}).size(), 5u);
}

TEST(PairRests, ByTimeOffsetAndDriftAreFound) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RestLists lists = lists_of(program_of(15, false, Rng(seed)), 1234.5, 8e-5, seed % 3);
    const auto found = pair_by_time(lists);
    ASSERT_TRUE(found) << "seed " << seed << ": " << found.error().what;
    EXPECT_NEAR(found->offset, 1234.5, 0.05);
    EXPECT_EQ(found->pairs.size(), 15u - seed % 3);
    for (const RestPair& pair : found->pairs) EXPECT_EQ(pair.joints, pair.measured + static_cast<int>(seed % 3));
    EXPECT_EQ(found->joints_alone.size(), seed % 3);
    EXPECT_LT(found->timing_error, 0.05);
  }
}

TEST(PairRests, ADriftIsFoundBesideAClockThatCountsFrom1970) {
  const Program program = program_of(15, false, Rng(4));
  const auto near = pair_by_time(lists_of(program, 0.25, 8e-5, 0)),
             far = pair_by_time(lists_of(program, 1.7e9 + 0.25, 8e-5, 0));
  ASSERT_TRUE(near && far);
  EXPECT_NEAR(far->drift, near->drift, 1e-7);
  EXPECT_NEAR(far->offset - near->offset, 1.7e9, 1e-3);
  EXPECT_NEAR(far->timing_error, near->timing_error, 1e-5);
}

TEST(PairRests, EqualDwellsAreDecidedByDistancesOrRefused) {
  const Program program = program_of(10, true, Rng(3));
  RestLists lists = lists_of(program, 20.0, 0.0, 2);
  lists.joints.pop_back(), lists.measured.pop_back();  // the last rest is longer, and would tell
  EXPECT_THAT(pair_by_time(lists).error().what, HasSubstr("explain the rests equally well; give --offset, or names"));
  const auto given = pair_by_time(lists, 20.3);
  ASSERT_TRUE(given) << given.error().what;
  EXPECT_EQ(given->pairs.front().joints, 2);
  lists.predicted = program.points;
  const auto found = pair_by_time(lists);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->pairs.front().joints, 2);
  EXPECT_EQ(found->pairs.size(), 7u);
  EXPECT_LT(found->distance_error, 1e-3);
}

RestLists lists_of_points(const std::vector<Vec3>& joints, const std::vector<Vec3>& measured) {
  RestLists lists;
  for (const Vec3& p : joints) lists.joints.push_back({.mean = VectorXd::Zero(1)}), lists.predicted.push_back(p);
  for (const Vec3& p : measured) lists.measured.push_back({.mean = p, .scatter = VectorXd::Zero(3)});
  return lists;
}

TEST(PairRests, ByOrderCountsThatDifferNameTheFirstPlaceWhereTheyPart) {
  const std::vector<Vec3> points = program_of(10, true, Rng(5)).points;
  EXPECT_EQ(pair_by_order(lists_of_points(points, points))->pairs.size(), 10u);
  std::vector<Vec3> without = points;
  without.erase(without.begin() + 6);
  EXPECT_THAT(pair_by_order(lists_of_points(points, without)).error().what,
              HasSubstr("the joint list has 10 rests and the measured list 9; they part at rest 7"));
}

TEST(PairRests, ByNameRepeatsAndStrangersAreTold) {
  RestLists lists = lists_of_points(std::vector<Vec3>(3, Vec3::Zero()), std::vector<Vec3>(3, Vec3::Zero()));
  for (std::size_t i = 0; i < 3; ++i)
    lists.joints[i].name = "p" + std::to_string(i), lists.measured[i].name = "p" + std::to_string(2 * i);
  const auto found = pair_by_name(lists);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pairs, (std::vector<RestPair>{{0, 0}, {2, 1}}));
  EXPECT_THAT(found->joints_alone, ElementsAre(1));
  EXPECT_THAT(found->measured_alone, ElementsAre(2));
  lists.measured[2].name = "p0";
  EXPECT_THAT(pair_by_name(lists).error().what, HasSubstr("\"p0\" stands in several places"));
}

}  // namespace
}  // namespace kinfer
