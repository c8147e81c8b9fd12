// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/known_positions.hpp"

#include <algorithm>

#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// A grid of starts finds single positions only.
bool has_grid(const FilterModel& model, std::size_t body) {
  return degrees_of_freedom(model.bodies[body].motion) == 1;
}

template <class Change>
void for_each_position(const FilterModel& model, std::size_t body, Change change) {
  for (Index k = 0; k < degrees_of_freedom(model.bodies[body].motion); ++k)
    change(static_cast<std::size_t>(model.layout.position[body] + k));
}

}  // namespace

KnownPositions::KnownPositions(const FilterModel& model) : positions_(model.positions.size()) {}

void KnownPositions::begin(const FilterModel& model, const InitialPosture& posture, BaseMode base) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const bool slides = model.bodies[b].motion == JointMotion::prismatic;
    for_each_position(model, b, [&](std::size_t i) {
      const StartPosition& start = posture.positions[i];
      const bool is_shown = slides || (parent_moves(model, b, base) && (base == BaseMode::moving || !start.is_unseen)),
                 has_zero = slides || start.is_known || start.is_unseen || model.is_loose(b);
      const double lost = std::min(max_position_sd, start.lost_sd.value_or(0.0)),
                   since_before = std::max(positions_[i].start_sd, lost);
      positions_[i] = {.is_known = start.is_known,
                       .is_open = !start.is_known && has_grid(model, b) && is_shown,
                       .is_relative = model.unknown_zero(static_cast<Index>(i)) != nullptr,
                       .start_sd = has_zero        ? 0.0
                                   : start.lost_sd ? since_before
                                                   : max_position_sd,
                       .lost_sd = lost};
    });
  }
}

void KnownPositions::let_base_move(const FilterModel& model) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    if (has_open_heading(model, b)) decide(model, b);  // its standard deviation is the filter's
    for_each_position(model, b,
                      [&](std::size_t i) { positions_[i].is_open = !positions_[i].is_known && has_grid(model, b); });
  }
}

void KnownPositions::decide(const FilterModel& model, std::size_t body) {
  for_each_position(model, body, [&](std::size_t i) {
    positions_[i] = {.is_known = true, .is_relative = positions_[i].is_relative};
  });
}

bool KnownPositions::has_open_heading(const FilterModel& model, std::size_t body) const {
  if (!motion_shows_heading(model, body)) return false;
  return !positions_[static_cast<std::size_t>(model.layout.position[body])].is_known;
}

void KnownPositions::lose(Index position, double sd, BaseMode base) {
  KnownPosition& at = positions_[static_cast<std::size_t>(position)];
  at.is_known = false;
  at.is_open = base == BaseMode::moving;
  at.lost_sd = std::max(at.lost_sd, std::min(max_position_sd, sd));
  at.start_sd = std::max(at.start_sd, at.lost_sd);
}

double KnownPositions::start_sd(const FilterModel& model, std::size_t body) const {
  const Index at = model.layout.position[body];
  return at < 0 ? 0.0 : positions_[static_cast<std::size_t>(at)].start_sd;
}

}  // namespace kinfer::track
