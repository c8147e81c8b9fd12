// SPDX-License-Identifier: Apache-2.0
// The measurements of one instrument within one interval of the time grid, compressed to a few numbers without loss for
// smooth motion: their least-squares polynomial at Gauss-Legendre nodes, in whitened (square-root information) form.
//
// n measurements y = V x + white noise, x the true values at the nodes, V Lagrange's polynomials at the sample times.
// With V = Q R, R x = Qᵀ y with the same white noise is a sufficient statistic for x, for any gaps and any sampling.
// The remainder y − Q Qᵀ y shows the noise. At Gauss-Legendre nodes interpolation and projection agree to the first
// omitted degree, so the error for a motion that is not exactly polynomial is small.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kinfer/estimate/continuous/model/uniform_spline.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"

namespace kinfer {

constexpr int block_nodes = 4;  // a cubic per interval: relative error 1e-3 at 2.5 Hz for intervals of 0.1 s

/// Positions of the Gauss-Legendre nodes in an interval, 0..1.
const std::array<double, block_nodes>& block_nodes_u();

/// Weights of the values at the nodes in the polynomial through them, at the position u in the interval.
Eigen::Matrix<double, 1, block_nodes> node_weights(double u);

using NodeMatrix = Eigen::Matrix<double, block_nodes, block_nodes>;

/// Differentiation matrix: derivatives at the nodes, with respect to the position u in the interval, of the polynomial
/// with given values at the nodes.
const NodeMatrix& node_derivative();

/// `float`: an hour of six sensors takes 90 MB instead of 170 MB; its 24 bits match the resolution of the
/// measurements.
struct InsBlock {
  using Factor = Eigen::Matrix<float, block_nodes, block_nodes, Eigen::DontAlign>;
  using Target = Eigen::Matrix<float, block_nodes, 3, Eigen::DontAlign>;
  Factor factor = Factor::Zero();                  ///< R, upper triangular; rows beyond `rows` are zero
  Target target = Target::Zero();                  ///< Qᵀ y, one column per axis
  Eigen::Vector3f left = Eigen::Vector3f::Zero();  ///< sum of squares about the polynomial, per axis
  std::int32_t samples = 0;                        ///< number of measurements; 0: none
  std::int32_t rows = 0;                           ///< rows of R and Qᵀ y in use
  float excess = 1.0F;  ///< variance of the measurements over that of the others; R, Qᵀ y and the squares are divided
};

enum class InsInstrument { gyroscope, accelerometer };

/// One block per grid interval. Invalid samples are left out. `clock_offset` [s] is added to the times.
std::vector<InsBlock> ins_blocks(const InsSensor& sensor, std::span<const double> time, InsInstrument instrument,
                                 const SplineGrid& grid, double clock_offset = 0.0);

/// Standard deviation of one measurement about its block's polynomial, robust against blocks with shocks; 0 if no block
/// is overdetermined.
double measurement_noise(std::span<const InsBlock> blocks);

}  // namespace kinfer
