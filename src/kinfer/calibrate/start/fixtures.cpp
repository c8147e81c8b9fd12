// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/fixtures.hpp"

#include <algorithm>
#include <optional>

#include "kinfer/base/square.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {
namespace {

template <class Named>
int find_by_name(const std::vector<Named>& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Named& entry) { return entry.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

/// The entries in the order of `names`, then the others.
template <class Named>
std::vector<Named> ordered_by_name(const std::vector<std::string>& names, const std::vector<Named>& known) {
  std::vector<Named> ordered;
  for (const std::string& name : names) {
    const int place = find_by_name(known, name);
    ordered.push_back(place >= 0 ? known[place] : Named{.name = name});
  }
  for (const Named& entry : known)
    if (find_by_name(ordered, entry.name) < 0) ordered.push_back(entry);
  return ordered;
}

void order_fixtures(Fixtures& fixtures, const PoseSet& data) {
  const std::vector<Target> before = fixtures.sockets;
  for_each_fixture_list(fixtures, [&]<class T>(const auto& row, std::vector<T>& list) {
    if constexpr (requires(T fixture) { fixture.name; })
      if (const auto* names = find_fixture_names(data, row.kind)) list = ordered_by_name(*names, list);
  });
  for (SocketDistance& known : fixtures.socket_distances)
    for (int* index : {&known.a, &known.b}) *index = find_by_name(fixtures.sockets, before[*index].name);
}

std::string name_of(const PoseSet& data, const std::vector<int>& index, const std::vector<std::string>& names,
                    Eigen::Index row) {
  if (data.rows() == 0 || index.empty() || index[row] < 0) return {};
  return names[index[row]];
}

/// The set-up of the chain's own base and tool: as given by the chain, or the first one where all rows name a set-up.
std::string own_setup(const Chain& chain, const PoseSet& data) {
  if (!chain.setup.empty() || data.setup.empty()) return chain.setup;
  if (std::find(data.setup.begin(), data.setup.end(), -1) != data.setup.end()) return {};
  return data.setups[data.setup.front()];
}

/// Index of the mounting for a set-up and a tip (−1: the chain's own); a new mounting is added to the chain.
Result<int> find_or_add_mounting(Chain& chain, const std::string& setup, const std::string& tip) {
  const bool own_setup = setup.empty() || setup == chain.setup;
  const int tip_joint = tip.empty() ? chain.tip_joint() : find_by_name(chain.joints, tip);
  if (tip_joint < 0) return error("the pose set names the tip \"{}\", but no joint of the robot has this name", tip);
  const bool own_tip = tip_joint == chain.tip_joint();
  if (own_setup && own_tip) return -1;
  const std::string name = own_tip ? setup : own_setup ? tip : setup + "/" + tip;
  const int known = find_by_name(chain.mountings, name);
  if (known >= 0) return known;
  RobotMounting mounting{.name = name, .tool = chain.tool, .tip = own_tip ? -1 : tip_joint};
  if (!own_setup) mounting.base = chain.base;
  if (const int arm = find_by_name(chain.mountings, tip); arm >= 0) mounting.tool = chain.mountings[arm].tool;
  chain.mountings.push_back(mounting);
  return static_cast<int>(chain.mountings.size()) - 1;
}

std::vector<Vec3> tool_points(const Chain& chain, const PoseSet& data) {
  std::vector<Vec3> points;
  for (const Pose& pose : evaluate_poses(chain, {}, data, Derivative::no).pose) points.push_back(pose.position);
  return points;
}

Vec3 median_point(const std::vector<Vec3>& points) {
  Vec3 middle;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Vec3& p : points) values.push_back(p[k]);
    middle[k] = median(std::move(values));
  }
  return middle;
}

