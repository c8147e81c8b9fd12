// SPDX-License-Identifier: Apache-2.0
// Fourier sums of samples at any angles, for many orders at once.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace kinfer {

/// Σ weight_i exp(j k angle_i) for k = 0 .. orders − 1; angles in rad. A non-uniform fast Fourier transform: a Taylor
/// series about the points of a grid, one transform for each of its terms (Anderson & Dahleh 1996, "Rapid computation
/// of the discrete Fourier transform"). Accurate to 1e-11 of Σ |weight_i|.
std::vector<std::complex<double>> fourier_sums(std::span<const double> angle,
                                               std::span<const std::complex<double>> weight, std::size_t orders);

}  // namespace kinfer
