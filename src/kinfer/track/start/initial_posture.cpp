// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/initial_posture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

/// What is known of a body's motion from its own sensor, or from its parent's.
struct SeenBody {
  Vec3 force = Vec3::Zero(), rate = Vec3::Zero();  ///< in its frame
  Vec3 gravity = Vec3::Zero();                     ///< in its frame, by those of its parents and of the joints
  double force_sd = 0.0, rest_sd = 0.0;  ///< [m/s²] of the direction of gravity, as it moves and were it at rest
};

struct JointStart {
  Vec3 position = Vec3::Zero(), sd = Vec3::Zero();
  Mat3 spherical = Mat3::Identity();
  Vec3 heading =
      Vec3::Zero();         ///< of a spherical joint: direction of gravity in its rotating frame, the unobservable axis
  double heading_sd = 0.0;  ///< [rad] of a rotation about that, where nothing but the user shows it
  std::array<bool, 3> is_known{};
  bool is_blurred = false, is_rough = false;  ///< as of StartPosition
  std::optional<double> lost_sd{};
  double contradicts_given = 0.0;  ///< as of StartPosition
};

double angle_of(const Vec3& v) {
  return std::atan2(v.y(), v.x());
}

SeenBody seen_body(const FilterModel& model, const BlockMeasurement& block, const InsBody& body, const SeenBody& parent,
                   const Mat3& child_R_parent) {
  const bool has_sensor = body.sensor >= 0;
  SeenBody seen{.force = child_R_parent * parent.force,
                .rate = child_R_parent * parent.rate,
                .gravity = child_R_parent * parent.gravity,
                .force_sd = parent.force_sd + unseen_force_sd,
                .rest_sd = parent.rest_sd + unseen_force_sd};
  if (!has_sensor) return seen;
  const auto s = static_cast<std::size_t>(body.sensor);
  const SensorSettings& sensor = model.sensors[s];
  const BlockSample& sample = block.sensors[s];
  if (sample.rate_count > 0) seen.rate = sample.rate - sensor.gyroscope_bias;
  if (sample.force_count > 0) {
    seen.force = sample.force - sensor.accelerometer_bias;
    const double motion = std::abs(seen.force.norm() - model.gravity) +
                          start_arm * (seen.rate.squaredNorm() + sample.angular_acceleration);
    const Index own = sensor_states * static_cast<Index>(s);
    const double bias =
        std::sqrt(model.parameters.diagonal().segment<3>(own + SensorIndex::accelerometer_bias).maxCoeff() +
                  model.gravity * model.gravity *
                      model.parameters.diagonal().segment<9>(own + SensorIndex::accelerometer_scale).maxCoeff());
    seen.rest_sd = std::hypot(min_force_sd, bias, sensor.persistent.force);
    seen.force_sd = std::hypot(seen.rest_sd, motion);
  }
  return seen;
}

/// Standard deviations [rad] of the direction of a joint's axis in the parent and in the child.
struct AxisSd {
  double in_parent = 0.0, in_child = 0.0;
  double on_cone = 0.0;  ///< in the parent, along a cone whose angle is known: where nothing told the azimuth
};

/// [rad] The largest standard deviation, if the smallest one is a fraction of it; 0 otherwise.
double sd_of_line(ConstMatrixRef covariance) {
  const VectorXd variance = symmetric_eigen(covariance).values;
  return variance[0] < square(cone_width) * variance[1] ? std::sqrt(variance[1]) : 0.0;
}

AxisSd axis_sd(const FilterModel& model, std::size_t b) {
  const InsBody& body = model.bodies[b];
  Index at = model.layout.first_geometry - model.layout.fast + model.layout.geometry[b];
  const auto next = [&](const std::array<bool, 3>& is_free) {
    double variance = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      if (is_free[i]) {
        if (i < 2) variance = std::max(variance, model.parameters(at, at));  // the third is about the axis itself
        ++at;
      }
    return std::sqrt(variance);
  };
  AxisSd sd;
  if (body.free_parent_rotation[0] && body.free_parent_rotation[1])
    sd.on_cone = sd_of_line(model.parameters.block<2, 2>(at, at));
  sd.in_parent = next(body.free_parent_rotation);
  if (const UnknownAxis* unknown = model.unknown_axis(b)) {
    const Index first = unknown->state - model.layout.fast;
    sd.in_parent = std::sqrt(model.parameters.diagonal().segment<2>(first).maxCoeff());
  }
  if (body.parent == 0 && model.cone_sd > 0.0 && model.unknown_zero(model.layout.position[b]))
    sd.on_cone = sd.in_parent;
  sd.in_child = next(body.free_child_rotation);
  return sd;
}

