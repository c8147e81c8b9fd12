// SPDX-License-Identifier: Apache-2.0
// The straightforward version: 4 x 4 products in Eigen with sine and cosine at each joint. The interface has plain
// numbers only, because this file is compiled with other flags than the rest.
#pragma once

namespace kinfer::bench {

/// Σ |measured − f(x)|² of a modified DH chain; x: a, alpha, d, theta of each of six rows; joints 6 x n, measured 3 x
/// n.
double naive_sum(const double* x, const double* joints, const double* measured, int n);

/// World position of the tool.
void naive_position(const double* x, const double* q, double* position);

}  // namespace kinfer::bench
