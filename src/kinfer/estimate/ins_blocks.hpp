// What one instrument said within one interval of the time grid, squeezed into a few numbers without loss for smooth
// motion: the readings' least-squares polynomial at Gauss-Legendre nodes, in whitened form.
//
// n readings y = V x + white noise, x the true values at the nodes, V Lagrange's polynomials at the readings' times.
// With V = Q R all that y tells about x is R x = Qᵀ y with the same white noise, row by row; it holds for any gaps and
// any sampling. What is left, y − Q Qᵀ y, shows the noise. At Gauss-Legendre nodes interpolation and projection agree
// to the first omitted degree, so a motion that is not quite a polynomial does little harm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kinfer/estimate/uniform_spline.hpp"
#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

constexpr int block_nodes = 4;  // a cubic an interval: at a tenth of a second true to 1e-3 for waves of 2.5 Hz

/// Where the nodes lie in an interval, 0..1 (Gauss-Legendre).
const std::array<double, block_nodes>& block_places();

using NodeMatrix = Eigen::Matrix<double, block_nodes, block_nodes>;

/// Derivatives at the nodes, by the place in the interval, of the polynomial with given values at the nodes.
const NodeMatrix& node_derivative();

/// `float` because an hour of six sensors then takes 90 MB instead of 170 MB; its 24 bits are those of the readings.
struct InsBlock {
  using Factor = Eigen::Matrix<float, block_nodes, block_nodes, Eigen::DontAlign>;
  using Target = Eigen::Matrix<float, block_nodes, 3, Eigen::DontAlign>;
  Factor factor = Factor::Zero();                  ///< R, upper triangular; rows beyond `rows` are zero
  Target target = Target::Zero();                  ///< Qᵀ y, a column an axis
  Eigen::Vector3f left = Eigen::Vector3f::Zero();  ///< squares that no polynomial explains, an axis each
  std::int32_t samples = 0;                        ///< readings; 0: nothing was said
  std::int32_t rows = 0;                           ///< of R and Qᵀ y that are in use
};

enum class InsInstrument { gyroscope, accelerometer, magnetometer };

/// One a grid interval. Rows whose numbers must not be used are left out. `clock_offset` [s] is added to the times.
std::vector<InsBlock> ins_blocks(const InsSensor& sensor, std::span<const double> time, InsInstrument instrument,
                                 const SplineGrid& grid, double clock_offset = 0.0);

/// The mean of the readings alone, as one row: for what is only trusted as a whole.
std::vector<InsBlock> mean_blocks(const InsSensor& sensor, std::span<const double> time, InsInstrument instrument,
                                  const SplineGrid& grid, double clock_offset = 0.0);

/// Standard deviation of one reading about its block's polynomial, robust against shaken blocks; 0 where no block has
/// readings to spare.
double reading_noise(std::span<const InsBlock> blocks);

}  // namespace kinfer
