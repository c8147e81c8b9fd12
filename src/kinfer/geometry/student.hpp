// SPDX-License-Identifier: Apache-2.0
// Deviations in units of a spread that was itself estimated: probabilities, and as standard Gaussian numbers.
#pragma once

namespace kinfer {

/// Probability of more than t under the Student distribution with n = 1, 2, … degrees of freedom (Abramowitz and Stegun
/// 26.7.3-4), at least 1e-12.
double student_upper_tail(double t, int n);

/// The standard Gaussian number with the tail probability of t under the Student distribution with n = 1, 2, … degrees
/// of freedom (Abramowitz and Stegun 26.7.3-4; above 60 by Wallace 1959, exact to 1e-4 there). At most 7 for n ≤ 60.
double gaussian_of_student(double t, int n);

}  // namespace kinfer
