// SPDX-License-Identifier: Apache-2.0
// One MAP fit of the complete six-axis set (34 parameters) to 500 measured points, beside Ceres with automatic
// derivatives on the same residuals, priors and start, both to convergence on one core.
#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

constexpr int unknowns = 34;

struct Case {
  Chain nominal;
  PoseSet data;
  ParameterSet set;
};

const Case& benchmark_case() {
  static const Case made = [] {
    Chain nominal = test::er20(0.125);
    nominal.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
    nominal.tool.xyz = Vec3(0.03, 0.02, 0.1);
    const PoseSet data = test::measured(test::with_table3_errors(nominal), test::paper2_poses(500, test::tracker));
    return Case{nominal, data, geometric_parameters(nominal, data, Tolerances{})};
  }();
  return made;
}

void kinfer_fit(benchmark::State& state) {
  const Case& c = benchmark_case();
  const Weights weights = weights_of(c.data, test::tracker);
  const Residuals problem = pose_residuals(c.nominal, c.set, c.data, weights);
  const VectorXd start = pack(c.set, c.nominal);
  LeastSquaresOutcome outcome;
  for (auto _ : state) benchmark::DoNotOptimize(outcome = least_squares(problem, start));
  state.counters["cost"] = outcome.cost;
  state.counters["iterations"] = outcome.iterations;
}
BENCHMARK(kinfer_fit)->Unit(benchmark::kMillisecond);

void kinfer_fit_with_noise_level_outliers_and_covariance(benchmark::State& state) {
  const Case& c = benchmark_case();
  for (auto _ : state) benchmark::DoNotOptimize(fit_bundle(c.nominal, c.set, c.data, test::tracker));
}
BENCHMARK(kinfer_fit_with_noise_level_outliers_and_covariance)->Unit(benchmark::kMillisecond);

/// The same model for automatic derivatives: parameters in the order of the set (base 6; a alpha d theta [beta] of each
/// joint; tool 3).
struct PointResidual {
  Vec3 measured;
  double inverse_sd;
  Eigen::Matrix<double, 6, 1> q;
  Mat3 base_rotation;
  bool beta[6];

  template <class T>
  using V = Eigen::Matrix<T, 3, 1>;

  template <class T>
  static V<T> about_x(const T& angle, const V<T>& p) {
    using std::cos, std::sin;
    const T c = cos(angle), s = sin(angle);
    return {p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]};
  }
  template <class T>
  static V<T> about_y(const T& angle, const V<T>& p) {
    using std::cos, std::sin;
    const T c = cos(angle), s = sin(angle);
    return {c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]};
  }
  template <class T>
  static V<T> about_z(const T& angle, const V<T>& p) {
    using std::cos, std::sin;
    const T c = cos(angle), s = sin(angle);
    return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
  }

  template <class T>
  bool operator()(const T* x, T* residual) const {
    V<T> p(x[unknowns - 3], x[unknowns - 2], x[unknowns - 1]);
    const T* rows[6];
    const T* next = x + 6;
    for (int i = 0; i < 6; ++i) rows[i] = next, next += beta[i] ? 5 : 4;
    for (int i = 5; i >= 0; --i) {  // RotX(alpha) TransX(a) RotY(beta) RotZ(theta) TransZ(d) p
      const T* row = rows[i];
      p[2] += row[2];
      p = about_z(T(row[3] + q[i]), p);
      if (beta[i]) p = about_y(row[4], p);
      p[0] += row[0];
      p = about_x(row[1], p);
    }
    p = about_x(x[3], about_y(x[4], about_z(x[5], p)));
    const V<T> in_world = base_rotation.cast<T>() * p + V<T>(x[0], x[1], x[2]);
    for (int k = 0; k < 3; ++k) residual[k] = (measured[k] - in_world[k]) * inverse_sd;
    return true;
  }
};

struct PriorResidual {
  Eigen::Matrix<double, unknowns, 1> nominal, inverse_sd;
  template <class T>
  bool operator()(const T* x, T* residual) const {
    for (int k = 0; k < unknowns; ++k) residual[k] = (x[k] - nominal[k]) * inverse_sd[k];
    return true;
  }
};

void ceres_fit(benchmark::State& state) {
  const Case& c = benchmark_case();
  const Weights weights = weights_of(c.data, test::tracker);
  const VectorXd start = pack(c.set, c.nominal);
  bool beta[6];
  for (int i = 0; i < 6; ++i) beta[i] = c.set.find("beta" + std::to_string(i + 1)) != nullptr;
  PriorResidual prior;
  const auto free = c.set.free();
  for (int k = 0; k < unknowns; ++k) prior.nominal[k] = free[k]->nominal, prior.inverse_sd[k] = 1.0 / free[k]->prior_sd;
  ceres::Solver::Summary summary;
  for (auto _ : state) {
    VectorXd x = start;
    ceres::Problem problem;
    for (std::size_t i = 0; i < c.data.points.size(); ++i) {
      auto* residual = new PointResidual{c.data.points[i].position,
                                         1.0 / weights.of<PointMeasurement>()[i].x(),
                                         c.data.joints.col(c.data.points[i].row),
                                         c.nominal.base.rotation,
                                         {}};
      std::copy(beta, beta + 6, residual->beta);
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PointResidual, 3, unknowns>(residual), nullptr,
                               x.data());
    }
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PriorResidual, unknowns, unknowns>(new PriorResidual(prior)), nullptr,
        x.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.num_threads = 1;
    options.function_tolerance = 1e-14;
    ceres::Solve(options, &problem, &summary);
    benchmark::DoNotOptimize(x);
  }
  state.counters["cost"] = 2.0 * summary.final_cost;
  state.counters["iterations"] = static_cast<double>(summary.iterations.size());
}
BENCHMARK(ceres_fit)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinfer
