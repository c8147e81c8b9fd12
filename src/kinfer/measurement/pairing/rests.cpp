// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/pairing/rests.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double window = 0.25;        // [s]
constexpr double least_spread = 1e-9;  // of the range of a dimension; below it a stream does not move at all

/// Spread of each window that begins at a row, relative to the range of each dimension; the largest over dimensions.
std::vector<double> window_spreads(const std::vector<double>& time, const MatrixXd& values,
                                   std::vector<std::size_t>& ends) {
  VectorXd range = values.rowwise().maxCoeff() - values.rowwise().minCoeff();
  for (Eigen::Index d = 0; d < range.size(); ++d)
    if (!(range[d] > 0.0)) range[d] = 1.0;
  std::vector<double> spreads;
  std::size_t end = 0;
  for (std::size_t row = 0; row < time.size(); ++row) {
    while (end < time.size() && time[end] - time[row] < window) ++end;
    ends.push_back(end);
    const auto block = values.middleCols(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(end - row));
    double spread = least_spread;
    for (Eigen::Index d = 0; d < range.size(); ++d)
      spread = std::max(spread, (block.row(d).maxCoeff() - block.row(d).minCoeff()) / range[d]);
    spreads.push_back(spread);
  }
  return spreads;
}

/// The value that divides numbers into two groups of the largest variance between them (Otsu 1979).
double dividing_value(std::vector<double> values) {
  std::ranges::sort(values);
  double all = 0.0;
  for (const double v : values) all += v;
  double below = 0.0, best = -1.0, divide = values.front();
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    below += values[i];
    const double count = static_cast<double>(i + 1), apart = below / count - (all - below) / (n - count);
    const double variance = count * (n - count) * apart * apart;
    if (variance > best) best = variance, divide = 0.5 * (values[i] + values[i + 1]);
  }
  return divide;
}

/// Takes rows off both ends that are not of the rest: those that deviate from the median of its middle half by more
/// than noise does.
void trim(const MatrixXd& values, std::size_t& first, std::size_t& end) {
  constexpr double beyond_noise = 6.0;  // standard deviations
  const std::size_t quarter = (end - first) / 4;
  std::vector<double> centre, reach;
  for (Eigen::Index d = 0; d < values.rows(); ++d) {
    std::vector<double> middle;
    for (std::size_t row = first + quarter; row < end - quarter; ++row)
      middle.push_back(values(d, static_cast<Eigen::Index>(row)));
    centre.push_back(median(middle));
    for (double& value : middle) value = std::abs(value - centre.back());
    constexpr double sd_per_deviation = 1.4826;  // of a normal distribution
    const double range = values.row(d).maxCoeff() - values.row(d).minCoeff();
    reach.push_back(beyond_noise * sd_per_deviation * median(middle) + least_spread * range);
  }
  const auto is_outside = [&](std::size_t row) {
    for (std::size_t d = 0; d < centre.size(); ++d)
      if (std::abs(values(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(row)) - centre[d]) > reach[d])
        return true;
    return false;
  };
  while (end - first > 1 && is_outside(first)) ++first;
  while (end - first > 1 && is_outside(end - 1)) --end;
}

Rest make_rest(const MatrixXd& values, std::size_t first, std::size_t end) {
  const auto block = values.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(end - first));
  Rest rest;
  rest.mean = block.rowwise().mean();
  rest.first_row = static_cast<int>(first);
  rest.rows = static_cast<int>(end - first);
  rest.scatter = VectorXd::Zero(values.rows());
  if (rest.rows > 1)
    rest.scatter =
        ((block.colwise() - rest.mean).rowwise().squaredNorm() / static_cast<double>(rest.rows - 1)).cwiseSqrt();
  return rest;
}

}  // namespace

std::vector<Rest> find_rests(const std::vector<double>& time, const MatrixXd& values, double shortest) {
  KINFER_EXPECT(static_cast<Eigen::Index>(time.size()) == values.cols(), "{} times for {} rows", time.size(),
                values.cols());
  std::vector<Rest> rests;
  if (time.size() < 3) return rests;
  std::vector<std::size_t> ends;
  std::vector<double> spreads = window_spreads(time, values, ends);
  for (double& spread : spreads) spread = std::log(spread);
  const double limit = dividing_value(spreads);
  for (std::size_t row = 0; row < time.size();) {
    if (spreads[row] > limit) {
      ++row;
      continue;
    }
    std::size_t first = row;
    while (row < time.size() && spreads[row] <= limit) ++row;
    std::size_t end = ends[row - 1];  // the last quiet window reaches that far
    row = std::max(row, end);
    trim(values, first, end);
    if (time[end - 1] - time[first] < shortest) continue;
    Rest rest = make_rest(values, first, end);
    rest.begin = time[first], rest.end = time[end - 1];
    rests.push_back(std::move(rest));
  }
  return rests;
}

std::vector<Rest> rests_of_list(const MatrixXd& values, const std::vector<std::string>& names, const MatrixXd& keys) {
  std::vector<Rest> rests;
  const auto is_same = [&](std::size_t a, std::size_t b) {
    if (!names.empty()) return !names[a].empty() && names[a] == names[b];
    return keys.size() > 0 && keys.col(static_cast<Eigen::Index>(a)) == keys.col(static_cast<Eigen::Index>(b));
  };
  const auto rows = static_cast<std::size_t>(values.cols());
  for (std::size_t first = 0; first < rows;) {
    std::size_t end = first + 1;
    while (end < rows && is_same(first, end)) ++end;
    rests.push_back(make_rest(values, first, end));
    if (!names.empty()) rests.back().name = names[first];
    first = end;
  }
  return rests;
}

}  // namespace kinfer
