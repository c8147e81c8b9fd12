// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/gear_harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/functions/beside_functions.hpp"
#include "kinfer/calibrate/functions/pose_means.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/linalg/fourier_sums.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer::calibrate {
namespace {

/// One measured point, in units of the noise: with J the derivative of the point by the joint angle and r the residual,
/// weight = JᵀJ and along = Jᵀr.
struct Sample {
  double angle = 0.0;  // [rad] joint position
  double weight = 0.0, projection = 0.0;
};

std::vector<Sample> samples_of(const Estimate& fitted, const PoseSet& rows, int joint, int joint_row) {
  std::set<int> wrong;
  for (const Outlier& outlier : fitted.outliers) wrong.insert(outlier.row);
  std::vector<Sample> samples;
  ParameterSet angle;
  angle.parameters.push_back(parameter_at(fitted.chain, JointNumber{joint, Field::gain}, 1.0));
  const EvaluatedPoses at = evaluate_poses(fitted.chain, angle, rows, Derivative::yes);
  for (const PointMeasurement& point : rows.points) {
    const double q = rows.joints(joint_row, point.row);
    if (wrong.contains(point.row) || point.target >= 0 || std::abs(q) < 1e-6) continue;
    // The Jacobian column of the gain is the column of the joint angle times q.
    const Vec3 residual = (point.position - at.pose[point.row].position) / fitted.sigma;
    const Vec3 lever = at.twists[point.row].col(0).head<3>() / (q * fitted.sigma);
    samples.push_back({q, lever.squaredNorm(), lever.dot(residual)});
  }
  return samples;
}

/// Normal equations of the amplitudes of a sine and a cosine of one order.
struct WaveEquations {
  double ss = 0.0, cc = 0.0, sc = 0.0;  ///< they do not depend on the residuals
  double sr = 0.0, cr = 0.0;
};

/// The least-squares amplitudes of a wave, and the reduction of the sum of squares.
struct WaveFit {
  double sine = 0.0, cosine = 0.0, improvement = 0.0;
};

WaveFit solve(const WaveEquations& e) {
  const double determinant = e.ss * e.cc - e.sc * e.sc;
  if (!(determinant > 1e-6 * e.ss * e.cc)) return {};
  const double sine = (e.sr * e.cc - e.cr * e.sc) / determinant, cosine = (e.cr * e.ss - e.sr * e.sc) / determinant;
  return {sine, cosine, sine * e.sr + cosine * e.cr};
}

WaveFit fit_wave(const std::vector<Sample>& samples, double order) {
  WaveEquations e;
  for (const Sample& sample : samples) {
    double s = 0.0, c = 0.0;
    ::sincos(order * sample.angle, &s, &c);
    e.ss += s * s * sample.weight, e.cc += c * c * sample.weight, e.sc += s * c * sample.weight;
    e.sr += s * sample.projection, e.cr += c * sample.projection;
  }
  return solve(e);
}

/// Removes the line from the residuals.
void remove(std::vector<Sample>& samples, double order) {
  const WaveFit fit = fit_wave(samples, order);
  for (Sample& sample : samples)
    sample.projection -=
        (fit.sine * std::sin(order * sample.angle) + fit.cosine * std::cos(order * sample.angle)) * sample.weight;
}

/// A grid of orders; what lines that are removed do not change is computed once.
class OrderGrid {
 public:
  OrderGrid(const std::vector<Sample>& samples, double step) : step_(step) {
    const auto count = static_cast<std::size_t>((thresholds::highest_order - thresholds::lowest_order) / step) + 1;
    double all = 0.0;
    for (const Sample& sample : samples) all += sample.weight;
    const std::vector<Complex> twice = sums(samples, &Sample::weight, 2.0, count);
    for (const Complex& sum : twice)
      equations_.push_back({0.5 * (all - sum.real()), 0.5 * (all + sum.real()), 0.5 * sum.imag()});
  }

  SpectralLine strongest(const std::vector<Sample>& samples, int joint) const {
    SpectralLine best{joint, 0.0, 0.0};
    const std::vector<Complex> projections = sums(samples, &Sample::projection, 1.0, equations_.size());
    for (std::size_t k = 0; k < projections.size(); ++k) {
      WaveEquations e = equations_[k];
      e.sr = projections[k].imag(), e.cr = projections[k].real();
      if (const double reduction = solve(e).improvement; reduction > best.improvement)
        best = {joint, thresholds::lowest_order + step_ * static_cast<double>(k), reduction};
    }
    return best;
  }

