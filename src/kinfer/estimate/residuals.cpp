#include "kinfer/estimate/residuals.hpp"

#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double noise_free_sd = 1e-9;        // [m]; FORMATS: 0 means noise-free, floor 1e-6 mm
constexpr double noise_free_angle_sd = 1e-9;  // [rad]

Load load_at(const PoseSet& data, Eigen::Index row) {
  return {.payload = data.payload.empty() ? 0.0 : data.payload[row]};
}

Vec3 target_in_tool(const Chain& chain, int target) {
  return target < 0 ? Vec3::Zero().eval() : chain.targets[target].xyz;
}

/// Writes blocks of three rows one after the other.
struct Writer {
  VectorXd& residuals;
  MatrixXd* jacobian;
  Eigen::Index row = 0;
};

void write_points(const Chain& chain, const PoseSet& data, const EvaluatedPoses& at, const Weights& weights,
                  Writer& out) {
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const PointMeasurement& point = data.points[i];
    const Pose& pose = at.pose[point.row];
    const Vec3 arm = pose.rotation * target_in_tool(chain, point.target);
    const Vec3 inverse_sd = weights.point_sd[i].cwiseInverse();
    out.residuals.segment<3>(out.row) = inverse_sd.cwiseProduct(point.position - pose.position - arm);
    if (out.jacobian) {
      // d(p + arm) = dp + dω × arm
      const Twists& twist = at.twists[point.row];
      auto block = out.jacobian->middleRows<3>(out.row);
      if (point.target < 0) {
        block = -(inverse_sd.asDiagonal() * twist.topRows<3>());
      } else {
        const Mat3 turn = -skew(arm);
        block = -(inverse_sd.asDiagonal() * (twist.topRows<3>() + turn * twist.bottomRows<3>()));
      }
    }
    out.row += 3;
  }
}

void write_orientations(const PoseSet& data, const EvaluatedPoses& at, const Weights& weights, Writer& out) {
  for (std::size_t i = 0; i < data.orientations.size(); ++i) {
    const OrientationMeasurement& measured = data.orientations[i];
    const Mat3 misfit = measured.orientation.toRotationMatrix() * at.pose[measured.row].rotation.transpose();
    const Vec3 error = log_so3(misfit);
    const double inverse_sd = 1.0 / weights.orientation_sd[i];
    out.residuals.segment<3>(out.row) = inverse_sd * error;
    // R_measured (exp(δ) R)ᵀ = exp(error) exp(−δ), so d error = −J_r⁻¹(error) δ
    if (out.jacobian)
      out.jacobian->middleRows<3>(out.row) =
          -inverse_sd * right_jacobian_inverse(error) * at.twists[measured.row].bottomRows<3>();
    out.row += 3;
  }
}

void write_priors(const std::vector<const Parameter*>& free, ConstVectorRef x, Writer& out) {
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double inverse_sd = 1.0 / free[k]->prior_sd;  // 0 where there is no prior
    const auto column = static_cast<Eigen::Index>(k);
    out.residuals[out.row] = inverse_sd * (x[column] - free[k]->nominal);
    if (out.jacobian) {
      out.jacobian->row(out.row).setZero();
      (*out.jacobian)(out.row, column) = inverse_sd;
    }
    ++out.row;
  }
}

}  // namespace

EvaluatedPoses evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative) {
  const PoseEvaluator evaluator(chain, set);
  EvaluatedPoses at;
  at.pose.resize(data.rows());
  if (derivative == Derivative::yes) at.twists.resize(data.rows());
  for (Eigen::Index row = 0; row < data.rows(); ++row) {
    const auto q = data.joints.col(row);
    const Load load = load_at(data, row);
    at.pose[row] = derivative == Derivative::yes ? evaluator.pose_and_derivative(q, load, at.twists[row])
                                                 : evaluator.pose(q, load);
  }
  return at;
}

Weights weights_of(const PoseSet& data, const Instrument& instrument) {
  Weights weights;
  for (const PointMeasurement& point : data.points) {
    const double sd = std::max(position_sd(instrument, point.position), noise_free_sd);
    weights.point_sd.push_back(point.sd ? point.sd->cwiseMax(noise_free_sd).eval() : Vec3::Constant(sd));
  }
  weights.orientation_sd.assign(data.orientations.size(), std::max(instrument.sigma_angle, noise_free_angle_sd));
  return weights;
}

std::vector<Block> blocks_of(const PoseSet& data) {
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < data.points.size(); ++i)
    blocks.push_back({MeasurementKind::point, static_cast<int>(i), data.points[i].row});
  for (std::size_t i = 0; i < data.orientations.size(); ++i)
    blocks.push_back({MeasurementKind::orientation, static_cast<int>(i), data.orientations[i].row});
  return blocks;
}

Residuals pose_residuals(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights) {
  const auto blocks = data.points.size() + data.orientations.size();
  const Eigen::Index unknowns = set.free_count(), rows = static_cast<Eigen::Index>(3 * blocks) + unknowns;
  Residuals problem;
  problem.unknowns = unknowns;
  problem.rows = rows;
  problem.blocks.assign(blocks, 3);
  problem.evaluate = [&nominal, &set, &data, &weights, unknowns, rows](ConstVectorRef x, VectorXd& r,
                                                                       MatrixXd* jacobian) {
    const Chain chain = unpack(set, nominal, x);
    const EvaluatedPoses at = evaluate_poses(chain, set, data, jacobian ? Derivative::yes : Derivative::no);
    r.resize(rows);
    if (jacobian) jacobian->resize(rows, unknowns);
    Writer out{r, jacobian};
    write_points(chain, data, at, weights, out);
    write_orientations(data, at, weights, out);
    write_priors(set.free(), x, out);
  };
  return problem;
}

std::vector<double> point_errors(const Chain& chain, const PoseSet& data) {
  const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no);
  std::vector<double> errors;
  for (const PointMeasurement& point : data.points)
    errors.push_back((point.position - at.pose[point.row] * target_in_tool(chain, point.target)).norm());
  return errors;
}

std::vector<double> orientation_errors(const Chain& chain, const PoseSet& data) {
  const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no);
  std::vector<double> errors;
  for (const OrientationMeasurement& measured : data.orientations)
    errors.push_back(angle_between(at.pose[measured.row].rotation, measured.orientation.toRotationMatrix()));
  return errors;
}

}  // namespace kinfer
