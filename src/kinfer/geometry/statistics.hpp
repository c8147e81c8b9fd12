// SPDX-License-Identifier: Apache-2.0
// Descriptive statistics and distributions. The caller leaves out non-finite numbers.
#pragma once

#include <span>
#include <vector>

namespace kinfer {

double mean(std::span<const double> values);                   ///< 0 for an empty list
double rms(std::span<const double> values);                    ///< 0 for an empty list
double standard_deviation(std::span<const double> values);     ///< divided by n − 1; 0 for fewer than 2
double quantile(std::vector<double> values, double fraction);  ///< linear between ranks; `values` must not be empty
double median(std::vector<double> values);

/// Robust standard deviation of the Gaussian bulk: 1.4826 · median absolute deviation from the median.
double robust_sd(std::vector<double> values);

/// Effective number of independent samples of a series, n (1 − r) / (1 + r), r the lag-one autocorrelation; at least 1.
double effective_samples(std::span<const double> series);

/// ln Σ exp values, without overflow; `logarithms` must not be empty.
double log_sum(std::span<const double> logarithms);

/// Cumulative distribution function of the standard Gaussian, and its inverse for p in (0, 1).
double normal_cdf(double x);
double normal_quantile(double p);

/// Quantile of the chi-squared distribution with n degrees of freedom, for p in (0, 1).
double chi_squared_quantile(double p, double n);

/// Cumulative distribution function of the chi-squared distribution with n > 0 degrees of freedom: the regularised
/// incomplete gamma function P(n/2, x/2), by its series or continued fraction (Abramowitz and Stegun 6.5.29, 6.5.31).
double chi_squared_cdf(double x, double n);

/// Quantile of the F distribution with n1 and n2 degrees of freedom, for p in (0, 1).
double f_quantile(double p, double n1, double n2);

/// Cumulative distribution function of the F distribution with n1, n2 > 0 degrees of freedom: the regularised
/// incomplete beta function of n1 x / (n1 x + n2), by its continued fraction (Abramowitz and Stegun 26.6.2, 26.5.8).
double f_cdf(double x, double n1, double n2);

}  // namespace kinfer
