// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/scales/scale_findings.hpp"

#include <array>
#include <cmath>

#include "kinfer/estimate/continuous/solver/model_error.hpp"
#include "kinfer/identify/refinement/scales/scale_parameters.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using namespace scale_parameters;
using Index = Eigen::Index;

struct Estimate {
  double value = 0.0, sd = 0.0;
};

/// The best estimate of x where a measurement is x along `direction`, with `information`.
Estimate along(const VectorXd& direction, const VectorXd& value, ConstMatrixRef information) {
  const VectorXd weighted = information * direction;
  const double total = weighted.dot(direction);
  return {weighted.dot(value) / total, 1.0 / std::sqrt(total)};
}

/// Of all gyroscopes, that of the least variance.
Estimate common_residual(const InsFit& fit, ConstMatrixRef covariance) {
  const std::vector<Index> at = indices_of_scales(fit.layout);
  const VectorXd values = scale_values(fit.unknowns.errors);
  const VectorXd direction = common_factor(fit.unknowns.errors.size());
  const auto information = invert_spd(covariance(at, at));
  return information ? along(direction, values, *information) : Estimate{direction.dot(values) / direction.sum(), 0.0};
}

/// Of all gyroscopes: what they were divided by, and what the fit found beside it.
Estimate common_scale(const InsFit& fit, ConstMatrixRef covariance, const InsCommonScale& divided) {
  const Estimate residual = common_residual(fit, covariance);
  return {divided.factor * (1.0 + residual.value) - 1.0, divided.factor * residual.sd};
}

/// A clock that is wrong, found before the fit or by it.
bool is_clock_wrong(const ScaleReview& review, const InsCommonScales& divided) {
  return review.common_sd > 0.0 || !divided.gyroscope.is_none();
}

/// [rad] Rotation of a sensor's gyroscope against its accelerometer.
Estimate rotation_between(std::size_t sensor, const InsFit& fit, ConstMatrixRef covariance) {
  const InsErrors& errors = fit.unknowns.errors[sensor];
  const Mat3 between = errors.gyroscope_scale - errors.accelerometer_scale;
  MatrixXd rotation(3, each);
  rotation << 0.5 * rotations().transpose(), -0.5 * rotations().transpose();
  const MatrixXd own = propagated_covariance(
      rotation,
      covariance.block(fit.layout.error[sensor] + first_scale, fit.layout.error[sensor] + first_scale, each, each));
  const VectorXd turned = 0.5 * rotations().transpose() * Eigen::Map<const VectorXd>(between.data(), elements);
  return {turned.norm(), std::sqrt(own.trace() / 3.0)};
}

/// What of a matrix deviates most: "all", its scale; "x", "y", "z", that of one axis; "axes", their directions.
struct MatrixDeviation {
  std::string_view part = "axes";
  Estimate size;
};

MatrixDeviation deviation_of(const DeviantScale& deviant, const InsFit& fit, ConstMatrixRef covariance) {
  const InsErrors& errors = fit.unknowns.errors[deviant.sensor];
  const bool is_gyroscope = deviant.instrument == InsInstrument::gyroscope;
  const Mat3& matrix = is_gyroscope ? errors.gyroscope_scale : errors.accelerometer_scale;
  const Index first = fit.layout.error[deviant.sensor] + first_scale + (is_gyroscope ? 0 : elements);
  const VectorXd values = Eigen::Map<const VectorXd>(matrix.data(), elements);
  const MatrixXd own = covariance.block(first, first, elements, elements);
  const double skewness = std::sqrt((values.squaredNorm() - matrix.diagonal().squaredNorm()) / 2.0);
  MatrixDeviation best{.part = "axes", .size = {skewness, std::sqrt(own.trace() / elements)}};
  const auto information = invert_spd(own);
  if (!information) return best;
  double most = 0.5 * values.dot(*information * values);  // half of what the matrix explains
  const auto consider = [&](std::string_view part, const VectorXd& direction) {
    const Estimate size = along(direction, values, *information);
    if (const double explained = size.value * size.value / (size.sd * size.sd); explained > most)
      best = {part, size}, most = explained;
  };
  constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  VectorXd all = VectorXd::Zero(elements);
  for (const Index k : diagonal) all[k] = 1.0;
  consider("all", all);
  for (std::size_t k = 0; k < 3; ++k) consider(axes[k], VectorXd::Unit(elements, diagonal[k]));
  return best;
}

}  // namespace

Finding clock_rate_finding(double scale, double sd, Severity severity) {
  return {.kind = FindingKind::clock_rate, .severity = severity, .values = {{"scale", scale}, {"sd", sd}}};
}

std::vector<Finding> scale_findings(const ScaleReview& review, const RecordedMotion& motion,
                                    const InsCommonScales& divided, const InsFit& fit,
                                    const InsCovariance& covariance) {
  std::vector<Finding> findings;
  if (is_clock_wrong(review, divided)) {
    const Estimate common = common_scale(fit, covariance.model, divided.gyroscope);
    findings.push_back(clock_rate_finding(common.value, common.sd, Severity::warning));
  }
  for (const DeviantScale& deviant : review.deviant) {
    const MatrixDeviation deviation = deviation_of(deviant, fit, covariance.model);
    findings.push_back(
        {.kind = FindingKind::instrument_scale,
         .severity = Severity::warning,
         .values = {{"sensor", motion.segments[deviant.sensor].name},
                    {"instrument", deviant.instrument == InsInstrument::gyroscope ? "gyroscope" : "accelerometer"},
                    {"part", std::string(deviation.part)},
                    {"scale", deviation.size.value},
                    {"sd", deviation.size.sd}},
         .applied = true});
  }
  for (const TurnedAxes& turned : review.turned) {
    const Estimate angle = rotation_between(turned.sensor, fit, covariance.model);
    findings.push_back({.kind = FindingKind::instrument_scale,
                        .severity = Severity::warning,
                        .values = {{"sensor", motion.segments[turned.sensor].name},
                                   {"instrument", "gyroscope"},
                                   {"part", "turned"},
                                   {"scale", angle.value},
                                   {"sd", angle.sd}}});
  }
  return findings;
}

void add_clock_rate(const ScaleReview& review, const InsCommonScales& divided, const InsFit& fit,
                    const InsCovariance& covariance, ModelError& error) {
  if (!is_clock_wrong(review, divided)) return;
  const double rate = 1.0 + common_scale(fit, covariance.model, divided.gyroscope).value,
               change = 1.0 / (rate * rate) - 1.0;
  const InsBodies& bodies = fit.unknowns.bodies;
  if (error.shift.empty()) {
    error.mount_deflection.assign(fit.unknowns.errors.size(), 0.0);
    for (const InsBody& body : bodies) error.shift.emplace_back(body.unknowns(), 0);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const InsBody& body = bodies[b];
    MatrixXd& shift = error.shift[b];
    shift.conservativeResize(Eigen::NoChange, shift.cols() + 1);
    shift.rightCols<1>().setZero();
    // The points are the last of a body's unknowns, that in the child after that in the parent.
    const Index in_child = shift.rows() - 3, in_parent = body.free_point_in_child ? in_child - 3 : in_child;
    if (body.free_point_in_child) shift.col(shift.cols() - 1).segment<3>(in_child) = change * body.point_in_child;
    if (body.free_point_in_parent) shift.col(shift.cols() - 1).segment<3>(in_parent) = change * body.point_in_parent;
  }
}

}  // namespace kinfer::identify