/// [m/s²] What gravity has across an axis by errors of the axis: by all, and by those along a cone.
struct AcrossByAxis {
  double all = 0.0, on_cone = 0.0;
};

/// How a component of gravity that both sensors see changes with a position: its first two derivatives.
struct Lever {
  double first = 0.0;   ///< [m/s² per rad]
  double second = 0.0;  ///< [m/s² per rad²] counts where the first is nearly zero

  /// [rad] What an error of the component [m/s²] makes: lever σ + ½ second σ² by the larger of both.
  double angle(double error) const { return error / std::max({1e-3, first, std::sqrt(0.5 * second * error)}); }
};

/// What gravity tells of a position. Motion makes a position that gravity shows uncertain; only at an upright axis it
/// is unobservable.
JointStart shown_by_gravity(const Lever& lever, const AcrossByAxis& by_axis, const SeenBody& parent,
                            const SeenBody& child) {
  const double sd = lever.angle(std::hypot(parent.force_sd, child.force_sd, by_axis.all)),
               rest_sd = lever.angle(std::hypot(parent.rest_sd, child.rest_sd, by_axis.all));
  JointStart start;
  start.sd.x() = std::min(sd, max_observable_sd);
  start.is_known[0] = rest_sd < max_observable_sd && lever.angle(by_axis.on_cone) < max_cone_sd;
  start.is_blurred = std::hypot(parent.force_sd, child.force_sd) > 2.0 * std::hypot(parent.rest_sd, child.rest_sd);
  start.is_rough = start.is_known[0] && sd > max_observable_sd;
  return start;
}

/// [rad/s] Of the child against its parent, about the axis.
double joint_rate(const InsBody& body, const SeenBody& parent, const SeenBody& child) {
  return body.child_R_axis.col(2).dot(child.rate) - body.parent_R_axis.col(2).dot(parent.rate);
}

/// ln odds that a stated position is wrong, and the true one anywhere, where gravity shows one so far away.
double log_odds_of_wrong_start(double apart, double sd) {
  const double log_normal = -0.5 * (apart / sd) * (apart / sd) - std::log(sd * std::sqrt(2.0 * std::numbers::pi)),
               log_uniform = -std::log(2.0 * std::numbers::pi);
  return std::log(wrong_start_prior) + log_uniform - log_normal;
}

/// Where a position stands by gravity, which tells `start` of it, by what the user states and by what is expected after
/// a gap.
JointStart placed(JointStart start, double by_gravity, const PositionGuess& guess, const PositionAfterGap& expected) {
  const bool is_shown = start.is_known[0];
  const double apart = wrap_to_pi(by_gravity - guess.value),
               odds = log_odds_of_wrong_start(apart, std::hypot(guess.sd, start.sd.x()));
  if (guess.is_given && is_shown && odds > wrong_start_log_odds) {
    start.position.x() = guess.value + apart;
    start.contradicts_given = odds;
    return start;
  }
  if (guess.is_given && (!is_shown || guess.sd < start.sd.x())) {
    start.position.x() = guess.value, start.sd.x() = guess.sd, start.is_known[0] = true, start.is_rough = false;
    return start;
  }
  start.position.x() = expected.value + wrap_to_pi(by_gravity - expected.value);  // the turn nearest to what was seen
  if (!guess.last) return start;
  start.lost_sd = expected.sd;
  if (is_shown && expected.sd >= start.sd.x()) return start;
  start.position.x() = expected.value, start.is_rough = false;
  if (is_shown) start.sd.x() = expected.sd;
  return start;
}

/// `rate`: [rad/s] as the gyroscopes show it at `time` [s].
PositionAfterGap expected_position(const PositionGuess& guess, double time, double rate) {
  return guess.last ? after_gap(*guess.last, time, rate) : PositionAfterGap{guess.value, guess.sd};
}

