// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/heading_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr int scanned_directions = 36;     // on the circle
constexpr int scan_sweeps = 2;             // over all rotations
constexpr std::size_t scanned_bins = 200;  // evenly spaced
constexpr double rough_noise = 0.1;        // of the field: soft iron, disturbances
constexpr double independent_bins = 20.0;  // slow disturbances: what the scanned bins are worth

/// Field and hard iron are linear in the measurements once the rotations are given.
struct LinearScan {
  const MagneticModel& model;
  double hard_iron;
  std::size_t stride;

  /// Cost in units of variance; sets field and hard iron of x.
  double solve(MagneticUnknowns& x) const {
    const MagneticRecording& recording = model.recording();
    const auto sensors = static_cast<Index>(recording.sensors.size());
    MatrixXd matrix = MatrixXd::Zero(3 + 3 * sensors, 3 + 3 * sensors);
    VectorXd right = VectorXd::Zero(3 + 3 * sensors);
    double square = 0.0, count = 0.0;
    for (std::size_t s = 0; s < recording.sensors.size(); ++s) {
      const Index own = 3 + 3 * static_cast<Index>(s);
      for (std::size_t bin = 0; bin < recording.bins; bin += stride) {
        if (!recording.sensors[s].is_valid[bin]) continue;
        const Mat3 r = model.orientation(x, s, bin);
        const Vec3& y = recording.sensors[s].field[bin];
        matrix.topLeftCorner<3, 3>() += Mat3::Identity();
        matrix.block<3, 3>(own, 0) += r.transpose();
        matrix.block<3, 3>(own, own) += Mat3::Identity();
        right.head<3>() += r * y;
        right.segment<3>(own) += y;
        square += y.squaredNorm();
        count += 1.0;
      }
    }
    const double sd = rough_noise * recording.strength,
                 worth = independent_bins / std::max(1.0, count) * static_cast<double>(recording.sensors.size());
    const double by_variance = worth / (sd * sd);
    const MatrixXd scaled = by_variance * matrix;
    matrix = scaled;
    matrix.diagonal().tail(3 * sensors).array() += 1.0 / (hard_iron * hard_iron);
    matrix.diagonal().head<3>().array() += 1e-6 / (recording.strength * recording.strength);
    right *= by_variance;
    const auto solution = solve_spd(matrix, right);
    if (!solution) return std::numeric_limits<double>::infinity();
    x.field = solution->head<3>();
    for (std::size_t s = 0; s < recording.sensors.size(); ++s)
      x.hard_iron[s] = solution->segment<3>(3 + 3 * static_cast<Index>(s));
    return by_variance * square - solution->dot(right);
  }
};

double wrapped_square(ConstMatrixRef information, const VectorXd& rotation) {
  const VectorXd wrapped = rotation.unaryExpr([](double angle) { return wrap_to_pi(angle); });
  return wrapped.dot(information * wrapped);
}

}  // namespace

MagneticUnknowns scan_headings(const MagneticModel& model, ConstMatrixRef information, double hard_iron) {
  const std::size_t sensors = model.recording().sensors.size();
  MagneticUnknowns best{.rotation = VectorXd::Zero(model.rotations()),
                        .hard_iron = std::vector<Vec3>(sensors, Vec3::Zero()),
                        .soft_iron = std::vector<Mat3>(sensors, Mat3::Zero())};
  const LinearScan scan{model, hard_iron, std::max<std::size_t>(1, model.recording().bins / scanned_bins)};
  double least = scan.solve(best);
  for (int sweep = 0; sweep < scan_sweeps; ++sweep)
    for (Index k = 0; k < model.rotations(); ++k) {
      const double from = best.rotation[k];
      for (int i = 1; i < scanned_directions; ++i) {
        MagneticUnknowns trial = best;
        trial.rotation[k] = wrap_to_pi(from + 2.0 * std::numbers::pi * i / scanned_directions);
        const double cost = scan.solve(trial) + wrapped_square(information, trial.rotation);
        if (cost >= least) continue;
        least = cost;
        best = std::move(trial);
      }
    }
  return best;
}

}  // namespace kinfer
