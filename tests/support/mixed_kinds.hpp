// SPDX-License-Identifier: Apache-2.0
// Pose sets in which a few measurements of one kind stand beside many of another, of any two kinds.
#pragma once

#include <algorithm>

#include "support/instruments.hpp"

namespace kinfer::test {

/// Where the few are measured: in rows of their own, or in rows of the many as well.
enum class FewRows { own, shared };

struct MixedKinds {
  MeasurementKind many{}, few{};
  int many_count = 30, few_count = 1;
  FewRows rows = FewRows::own;
  Instrument instrument{.sigma = 20e-6,
                        .sigma_angle = 50e-6,
                        .sigma_distance = 20e-6,
                        .sigma_contact = 20e-6,
                        .sigma_tilt = 1e-3,
                        .sigma_direction = 10e-6};
};

/// The nominal robot with anchors, which a robot file must list.
inline Chain robot_with_anchors() {
  Chain chain = nominal_robot();
  chain.fixtures.anchors = {Vec3(1.8, -0.9, 0.1), Vec3(1.7, 1.1, 0.2), Vec3(0.2, 0.3, 2.4)};
  return chain;
}

inline bool is_touch(MeasurementKind kind) {
  return kind == kind_of<SocketContact> || kind == kind_of<PlaneContact>;
}

/// Places that the tool touches in row `row`: three sockets, or points on two planes.
inline Vec3 touched_place(MeasurementKind kind, int row, Rng rng) {
  const std::vector<Vec3> sockets{{0.9, 0.5, 0.4}, {0.8, -0.6, 0.6}, {1.1, 0.1, 0.9}};
  if (kind == kind_of<SocketContact>) return sockets[static_cast<std::size_t>(row % 3)];
  const double u = rng.uniform(-0.3, 0.3), v = rng.stream(1).uniform(-0.3, 0.3);
  return row % 2 == 0 ? Vec3(1.0 + u, v, 0.5) : Vec3(1.1, u, 0.8 + v);
}

/// A ball-bar has two.
inline int rows_of(MeasurementKind kind, int count) {
  return kind == kind_of<PairDistance> ? 2 * count : count;
}

/// Measures `kind` in the rows from `first` on, `count` times.
inline void measure_kind(PoseSet& set, const Chain& truth, MeasurementKind kind, int first, int count,
                         const Instrument& instrument, Rng rng) {
  const std::vector<Pose> poses = true_poses(truth, set);
  const Pose station = Pose::from_xyz_rpy({2.6, -1.8, 0.9}, {0.02, -0.01, 2.4});
  for (int i = 0; i < count; ++i) {
    const int row = first + i;
    const Pose& pose = poses[static_cast<std::size_t>(row)];
    if (kind == kind_of<PointMeasurement>)
      set.points.push_back({row, -1, pose.position + noise(rng, instrument.sigma), {}});
    if (kind == kind_of<OrientationMeasurement>)
      set.orientations.push_back({row, Quat(exp_so3(noise(rng, instrument.sigma_angle)) * pose.rotation)});
    if (kind == kind_of<SocketContact>) set.contacts.push_back({row, row % 3});
    if (kind == kind_of<DistanceMeasurement>) {
      const int a = row % static_cast<int>(truth.fixtures.anchors.size());
      const Vec3 anchor = truth.base.pose() * truth.fixtures.anchors[static_cast<std::size_t>(a)];
      set.distances.push_back({row, a, (pose.position - anchor).norm() + *instrument.sigma_distance * rng.normal()});
    }
    if (kind == kind_of<PairDistance>) {
      const int other = row + count;
      const double length = (pose.position - poses[static_cast<std::size_t>(other)].position).norm();
      set.pairs.push_back({row, other, length + *instrument.sigma_distance * rng.normal()});
    }
    if (kind == kind_of<PlaneContact>) set.plane_contacts.push_back({row, row % 2});
    if (kind == kind_of<TiltMeasurement>)
      set.tilts.push_back({row, -(pose.rotation.transpose() * truth.gravity) + noise(rng, *instrument.sigma_tilt)});
    if (kind == kind_of<DirectionMeasurement>) {
      const Vec3 sight = (station.inverse() * pose.position).normalized();
      set.directions.push_back({row, 0, (sight + noise(rng, *instrument.sigma_direction)).normalized()});
    }
  }
}

inline PoseSet mixed_kinds(const Chain& truth, const MixedKinds& of, int seed = 1) {
  const bool shared = of.rows == FewRows::shared && (!is_touch(of.few) || of.few == of.many);
  const int rows_of_many = rows_of(of.many, of.many_count), first_few = shared ? 0 : rows_of_many;
  const int rows = std::max(rows_of_many, first_few + rows_of(of.few, of.few_count));
  PoseSet set = readings_of(measured(truth, paper2_poses(rows, noise_free), seed));
  Rng rng(seed);
  for (int row = 0; row < rows; ++row) {
    const MeasurementKind kind = row < rows_of_many ? of.many : of.few;
    if (!is_touch(kind)) continue;
    PoseSet one = select(set, {row});
    touch(
        one, truth, [&](int) { return touched_place(kind, row, rng.stream(row)); }, 20e-6, rng.stream(1000 + row));
    set.joints.col(row) = one.joints.col(0);
  }
  const auto measures = [&](MeasurementKind kind) { return of.many == kind || of.few == kind; };
  if (measures(kind_of<SocketContact>)) set.sockets = {"a", "b", "c"};
  if (measures(kind_of<PlaneContact>)) set.planes = {"floor", "wall"};
  if (measures(kind_of<DirectionMeasurement>)) set.stations = {"west"};
  measure_kind(set, truth, of.many, 0, of.many_count, of.instrument, rng.stream(2));
  measure_kind(set, truth, of.few, first_few, of.few_count, of.instrument, rng.stream(3));
  return set;
}

}  // namespace kinfer::test