Vec3 mean_point(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Whether a fixture is estimated as the start of a robust fit, or for rows whose outliers are already excluded.
enum class Estimator { robust, mean };

/// The measurements of one fixture, with the tool point of each.
template <class M>
struct Sightings {
  std::vector<M> measured;
  std::vector<Vec3> points;
};

/// The functions `place` estimate a fixture from its sightings; unchanged where they do not suffice.
void place(Target& socket, const Sightings<SocketContact>& seen, Estimator estimator) {
  if (seen.points.empty()) return;
  socket.xyz = estimator == Estimator::robust ? median_point(seen.points) : mean_point(seen.points);
}

void place(Plane& plane, const Sightings<PlaneContact>& seen, Estimator) {
  if (seen.points.size() < 3) return;
  const PlaneFit fit = fit_plane(seen.points);
  const Vec3 u = any_perpendicular(fit.normal);
  plane.rotation << u, fit.normal.cross(u), fit.normal;
  plane.small_rotation.setZero();
  plane.offset = fit.normal.dot(fit.point);
}

/// Number of measurements of each fixture.
template <class M>
std::vector<int> counts_of(const std::vector<M>& list, std::size_t fixtures) {
  std::vector<int> counts(fixtures, 0);
  for (const M& measurement : list) ++counts[measurement.*M::fixture_index];
  return counts;
}

constexpr std::size_t fewest_sights = 6;  // of a resection by direct linear transformation

/// Resection: the pose of a station that sees these points in these directions m. Of P X ∥ m with a 3 x 4 matrix P
/// (direct linear transformation, Hartley and Zisserman 2004, 7.1), the rotation nearest to its left part is taken.
Pose resect_linearly(const Sightings<DirectionMeasurement>& seen) {
  const Vec3 centre = mean_point(seen.points);
  double size = 0.0;
  for (const Vec3& p : seen.points) size += (p - centre).norm() / static_cast<double>(seen.points.size());
  MatrixXd information = MatrixXd::Zero(12, 12);
  const auto homogeneous = [&](std::size_t i) { return Vec3((seen.points[i] - centre) / size).homogeneous().eval(); };
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    MatrixXd by_matrix = MatrixXd::Zero(3, 12);  // of P X, P in rows
    for (int k = 0; k < 3; ++k) by_matrix.block<1, 4>(k, 4 * k) = homogeneous(i).transpose();
    const MatrixXd rows = skew(seen.measured[i].direction) * by_matrix;
    information += gram(rows);
  }
  const VectorXd smallest = symmetric_eigen(information).vectors.col(0);
  Eigen::Matrix<double, 3, 4> projection;
  for (int k = 0; k < 3; ++k) projection.row(k) = smallest.segment<4>(4 * k).transpose();
  double forward = 0.0;  // the points lie before the station, not behind it
  for (std::size_t i = 0; i < seen.points.size(); ++i)
    forward += seen.measured[i].direction.dot(projection * homogeneous(i));
  if (forward < 0.0) projection *= -1.0;
  const Svd parts = svd(projection.leftCols<3>());
  const Vec3 sign(1.0, 1.0, Mat3(times_transposed(parts.u, parts.v)).determinant() < 0.0 ? -1.0 : 1.0);
  const Mat3 station_R_world = times_transposed(parts.u * sign.asDiagonal(), parts.v);
  const double scale = parts.s.mean();
  return {station_R_world.transpose(), centre - size / scale * (station_R_world.transpose() * projection.col(3))};
}

/// One Gauss-Newton step on the angles, with weights that gross errors cannot dominate.
Pose refine_resection(const Pose& station, const Sightings<DirectionMeasurement>& seen) {
  std::vector<Vec3> sights, errors;
  std::vector<double> angles;
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    sights.push_back(station.inverse() * seen.points[i]);
    errors.push_back(sights[i].normalized() - seen.measured[i].direction);
    angles.push_back(errors[i].norm());
  }
  const double typical = std::max(1e-12, median(angles));
  MatrixXd information = MatrixXd::Zero(6, 6);
  VectorXd gradient = VectorXd::Zero(6);
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const Vec3 along = sights[i].normalized();
    const Mat3 by_sight = (Mat3::Identity() - along * along.transpose()) / sights[i].norm();
    MatrixXd rows(3, 6);  // by a shift and a turn in the station's frame
    rows << -by_sight, by_sight * skew(sights[i]);
    const double weight = 1.0 / (1.0 + square(angles[i] / (3.0 * typical)));
    information += weight * gram(rows), gradient += weight * rows.transpose() * errors[i];
  }
  const auto step = solve_spd(information, gradient);
  if (!step) return station;
  return {station.rotation * exp_so3(-step->tail<3>()), station.position - station.rotation * step->head<3>()};
}