 private:
  using Complex = std::complex<double>;

  /// Σ value exp(i times order angle) of each order.
  std::vector<Complex> sums(const std::vector<Sample>& samples, double Sample::*value, double times,
                            std::size_t count) const {
    std::vector<double> angle;
    std::vector<Complex> weight;
    for (const Sample& sample : samples) {
      angle.push_back(times * step_ * sample.angle);
      weight.push_back(std::polar(1.0, times * thresholds::lowest_order * sample.angle) * (sample.*value));
    }
    return fourier_sums(angle, weight, count);
  }

  double step_;
  std::vector<WaveEquations> equations_;  // of each order, without the residuals' part
};

std::vector<SpectralLine> lines_of_joint(std::vector<Sample> samples, int joint, double threshold, int most) {
  std::vector<SpectralLine> lines;
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end(),
                                               [](const Sample& a, const Sample& b) { return a.angle < b.angle; });
  const double range = high->angle - low->angle;
  if (range < thresholds::min_spectrum_range) return lines;
  const double step = std::min(1.0, thresholds::order_step * 2.0 * std::numbers::pi / range);
  const OrderGrid grid(samples, step);
  while (static_cast<int>(lines.size()) < most) {
    SpectralLine best = grid.strongest(samples, joint);
    for (double fine_step = 0.5 * step; fine_step > 1e-3; fine_step *= 0.5)
      for (const double order : {best.order - fine_step, best.order + fine_step})
        if (const double by = order < thresholds::lowest_order ? 0.0 : fit_wave(samples, order).improvement;
            by > best.improvement)
          best = {joint, order, by};
    if (best.improvement < threshold) break;
    const double whole = std::round(best.order);  // gears have integer numbers of teeth; most lines have integer orders
    if (fit_wave(samples, whole).improvement > thresholds::integer_order_ratio * best.improvement) best.order = whole;
    best.resolution = 2.0 * std::numbers::pi / range;
    lines.push_back(best);
    remove(samples, best.order);
  }
  return lines;
}

}  // namespace

std::vector<SpectralLine> find_gear_harmonics(const Estimate& with_outliers, const PoseSet& all_rows, int threads,
                                              int most) {
  std::vector<SpectralLine> lines;
  Estimate fitted = with_outliers;
  PoseSet rows = all_rows;
  if (distinct_poses(all_rows) < static_cast<std::size_t>(all_rows.rows())) {  // each pose once
    rows = pose_means(fitted.chain, keep_measurements(rows, inliers_of(fitted, rows)), {}, {}, threads).rows;
    fitted.outliers.clear();
  }
  if (rows.points.size() < thresholds::min_spectrum_points || !(fitted.sigma > 0.0)) return lines;
  const std::vector<int> moving = active_joints(fitted.chain);
  // For pure noise the improvement is χ² with two degrees of freedom; its maximum over n lines is about 2 ln n.
  const double tried = thresholds::highest_order * 4.0 * static_cast<double>(moving.size());
  const double threshold = 2.0 * std::log(tried) + thresholds::spectral_margin;
  std::vector<std::vector<SpectralLine>> of_joint(moving.size());
  parallel_for(moving.size(), threads, [&](std::size_t k) {
    if (!rotates(fitted.chain.joints[moving[k]].type)) return;
    const auto samples = samples_of(fitted, rows, moving[k], static_cast<int>(k));
    if (samples.size() >= thresholds::min_spectrum_points)
      of_joint[k] = lines_of_joint(samples, moving[k], threshold, most);
  });
  for (const std::vector<SpectralLine>& found : of_joint) lines.insert(lines.end(), found.begin(), found.end());
  std::sort(lines.begin(), lines.end(),
            [](const SpectralLine& a, const SpectralLine& b) { return a.improvement > b.improvement; });
  if (static_cast<int>(lines.size()) > most) lines.resize(most);
  return lines;
}

void merge_lines(std::vector<SpectralLine>& lines, const std::vector<SpectralLine>& more) {
  const std::vector<SpectralLine> known = lines;
  for (const SpectralLine& line : more)
    if (static_cast<int>(lines.size()) < thresholds::max_spectral_lines &&
        std::ranges::none_of(known, [&](const SpectralLine& other) {
          return other.joint == line.joint && std::abs(other.order - line.order) < 0.5 * line.resolution;
        }))
      lines.push_back(line);
}

}  // namespace kinfer::calibrate