/// The axis tilts what gravity has across it by what it has along it: on level ground a vertical axis is all that.
JointStart revolute_start(const InsBody& body, const AxisSd& axis, const SeenBody& parent, const SeenBody& child,
                          const PositionGuess& guess, double time) {
  const Vec3 u = body.parent_R_axis.transpose() * parent.force, w = body.child_R_axis.transpose() * child.force;
  const double lever = (body.parent_R_axis.transpose() * parent.gravity).head<2>().norm();
  const AcrossByAxis by_axis{std::hypot(u.z() * axis.in_parent, w.z() * axis.in_child), std::abs(u.z()) * axis.on_cone};
  return placed(shown_by_gravity({.first = lever}, by_axis, parent, child), angle_of(u) - angle_of(w), guess,
                expected_position(guess, time, joint_rate(body, parent, child)));
}

/// The two angles of a universal joint: R_z(q₂) w = M R_z(−q₁) u, two solutions; the one nearer to what was seen.
std::array<double, 2> universal_angles(const Vec3& u, const Vec3& w, const Mat3& m, double near_first,
                                       double near_second) {
  const Vec3 row = m.row(2);
  // (R_z(−q) u) = (c u_x + s u_y, −s u_x + c u_y, u_z)
  const double a = row.x() * u.x() + row.y() * u.y(), b = row.x() * u.y() - row.y() * u.x(),
               c = w.z() - row.z() * u.z(), size = std::hypot(a, b);
  const double middle = std::atan2(b, a), half = std::acos(std::clamp(size > 0.0 ? c / size : 0.0, -1.0, 1.0));
  std::array<double, 2> best{near_first, near_second};
  double least = std::numeric_limits<double>::infinity();
  for (const double first : {middle + half, middle - half}) {
    const double q1 = near_first + wrap_to_pi(first - near_first);
    const Vec3 turned = m * (rot_z(-q1) * u);
    const double q2 = near_second + wrap_to_pi(angle_of(turned) - angle_of(w) - near_second);
    const double far = std::abs(q1 - near_first) + std::abs(q2 - near_second);
    if (far < least) least = far, best = {q1, q2};
  }
  return best;
}

/// A universal joint between two sensors, in the frame of its second axis when the second angle is zero. There gravity
/// is F = M R_z(−q₁) u to the parent and R_z(q₂) w to the child: F_z shows the first angle, F_x and F_y the second.
class UniversalStart {
 public:
  UniversalStart(const InsBody& first, const InsBody& second, const SeenBody& parent, const SeenBody& child)
      : first_(first),
        second_(second),
        parent_(parent),
        child_(child),
        u_(first.parent_R_axis.transpose() * parent.force),
        w_(second.child_R_axis.transpose() * child.force),
        m_(second.parent_R_axis.transpose() * first.child_R_axis) {}

  /// Of both angles.
  std::array<JointStart, 2> at(const std::array<PositionGuess, 2>& guess, double time) const {
    const auto near = [](const PositionGuess& g) { return g.last ? g.last->value : g.value; };
    const Rates rates = rates_at(universal_angles(u_, w_, m_, near(guess[0]), near(guess[1])));
    const PositionAfterGap expected_first = expected_position(guess[0], time, rates[0]),
                           expected_second = expected_position(guess[1], time, rates[1]);
    const double by_gravity = universal_angles(u_, w_, m_, expected_first.value, expected_second.value)[0];
    const JointStart first = placed(shown_first(by_gravity), by_gravity, guess[0], expected_first);
    const Vec3 gravity = gravity_at(first.position.x()), change = change_at(first.position.x());
    JointStart second = placed(shown_by_gravity({.first = w_.head<2>().norm()}, {}, parent_, child_),
                               angle_of(gravity) - angle_of(w_), guess[1], expected_second);
    // It was read from gravity as it lies at the first angle.
    const double by_first =
        (gravity.x() * change.y() - gravity.y() * change.x()) / std::max(1e-6, gravity.head<2>().squaredNorm());
    second.sd.x() =
        std::min(std::hypot(second.sd.x(), by_first * first.sd.x()), std::max(second.sd.x(), max_observable_sd));
    return {first, second};
  }

 private:
  using Rates = std::array<double, 2>;

  Vec3 first_axis() const { return m_.col(2); }
  Vec3 gravity_at(double first) const { return m_ * (rot_z(-first) * u_); }
  /// Of that by the first angle.
  Vec3 change_at(double first) const { return gravity_at(first).cross(first_axis()); }

  JointStart shown_first(double angle) const {
    const Vec3 change = change_at(angle);
    return shown_by_gravity({.first = std::abs(change.z()), .second = std::abs(change.cross(first_axis()).z())}, {},
                            parent_, child_);
  }

