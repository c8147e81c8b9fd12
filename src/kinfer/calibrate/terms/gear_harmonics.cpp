// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/gear_harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

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

/// Sine and cosine of one order at all samples.
struct Wave {
  std::vector<double> sine, cosine;

  Wave(const std::vector<Sample>& samples, double order) {
    sine.resize(samples.size()), cosine.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) ::sincos(order * samples[i].angle, &sine[i], &cosine[i]);
  }
  /// Increases the order by that of `by`, by the addition theorem instead of new sines.
  void advance(const Wave& by) {
    for (std::size_t i = 0; i < sine.size(); ++i) {
      const double s = sine[i] * by.cosine[i] + cosine[i] * by.sine[i];
      cosine[i] = cosine[i] * by.cosine[i] - sine[i] * by.sine[i];
      sine[i] = s;
    }
  }
};

/// The least-squares amplitudes of a wave, and the reduction of the sum of squares.
struct WaveFit {
  double sine = 0.0, cosine = 0.0, improvement = 0.0;
};

WaveFit fit_wave(const std::vector<Sample>& samples, const Wave& wave) {
  double ss = 0.0, cc = 0.0, sc = 0.0, sr = 0.0, cr = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double s = wave.sine[i], c = wave.cosine[i];
    const double weight = samples[i].weight, projection = samples[i].projection;
    ss += s * s * weight, cc += c * c * weight, sc += s * c * weight;
    sr += s * projection, cr += c * projection;
  }
  const double determinant = ss * cc - sc * sc;
  if (!(determinant > 1e-6 * ss * cc)) return {};
  const double sine = (sr * cc - cr * sc) / determinant, cosine = (cr * ss - sr * sc) / determinant;
  return {sine, cosine, sine * sr + cosine * cr};
}

double improvement_by(const std::vector<Sample>& samples, double order) {
  return fit_wave(samples, Wave(samples, order)).improvement;
}

/// Removes the line from the residuals.
void remove(std::vector<Sample>& samples, double order) {
  const Wave wave(samples, order);
  const WaveFit fit = fit_wave(samples, wave);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].projection -= (fit.sine * wave.sine[i] + fit.cosine * wave.cosine[i]) * samples[i].weight;
}

/// The strongest line on a grid of orders with this step.
SpectralLine strongest(const std::vector<Sample>& samples, int joint, double step) {
  SpectralLine best{joint, 0.0, 0.0};
  Wave wave(samples, thresholds::lowest_order);
  const Wave by(samples, step);
  for (double order = thresholds::lowest_order; order <= thresholds::highest_order; order += step, wave.advance(by))
    if (const double reduction = fit_wave(samples, wave).improvement; reduction > best.improvement)
      best = {joint, order, reduction};
  return best;
}

std::vector<SpectralLine> lines_of_joint(std::vector<Sample> samples, int joint, double threshold, int most) {
  std::vector<SpectralLine> lines;
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end(),
                                               [](const Sample& a, const Sample& b) { return a.angle < b.angle; });
  const double range = high->angle - low->angle;
  if (range < thresholds::min_spectrum_range) return lines;
  const double step = std::min(1.0, thresholds::order_step * 2.0 * std::numbers::pi / range);
  while (static_cast<int>(lines.size()) < most) {
    SpectralLine best = strongest(samples, joint, step);
    for (double fine_step = 0.5 * step; fine_step > 1e-3; fine_step *= 0.5)
      for (const double order : {best.order - fine_step, best.order + fine_step})
        if (const double by = order < thresholds::lowest_order ? 0.0 : improvement_by(samples, order);
            by > best.improvement)
          best = {joint, order, by};
    if (best.improvement < threshold) break;
    const double whole = std::round(best.order);  // gears have integer numbers of teeth; most lines have integer orders
    if (improvement_by(samples, whole) > thresholds::integer_order_ratio * best.improvement) best.order = whole;
    best.resolution = 2.0 * std::numbers::pi / range;
    lines.push_back(best);
    remove(samples, best.order);
  }
  return lines;
}

}  // namespace

std::vector<SpectralLine> find_gear_harmonics(const Estimate& fitted, const PoseSet& rows, int threads, int most) {
  std::vector<SpectralLine> lines;
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
