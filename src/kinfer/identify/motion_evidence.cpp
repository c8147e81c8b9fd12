#include "kinfer/identify/motion_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

constexpr std::size_t most_bins = 500;    // of a trace: about one for two pixels of a wide screen
constexpr std::size_t most_frames = 600;  // of the film

/// Three axes of one signal at every row, NaN where the row is not to be used.
using Signals = std::array<std::vector<double>, 3>;

template <class Vector>
Signals axes_of(const RecordedMotion& motion, Vector vector_at) {
  Signals axes;
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const Vec3 v = motion.usable[row] ? vector_at(row) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index k = 0; k < 3; ++k) axes[static_cast<std::size_t>(k)].push_back(v[k]);
  }
  return axes;
}

/// Of the rows that are marked so.
double rms(const Signals& axes, const std::vector<bool>& marked, bool mark) {
  double sum = 0.0, count = 0.0;
  for (std::size_t row = 0; row < axes[0].size(); ++row) {
    const double square = axes[0][row] * axes[0][row] + axes[1][row] * axes[1][row] + axes[2][row] * axes[2][row];
    if (marked[row] == mark && std::isfinite(square)) sum += square, count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

std::vector<bool> rows_in(const std::vector<double>& time, const std::vector<TimeWindow>& windows) {
  std::vector<bool> inside;
  for (const double t : time)
    inside.push_back(std::ranges::any_of(windows, [t](const TimeWindow& w) { return t >= w.begin && t < w.end; }));
  return inside;
}

/// `unseen`: rows of the held-out windows; `foreseen`: what the chain predicts there that did not see them.
template <class Measured, class Predicted>
Trace trace_of(const RecordedMotion& motion, Trace trace, const std::vector<bool>& unseen, Measured measured,
               Predicted predicted, Predicted foreseen) {
  const Binning bins = binning(motion.rows(), most_bins);
  const Signals m = axes_of(motion, measured), p = axes_of(motion, predicted);
  const Signals r = axes_of(motion, [&](std::size_t row) -> Vec3 { return measured(row) - predicted(row); });
  for (std::size_t k = 0; k < 3; ++k) {
    trace.measured[k] = envelope(m[k], bins);
    trace.predicted[k] = envelope(p[k], bins);
    trace.residual[k] = envelope(r[k], bins);
  }
  const std::vector<bool> all(motion.rows(), true);
  trace.rms_measured = rms(m, all, true);
  trace.rms_fitted = rms(r, unseen, false);
  trace.rms_holdout =
      rms(axes_of(motion, [&](std::size_t row) -> Vec3 { return measured(row) - foreseen(row); }), unseen, true);
  return trace;
}

/// Accelerations and rates of a segment in the ground, one a row.
struct Foreseen {
  std::vector<Vec3> acceleration, rate;
};

std::size_t index_of_segment(const RecordedMotion& motion, const std::string& sensor) {
  return static_cast<std::size_t>(std::ranges::find(motion.segments, sensor, &SegmentMotion::name) -
                                  motion.segments.begin());
}

/// Acceleration of a point of the segment less that of its sensor, for the point's place in the sensor.
Vec3 of_lever(const SegmentMotion& segment, std::size_t row, const Vec3& lever) {
  const Vec3 arm = segment.rotation[row] * lever, &rate = segment.rate[row];
  return segment.rate_change[row].cross(arm) + rate.cross(rate.cross(arm));
}

Vec3 along(const Vec3& axis, const Vec3& v) {
  return axis.dot(v) * axis;
}

Foreseen carried_over(const FoundJoint& joint, const SegmentMotion& parent, const SegmentMotion& child,
                      const Foreseen& before) {
  Foreseen result;
  for (std::size_t row = 0; row < parent.rate.size(); ++row) {
    const Vec3 axis = parent.rotation[row] * joint.axis_in_parent;
    Vec3 acceleration = before.acceleration[row] + of_lever(parent, row, joint.point_in_parent) -
                        of_lever(child, row, joint.point_in_child);
    Vec3 rate = before.rate[row];
    if (joint.type == FoundJointType::prismatic) acceleration += along(axis, child.acceleration[row] - acceleration);
    if (joint.type == FoundJointType::revolute)
      rate += along(axis, child.rate[row] - rate);
    else if (joint.type != FoundJointType::prismatic && joint.type != FoundJointType::rigid)
      rate = child.rate[row];  // turns about several axes: no rate contradicts it
    result.acceleration.push_back(acceleration);
    result.rate.push_back(rate);
  }
  return result;
}

using ForeseenMotion = std::map<std::string, Foreseen>;

/// Of every segment that the joints reach.
ForeseenMotion predictions_of(const RecordedMotion& motion, const std::string& root_name,
                              const std::vector<FoundJoint>& joints) {
  const SegmentMotion& root = motion.segments[index_of_segment(motion, root_name)];
  ForeseenMotion predictions{{root_name, {root.acceleration, root.rate}}};
  for (const FoundJoint& joint : joints)
    predictions[joint.child] =
        carried_over(joint, motion.segments[index_of_segment(motion, joint.parent)],
                     motion.segments[index_of_segment(motion, joint.child)], predictions.at(joint.parent));
  return predictions;
}

void add_traces(MotionEvidence& evidence, const RecordedMotion& motion, const SegmentMotion& segment,
                const std::vector<bool>& unseen, const Foreseen& prediction, const Foreseen& unseeing) {
  const auto add = [&](const char* quantity, const char* unit, const std::vector<Vec3>& measured,
                       const std::vector<Vec3>& predicted, const std::vector<Vec3>& foreseen) {
    const auto of = [](const std::vector<Vec3>& rows) {
      return [&rows](std::size_t row) -> Vec3 { return rows[row]; };
    };
    Trace trace{.sensor = segment.name, .quantity = quantity, .unit = unit, .frame = "ground"};
    evidence.traces.push_back(trace_of(motion, std::move(trace), unseen, of(measured), of(predicted), of(foreseen)));
  };
  add("acceleration", "m/s^2", segment.acceleration, prediction.acceleration, unseeing.acceleration);
  add("rate", "rad/s", segment.rate, prediction.rate, unseeing.rate);
}

std::vector<double> middles(const std::vector<double>& time, const Binning& bins) {
  std::vector<double> middle;
  for (std::size_t i = 0; i < time.size(); i += bins.size)
    middle.push_back(0.5 * (time[i] + time[std::min(i + bins.size, time.size()) - 1]));
  return middle;
}

int frame_named(const Chain& chain, const std::string& name) {
  const auto found = std::ranges::find(chain.joints, name, &Joint::name);
  return found == chain.joints.end() ? -1 : static_cast<int>(found - chain.joints.begin());
}

/// Angle of the hinge that the child's orientation in the parent is nearest to.
double angle_at(const Vec3& axis_in_parent, const Mat3& home, const Mat3& parent, const Mat3& child) {
  const Quat turn(Mat3(parent.transpose() * child * home.transpose()));
  return 2.0 * std::atan2(axis_in_parent.dot(turn.vec()), turn.w());
}

/// Nearest to the angle before, so that a film does not jump by a turn.
double continued(double angle, double before) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return angle + turn * std::round((before - angle) / turn);
}

void play_joint(MatrixXd& q, Eigen::Index reading, const FoundJoint& joint, const Mat3& home,
                const SegmentMotion& parent, const SegmentMotion& child, std::size_t step) {
  double before = 0.0;
  for (Eigen::Index k = 0; k < q.cols(); ++k) {
    const std::size_t row = static_cast<std::size_t>(k) * step;
    before = continued(angle_at(joint.axis_in_parent, home, parent.rotation[row], child.rotation[row]), before);
    q(reading, k) = before;
  }
}

/// That a joint has in the chain.
Eigen::Index variables(FoundJointType type) {
  switch (type) {
    case FoundJointType::rigid:
      return 0;
    case FoundJointType::universal:
      return 2;
    case FoundJointType::spherical:
      return 3;
    case FoundJointType::revolute:
    case FoundJointType::prismatic:
      break;
  }
  return 1;
}

Playback playback_of(const RecordedMotion& motion, const Identification& found) {
  const Binning bins = binning(motion.rows(), most_frames);
  const std::vector<int> readings = joints_with_reading(found.chain);
  const std::vector<Pose> home = joint_frames(found.chain, VectorXd::Zero(dof(found.chain)));
  Playback film;
  film.q = MatrixXd::Zero(dof(found.chain), static_cast<Eigen::Index>(bins.count()));
  const SegmentMotion& root = motion.segments[index_of_segment(motion, found.root)];
  film.time = film_times(motion);
  for (std::size_t row = 0; row < motion.rows(); row += bins.size) {
    const Quat r(root.rotation[row]);
    film.root.push_back({r.w(), r.x(), r.y(), r.z()});
  }
  if (root.still) film.root.resize(1);
  Eigen::Index row = 0;
  for (const FoundJoint& joint : found.joints) {  // their variables stand in the chain in the same order
    if (joint.film.size() > 0) film.q.middleRows(row, joint.film.rows()) = joint.film;
    row += variables(joint.type);
  }
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const std::string& name = found.chain.joints[readings[k]].name;
    const auto joint =
        std::ranges::find_if(found.joints, [&](const FoundJoint& j) { return j.parent + "-" + j.child == name; });
    if (joint == found.joints.end() || joint->type != FoundJointType::revolute || joint->film.size() > 0) continue;
    const int parent = frame_named(found.chain, joint->parent), child = frame_named(found.chain, joint->child);
    const Mat3 parent_home = parent < 0 ? found.chain.base.pose().rotation : home[parent].rotation;
    play_joint(film.q, static_cast<Eigen::Index>(k), *joint, parent_home.transpose() * home[child].rotation,
               motion.segments[index_of_segment(motion, joint->parent)],
               motion.segments[index_of_segment(motion, joint->child)], bins.size);
  }
  return film;
}

}  // namespace

std::vector<double> film_times(const RecordedMotion& motion) {
  std::vector<double> times;
  for (std::size_t row = 0; row < motion.rows(); row += binning(motion.rows(), most_frames).size)
    times.push_back(motion.time[row]);
  return times;
}

MotionEvidence motion_evidence(const RecordedMotion& motion, const Identification& found, const HeldOut& held) {
  MotionEvidence evidence;
  evidence.time = middles(motion.time, binning(motion.rows(), most_bins));
  evidence.held_out = held.windows;
  const std::vector<bool> unseen = rows_in(motion.time, held.windows);
  const ForeseenMotion seen = predictions_of(motion, found.root, found.joints),
                       foreseen = predictions_of(motion, found.root, held.windows.empty() ? found.joints : held.joints);
  for (const FoundJoint& joint : found.joints)
    add_traces(evidence, motion, motion.segments[index_of_segment(motion, joint.child)], unseen, seen.at(joint.child),
               foreseen.at(joint.child));
  evidence.playback = playback_of(motion, found);
  return evidence;
}

}  // namespace kinfer
