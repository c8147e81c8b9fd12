// SPDX-License-Identifier: Apache-2.0
#include "peers/ceres_jets.hpp"

#include <ceres/ceres.h>

#include <vector>

namespace kinfer::bench {
namespace {

/// The point transformed from the tip inwards, as a careful user of Ceres would write it.
struct PointResidual {
  double q[6], measured[3], inverse_sd;

  template <class T>
  bool operator()(const T* x, T* residual) const {
    using std::cos, std::sin;
    T px = T(0), py = T(0), pz = T(0);
    for (int j = 5; j >= 0; --j) {  // RotX(alpha) TransX(a) RotZ(theta) TransZ(d) p
      const T *row = x + 4 * j, ct = cos(row[3] + q[j]), st = sin(row[3] + q[j]), ca = cos(row[1]), sa = sin(row[1]);
      pz += row[2];
      const T x1 = ct * px - st * py + row[0], y1 = st * px + ct * py;
      px = x1;
      py = ca * y1 - sa * pz;
      pz = sa * y1 + ca * pz;
    }
    residual[0] = (measured[0] - px) * inverse_sd;
    residual[1] = (measured[1] - py) * inverse_sd;
    residual[2] = (measured[2] - pz) * inverse_sd;
    return true;
  }
};

using Cost = ceres::AutoDiffCostFunction<PointResidual, 3, 24>;

}  // namespace

struct JetPoints::Costs {
  std::vector<PointResidual> residuals;
  std::vector<std::unique_ptr<Cost>> costs;
};

JetPoints::JetPoints(const double* joints, const double* measured, int n, double inverse_sd)
    : costs_(std::make_unique<Costs>()) {
  for (int i = 0; i < n; ++i) {
    PointResidual residual{};
    std::copy(joints + 6 * i, joints + 6 * i + 6, residual.q);
    std::copy(measured + 3 * i, measured + 3 * i + 3, residual.measured);
    residual.inverse_sd = inverse_sd;
    costs_->residuals.push_back(residual);
    costs_->costs.push_back(std::make_unique<Cost>(new PointResidual(residual)));
  }
}

JetPoints::~JetPoints() = default;

void JetPoints::evaluate(const double* x, double* r, double* jacobian) const {
  for (std::size_t i = 0; i < costs_->costs.size(); ++i) {
    double* row = jacobian + 72 * i;
    costs_->costs[i]->Evaluate(&x, r + 3 * i, &row);
  }
}

double JetPoints::fit(double* x) const {
  ceres::Problem problem;
  for (const PointResidual& residual : costs_->residuals)
    problem.AddResidualBlock(new Cost(new PointResidual(residual)), nullptr, x);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return 2.0 * summary.final_cost;
}

}  // namespace kinfer::bench