  /// [rad/s] As the gyroscopes show them.
  Rates rates_at(const std::array<double, 2>& angles) const {
    const Vec3 of_child = rot_z(angles[1]) * (second_.child_R_axis.transpose() * child_.rate),
               of_parent = m_ * (rot_z(-angles[0]) * (first_.parent_R_axis.transpose() * parent_.rate)),
               relative = of_child - of_parent, axis = first_axis();
    const double first = axis.head<2>().dot(relative.head<2>()) / std::max(1e-6, axis.head<2>().squaredNorm());
    return {first, relative.z() - axis.z() * first};
  }

  const InsBody &first_, &second_;
  const SeenBody &parent_, &child_;
  Vec3 u_, w_;
  Mat3 m_;
};

/// The rotation of a spherical joint nearest to its guess that carries gravity from the parent to the child; its
/// heading stays as guessed, and is as uncertain as what the user states.
JointStart spherical_start(const InsBody& body, const SeenBody& parent, const SeenBody& child, const Mat3& guess,
                           bool is_given) {
  JointStart start;
  const Vec3 u = body.parent_R_axis.transpose() * parent.force, w = body.child_R_axis.transpose() * child.force;
  start.spherical = rotation_between(guess * w, u).toRotationMatrix() * guess;
  start.sd.setConstant(std::hypot(parent.force_sd, child.force_sd) / std::max(1.0, u.norm()));
  start.heading = w.normalized();
  start.is_known.fill(is_given);
  if (is_given) start.heading_sd = given_start_sd;
  return start;
}

Mat3 child_from_parent(const InsBody& body, const JointStart& start) {
  const Mat3 back = body.motion == JointMotion::revolute    ? rot_z(-start.position.x())
                    : body.motion == JointMotion::spherical ? Mat3(start.spherical.transpose())
                                                            : Mat3(Mat3::Identity());
  return body.child_R_axis * back * body.parent_R_axis.transpose();
}

/// Attitude of a base on which gravity is seen.
Mat3 levelled(const Vec3& force) {
  return rotation_between(force, Vec3::UnitZ()).toRotationMatrix();
}

class PostureStart {
 public:
  PostureStart(const FilterModel& model, const BlockMeasurement& block, const std::vector<PositionGuess>& guess)
      : model_(model),
        block_(block),
        guess_(guess),
        starts_(model.bodies.size()),
        seen_(model.bodies.size()),
        is_unseen_(model.bodies.size(), false) {
    InsBody base = model.bodies.front();
    seen_[0] = seen_body(model, block, base, {.force = Vec3(0.0, 0.0, model.gravity), .force_sd = unseen_force_sd},
                         Mat3::Identity());
    seen_[0].gravity = seen_[0].force;
    for (std::size_t b = 1; b < model.bodies.size(); ++b) place(b);
  }

  const JointStart& joint(std::size_t body) const { return starts_[body]; }
  const SeenBody& seen(std::size_t body) const { return seen_[body]; }
  bool is_unseen(std::size_t body) const { return is_unseen_[body]; }

 private:
  const PositionGuess& guess_of(std::size_t b, Index i) const {
    return guess_[static_cast<std::size_t>(model_.layout.position[b] + i)];
  }
  const PositionGuess& guess(std::size_t b) const { return guess_of(b, 0); }

  /// Of a spherical joint: all of it, or of a loose revolute one the rotation about its axis.
  bool is_given(std::size_t b) const {
    const bool about_axis = guess_of(b, 2).is_given;
    return about_axis && (model_.is_loose(b) || (guess_of(b, 0).is_given && guess_of(b, 1).is_given));
  }

