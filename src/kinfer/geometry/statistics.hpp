// Figures that sum up a list of numbers. Non-finite numbers are the caller's to leave out.
#pragma once

#include <span>
#include <vector>

namespace kinfer {

double mean(std::span<const double> values);                   ///< 0 for an empty list
double rms(std::span<const double> values);                    ///< 0 for an empty list
double standard_deviation(std::span<const double> values);     ///< n − 1 below; 0 for fewer than 2
double quantile(std::vector<double> values, double fraction);  ///< linear between ranks; `values` must not be empty
double median(std::vector<double> values);

/// Standard deviation of the Gaussian bulk that gives these magnitudes' median deviation: 1.4826 · MAD.
double robust_sd(std::vector<double> values);

/// Probability that a standard Gaussian is below x, and the x below which it lies with probability p in (0, 1).
double normal_cdf(double x);
double normal_quantile(double p);

/// Value below which a chi-squared variable of n degrees of freedom lies with probability p in (0, 1).
double chi_squared_quantile(double p, double n);

/// Probability that a chi-squared variable of n > 0 degrees of freedom is below x: the regularised incomplete gamma
/// function P(n/2, x/2), by its series or its continued fraction (Abramowitz and Stegun 6.5.29, 6.5.31).
double chi_squared_cdf(double x, double n);

}  // namespace kinfer