void place(NamedFrame& station, const Sightings<DirectionMeasurement>& seen, Estimator) {
  constexpr int rounds = 10;
  if (seen.points.size() < fewest_sights) return;
  Pose pose = resect_linearly(seen);
  for (int i = 0; i < rounds; ++i) pose = refine_resection(pose, seen);
  station.frame = Frame::from_pose(pose);
}

/// An error for a station that neither the robot file nor its sights locate.
Result<void> check_stations(const Fixtures& known, const PoseSet& data) {
  const std::vector<int> sights = counts_of(data.directions, data.stations.size());
  for (std::size_t i = 0; i < sights.size(); ++i)
    if (static_cast<std::size_t>(sights[i]) < fewest_sights && find_by_name(known.stations, data.stations[i]) < 0)
      return error("station \"{}\" sees {} poses; at least {} are needed to find where it stands", data.stations[i],
                   sights[i], fewest_sights);
  return {};
}

/// One entry for each fixture.
template <class M>
std::vector<Sightings<M>> sightings_of(const std::vector<M>& list, std::size_t fixtures,
                                       const std::vector<Vec3>& points) {
  std::vector<Sightings<M>> sightings(fixtures);
  for (const M& measurement : list) {
    Sightings<M>& seen = sightings[measurement.*M::fixture_index];
    seen.measured.push_back(measurement), seen.points.push_back(points[measurement.row]);
  }
  return sightings;
}

/// Estimates the fixtures without a prior to which `data` refers and `fitted` does not.
Chain with_placed_fixtures(const Chain& chain, const PoseSet& data, const PoseMeasurements& fitted,
                           Estimator estimator) {
  Chain result = chain;
  std::optional<std::vector<Vec3>> points;
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if constexpr (RefersToFixture<M>) {
      constexpr auto& row = std::get<index(fixture_kind(M::traits.fixture))>(fixture_lists);
      if constexpr (row.prior == FixturePrior::none) {
        if (list.empty()) return;
        if (!points) points = tool_points(chain, data);
        auto& fixtures = result.fixtures.*row.list;
        const auto of_fitted = counts_of(list_of<M>(fitted), fixtures.size());
        const auto sightings = sightings_of(list, fixtures.size(), *points);
        for (std::size_t i = 0; i < fixtures.size(); ++i)
          if (of_fitted[i] == 0) place(fixtures[i], sightings[i], estimator);
      }
    }
  });
  return result;
}

}  // namespace

Result<DataWithFixtures> with_fixtures(const Chain& given, const PoseSet& data) {
  DataWithFixtures result{given, data};
  Chain& chain = result.chain;
  for (const DistanceMeasurement& wire : data.distances)
    if (wire.anchor >= static_cast<int>(chain.fixtures.anchors.size()))
      return error("a distance is measured from anchor {}, but the robot file lists {} anchors", wire.anchor + 1,
                   chain.fixtures.anchors.size());
  if (auto located = check_stations(chain.fixtures, data); !located) return forward_error(located.error());
  order_fixtures(chain.fixtures, data);
  chain.setup = own_setup(chain, data);
  if (data.setups.empty() && data.tips.empty()) return result;
  result.data.mounting.assign(data.rows(), -1);
  for (Eigen::Index row = 0; row < data.rows(); ++row) {
    KINFER_TRY(index, find_or_add_mounting(chain, name_of(data, data.setup, data.setups, row),
                                           name_of(data, data.tip, data.tips, row)));
    result.data.mounting[row] = index;
  }
  return result;
}

Chain with_initial_fixtures(const Chain& chain, const PoseSet& data) {
  return with_placed_fixtures(chain, data, {}, Estimator::robust);
}

Chain with_unfitted_fixtures(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& evaluated) {
  return with_placed_fixtures(chain, evaluated, fitted_rows, Estimator::mean);
}

}  // namespace kinfer::calibrate
