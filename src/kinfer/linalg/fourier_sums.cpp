// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/fourier_sums.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

using Complex = std::complex<double>;

// With 8 grid points an order, highest order times distance to the grid is at most π/8: ten terms leave (π/8)¹⁰ / 10!.
constexpr std::size_t grid_points_an_order = 8;
constexpr int taylor_terms = 10;

/// The grid point next to each sample, and its distance from there in units of 1 / orders.
struct OnGrid {
  std::vector<std::size_t> point;
  std::vector<double> distance;

  OnGrid(std::span<const double> angle, std::size_t grid, std::size_t orders) {
    const double step = 2.0 * std::numbers::pi / static_cast<double>(grid);
    for (const double a : angle) {
      const double nearest = std::round(a / step);
      const double turned = std::fmod(nearest, static_cast<double>(grid));
      point.push_back(static_cast<std::size_t>(turned < 0.0 ? turned + static_cast<double>(grid) : turned));
      distance.push_back((a - nearest * step) * static_cast<double>(orders));
    }
  }
};

}  // namespace

std::vector<Complex> fourier_sums(std::span<const double> angle, std::span<const Complex> weight, std::size_t orders) {
  KINFER_EXPECT(angle.size() == weight.size(), "{} angles, {} weights", angle.size(), weight.size());
  if (orders == 0) return {};
  const std::size_t grid = std::bit_ceil(grid_points_an_order * orders);
  const OnGrid at(angle, grid, orders);
  std::vector<Complex> moment(weight.begin(), weight.end()), sums(orders), factor(orders, 1.0), transformed;
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::Unscaled);
  for (int term = 0; term < taylor_terms; ++term) {
    std::vector<Complex> on_grid(grid);
    for (std::size_t i = 0; i < moment.size(); ++i) on_grid[at.point[i]] += moment[i];
    fft.inv(transformed, on_grid);
    for (std::size_t k = 0; k < orders; ++k) {
      sums[k] += factor[k] * transformed[k];
      factor[k] *= Complex(0.0, static_cast<double>(k) / static_cast<double>(orders) / (term + 1));
    }
    for (std::size_t i = 0; i < moment.size(); ++i) moment[i] *= at.distance[i];
  }
  return sums;
}

}  // namespace kinfer