  void place(std::size_t b) {
    const InsBody& body = model_.bodies[b];
    const auto parent = static_cast<std::size_t>(body.parent);
    const bool is_seen = body.sensor >= 0 && block_.sensors[static_cast<std::size_t>(body.sensor)].force_count > 0;
    const SeenBody& before = seen_[parent];
    if (body.motion == JointMotion::revolute && body.sensor < 0) return place_first_of_universal(b);
    SeenBody own = is_seen ? seen_body(model_, block_, body, before, Mat3::Identity()) : SeenBody{};
    if (is_second_of_universal_ == static_cast<int>(b)) {
      is_second_of_universal_ = -1;
    } else if (body.motion == JointMotion::revolute && is_seen) {
      starts_[b] = revolute_start(body, axis_sd(model_, b), before, own, guess(b), block_.time);
    } else if (body.motion == JointMotion::spherical && is_seen) {
      const Vec3 angles(guess_of(b, 0).value, guess_of(b, 1).value, guess_of(b, 2).value);
      const Mat3 guessed = rot_x(angles.x()) * rot_y(angles.y()) * rot_z(angles.z());
      starts_[b] = spherical_start(body, before, own, guessed, is_given(b));
    } else if (body.motion != JointMotion::fixed) {
      guess_start(b);
    }
    seen_[b] = seen_body(model_, block_, body, before, child_from_parent(body, starts_[b]));
    const int parent_sensor = model_.bodies[parent].sensor;
    is_unseen_[b] = (body.sensor >= 0 && !is_seen) ||
                    (parent_sensor >= 0 && block_.sensors[static_cast<std::size_t>(parent_sensor)].force_count == 0);
    if (body.sensor < 0 || is_seen) return;
    // Gravity as the parent sees it, turned by a position that is a guess.
    seen_[b].force_sd = std::hypot(before.force_sd, model_.gravity * starts_[b].sd.norm());
  }

  void guess_start(std::size_t b) {
    for (Index i = 0; i < degrees_of_freedom(model_.bodies[b].motion); ++i) {
      const PositionGuess& g = guess_[static_cast<std::size_t>(model_.layout.position[b] + i)];
      starts_[b].position[i] = model_.bodies[b].motion == JointMotion::spherical ? 0.0 : g.value;
      starts_[b].sd[i] = g.sd;
      starts_[b].is_known[static_cast<std::size_t>(i)] = g.is_given;
    }
  }

  void place_first_of_universal(std::size_t b) {
    const InsBody& body = model_.bodies[b];
    const auto child = std::find_if(model_.bodies.begin() + static_cast<std::ptrdiff_t>(b) + 1, model_.bodies.end(),
                                    [&](const InsBody& x) { return x.parent == static_cast<int>(b); });
    const SeenBody& before = seen_[static_cast<std::size_t>(body.parent)];
    guess_start(b);
    if (child != model_.bodies.end() && child->motion == JointMotion::revolute && child->sensor >= 0 &&
        block_.sensors[static_cast<std::size_t>(child->sensor)].force_count > 0) {
      const auto c = static_cast<std::size_t>(child - model_.bodies.begin());
      const SeenBody own = seen_body(model_, block_, *child, before, Mat3::Identity());
      const auto starts = UniversalStart(body, *child, before, own).at({guess(b), guess(c)}, block_.time);
      starts_[b] = starts[0], starts_[c] = starts[1];
      is_second_of_universal_ = static_cast<int>(c);
    }
    seen_[b] = seen_body(model_, block_, body, before, child_from_parent(body, starts_[b]));
  }

  const FilterModel& model_;
  const BlockMeasurement& block_;
  const std::vector<PositionGuess>& guess_;
  std::vector<JointStart> starts_;
  std::vector<SeenBody> seen_;
  std::vector<bool> is_unseen_;
  int is_second_of_universal_ = -1;
};

}  // namespace

bool parent_moves(const FilterModel& model, std::size_t body, BaseMode base) {
  if (base == BaseMode::moving) return true;
  for (int a = model.bodies[body].parent; a > 0; a = model.bodies[static_cast<std::size_t>(a)].parent)
    if (model.layout.position[static_cast<std::size_t>(a)] >= 0) return true;
  return false;
}

bool motion_shows_heading(const FilterModel& model, std::size_t body) {
  if (model.bodies[body].motion != JointMotion::spherical || model.is_loose(body)) return false;
  const auto is_tight = [&](int sensor) {
    if (sensor < 0) return false;
    const SensorSettings& of = model.sensors[static_cast<std::size_t>(sensor)];
    return of.persistent.rate <= of.white.rate && of.persistent.force <= of.white.force;
  };
  return is_tight(model.bodies[body].sensor) &&
         is_tight(model.bodies[static_cast<std::size_t>(model.bodies[body].parent)].sensor);
}

double heading_sd(const FilterModel& model, std::size_t body, const std::vector<PositionGuess>& guess, const Vec3& up) {
  Vec3 half;
  for (Index i = 0; i < 3; ++i) half[i] = guess[static_cast<std::size_t>(model.layout.position[body] + i)].sd;
  return half.cwiseProduct(up).norm() / std::sqrt(3.0);
}

