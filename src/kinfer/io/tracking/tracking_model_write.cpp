// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>

#include "kinfer/io/text/quoted_text.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

std::string vector_text(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

/// Row by row.
std::string matrix_text(const Mat3& m) {
  const Mat3 rows = m.transpose();
  return fmt::format("[{}]", fmt::join(rows.data(), rows.data() + 9, ", "));
}

std::string pair_text(const InsLevel& level) {
  return fmt::format("[{}, {}]", level.rate, level.force);
}

std::string head_text(const TrackingModel& model) {
  const TrackingPrior& p = model.prior;
  const TrackingBase& b = model.base;
  return fmt::format(
             "# What kinfer track needs besides chain.toml (docs/formats.md). SI throughout; pairs: gyroscope, "
             "accelerometer.\ngravity = {}\ngravity_sd = {}\n\n[prior]\nrotation = {}\npoint = {}\nbias = {}\nscale = "
             "{}\nbias_instability = {}\ninstability_time = {}\n",
             model.gravity, model.gravity_sd, p.rotation, p.point, pair_text(p.bias), pair_text(p.scale),
             pair_text(p.bias_instability), p.instability_time) +
         fmt::format(
             "\n[base]\nmoved = {}\nforce = {}\nangular_acceleration = {}\nacceleration = {}\n\n[tool]\nbody = {}\nxyz "
             "= {}\nrotation = {}\nsd = {}\n",
             b.moved, vector_text(b.force), b.angular_acceleration, b.acceleration, model.tool.body,
             vector_text(model.tool.body_T_tool.position), matrix_text(model.tool.body_T_tool.rotation),
             vector_text(model.tool.sd));
}

std::string sensor_text(const TrackingSensor& s) {
  return fmt::format(
             "\n[[sensor]]\nname = {}\nbody = {}\ngyroscope_bias = {}\naccelerometer_bias = {}\ngyroscope_scale = "
             "{}\naccelerometer_scale = {}\n",
             quoted_text(s.name), s.body, vector_text(s.gyroscope_bias), vector_text(s.accelerometer_bias),
             matrix_text(s.gyroscope_scale), matrix_text(s.accelerometer_scale)) +
         fmt::format(
             "noise = {}\nresidual = {}\nslow_residual = {}\nsample_period = {}\nmount_compliance = {}\nmount_stray = "
             "{}\nclock_offset = {}\nclock_offset_sd = {}\n",
             pair_text(s.noise), pair_text(s.residual), pair_text(s.slow_residual), s.sample_period,
             matrix_text(s.mount_compliance), s.mount_stray, s.clock_offset, s.clock_offset_sd);
}

std::string body_text(const TrackingBody& b) {
  return fmt::format(
      "\n[[body]]\nparent = {}\nsensor = {}\njoint = {}\nmotion = \"{}\"\nparent_R_axis = {}\nchild_R_axis = "
      "{}\npoint_in_parent = {}\npoint_in_child = {}\n",
      b.parent, b.sensor, b.joint, name(b.motion), matrix_text(b.parent_R_axis), matrix_text(b.child_R_axis),
      vector_text(b.point_in_parent), vector_text(b.point_in_child));
}

std::string joint_text(const TrackingJoint& j) {
  std::string text = fmt::format("\n[[joint]]\nname = {}\ntype = \"{}\"\nstray = {}\nstray_time = {}\n",
                                 quoted_text(j.name), name(j.type), j.stray, j.stray_time);
  for (const TrackingRange& r : j.range)
    text += fmt::format("[[joint.range]]\nlower = {}\nupper = {}\nspeed = {}\nacceleration = {}\n", r.lower, r.upper,
                        r.speed, r.acceleration);
  return text;
}

/// l with l lᵀ = covariance; a trace of noise makes what is certain by definition regular.
MatrixXd covariance_root(const MatrixXd& covariance) {
  constexpr double trace_of_noise = 1e-12;  // relative to each parameter's variance
  const VectorXd sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const VectorXd inverse = sd.unaryExpr([](double value) { return value > 0.0 ? 1.0 / value : 0.0; });
  MatrixXd correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  for (double noise = trace_of_noise; noise < 1.0; noise *= 10.0) {
    MatrixXd regular = correlation;
    for (Index i = 0; i < sd.size(); ++i) regular(i, i) = 1.0 + noise;
    if (const auto root = cholesky(regular)) return sd.asDiagonal() * *root;
  }
  return sd.asDiagonal();
}

std::string covariance_text(const TrackingModel& model) {
  std::vector<std::string> names;
  for (const TrackingParameter& p : model.parameters)
    names.push_back(fmt::format("\"{} {} {}\"", name(p.kind), p.index, p.component));
  std::string text = fmt::format("\n[covariance]\nparameters = [{}]\nroot = [\n", fmt::join(names, ", "));
  const MatrixXd root = covariance_root(model.covariance);
  for (Index i = 0; i < root.rows(); ++i) {
    for (Index j = 0; j <= i; ++j) text += fmt::format("{}{:.9g}", j == 0 ? "  " : ", ", root(i, j));
    text += ",\n";
  }
  return text + "]\n";
}

}  // namespace

std::string format_tracking_model(const TrackingModel& model) {
  std::string text = head_text(model);
  for (const TrackingSensor& sensor : model.sensors) text += sensor_text(sensor);
  for (const TrackingBody& body : model.bodies) text += body_text(body);
  for (const TrackingJoint& joint : model.joints) text += joint_text(joint);
  return text + covariance_text(model);
}

}  // namespace kinfer
