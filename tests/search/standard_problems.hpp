// SPDX-License-Identifier: Apache-2.0
// Least-squares problems with known optima: from Moré, Garbow and Hillstrom, "Testing unconstrained optimization
// software", ACM TOMS 7 (1981), and fits of a line and of a planar pose with outliers.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/search/least_squares/least_squares.hpp"

namespace kinfer::testing {

inline constexpr std::array losses{Loss::none, Loss::huber, Loss::cauchy, Loss::tukey};

struct StandardProblem {
  std::string name;
  Residuals residuals;
  VectorXd start;
  double optimum;  // sum of squares, as the paper prints it
};

inline StandardProblem rosenbrock() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    r << 10 * (x[1] - x[0] * x[0]), 1 - x[0];
    if (j) *j << -20 * x[0], 10, -1, 0;
  };
  return {"rosenbrock", {2, 2, {}, evaluate}, Eigen::Vector2d(-1.2, 1), 0.0};
}

inline StandardProblem powell_singular() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    const double s5 = std::sqrt(5.0), s10 = std::sqrt(10.0), a = x[1] - 2 * x[2], b = x[0] - x[3];
    r << x[0] + 10 * x[1], s5 * (x[2] - x[3]), a * a, s10 * b * b;
    if (j) *j << 1, 10, 0, 0, 0, 0, s5, -s5, 0, 2 * a, -4 * a, 0, 2 * s10 * b, 0, 0, -2 * s10 * b;
  };
  return {"powell_singular", {4, 4, {}, evaluate}, Eigen::Vector4d(3, -1, 0, 1), 0.0};
}

inline StandardProblem wood() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    const double s90 = std::sqrt(90.0), s10 = std::sqrt(10.0);
    r << 10 * (x[1] - x[0] * x[0]), 1 - x[0], s90 * (x[3] - x[2] * x[2]), 1 - x[2], s10 * (x[1] + x[3] - 2),
        (x[1] - x[3]) / s10;
    if (!j) return;
    // clang-format off
    *j << -20 * x[0],      10,                0,       0,
                  -1,       0,                0,       0,
                   0,       0, -2 * s90 * x[2],     s90,
                   0,       0,               -1,       0,
                   0,     s10,                0,     s10,
                   0, 1 / s10,                0, -1 / s10;
    // clang-format on
  };
  return {"wood", {4, 6, {}, evaluate}, Eigen::Vector4d(-3, -1, -3, -1), 0.0};
}

inline StandardProblem bard() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    constexpr std::array y{0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39, 0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39};
    for (int i = 0; i < 15; ++i) {
      const double u = i + 1, v = 15 - i, w = std::min(u, v), d = v * x[1] + w * x[2];
      r[i] = y[i] - (x[0] + u / d);
      if (j) j->row(i) << -1, u * v / (d * d), u * w / (d * d);
    }
  };
  return {"bard", {3, 15, {}, evaluate}, Eigen::Vector3d(1, 1, 1), 8.21487e-3};
}

inline StandardProblem kowalik_osborne() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    constexpr std::array y{0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246};
    constexpr std::array u{4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
    for (int i = 0; i < 11; ++i) {
      const double n = u[i] * (u[i] + x[1]), d = u[i] * (u[i] + x[2]) + x[3];
      r[i] = y[i] - x[0] * n / d;
      if (j) j->row(i) << -n / d, -x[0] * u[i] / d, x[0] * n * u[i] / (d * d), x[0] * n / (d * d);
    }
  };
  return {"kowalik_osborne", {4, 11, {}, evaluate}, Eigen::Vector4d(0.25, 0.39, 0.415, 0.39), 3.07505e-4};
}

inline StandardProblem meyer() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    constexpr std::array y{34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744,
                           8261,  7030,  6005,  5147,  4427,  3820,  3307,  2872};
    for (int i = 0; i < 16; ++i) {
      const double d = 45 + 5 * (i + 1) + x[2], e = std::exp(x[1] / d);
      r[i] = x[0] * e - y[i];
      if (j) j->row(i) << e, x[0] * e / d, -x[0] * e * x[1] / (d * d);
    }
  };
  return {"meyer", {3, 16, {}, evaluate}, Eigen::Vector3d(0.02, 4000, 250), 87.9458};
}

/// y = exp(a t + b) with a = 0.3, b = 0.1, 20 samples without noise.
inline StandardProblem exponential() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    for (int i = 0; i < 20; ++i) {
      const double t = 0.25 * i, e = std::exp(x[0] * t + x[1]);
      r[i] = e - std::exp(0.3 * t + 0.1);
      if (j) j->row(i) << t * e, e;
    }
  };
  return {"exponential", {2, 20, {}, evaluate}, Eigen::Vector2d(0, 0), 0.0};
}

inline std::vector<StandardProblem> standard_problems() {
  return {rosenbrock(), powell_singular(), wood(), bard(), kowalik_osborne(), meyer(), exponential()};
}

/// y = 2 t − 1 with noise of 1 sigma = 0.1 and every fifth of 40 samples 30 sigma too high; one row a block.
inline Residuals line_with_outliers() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    const Rng noise(3);
    for (int i = 0; i < 40; ++i) {
      const double t = 0.1 * i, y = 2 * t - 1 + 0.1 * noise.stream(i).normal() + (i % 5 == 0 ? 3.0 : 0.0);
      r[i] = (x[0] * t + x[1] - y) / 0.1;
      if (j) j->row(i) << t / 0.1, 1 / 0.1;
    }
  };
  return {2, 40, std::vector<int>(40, 1), evaluate};
}

/// Rotation by 0.5 rad and shift (1, 2) of 30 planar points, measured with noise of 0.01 and six gross errors (two rows
/// a block), and a prior on the rotation, 0.4 ± 0.1 (a plain row).
inline Residuals planar_pose_with_outliers() {
  const auto evaluate = [](ConstVectorRef x, VectorXd& r, MatrixXd* j) {
    const Rng noise(4);
    if (j) j->setZero();
    for (int i = 0; i < 30; ++i) {
      Rng rng = noise.stream(i);
      const Eigen::Vector2d p{rng.uniform(-1, 1), rng.uniform(-1, 1)}, error{0.01 * rng.normal(), 0.01 * rng.normal()};
      const Eigen::Vector2d gross = i % 5 == 0 ? Eigen::Vector2d(0.5, -0.3) : Eigen::Vector2d(0, 0);
      const Eigen::Vector2d seen = Eigen::Rotation2Dd(0.5) * p + Eigen::Vector2d(1, 2) + error + gross;
      const Eigen::Vector2d turned = Eigen::Rotation2Dd(x[0]) * p;
      r.segment<2>(2 * i) = (turned + x.tail<2>() - seen) / 0.01;
      if (!j) continue;
      j->block<2, 1>(2 * i, 0) = Eigen::Vector2d(-turned.y(), turned.x()) / 0.01;
      j->block<2, 2>(2 * i, 1) = Eigen::Matrix2d::Identity() / 0.01;
    }
    r[60] = (x[0] - 0.4) / 0.1;
    if (j) (*j)(60, 0) = 1 / 0.1;
  };
  return {3, 61, std::vector<int>(30, 2), evaluate};
}

}  // namespace kinfer::testing
