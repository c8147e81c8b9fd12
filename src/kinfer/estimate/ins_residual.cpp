#include "kinfer/estimate/ins_residual.hpp"

#include <cmath>

#include "kinfer/estimate/ins_mount.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

Vec3 read_rate(const InsState& s, const InsErrors& e) {
  return s.rate + e.rate_matrix * s.rate + e.rate_bias;
}
Vec3 read_force(const InsState& s, const InsErrors& e) {
  return s.force + e.force_matrix * s.force + e.force_bias;
}
Vec3 read_field(const InsState& s, const InsErrors& e) {
  return s.field + e.field_bias;
}

}  // namespace

double from_middle(const SplineGrid& grid, Index interval) {
  return grid.period * (static_cast<double>(interval) + 0.5 - 0.5 * static_cast<double>(grid.intervals));
}

BlockResidual residual(const InsBlock& block, const NodeMatrix& factor, const BlockResidual& predicted, double sd) {
  return (block.target.cast<double>() - factor * predicted) / sd;
}

double clock_shift(const InsProblem& problem, const InsLayout& layout, const InsErrors& errors, Index interval) {
  if (!layout.has_clocks) return 0.0;
  return (errors.clock.offset + errors.clock.drift * from_middle(problem.grid, interval)) / problem.grid.period;
}

NodeMatrix shifted_factor(const InsBlock& block, const InsLayout& layout, double shift) {
  if (!layout.has_clocks) return block.factor.cast<double>();
  return block.factor.cast<double>() * (NodeMatrix::Identity() + shift * node_derivative());
}

RobustBlock robust(double squares, double terms) {
  const double limit = terms + 4.0 * std::sqrt(2.0 * terms);
  if (squares <= limit) return {squares, 1.0};
  if (!std::isfinite(squares)) return {1e300, 0.0};
  return {limit * (1.0 + std::log(squares / limit)), limit / squares};
}

std::vector<InstrumentUse> instruments(const InsProblem& problem, const InsLayout& layout, std::size_t sensor) {
  const InsReadings& r = problem.sensors[sensor];
  std::vector<InstrumentUse> uses{{r.rate, r.noise.rate, read_rate, 0}, {r.force, r.noise.force, read_force, 6}};
  if (layout.has_field && !r.field.empty()) uses.push_back({r.field, r.noise.field, read_field, 9});
  return uses;
}

InsState felt_at(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t sensor,
                 Index interval, std::size_t node, const InsState& segment) {
  if (!layout.has_tilts) return segment;
  const InsBending& bending = problem.sensors[sensor].bending[static_cast<std::size_t>(interval)];
  return felt(segment, x.errors[sensor].tilt, bending.force_at(node), bending.change_at(node));
}

}  // namespace kinfer