InitialPosture initial_posture(const FilterModel& model, const BlockMeasurement& block,
                               const std::vector<PositionGuess>& guess, BaseMode base) {
  const FilterLayout& layout = model.layout;
  const PostureStart found(model, block, guess);
  InitialPosture posture{.state = initial_state(model),
                         .covariance = MatrixXd::Zero(layout.fast, layout.fast),
                         .positions = std::vector<StartPosition>(static_cast<std::size_t>(layout.positions))};
  ChainState& state = posture.state;
  state.time = block.time;
  state.base = base;
  state.world_R_base = levelled(found.seen(0).force);
  const auto set = [&](Index first, double sd) {
    posture.covariance.diagonal().segment<3>(first).setConstant(sd * sd);
  };
  const double tilt_sd = found.seen(0).force_sd / model.gravity;
  const Vec3 up = found.seen(0).force.normalized();  // the heading counts from here
  posture.covariance.topLeftCorner<3, 3>() = tilt_sd * tilt_sd * (Mat3::Identity() - up * up.transpose());
  if (base == BaseMode::moving) {
    state.rate = found.seen(0).rate;
    set(BaseIndex::rate, start_rate_sd);
    set(BaseIndex::angular_acceleration, model.base_rotation.sd);
    set(BaseIndex::velocity, start_velocity_sd);
    set(BaseIndex::acceleration, model.base_translation.sd);
  }
  const auto ball_is_shown = [&](std::size_t b) {
    return base == BaseMode::moving || (parent_moves(model, b, base) && !found.is_unseen(b));
  };
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const InsBody& body = model.bodies[b];
    const Index dof = degrees_of_freedom(body.motion);
    const JointStart& start = found.joint(b);
    state.spherical[b] = start.spherical;
    const Vec3 relative =
        body.child_R_axis.transpose() *
        (found.seen(b).rate - child_from_parent(body, start) * found.seen(static_cast<std::size_t>(body.parent)).rate);
    for (Index i = 0; i < dof; ++i) {
      const Index at = layout.position[b] + i, row = layout.joint_state(at);
      const bool is_revolute = body.motion == JointMotion::revolute;
      if (dof == 1) state.joints[position_states * at] = start.position[i];
      const bool rate_is_seen = body.motion != JointMotion::prismatic && body.sensor >= 0;
      if (rate_is_seen) state.joints[position_states * at + 1] = is_revolute ? relative.z() : relative[i];
      const AccelerationProcess& process = model.positions[static_cast<std::size_t>(at)];
      posture.covariance(row, row) = start.sd[i] * start.sd[i];
      // Gravity does not show the heading: it counts from here, unless motion will show it.
      const bool is_ball = motion_shows_heading(model, b),
                 is_shown = dof == 3 && !start.is_known[0] && (is_ball ? ball_is_shown(b) : base == BaseMode::moving);
      const double heading_sd = !is_shown ? start.heading_sd
                                : is_ball ? track::heading_sd(model, b, guess, start.heading)
                                          : start_heading_sd;
      for (Index j = 0; j < dof && dof == 3; ++j) {
        const double of_heading = start.heading[i] * start.heading[j],
                     covariance = start.sd[i] * start.sd[j] * ((i == j ? 1.0 : 0.0) - of_heading) +
                                  heading_sd * heading_sd * of_heading;
        posture.covariance(row, layout.joint_state(layout.position[b] + j)) = covariance;
      }
      const double rate_sd = rate_is_seen                            ? start_rate_sd
                             : body.motion == JointMotion::prismatic ? start_prismatic_speed
                                                                     : process.sd * process.time;
      posture.covariance(row + 1, row + 1) = rate_sd * rate_sd;
      posture.covariance(row + 2, row + 2) = process.sd * process.sd;
      posture.positions[static_cast<std::size_t>(at)] = {
          .is_known = is_shown || start.is_known[static_cast<std::size_t>(i)],
          .is_unseen = found.is_unseen(b),
          .is_blurred = start.is_blurred,
          .is_rough = start.is_rough,
          .has_open_heading = is_ball && is_shown,
          .lost_sd = start.lost_sd,
          .contradicts_given = start.contradicts_given};
    }
  }
  return posture;
}

}  // namespace kinfer::track
